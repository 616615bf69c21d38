"""From an oscillator and values for some of its numbers to what kernels are given of each point."""

import numpy as np

from vibro_sweep.engine.points.any_points import any_points, kind_of
from vibro_sweep.engine.records import Kind
from vibro_sweep.oscillator.grid import linears
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.oscillator.own_time import in_own_time, rate_of


def table_of(system: Oscillator, axes: dict[str, np.ndarray], frames: bool) -> tuple[np.ndarray, Kind, float]:
    """Points of a grid of values, of its shape, the kernels that they need, and the rate of their unit of time.

    frames : for tangent vectors
    """
    each = linears(system, axes)
    kind, rate = kind_of(each), rate_of(system.omega)  # of the system, so that it is the same in all blocks
    return any_points(in_own_time(each, rate), kind, frames), kind, rate
