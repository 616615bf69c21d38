"""Points of a curve, one after the other."""

from typing import NamedTuple

import numpy as np


class Rows(NamedTuple):
    """Points of a curve."""

    p: np.ndarray  # (points, 3)
    t: np.ndarray  # (points, K)
    D: np.ndarray  # (points, K)
    motion: np.ndarray  # (points, K, 2)
    margin: np.ndarray  # (points,)
    residual: np.ndarray  # (points,)
    h: np.ndarray  # (points, n): free part of the state before the first impact, in contact coordinates


def join(parts: list[Rows]) -> Rows:
    """One after the other; NaN where a part has fewer impacts than another."""
    K = max(part.t.shape[1] for part in parts)

    def filled(values):
        missing = [(0, 0)] * values.ndim
        missing[1] = (0, K - values.shape[1])
        return np.pad(values, missing, constant_values=np.nan)

    full = [part._replace(t=filled(part.t), D=filled(part.D), motion=filled(part.motion)) for part in parts]
    return Rows(*(np.concatenate(values) for values in zip(*full, strict=True)))
