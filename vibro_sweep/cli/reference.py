"""Pages of the reference, made from the declarations:  python -m vibro_sweep.cli.reference docs/reference"""

import sys
from pathlib import Path

from .reference_pages import (
    bifurcation_page,
    citation_page,
    command_page,
    file_pages,
    model_page,
    picture_page,
    scene_page,
    status_page,
)

PAGES = {
    "commands": command_page.page,
    "scenes": scene_page.page,
    "model_numbers": model_page.page,
    "sweep_files": file_pages.of_sweeps,
    "branch_files": file_pages.of_branches,
    "pictures": picture_page.page,
    "bifurcations": bifurcation_page.page,
    "statuses": status_page.page,
}


def pages(repository: Path) -> dict[str, str]:
    """The pages as Markdown, by the names of their files."""
    made = {name: page() for name, page in PAGES.items()} | {"citing": citation_page.page(repository)}
    return {f"{name}.md": "\n".join(lines).rstrip() + "\n" for name, lines in made.items()}


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    for name, text in pages(folder.resolve().parents[1]).items():
        (folder / name).write_text(text)
