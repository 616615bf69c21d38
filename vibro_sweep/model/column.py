"""What is declared of a variable of files of branches, windows and curves."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np


class Column(NamedTuple):
    """A variable. An index counts from 0; -1: there is none."""

    name: str
    dimensions: tuple[str, ...]
    dtype: str
    label: str  # `long_name`
    text: str  # `description`
    units: str = "1"
    flags: tuple[str, ...] = ()  # words of the codes 0, 1, ...
    index_in: str = ""  # of an index: the dimension along which it counts
    optional: bool = False  # of an index: whether it may be -1

    def limits(self, lengths: Mapping[str, int]) -> tuple[int, int] | None:
        """The least and the largest index or code; None for other numbers. lengths : of dimensions"""
        if self.index_in:
            return -1 if self.optional else 0, lengths.get(self.index_in, 0) - 1
        return (0, len(self.flags) - 1) if self.flags else None

    def holds(self, values: np.ndarray, lengths: Mapping[str, int]) -> bool:
        """Whether all are indices or codes that there are."""
        least, most = self.limits(lengths) or (-np.inf, np.inf)
        return not np.any((values < least) | (values > most))


OF_FIRST = "of the first parameter"  # the unit that such a number has
OF_PARAMETER = "of the parameters"  # that which all of them have; where they differ there is none
