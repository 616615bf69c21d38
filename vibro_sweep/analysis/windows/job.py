"""The unit of work: from one recorded orbit of a sweep to its window."""

from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.branch import Branch
from vibro_sweep.analysis.branches.branch_arrays import Arrays, arrays_of, section_states
from vibro_sweep.analysis.branches.branch_start import changes_rests
from vibro_sweep.analysis.periodic.finding import periodic_orbit
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.windows.rows import REASON_CODES
from vibro_sweep.analysis.windows.stretch import representative, stable_stretch
from vibro_sweep.oscillator.own_time import as_lengths

SLACK = 1e-9  # of the range: an orbit that is so far from a window's end may be counted as beyond it
NEAR = 1e-3  # of the size of the state: a recorded orbit that is farther from the periodic one has not settled
WITHOUT = {  # statuses of orbits that have no window, and why
    "sticking": "sticking",
    "resonance": "not_isolated",
    "turning": "turning",
    "permanent_contact": "permanent_contact",
    "unrelaxed": "unrelaxed",
}


class Job(NamedTuple):
    """A recorded orbit: its oscillator, its state at t = 0 mod T, its period, the swept number and its range."""

    system: Any
    state: np.ndarray  # (2N,)
    period: int
    parameter: str
    bounds: tuple[float, float]


@one_thread()
def window_of(job: Job) -> Arrays:
    """The window of a recorded orbit, as a branch between its two ends; or `reason`, why there is none."""
    found = _found(job)
    return {"reason": np.int8(REASON_CODES[found])} if isinstance(found, str) else found


def _found(job: Job) -> Arrays | str:
    try:
        orbit = periodic_orbit(job.system, job.state, job.period)
    except ValueError:  # impacts of the recorded orbit that are not those of a period
        return "failed"
    if not orbit.ok:
        return WITHOUT.get(str(orbit.status), "failed")
    if not orbit.stable or not lies_on(orbit, job.state):
        return "not_settled"
    if changes_rests(orbit._solution, job.parameter):  # at any other R the rest begins after infinitely many impacts
        return "sticking"
    chosen = representative(orbit, job.parameter)
    try:
        branch = stable_stretch(chosen, job.parameter, job.bounds)
    except ValueError:  # an orbit of hundreds of impacts, which rounding does not let Newton's method correct
        return "failed"
    value = chosen._solution.family.free[job.parameter]
    if not holds(branch, value, SLACK * (job.bounds[1] - job.bounds[0])):
        return "not_settled"
    return arrays_of(branch, value)


def holds(branch: Branch, value: float, slack: float) -> bool:
    """Whether a stretch has a width, beyond what its ends may be wrong by, and a value lies in it."""
    lo, hi = (end.parameters[branch.parameter] for end in (branch.begins, branch.ends))
    width = float(np.nansum([end.error for end in (branch.begins, branch.ends)]))
    return hi - lo > width and lo - slack <= value <= hi + slack


def lies_on(orbit: PeriodicOrbit, state: np.ndarray) -> bool:
    """Whether a section state is one of an orbit, or of its mirror image where the oscillator has one."""
    return bool(are_near(section_states(orbit), state[None], orbit._solution.family.linear.omega)[0])


def are_near(sections: np.ndarray, states: np.ndarray, omega: float) -> np.ndarray:
    """(m,) whether states (m, 2N) are among the section states (s, 2N) of an orbit."""
    sections, states = (as_lengths(values, omega) for values in (sections, states))
    distance = np.abs(sections - states[:, None]).max(axis=2).min(axis=1)
    return distance <= NEAR * np.maximum(np.abs(states).max(axis=1), 1e-300)
