"""The tables of a point, in contact coordinates (points/contact.py)."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.simd.jit import exported
from vibro_sweep.engine.tables.exclusion import fill_exclusion
from vibro_sweep.engine.tables.fast_roots import fill_stiff_exclusion
from vibro_sweep.engine.tables.flight import inputs_of
from vibro_sweep.engine.tables.forced import fill_forced_motion, fill_phases
from vibro_sweep.engine.tables.frame_tables import fill_frame
from vibro_sweep.engine.tables.products import fill_products
from vibro_sweep.engine.tables.series import (
    fill_equations,
    fill_flight_series,
    fill_held,
    fill_impulse,
    set_grid,
)


class Workspace(NamedTuple):
    """The arrays in which the tables are computed."""

    A: np.ndarray  # (inputs, inputs)
    row: np.ndarray  # (inputs,)
    turned: np.ndarray  # (2, 2 N + 3)
    twofold: np.ndarray  # (4, 2, inputs, inputs)


def new_workspace(masses: int, constant: bool) -> Workspace:
    """Room for the tables of an oscillator with so many masses."""
    inputs = inputs_of(masses, constant)
    return Workspace(
        np.empty((inputs, inputs)),
        np.empty(inputs),
        np.empty((2, 2 * masses + 3)),
        np.empty((4, 2, inputs, inputs)),
    )


@exported
def build(f, w, point):
    """Fill the tables of a point (`point_of`)."""
    q = f.oscillator[0]
    fill_phases(q, f.nodes, point.cells, point.tau)
    set_grid(q, point.omega, max(point.omega, point.rate))
    fill_equations(w.A, point, len(q.force))
    fill_flight_series(q, w)
    fill_impulse(q, point)
    fill_held(q, point, max(point.omega, point.constrained_rate))
    fill_products(q, f.nodes, point, w.twofold)
    fill_forced_motion(q, f.nodes, point.begin)
    if q.stiff:
        fill_stiff_exclusion(q, f.nodes, f.scan, point, w.turned)
    else:
        fill_exclusion(q, f.nodes, f.scan)
    if point.frame_scale[0] > 0.0:  # 0: no tangent vectors are wanted
        fill_frame(q, f.nodes, point)
    q.middle, q.swing = point.middle, point.swing
    for i in range(len(q.steady)):
        q.steady[i] = point.steady[i]
        for j in range(len(q.steady)):
            q.confining[i, j] = point.confining[i, j]
