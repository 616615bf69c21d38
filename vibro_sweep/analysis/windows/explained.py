"""Why the regions of a plane end: curves for its edges, in rounds, until each edge has a curve or a reason.

In a round each connected region of one period sends some of its edges that no curve explains. The orbit there is
followed across the edge, to what ends its stability; from that a curve is followed, which explains other edges as well.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy import ndimage

from vibro_sweep.analysis.branches.branch_arrays import Arrays
from vibro_sweep.analysis.branches.search import Evaluate, Node
from vibro_sweep.analysis.branches.seeds import Seed, packed, unpacked
from vibro_sweep.analysis.curves.curve_search import Curves, seed_at
from vibro_sweep.analysis.periodic.finding import periodic_orbit
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.windows.edges import Edges, Plane, edges_of, passing
from vibro_sweep.analysis.windows.job import lies_on
from vibro_sweep.analysis.windows.stretch import stable_end
from vibro_sweep.tables.outcomes import EDGES, codes

SHARE = 12  # edges of a region, of which one is sent in a round
BEYOND = 0.25  # of the way to the neighbour: so far behind it the orbit is followed
_CODES = codes(EDGES)


class Probe(NamedTuple):
    """An orbit beside an edge: its oscillator, a state at t = 0 mod T, its period; the number that changes towards the
    neighbour, and how far to follow it."""

    system: Any
    state: np.ndarray
    period: int
    names: tuple[str, str]
    parameter: str
    beyond: float


@one_thread()
def probe(task: Probe) -> Arrays:
    """The end of the stability of an orbit that is followed across an edge: `reason`, a code of EDGES, and, as `packed`
    has it, a start of a curve or none."""
    reason, seed = _probed(task)
    return {"reason": np.int8(_CODES[reason])} | packed([] if seed is None else [seed], task.names)


def _probed(task: Probe) -> tuple[str, Seed | None]:
    here = float(task.system.family.free[task.parameter])
    bounds = (min(here, task.beyond), max(here, task.beyond))
    try:
        orbit = periodic_orbit(task.system, task.state, task.period)
        if not (orbit.ok and orbit.stable and lies_on(orbit, task.state)):
            return "not_settled" if orbit.ok else "failed", None
        end = stable_end(orbit, task.parameter, bounds, float(np.sign(task.beyond - here)))
    except ValueError:
        return "failed", None
    if end.type == "boundary":
        return "stable_at_both", None
    seed = seed_at(end, task.names)
    return ("no_curve", seed) if seed is not None else ("failed", None)


class Explained(NamedTuple):
    """curves : list of Node; edges; reason : (edges,) codes of EDGES; curve : (edges,) index of the curve or -1."""

    curves: list[Node]
    edges: Edges
    reason: np.ndarray
    curve: np.ndarray


def explain(
    plane: Plane,
    states: np.ndarray,
    system,
    names: tuple[str, str],
    bounds,
    of: tuple[str, ...],
    depth: int,
    evaluate_probes: Callable[[list[str], list[Probe]], list[Arrays]],
    evaluate_curves: Evaluate,
) -> Explained:
    """Curves for the edges of a plane. states : (n, m, 2N), of the orbits; evaluate_probes, evaluate_curves : give
    `probe` and `compute_curve` of tasks by their names."""
    edges = edges_of(plane)
    count = len(edges.periods)
    reason, curve = np.full(count, _CODES["open"]), np.full(count, -1)
    tried = edges.periods == 0  # (edges, 2): whether the orbits of both points have been followed
    known: list[Node] = []
    turn = 0
    while len(picks := _picked(plane, edges, tried)):
        jobs = {f"edge {edge}:{side}": _task(plane, states, system, names, edges, edge, side) for edge, side in picks}
        seeds, before = [], len(known)
        for (edge, side), arrays in zip(picks, evaluate_probes(list(jobs), list(jobs.values())), strict=True):
            found = unpacked(arrays, names, system)
            tried[edge, side] = True
            reason[edge] = min(reason[edge], arrays["reason"])  # what says most comes first
            if found:
                tried[edge] = True
                seeds += found

        def evaluate(keys, tasks, turn=turn):
            return evaluate_curves([f"{turn}:{key}" for key in keys], tasks)

        known = Curves(names, bounds, of).run([seed for seed in seeds if seed.type in of], depth, evaluate, known)
        for i in range(before, len(known)):
            passed = passing(plane, edges, known[i].arrays)
            passed = passed[curve[passed] < 0]
            curve[passed], reason[passed], tried[passed] = i, _CODES["curve"], True
        turn += 1
    return Explained(known, edges, reason, curve)


def _picked(plane: Plane, edges: Edges, tried: np.ndarray) -> list[tuple[int, int]]:
    """(edge, side) of some edges of each region, spread over it."""
    found = []
    for period in np.unique(plane.period[plane.period > 0]):
        label, _ = ndimage.label(plane.period == period, np.ones((3, 3)))
        for side in (0, 1):
            there = np.flatnonzero(~tried[:, side] & (edges.periods[:, side] == period) & ((side == 0) | tried[:, 0]))
            region = label[tuple(edges.places[there, side].T)]
            for one in np.unique(region):
                own = there[region == one]
                found += [(int(own[i]), side) for i in range(len(own) % SHARE // 2, len(own), SHARE)]
    return sorted(found)


def _task(plane: Plane, states, system, names, edges: Edges, edge: int, side: int) -> Probe:
    axis = int(edges.axis[edge])
    here, there = edges.places[edge][[side, 1 - side]]
    at = {name: float(plane.values[j][here[j]]) for j, name in enumerate(names)}
    one, other = plane.values[axis][here[axis]], plane.values[axis][there[axis]]
    beyond = float(other + BEYOND * (other - one))
    own = system.replace(**at)
    return Probe(own, states[tuple(here)], int(plane.period[tuple(here)]), names, names[axis], beyond)
