"""Pieces of Markdown that the pages have in common."""

import inspect
from collections.abc import Iterable, Iterator

from vibro_sweep.model.wording import sentence

NOTE = "<!-- made by `python -m vibro_sweep.cli.reference docs/reference`; not edited by hand -->"


def head(title: str, text: str) -> Iterator[str]:
    """The title of a page, and what it is for."""
    yield f"# {title}\n\n{NOTE}\n\n{text}\n"


def table(columns: tuple[str, ...], rows: Iterable[tuple]) -> Iterator[str]:
    for row in (columns, ["---"] * len(columns), *rows):
        cells = (str(cell).replace("|", "\\|") for cell in row)
        yield f"| {' | '.join(cells)} |"
    yield ""


def outcomes(found: Iterable[tuple[str, str, str]]) -> Iterator[str]:
    """A list of names, each with its meaning and what to do."""
    for name, text, advice in found:
        yield f"- **{name}**: {sentence(text)}" + (f"\n  *What to do:* {advice}" if advice else "")
    yield ""


def summary(function) -> str:
    """The first paragraph of a docstring."""
    return " ".join(inspect.getdoc(function).partition("\n\n")[0].split())


def listed(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)
