"""Orbits that the record of a sweep left undecided, computed further: periodic, chaotic or quasi-periodic."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.single.tables import table_of
from vibro_sweep.analysis.windows.rows import REASON_CODES, Row, first_reason
from vibro_sweep.engine import orbit_block
from vibro_sweep.engine.halting import interruptible
from vibro_sweep.engine.impulses.free_modes import has_free_gap, turns
from vibro_sweep.engine.one_system import plan_of
from vibro_sweep.engine.records import new_results, starts_at
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.oscillator.family import family_of
from vibro_sweep.oscillator.own_time import with_velocities
from vibro_sweep.tables.exponents import sign_of
from vibro_sweep.tables.outcomes import NOT_SETTLED, is_valid

WARM_UP = 200  # forcing periods, for tangent vectors
MORE = 3800  # forcing periods after them: the exponents' errors are then some 4 times smaller than in a record of 200
MUCH_MORE = 40_000  # for those that are still on their way: the last ones of a window take longest
LONGEST = 1000  # period that is looked at; a longer one counts as not settled
AT_ONCE = 256  # orbits


class Continued(NamedTuple):
    """Results of n orbits: period (0: none), state at the end, code of the reason where there is no period."""

    period: np.ndarray  # (n,)
    state: np.ndarray  # (n, 2N)
    reason: np.ndarray  # (n,)


def continued(row: Row, i: np.ndarray, j: np.ndarray) -> Continued:
    """The orbits of a row at the values i of the starts j, some periods on: `MORE`, where they need it `MUCH_MORE`."""
    blocks = [(i[at : at + AT_ONCE], j[at : at + AT_ONCE]) for at in range(0, len(i), AT_ONCE)]
    parts = [_far_enough(row, *block) for block in blocks]
    return Continued(*map(np.concatenate, zip(*parts, strict=True)))


def _far_enough(row: Row, i: np.ndarray, j: np.ndarray) -> Continued:
    found = _computed(row, i, row.states[i, j], 0)
    slow = np.flatnonzero(found.reason == REASON_CODES["not_settled"])
    if len(slow):
        later = _computed(row, i[slow], found.state[slow], MUCH_MORE)
        for values, new in zip(found, later, strict=True):
            values[slow] = new
    return found


def _computed(row: Row, i: np.ndarray, begin: np.ndarray, transient: int) -> Continued:
    table, kind, rate = table_of(row.system, {row.parameter: row.values[i]}, frames=True)
    begin = with_velocities(begin, kind.masses, 1 / rate)
    n, states = len(i), 2 * kind.masses
    plan = plan_of(transient + WARM_UP, MORE, lyapunov=True)._replace(impacts=True)
    results, nothing = new_results((1, n), kind.masses), np.empty((1, n, 0))
    starts = starts_at(np.stack([begin, begin]))
    workspace = orbit_block.new_workspace(plan, int(table["cells"].max()), 0, kind, min(n, LANES))
    unused = np.empty((1, n, 0, states))
    interruptible(
        orbit_block.run_points, table.reshape(1, n), starts, results, unused, nothing, unused, workspace, plan, None,
        halt=workspace.ensemble.halt, cells=int(table["cells"].sum()) * (plan.transient + plan.record),
    )  # fmt: skip
    found = results[0]
    period = np.where(is_valid(found["status"]) & (found["period"] <= LONGEST), found["period"], 0)
    reasons = _reasons(found)
    touches = ("impacts_left", "impacts_right", "contacts_left", "contacts_right", "contact_time")
    free = ~np.any([found[name] > 0 for name in touches], axis=0)
    for m in np.flatnonzero(reasons == REASON_CODES["quasi_periodic"]):
        q = family_of(row.system_at(row.values[i[m]])).linear
        if turns(q):
            reasons[m] = REASON_CODES["turning"]
        elif free[m] and has_free_gap(q):  # a mass that flies towards a stop
            reasons[m] = REASON_CODES["not_settled"]
    return Continued(period, with_velocities(found["end"], kind.masses, rate), reasons)


def _reasons(found: np.ndarray) -> np.ndarray:
    """Codes of `REASONS`: 0 for periodic orbits."""
    largest = found["lyapunov"][:, 0]
    sign = sign_of(largest, found["lyapunov_error"][:, 0])
    return first_reason(
        failed=~is_valid(found["status"]),
        in_a_window=(found["period"] > 0) & (found["period"] <= LONGEST),
        chaos=sign > 0,
        sticking=found["sticking_time"] > 0,
        not_settled=(found["status"] == NOT_SETTLED) | (sign < 0),
        quasi_periodic=np.isfinite(largest),
    )
