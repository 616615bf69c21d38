"""Tables of cases: tests/cases/NAME.yaml, one case a row, as parameters of a test."""

from pathlib import Path
from typing import Any

import pytest
import yaml

from . import ROOT, spread

FOLDER = ROOT / "tests" / "cases"


def rows(name: str, sample: int | None = None, folder: Path = FOLDER, one_in: int = 1) -> list:
    """The rows of a table, each a dict, with their ids; those with `slow: true` have the mark.

    Of a long table `sample` rows, spread over all of it, are fast, and one in `one_in` of the others slow.
    """
    table = read((folder / f"{name}.yaml").read_text())
    fast = spread(len(table) if sample is None else sample, len(table))
    return [
        pytest.param(row, id=row["id"], marks=[pytest.mark.slow] if row.get("slow") or k not in fast else [])
        for k, row in enumerate(table)
        if k in fast or k % one_in == 0
    ]


def nth(name: str, k: int) -> dict[str, Any]:
    """The k-th row of a table."""
    return rows(name)[k].values[0]


def read(text: str) -> list[dict[str, Any]]:
    """The rows in a text. An entry with `rows` is a group, and gives its rows what else it has.

    A row without an id has the first of its values as its id.
    """
    table = []
    for entry in yaml.load(text, yaml.CSafeLoader):
        common = {key: value for key, value in entry.items() if key != "rows"} if "rows" in entry else {}
        table += [{"id": str(next(iter(row.values())))} | common | row for row in entry.get("rows", [entry])]
    names = [row["id"] for row in table]
    if repeated := sorted({name for name in names if names.count(name) > 1}):
        raise ValueError(f"these ids are given twice: {repeated}")
    return table
