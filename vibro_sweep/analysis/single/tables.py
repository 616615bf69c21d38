"""From an oscillator and values for some of its numbers to what kernels are given of each point."""

import numpy as np

from vibro_sweep.engine.any_points import any_points, kind_of
from vibro_sweep.engine.one_system import is_paper, points_of
from vibro_sweep.engine.records import PAPER, Kind
from vibro_sweep.model.any_oscillator import AnyOscillator
from vibro_sweep.model.grid import grid, linears


def table_of(system: AnyOscillator, axes: dict[str, np.ndarray], frames: bool) -> tuple[np.ndarray, Kind]:
    """Points of a grid of values, of its shape, and the kernels that they need. frames: for tangent vectors."""
    if is_paper(system, axes):
        return points_of(grid(system, axes), system.stops, frames), PAPER
    each = linears(system, axes)
    kind = kind_of(each)
    return any_points(each, kind, frames), kind
