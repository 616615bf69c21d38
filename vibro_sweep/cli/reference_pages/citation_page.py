"""How to cite the program, the paper that it follows, and the sources of its models."""

from collections.abc import Iterator
from pathlib import Path

import yaml

from vibro_sweep.model.models import MODELS

from .markdown import head, table


def page(repository: Path) -> Iterator[str]:
    """The page, from CITATION.cff of the repository, which an installed package does not have."""
    cited = yaml.safe_load((repository / "CITATION.cff").read_text(encoding="utf-8"))
    yield from head(
        "How to cite",
        "Please cite the program with its version, as `vibro-sweep --version` prints it, the paper that it follows,\n"
        "and the source of the model that you use. `CITATION.cff` in the repository has the same for programs.",
    )
    yield f"```bibtex\n@software{{{cited['title']},"
    yield _fields(
        title=f"{{{cited['title']}}}: {cited['abstract'].rstrip('.')}",
        author=_authors(cited["authors"]),
        version="...",
    )
    for one in cited["references"]:
        first = one["authors"][0]["family-names"].lower()
        yield f"}}\n\n@{one['type']}{{{first}{one['year']},"
        yield _fields(
            **{key: one[key] for key in ("title", "journal", "year", "doi")},
            author=_authors(one["authors"]),
            pages=one["start"],
        )
    yield "}\n```\n\n## Sources of the models\n"
    rows = (
        (f"`{name}`", one.source.replace("docs/how/model.md", "[the model](../how/model.md)"))
        for name, one in MODELS.items()
    )
    yield from table(("model", "source"), rows)


def _fields(**fields: object) -> str:
    return "\n".join(f"  {name} = {{{value}}}," for name, value in fields.items())


def _authors(authors: list[dict]) -> str:
    """Names as BibTeX has them: family name first, one that is no person's in braces."""
    names = (
        f"{one['family-names']}, {one['given-names']}" if "given-names" in one else f"{{{one['name']}}}"
        for one in authors
    )
    return " and ".join(names)
