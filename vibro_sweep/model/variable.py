"""What is declared of a variable of a file of orbits."""

from typing import Any, NamedTuple

import numpy as np


class Variable(NamedTuple):
    """A variable of a file."""

    name: str
    asked_by: tuple[str, ...]  # words of `observe`, TRAJECTORY or SETTLE; of none: it is always there
    label: str  # short: of an axis; `long_name` in the file
    text: str  # `description` in the file
    dimensions: tuple[str, ...] = ()
    dtype: str = "f8"
    units: str = "1"
    missing: float | None = None  # by default NaN, or -1 of integers
    in_kernel: bool = True  # a field of the record that kernels fill for each orbit
    at_impacts: bool = False  # only of sections at impacts
    symbol: str = ""  # TeX, where it has one
    attributes: dict[str, Any] = {}  # noqa: RUF012  # more attributes in the file; read only

    @property
    def long_name(self) -> str:
        return self.label

    @property
    def fill(self) -> float:
        """The value where nothing is computed."""
        if self.missing is not None:
            return self.missing
        return np.nan if np.dtype(self.dtype).kind == "f" else -1
