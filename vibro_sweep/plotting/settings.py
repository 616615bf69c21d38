"""The numbers of a run as its file holds them."""

from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.tables.outcomes import VALID, status_of
from vibro_sweep.tables.parameters import FOLLOWING

Along = dict[str, tuple[tuple[str, ...], np.ndarray]]  # name -> the keys that a number depends on, its values


class Settings(NamedTuple):
    """The settings of a run.

    `constant`: numbers and words that are the same at all points. `along`: numbers that follow from swept ones.
    `significant`: standard errors that tell an exponent from zero; NaN where the file has none. `valid`: codes of
    points whose numbers are valid, as the file itself names them.
    """

    constant: dict[str, Any]
    along: Along
    significant: float
    valid: list[int]


def settings_of(source: Sweep) -> Settings:
    """The settings of a run as a file, or a Dataset of one, states them."""
    along = {
        name: (source.dims(name), source.values(name))
        for name in FOLLOWING
        if name in source and name not in source.keys
    }
    significant = source.attribute("lyapunov_error", "significant") if "lyapunov_error" in source else None
    words = {str(name): x.item() for name, x in source.data.coords.items() if x.ndim == 0 and x.dtype.kind not in "if"}
    return Settings(
        source.attrs | words | source.held | source.numbers,
        along,
        np.nan if significant is None else float(significant),
        _valid(source),
    )


def _valid(source: Sweep) -> list[int]:
    meanings = source.attribute("status", "flag_meanings")
    if meanings is None:
        return [0]
    named = zip(np.atleast_1d(source.attribute("status", "flag_values")).tolist(), meanings.split(), strict=False)
    valid = {status_of(code).name for code in VALID}
    return [code for code, meaning in named if meaning in valid]
