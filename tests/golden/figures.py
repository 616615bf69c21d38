"""Figures as records: what is drawn of data that are part of the record, of results, and by the command line.

A case is a call in Python, or the words of the command line; what it draws is described by `drawn`.
"""

from contextlib import chdir
from functools import cache
from unittest.mock import patch

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from support.programs import ended

import vibro_sweep as vs
from golden import records
from golden.datasets import dataset_of
from golden.drawn import described, without_arrays
from golden.files import PAPER, file_of
from golden.shown import different


class Data(dict):
    """The Datasets that are drawn, by their names."""

    def __missing__(self, name: str):
        self[name] = dataset_of(_stored()[name])
        return self[name]


@cache
def _stored() -> dict[str, dict]:
    return records.read("figure_data")


def result_of(case: dict) -> list[dict]:
    """The figures of a case, described; the command line may draw several."""
    figures = _by_command(case) if "command" in case else [figure_of(case)]
    return [described(figure) if case.get("arrays", True) else without_arrays(described(figure)) for figure in figures]


def figure_of(case: dict) -> Figure:
    """What a call in Python draws."""
    shown = eval(case["call"], {"vs": vs, "data": Data(), "paper": PAPER, "Figure": Figure})
    return shown.figure if isinstance(shown, Axes) else shown  # where it was drawn into axes


def _by_command(case: dict) -> list[Figure]:
    """Those that the program writes."""
    figures, save = [], Figure.savefig

    def savefig(self, *arguments, **options):
        figures.append(self)
        return save(self, *arguments, **options)

    words = [f"{case['file']}.h5", *case["command"].split()]
    files = [file_of(record) for record in records.read("files").values() if record["file"] in words]
    with patch.object(Figure, "savefig", savefig), chdir(files[0].parent):
        status, _, errors = ended("plot", *words, "--output", "picture.svg", "--overwrite")
    if status or not figures:
        raise ValueError(errors or "nothing is drawn")
    return figures


def differences_from(record: dict) -> list[str]:
    """Between a record and what is drawn now."""
    return different(record["result"], result_of(record))
