"""The unit of work: from one recorded orbit of a sweep to its window."""

from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.beginning import changes_rests
from vibro_sweep.analysis.branches.continuation import Branch
from vibro_sweep.analysis.branches.flat import Flat, flatten, section_states
from vibro_sweep.analysis.periodic.finding import periodic_orbit
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit
from vibro_sweep.analysis.windows.stretch import representative, stable_stretch

SLACK = 1e-9  # of the range: an orbit that is so far from a window's end may be counted as beyond it
NEAR = 1e-3  # of the size of the state: a recorded orbit that is farther from the periodic one has not settled
WITHOUT = {"sticking": "sticking", "resonance": "not_isolated"}  # statuses of orbits that have no window, and why


class Job(NamedTuple):
    """A recorded orbit: its oscillator, its state at t = 0 mod T, its period, the swept number and its range."""

    system: Any
    state: np.ndarray  # (2N,)
    period: int
    parameter: str
    bounds: tuple[float, float]


class Result(NamedTuple):
    """A window as a branch between its two ends; or, where `flat` is None, the reason why there is none."""

    flat: Flat | None
    reason: str


@one_thread()
def window_of(job: Job) -> Result:
    """The window of a recorded orbit."""
    try:
        orbit = periodic_orbit(job.system, job.state, job.period)
    except ValueError:  # impacts of the recorded orbit that are none of a period
        return Result(None, "failed")
    if not orbit.ok:
        return Result(None, WITHOUT.get(str(orbit.status), "failed"))
    if not orbit.stable or not lies_on(orbit, job.state):
        return Result(None, "not_settled")
    if changes_rests(orbit._solution, job.parameter):  # at any other R the rest begins after infinitely many impacts
        return Result(None, "sticking")
    chosen = representative(orbit, job.parameter)
    try:
        branch = stable_stretch(chosen, job.parameter, job.bounds)
    except ValueError:  # an orbit of hundreds of impacts, which rounding does not let Newton's method correct
        return Result(None, "failed")
    value = chosen._solution.family.numbers[job.parameter]
    if not holds(branch, value, SLACK * (job.bounds[1] - job.bounds[0])):
        return Result(None, "not_settled")
    return Result(flatten(branch, value), "in_a_window")


def holds(branch: Branch, value: float, slack: float) -> bool:
    """Whether a stretch has a width, beyond what its ends may be wrong by, and a value lies in it."""
    lo, hi = (end.parameters[branch.parameter] for end in (branch.begins, branch.ends))
    width = float(np.nansum([end.error for end in (branch.begins, branch.ends)]))
    return hi - lo > width and lo - slack <= value <= hi + slack


def lies_on(orbit: PeriodicOrbit, state: np.ndarray) -> bool:
    """Whether a section state is one of an orbit, or of its mirror image where the oscillator has one."""
    return is_near(section_states(orbit), state)


def is_near(sections: np.ndarray, state: np.ndarray) -> bool:
    """Whether a state (2N,) is one of the section states (s, 2N) of an orbit; s may be 0."""
    distance = np.abs(sections - state).max(axis=1).min(initial=np.inf)
    return bool(distance <= NEAR * max(np.abs(state).max(), 1e-300))
