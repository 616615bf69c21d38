"""The linearised equations of an orbit: how it moves with a number, and what a multiplier 1 or -1 moves.

In the units of event_equations.py. A change of the orbit is (xi, dphi, dD) at each event: of the state at a fixed
phase, of the phase, and of the jump.
"""

import numpy as np

from vibro_sweep.analysis.periodic.contact_numbers import EventUnits, number_slopes
from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.problem import FLIP, FOLD, GRAZE
from vibro_sweep.engine.continuation.workspace import THETA
from vibro_sweep.engine.impulses.flow import rate_slopes
from vibro_sweep.oscillator.linear import Linear


class Linearised:
    """About a solution.

    slope : how its oscillator changes with a number
    watched : indices of impacts without speed, which are followed as turning points and take part in nothing
    corner : that of them which begins as a contact does that ends by force, if any
    """

    def __init__(self, solution, slope: Linear | None = None, watched=(), corner: int | None = None):
        e = self.equations = EventEquations.of(solution)
        self.solution, self.slope, self.q = solution, slope, e.q
        e.problem = e.problem._replace(parameters=int(slope is not None))
        bare = [i for i in watched if i != corner]
        e.problem.sides[bare], e.problem.rests[bare] = 0.0, False
        if corner is not None:
            e.problem = e.problem._replace(kind=GRAZE, index=corner)
        self._take_oscillator()
        e.take_solution(solution)
        e.place.jumps[list(watched)] = 0.0
        self.phases, units = e.place.phases, np.repeat([1.0, self.q.omega], e.n // 2)
        steady = (e.planes[0]["Z"] * np.exp(1j * self.phases[:, None])).real
        e.place.x[:, : e.n] = solution.states[: e.K, : e.n] / units - steady

    def _take_oscillator(self) -> None:
        """The numbers of the kernels, and their derivatives as polynomials of degree 1 of the number's change."""
        r, n, omega = self.equations.planes[0], self.equations.n, self.q.omega
        r["fit"][0, 0] = r["exact"]
        if self.slope is not None:
            slope, units = self.slope, np.append(np.repeat([1.0, omega], n // 2), 1.0)
            dB = rate_slopes(self.q, slope)[:n]
            dA = dB[:, [*range(n), n + 2]] * units / units[:n, None] / omega
            r["parameters"], r["degree"], r["moves"][0] = 1, [1, 0], bool(np.any(dA))
            r["fit"][1, 0, : n * (n + 1)] = dA.ravel()
            r["fit"][1, 0, n * (n + 1) : n * (n + 2)] = dB[n // 2 :, n : n + 2].T.ravel() / omega**2
            r["fit"][1, 0, n * (n + 2) :] = number_slopes(self.q, slope, EventUnits(1.0, omega))
        self.equations.move()

    def _assembled(self):
        if not self.equations.run_task(stepper.ASSEMBLE):
            raise np.linalg.LinAlgError("the equations are singular")
        return self.equations.workspace.work[0]

    def multipliers(self) -> np.ndarray:
        """(n,) of the map over P, by falling modulus. LinAlgError where the equations are singular."""
        self._assembled()
        return self.equations.multipliers()

    def tangent(self) -> np.ndarray:
        """(K, n + 2) change of the orbit with the number. LinAlgError at a fold.

        Without impacts a free mode may stand anywhere: it stays.
        """
        e, n = self.equations, self.equations.n
        work = self._assembled()
        G, right = work["ends"][:n, :n], -work["ends"][:n, n]
        alone = self.solution.is_free and not np.any(e.problem.sides)
        work["null"][:n] = np.linalg.lstsq(G, right)[0] if alone else np.linalg.solve(G, right)
        work["null"][n:] = 0.0
        work["null"][n] = 1.0
        e.run_task(stepper.TAKE_APART)
        return e.workspace.events["changes"][:, 1].copy()

    def slopes(self) -> np.ndarray:
        """(2K + rests,) du/dp."""
        return self._of_times(self.tangent(), self.slope)

    def _of_times(self, moved: np.ndarray, slope: Linear | None = None) -> np.ndarray:
        """(2K + rests,) changes of times, jumps and ends of rests, from those of phases and states."""
        e, n, q, rests = self.equations, self.equations.n, self.q, self.equations.problem.rests
        phases, ends = moved[:, n].copy(), (moved[:, n] + moved[:, n + 1])[rests]
        speeds = moved[:, n // 2] + e.workspace.events["motion"][:, 1] * phases
        if slope is not None:
            speeds += (e.planes[0]["Z_slopes"][0, n // 2] * np.exp(1j * self.phases)).real
            phases -= slope.omega * self.solution.times + slope.tau
            ends -= slope.omega * self.solution.ends + slope.tau
        jumps = np.where(rests, -speeds, moved[:, n + 1])
        return np.concatenate([phases / q.omega, jumps * q.omega, ends / q.omega])

    def distance_slope(self, index: int) -> float:
        """The slope, by the number, of the distance of a watched turning point from its stop."""
        moved, side = self.tangent()[index], self.solution.sides[index]
        steady = (self.equations.planes[0]["Z_slopes"][0, 0] * np.exp(1j * self.phases[index])).real
        return float(side * (self.slope.contact.stop([side])[0] - moved[0] - steady))

    def critical_direction(self, mu: int) -> np.ndarray:
        """(2K + rests,) what a multiplier mu = 1 or -1 moves: of times, jumps and ends of rests."""
        self.take_null_vectors(FOLD if mu == 1 else FLIP)
        return self._of_times(self.equations.place.v.real)

    def take_null_vectors(self, kind: int, theta: float = 0.0) -> None:
        """Leave in `place` those of the critical multiplier of this kind, e^{i theta} of a pair."""
        e = self.equations
        e.problem, e.place.p[THETA] = e.problem._replace(kind=kind), theta
        for _ in range(2):  # first across any direction, which may lie badly, then across the one that is found
            self._assembled()
            for here, found in ((e.place.v, e.workspace.events["v"]), (e.place.w, e.workspace.trial)):
                here[:] = found / np.linalg.norm(found)

    def closure(self, mu: int) -> np.ndarray:
        """(n, n) G(mu), which is singular where mu is a multiplier."""
        n, last = self.equations.n, self._assembled()["last"]
        return self.solution.sigma * mu * last[:, :n] + last[:, 2 * n + 2 : 3 * n + 2]
