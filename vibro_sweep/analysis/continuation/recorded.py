"""Recorded points of a branch or a curve, one after the other."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.engine.continuation.workspace import TEST


class Rows(NamedTuple):
    """Points."""

    p: np.ndarray  # (points,); of a curve (points, 3)
    t: np.ndarray  # (points, K)
    D: np.ndarray  # (points, K)
    ends: np.ndarray  # (points, rests)
    motion: np.ndarray  # (points, K, 2): gap velocity and acceleration before each impact
    stop_distance: np.ndarray  # (points,)
    residual: np.ndarray  # (points,)
    state: np.ndarray  # (points, 2N): x1 v1 .. xN vN at t = 0; of a curve what is free of the state before the first
    # impact, in contact coordinates

    def taken(self, which: slice) -> "Rows":
        return Rows(*(values[which] for values in self))


def join(parts: list[Rows]) -> Rows:
    """One after the other; NaN where a part has fewer impacts than another."""
    K = max(part.t.shape[1] for part in parts)

    def filled(values):
        missing = np.full((len(values), K - values.shape[1], *values.shape[2:]), np.nan)
        return np.concatenate([values, missing], axis=1)

    full = [part._replace(t=filled(part.t), D=filled(part.D), motion=filled(part.motion)) for part in parts]
    return Rows(*(np.concatenate(values) for values in zip(*full, strict=True)))


def both_directions(down: Rows, up: Rows) -> Rows:
    """The rows of two runs from one point, from the end of the first run to that of the second."""
    return join([down.taken(np.s_[:0:-1]), up])


def rows_of(curve: SolutionCurve, x, motion, p, tests, omega, tau, state) -> Rows:
    """Points, of what kernels have of them; omega, tau: (points,) of the force, state: as of `Rows`."""
    units, rests, omega = curve.units, curve.problem.rests, omega[:, None] * curve.units.rate
    t, speeds = (x[..., -2] - np.reshape(tau, (-1, 1))) / omega, motion * units.speed * [1.0, units.rate]
    D = np.where(rests, -speeds[..., 0], x[..., -1] * units.speed)
    ends = (t + x[..., -1] / omega)[:, rests]
    stop_distance, residual = tests[:, TEST.stop_distance] * units.length, tests[:, TEST.residual].copy()
    return Rows(p.copy(), t, D, ends, speeds, stop_distance, residual, state)
