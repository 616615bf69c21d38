"""docs/reference/glossary.md: every key, option, argument and variable is in it, once, and nothing else."""

import inspect
import re
from fnmatch import fnmatchcase

import typer
from support import ROOT

import vibro_sweep as vs
from vibro_sweep import types
from vibro_sweep.cli.commands import app
from vibro_sweep.model.branch_file import BRANCHES, CHART, WINDOWS, columns
from vibro_sweep.model.curve_columns import OF_EDGES
from vibro_sweep.model.observables import VARIABLES
from vibro_sweep.scene import json_schema

TEXT = (ROOT / "docs" / "reference" / "glossary.md").read_text()
OF_NUMPY = {"Exponents", "Status"}  # an array and a text, with the methods of these


def words(title):
    """The words of a section's table, one or several in a row."""
    rows = re.findall(r"^\| (`.*?`) \|", TEXT.partition(f"## {title}\n")[2].partition("\n## ")[0], re.M)
    return [word.replace("#", "[0-9]*") for row in rows for word in re.findall(r"`(.+?)`", row)]


def keys(node):
    if isinstance(node, dict):
        yield from node.get("properties", {})
        for one in node.values():
            yield from keys(one)
    elif isinstance(node, list):
        for one in node:
            yield from keys(one)


def arguments():
    functions = [getattr(vs, name) for name in vs.__all__]
    classes = [getattr(types, name) for name in types.__all__ if name not in OF_NUMPY]
    functions += [
        one
        for kind in classes
        if inspect.isclass(kind)
        for name, one in inspect.getmembers(kind, inspect.isfunction)
        if not name.startswith("_") and one.__module__.startswith("vibro_sweep")
    ]
    for function in functions:
        if not (inspect.isclass(function) and function.__init__ is Exception.__init__):
            try:
                signature = inspect.signature(function)
            except ValueError:  # of an exception without one of its own
                continue
            yield from (name for name in signature.parameters if name != "self")


def options():
    for command in typer.main.get_command(app).commands.values():
        for one in command.params:
            yield from (option.lstrip("-") for option in one.opts if not re.fullmatch("-.", option))


def variables():
    yield from (one.name for one in VARIABLES)
    for kind in (BRANCHES, WINDOWS, CHART):
        yield from (one.name for one in columns(kind, ["b"], 2))
    yield from (one.name for one in OF_EDGES)


def missing(found, known):
    return sorted(one for one in found if not any(fnmatchcase(one, word) for word in known))


def test_keys_options_and_arguments_are_in_it():
    known = words("Keys, options and arguments")
    found = {*keys(json_schema()), *arguments(), *options()}
    assert len(found) > 150 and missing(found, known) == []
    assert [word for word in known if not any(fnmatchcase(one, word) for one in found)] == []


def test_variables_are_in_it():
    known = words("Variables of files")
    found = {*variables(), "gap"}
    numbers = {"b", *(f"{letter}{i}" for letter in "xv" for i in (1, 2))}  # keys
    assert len(found) > 90 and missing(found - numbers, known) == []
    assert [word for word in known if not any(fnmatchcase(one, word) for one in found)] == []


def test_a_word_has_one_meaning():
    for title in ("Keys, options and arguments", "Variables of files"):
        found = words(title)
        assert len(found) == len({*found}) > 20
    terms = re.findall(r"^\| ([a-zA-Z].*?) \|", TEXT.partition("## Terms\n")[2].partition("\n## ")[0], re.M)[1:]
    assert terms == sorted(terms, key=str.lower) and len(terms) == len({*terms}) > 25
