"""The motion of a periodic orbit, from its events: the states before them, and the turning points between them."""

import math
from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.steady_gap import steady_gap
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.workspace import TEST
from vibro_sweep.oscillator.linear import forcing_period


class OrbitMotion:
    """The motion of a `Solution` without rests, whose states follow from its impacts.

    watched : indices of impacts without speed, whose own turning points are left out
    """

    def __init__(self, solution, watched=()):
        self.q, self.sigma, self.length = solution.family.linear, solution.sigma, np.pi * solution.half_periods
        self.alone = solution.K == 0
        if self.alone:
            solution, watched = _with_watched_event(solution), [0]
        e = self.equations = EventEquations.of(solution)
        self.n, self.place, self.events, self.Z = e.n, e.place, e.workspace.events, e.planes[0]["Z"]
        self.rests, self.pressed = list(solution.rests), solution.contacts
        e.take_solution(solution)
        self._follow_events(list(watched))

    def _follow_events(self, watched: list[int]) -> None:
        x, steady = self.place.x, self.equations.steady(self.place.phases)[0, 0]
        x[0, 0] = (0.0 if self.alone else self.q.contact.stop(self.equations.problem.sides[:1])[0]) - steady
        self.equations.problem.sides[watched] = 0.0
        self.equations.run_task(stepper.CLOSE)

    @property
    def states(self) -> np.ndarray:
        """(max(K, 1), 2N + 3) before the impacts; at t = 0 without impacts."""
        phases = np.array([self.q.tau]) if self.alone else self.place.phases
        return self.equations.whole(self.place.x[:, : self.n], phases)

    def certificate(self) -> tuple[np.ndarray, float, float]:
        """(distance, t, side) of the turning point nearest to its stop, inf where there is none; the least free
        acceleration into the stop, where a rest begins, or where it turns within; and `time_to_spare` of its stops."""
        nearest = self.equations.workspace.work[0]["nearest"]
        nearest[:] = np.inf, 0.0, 0.0
        self.equations.run_task(stepper.CERTIFY)
        distance, phase, side = nearest
        if self.alone and distance < np.inf:  # its event lies before t = 0
            turns = math.floor((phase - self.q.tau) / self.length)
            phase, side = phase - turns * self.length, side * self.sigma**turns
        time = (phase - self.q.tau) / self.q.omega if distance < np.inf else 0.0
        hold = (self.events["hold"] * np.where(self.pressed, 1.0, self.q.omega**2))[self.rests].min(initial=np.inf)
        return np.array([distance, time, side]), float(hold), float(self.place.tests[TEST.relaxed])


def _with_watched_event(solution):
    """The free motion with an event that takes part in nothing, where the gap does not turn."""
    q = solution.family.linear
    time = (np.pi / 2 - np.angle(steady_gap(q).swing) - q.tau) / q.omega
    return replace(solution, sides=(1,), u=np.array([time % forcing_period(q) - forcing_period(q), 0.0]))
