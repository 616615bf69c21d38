"""docs/reference/glossary.md: every key, option, argument and variable is in it, once, and nothing else."""

import inspect
import json
import re
from fnmatch import fnmatchcase

from support import ROOT
from support.programs import ended

import vibro_sweep as vs
from vibro_sweep import types

REFERENCE = ROOT / "docs" / "reference"
TEXT = (REFERENCE / "glossary.md").read_text()
OF_NUMPY = {"Exponents", "Status"}  # an array and a text, with the methods of these


def words(title):
    """The words of a section's table, one or several in a row."""
    rows = re.findall(r"^\| (`.*?`) \|", TEXT.partition(f"## {title}\n")[2].partition("\n## ")[0], re.M)
    return [word.replace("#", "[0-9]*") for row in rows for word in re.findall(r"`(.+?)`", row)]


def keys(node):
    """Of the JSON Schema of scenes."""
    if isinstance(node, dict):
        yield from node.get("properties", {})
    if isinstance(node, (dict, list)):
        for inner in node.values() if isinstance(node, dict) else node:
            yield from keys(inner)


def arguments():
    functions = [getattr(vs, name) for name in vs.__all__]
    classes = [getattr(types, name) for name in types.__all__ if name not in OF_NUMPY]
    functions += [
        method
        for kind in classes
        if inspect.isclass(kind)
        for name, method in inspect.getmembers(kind, inspect.isfunction)
        if not name.startswith("_") and method.__module__.startswith("vibro_sweep")
    ]
    for function in functions:
        if not (inspect.isclass(function) and function.__init__ is Exception.__init__):
            try:
                signature = inspect.signature(function)
            except ValueError:  # of an exception without one of its own
                continue
            yield from (name for name in signature.parameters if name != "self")


def in_tables(page, pattern, heading=""):
    """What a page of the reference, or its part behind a heading, has in the first column of its tables; it is made by
    the program."""
    rows = re.findall(r"^\| (`.*?`) \|", (REFERENCE / page).read_text().partition(heading or "\n")[2], re.M)
    return {word for row in rows for word in re.findall(pattern, row)}


def missing(found, known):
    return sorted(name for name in found if not any(fnmatchcase(name, word) for word in known))


def test_keys_options_and_arguments_are_in_it():
    known = words("Keys, options and arguments")
    options = in_tables("commands.md", r"--([a-z-]+)")
    found = {*keys(json.loads(ended("schema").out)), *arguments(), *options}
    assert len(found) > 150 and len(options) > 18 and missing(found, known) == []
    assert [word for word in known if not any(fnmatchcase(name, word) for name in found)] == []


def test_variables_are_in_it():
    known = words("Variables of files")
    found = {"gap"}.union(*(in_tables(page, r"^`(\w+)`$") for page in ("sweep_files.md", "branch_files.md")))
    dimensions = in_tables("sweep_files.md", r"^`(\w+)`$", "## Dimensions\n")
    numbers = {"b", "omega", *(f"{letter}{i}" for letter in "xv" for i in (1, 2))}  # keys
    assert len(found) > 90 and len(dimensions) > 8 and missing(found - numbers - dimensions, known) == []
    assert [word for word in known if not any(fnmatchcase(name, word) for name in found)] == []


def test_a_word_has_one_meaning():
    for title in ("Keys, options and arguments", "Variables of files"):
        found = words(title)
        assert len(found) == len({*found}) > 20
    terms = re.findall(r"^\| ([a-zA-Z].*?) \|", TEXT.partition("## Terms\n")[2].partition("\n## ")[0], re.M)[1:]
    assert terms == sorted(terms, key=str.lower) and len(terms) == len({*terms}) > 25
