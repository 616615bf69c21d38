"""Periodic orbits of one oscillator as sequences of impacts: the equations of engine/continuation, no number free.

Phases are in radians of the force and lengths as they are, so that omega is 1 there.
"""

from functools import cache

import numpy as np

from vibro_sweep.analysis.periodic.contact_numbers import EventUnits, compliant_stops, numbers_of
from vibro_sweep.analysis.periodic.steady_gap import push_of_free_mode, steady_gap
from vibro_sweep.engine.continuation import moving_flow, path, stepper
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, NUMBERS
from vibro_sweep.engine.continuation.problem import ORBIT, Problem
from vibro_sweep.engine.continuation.workspace import new_place, new_workspace
from vibro_sweep.engine.impulses.extremes import middle_weights
from vibro_sweep.engine.impulses.flow import closing, contact_coordinates, flow, unseen_modes
from vibro_sweep.engine.impulses.free_modes import checked_cells
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.oscillator.linear import MOTION, Linear, amplitudes, memoised


class EventEquations:
    """Orbits of `q` with impacts on `sides`, z(t + P) = sigma z(t), P = half_periods T/2.

    sigma = +1 and an even number of half periods, or sigma = -1 and an odd one (symmetric orbits).
    Raises ResonanceError, TooStiffError (free_modes.py).
    """

    def __init__(self, q: Linear, sigma: int, half_periods: int, sides, rests=()):
        """rests : indices of impacts after which the mass rests"""
        self.q, self.K, self.n = q, len(sides), 2 * q.masses
        planes = _tables(q, sigma, half_periods, bool(rests), q.compliant)
        self.planes = planes.copy()  # kernels write the contact's numbers into it
        self.planes[0]["numbers"], self.planes[0]["by_force"] = _contact_of(q), q.contact.by_force
        self.planes[0]["exact"][self.n * (self.n + 2) :] = numbers_of(q, EventUnits(1.0, q.omega))
        resting, compliant = np.zeros(self.K, bool), compliant_stops(q)
        resting[list(rests)] = True
        self.problem = Problem(
            ORBIT, 0, np.array(sides, float), resting, float(sigma), 0, np.ones(2), False, False, compliant
        )
        self.place, self.workspace = new_place(self.K, self.n), new_workspace(self.K, self.n)

    @classmethod
    def of(cls, solution) -> "EventEquations":
        """The equations of a `Solution`."""
        return cls(solution.family.linear, solution.sigma, solution.half_periods, solution.sides, solution.rests)

    def take_solution(self, solution) -> None:
        """The events of a `Solution`, without the states before them."""
        place, omega, rests = self.place, self.q.omega, list(solution.rests)
        place.phases[:], place.jumps[:] = omega * solution.times + self.q.tau, solution.jumps / omega
        place.jumps[rests] = omega * (solution.ends - solution.times[rests])

    def move(self) -> None:
        """Leave in `planes` what tasks need beyond Newton's method."""
        self.planes["is_known"] = 0
        self.run_task(stepper.MOVE)

    def run_task(self, task: int, row: np.ndarray | None = None) -> float:
        """A task of engine/continuation/stepper.py."""
        row = np.zeros(2 * self.K + 3) if row is None else row
        return stepper.at(task, self.planes, self.problem, _no_path(), self.place, row, self.workspace)

    def multipliers(self) -> np.ndarray:
        """(n,) of the equations that were assembled last, by falling modulus; at a graze one may be infinite."""
        last, n = self.workspace.work[0]["last"], self.n
        ahead, behind = last[:, :n], -self.problem.sigma * last[:, 2 * n + 2 : 3 * n + 2]
        try:
            values = np.linalg.eigvals(np.linalg.solve(ahead, behind)).astype(complex)
        except np.linalg.LinAlgError:
            from scipy.linalg import eigvals

            over, under = eigvals(behind, ahead, homogeneous_eigvals=True)
            finite = np.abs(under) > np.finfo(float).tiny * np.abs(over)  # the quotient of complex numbers would be NaN
            values = np.divide(over, under, out=np.full(n, np.inf, complex), where=finite)
        return values[np.lexsort((-values.imag, -np.abs(values)))]

    def newton(self, starts, oscillators=()) -> tuple[np.ndarray, np.ndarray]:
        """Newton's method from guesses (m, 2K) of times and jumps, without rests: solutions; and the last change, NaN:
        none found. oscillators : of each guess, where contacts differ."""
        q, K, n = self.q, self.K, self.n
        if not K:
            return starts, np.zeros(len(starts))
        contacts = np.array([_contact_of(one) for one in oscillators or [q]])
        guesses = np.zeros((len(starts), K * (n + 2) + 1 + NUMBERS))
        x, guesses[:, -NUMBERS:] = guesses[:, : K * (n + 2)].reshape(len(starts), K, n + 2), contacts
        x[..., n], x[..., n + 1] = q.omega * starts[:, :K] + q.tau, starts[:, K:] / q.omega
        x[:, 0, 0] = contacts[:, HIGH if self.problem.sides[0] > 0 else LOW] - self.steady(x[:, 0, n])[:, 0]
        self.run_task(stepper.CONVERGE, guesses.reshape(-1))
        u = np.hstack([(x[..., n] - q.tau) / q.omega, x[..., n + 1] * q.omega])
        return u, guesses[:, K * (n + 2)]

    def steady(self, phases: np.ndarray) -> np.ndarray:
        """(.., 2N) the steady motion at these phases."""
        return (self.planes[0]["Z"] * np.exp(1j * phases[..., None])).real

    def whole(self, free: np.ndarray, phases: np.ndarray) -> np.ndarray:
        """(.., 2N + 3) states in contact coordinates, cos and sin of the phases, 1; free: without the steady motion."""
        state = (free + self.steady(phases)) * np.repeat([1.0, self.q.omega], self.n // 2)
        return np.concatenate([state, np.stack([np.cos(phases), np.sin(phases), np.ones(phases.shape)], -1)], -1)


@cache
def _no_path() -> path.Path:
    """Of an orbit alone, which follows none."""
    return path.new_path(1, 1, 2, 1.0, 1.0, 1.0, np.zeros((2, 2)))


def _contact_of(q: Linear) -> list[float]:
    """`numbers` of a plane, omega in radians of the force."""
    return [q.contact.low, q.contact.high, 1 + q.contact.R_low, 1 + q.contact.R_high, 1.0]


@memoised(*MOTION)
def _tables(q: Linear, sigma: int, half_periods: int, rests: bool, compliant: bool) -> np.ndarray:
    """(1,) `plane_of` of an oscillator, without its contact; `closing` without rests."""
    checked_cells(q, half_periods)
    steady_gap(q)  # where it does not exist there is no such orbit; nor where this does not, but rests hold the gap
    if not rests:
        push_of_free_mode(q)
    f = flow(q)
    m = len(f.B)
    n = m - 3
    units = np.repeat([1.0, q.omega], n // 2)
    scale = np.append(units, 1.0) / units[:, None]
    result = np.zeros(1, moving_flow.plane_of(n // 2, compliant))
    r, columns = result[0], [*range(n), m - 1]
    r["A"] = f.B[:n, columns] * scale / q.omega
    to, X = contact_coordinates(q), amplitudes(q)
    r["Z"] = np.concatenate([to.P @ X, 1j * (to.U @ X)])
    rates = q.omega ** -np.arange(ORDER + 1.0)
    r["series"][:, :, : n + 1] = f.series.reshape(-1, m, m)[:, :n, columns] * scale * rates[:, None, None]
    r["powers"][:, :, : n + 1] = f.powers[:, :n, columns] * scale
    r["width"], r["bits"], r["is_still"], r["is_known"] = f.width * q.omega, moving_flow.BITS, 1, 1
    r["half_turns"], r["reach"] = half_periods, 1.0
    r["exact"][: n * (n + 1)] = r["A"].ravel()
    r["exact"][n * (n + 1) : n * (n + 2)] = f.B[n // 2 : n, n : n + 2].T.ravel() / q.omega**2
    r["middle_weights"], r["rest_weights"] = middle_weights(float(r["width"]))
    if rests:
        return result
    if sigma == 1:
        r["unseen"] = unseen_modes(q) / np.outer(units, units)
        r["has_unseen"] = bool(np.any(r["unseen"]))
    r["closing"] = closing(q, sigma, half_periods) * np.append(units, 1.0) / units[:, None]
    return result
