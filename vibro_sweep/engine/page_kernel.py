"""What a page computes in a browser, where there is no Python: one kernel, which becomes a WebAssembly module.

It has the machine's own unit of time, as all of the engine. Points are those of points/plain_points.py, or of
points/coupled_points.py; of oscillators that are neither, and of those that cells do not resolve, the page has none.
"""

import math

from vibro_sweep.engine.orbit_block import run_points
from vibro_sweep.engine.points.coupled_points import set_coupled_point
from vibro_sweep.engine.points.plain_modes import PLAIN, UNKNOWN, set_modes
from vibro_sweep.engine.points.plain_points import set_plain_point
from vibro_sweep.engine.points.refined_equations import refine_equations
from vibro_sweep.engine.simd.jit import exported, inline, jit
from vibro_sweep.engine.tables.cells import LEAST_CELLS, LONGEST, MOST_CELLS
from vibro_sweep.engine.tables.flight import WIDTH
from vibro_sweep.engine.trajectory import run_trajectories

SET_UP, DIAGRAM, TRAJECTORY = range(3)  # what `run_page` does


@exported
def run_page(
    task, machines, stops, laws, release, known, modes, points, starts, results, sections, phases, running, hits, kept,
    w, plan,
):  # fmt: skip
    """Set up points, or compute a block of them, or go on with the motion of its first orbit.

    machines: (m,) of `machine_of`; stops: (m, 4), as of a point; laws: (m, 2, 3), stiffness, damping and preload of the
    left stop and of the right one, None where all are rigid; release: as of a point. known: (m,), which of them could
    be set up. points: (n, m); to be set up are those of the first step. hits, kept: as of `run_trajectories`. All
    others as of `run_points`.
    """
    if task == SET_UP:
        set_points(machines, stops, laws, release, known, modes, points[0], plan.lyapunov)
    elif task == DIAGRAM:
        run_points(points, starts, results, sections, phases, running, w, plan, None)
    else:
        run_trajectories(points[0, :1], results[:1, :1], hits, kept, w, plan)


@jit
def set_points(machines, stops, laws, release, known, modes, points, frames):
    """Set up points (m,) with their stops and cells."""
    for i in range(len(machines)):
        q, p, w = machines[i], points[i], modes[0]
        kind = set_modes(q, w)
        plain = kind == PLAIN and set_plain_point(q, p, w, frames)
        known[i] = plain or (kind != UNKNOWN and set_coupled_point(q, p, w))
        p.cells = cells_of(max(p.rate, p.omega), p.omega) if known[i] else 0
        known[i] = p.cells > 0
        if known[i] and p.apart:
            refine_equations(q, p, w)
        for j in range(4):
            p.stops[j] = stops[i, j]
        set_law(laws, release, i, q, p, w)


@jit
def cells_of(rate, omega):
    """`cells_for` of one oscillator; 0 also where that would be too many."""
    turns = 2.0 * math.pi * max(rate / omega, 1.0)
    if not turns <= LONGEST:
        return 0
    cells = max(LEAST_CELLS, 8 * math.ceil(turns / WIDTH / 8.0))
    return cells if cells <= MOST_CELLS else 0


@inline
def set_law(laws, release, i, q, p, modes):
    """The compliant stops of a point, over m_e = 1/(n M^-1 n), and a bound of the rates in contact with each.

    Where no motion is stiffer than k, nor damped more than c, no root of s^2 + c s + k is beyond max(sqrt k, c).
    """
    if laws is not None:
        compliance, stiffest, strongest = modes.along[0], 0.0, 0.0
        for j in range(len(q.M)):
            stiffest, strongest = max(stiffest, modes.square[j]), max(strongest, modes.damping[j])
        p.contact_mass, p.release = 1.0 / compliance, release
        for n in range(2):
            for j in range(3):
                p.contact_law[n, j] = laws[i, n, j] * compliance
            stiffness, damping = stiffest + p.contact_law[n, 0], strongest + p.contact_law[n, 1]
            p.contact_rate[n] = max(math.sqrt(stiffness), damping, p.omega)
