"""Docstrings as reStructuredText: lists of "name : meaning", sections, and signs that mean something else there.

A name in single backticks is linked where it is one of ours, or of a package with an inventory.
"""

import re
from collections.abc import Iterator

from numpy.typing import ArrayLike
from sphinx.application import Sphinx
from sphinx.pycode import ModuleAnalyzer
from sphinx.util.typing import stringify_annotation

ITEM = re.compile(r"([\w.]+(?:\([^)]*\))?(?:, [\w.]+)*) : (.+)")
NAME = re.compile(r"\w+(\.\w+)*")
RULE = re.compile(r"-{3,}")


def as_rst(lines: list[str]) -> Iterator[str]:
    """The lines of a docstring in reStructuredText."""
    code = within = False
    for line, after in zip(lines, [*lines[1:], ""], strict=True):
        code = line.startswith(">>> ") or (code and bool(line))  # an example and its output
        item = ITEM.fullmatch(line)
        if RULE.fullmatch(line):
            continue
        elif RULE.fullmatch(after):
            yield from ("", f".. rubric:: {line}", "")
        elif code:
            yield line
        elif item:
            names = ", ".join(f"``{name}``" for name in item[1].split(", "))
            yield from ("", names, f"    {_escaped(item[2])}")
        else:
            if within and line and not line.startswith(" "):
                yield ""
            yield _escaped(line)
        within = bool(item) or (within and line.startswith(" "))


def _escaped(line: str) -> str:
    """Outside of backticks, stars, bars and a final underscore mean themselves; inside, all but a name is code."""
    texts = re.split(r"`([^`]*)`", line)
    texts[::2] = [re.sub(r"[*|]|(?<=\w)_(?!\w)", r"\\\g<0>", text) for text in texts[::2]]
    texts[1::2] = [f"`{text}`" if NAME.fullmatch(text) else f"``{text}``" for text in texts[1::2]]
    return "".join(texts)


def _process(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    lines[:] = as_rst(lines)


def _signature(app: Sphinx, what: str, name: str, obj: object, options: object, signature: str, returned: str):
    """ArrayLike by its name, not as all that it may be; none of a class that only the package makes."""
    if re.search(r"\b_\w+:|^\(iterable", signature or ""):
        return "", ""
    long = stringify_annotation(ArrayLike, "smart")
    return tuple(text and text.replace(long, "~numpy.typing.ArrayLike") for text in (signature, returned))


def _skip(app: Sphinx, what: str, name: str, obj: object, skip: bool, options: object) -> bool | None:
    """Leave out fields of tuples: the docstring of the class has them."""
    return True if (getattr(obj, "__doc__", None) or "").startswith("Alias for field number") else None


# One signature for each function, with all its options: overloads are for type checkers.
ModuleAnalyzer.overloads = property(lambda self: {}, lambda self, _: None)


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", _process)
    app.connect("autodoc-process-signature", _signature)
    app.connect("autodoc-skip-member", _skip)
    return {"parallel_read_safe": True}
