"""The equations of periodic orbits in which the mass rests on a stop after impacts with R = 0.

Such an impact is one event: at t_k the velocity is lost, and the gap is held until e_k, where its free acceleration
vanishes. Unknowns are the times t_1 .. t_K, the impulses D_1 .. D_K and the ends of the rests; the states follow from
them linearly, since the motion repeats itself. Each rest gives two multipliers 0.

Everything is in zeta = (x, x', cos(omega t + tau), sin(omega t + tau), 1). A perturbation is taken at a fixed time,
as if the motion before and after an event went on beyond it.
"""

import functools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.periodic.held_motion import motion_of, motion_slopes
from vibro_sweep.analysis.periodic.impulse_equations import contacts_of, flow, held_flow, steady
from vibro_sweep.analysis.periodic.one_thread import one_thread
from vibro_sweep.engine.impulses import flights
from vibro_sweep.engine.impulses.equations import GAIN, GAIN_SLOPE, STOP, STOP_SLOPE
from vibro_sweep.engine.impulses.flow import Flow, contact_coordinates
from vibro_sweep.engine.impulses.tables import ORDER
from vibro_sweep.model.linear import Linear, forcing_period

MOST_STEPS = 30


class Pass(NamedTuple):
    """Derivatives are by the state before the first impact at a fixed time (n), by u, and by the parameter."""

    end: np.ndarray  # (n,): state after the period
    F: np.ndarray  # (2K + rests,)
    rows: np.ndarray  # (2K + rests, n + 2K + rests + 1): derivatives of F
    ends: np.ndarray  # (n, n + 2K + rests + 1): of the end
    motion: np.ndarray  # (K, 3): gap velocity, acceleration and jerk before the impacts
    before: np.ndarray  # (K, m): zeta before the impacts
    after: list[np.ndarray]  # zeta at the beginning of each piece


class RestEquations:
    """As `Equations`, for orbits that rest after the impacts `rests` (indices, in order); u ends with the ends e_k."""

    free = False  # a rest holds the gap, and with it a free mode that the contact sees

    def __init__(self, q: Linear, sigma: int, halves: int, slope: Linear | None, rests: tuple[int, ...]):
        self.q, self.sigma, self.halves, self.slope, self.rests = q, sigma, halves, slope, rests
        self.P = forcing_period(q) / 2 * halves
        self.steady = steady(q, sigma, halves, slope)
        self.f = motion_of(q)
        self.df = motion_slopes(q, slope) if slope is not None else None

    def contacts(self, sides) -> np.ndarray:
        return contacts_of(self.q, self.slope, sides)

    def size(self, sides) -> int:
        return 2 * len(sides) + len(self.rests)

    def _phase(self, t: float) -> np.ndarray:
        angle = self.q.omega * t + self.q.tau
        return np.array([np.cos(angle), np.sin(angle), 1.0])

    def pieces(self, sides, u):
        """[(kind, index, begin, end)]: flights and rests in order, each after the event `index` of its kind."""
        K = len(sides)
        t, ends = u[:K], u[2 * K :]
        result = []
        for k in range(K):
            begin, following = t[k], t[k + 1] if k + 1 < K else t[0] + self.P
            if k in self.rests:
                r = self.rests.index(k)
                result.append(("rest", k, begin, ends[r]))
                begin = ends[r]
            result.append(("flight", k, begin, following))
        return result

    def _transition(self, held: bool, length: float) -> np.ndarray:
        """exp(A length) (m, m) of a piece; (2m, 2m) with the derivative by the parameter, where that changes A."""
        from scipy.linalg import expm  # loaded where an orbit rests: it takes a tenth of the program's start

        A, dA = (self.f.H, self.df and self.df.H) if held else (self.f.B, self.df and self.df.B)
        if dA is not None and np.any(dA):
            A = np.block([[A, np.zeros_like(A)], [dA, A]])
        with one_thread():
            return expm(A * length)

    def _pass(self, sides, u, start, transition: Callable[[bool, float], np.ndarray]) -> Pass:
        """Once through the period, from the state `start` (n,) before the first impact."""
        f, df, n, K = self.f, self.df, len(start), len(sides)
        contacts, size = self.contacts(sides), self.size(sides)
        m, wide = n + 3, n + size + 1  # columns: start, u, parameter
        t, D = u[:K], u[K : 2 * K]
        zeta = np.concatenate([start, self._phase(t[0])])
        delta = np.zeros((m, wide))
        delta[:n, :n] = np.eye(n)
        if df is not None:
            turn = self.slope.omega * t[0] + self.slope.tau
            delta[n : n + 2, -1] = -turn * zeta[n + 1], turn * zeta[n]
        F, rows = np.zeros(size), np.zeros((size, wide))
        motion, before, after = np.zeros((K, 3)), np.zeros((K, m)), []
        for kind, k, begin, end in self.pieces(sides, u):
            held = kind == "rest"
            if held or k not in self.rests:  # an impact comes first
                stop, gain, d_stop, d_gain = (contacts[k, c] for c in (STOP, GAIN, STOP_SLOPE, GAIN_SLOPE))
                rate, v, before[k] = f.B @ zeta, f.e_s @ zeta, zeta
                motion[k] = v, f.pull @ zeta, f.pull @ rate
                F[k], F[K + k] = f.e_g @ zeta - stop, D[k] + gain * v
                rows[k], rows[K + k] = f.e_g @ delta, gain * (f.e_s @ delta)
                rows[k, n + k] += v
                rows[K + k, n + k] += gain * motion[k, 1]
                rows[K + k, n + K + k] += 1.0
                if df is not None:
                    rows[k, -1] += df.e_g @ zeta - d_stop
                    rows[K + k, -1] += gain * (df.e_s @ zeta) + d_gain * v
                if held:
                    lost, off = f.e_s @ zeta, f.e_g @ zeta - stop
                    keep = np.eye(m) - np.outer(f.push, f.e_s) - np.outer(f.shift, f.e_g)
                    zeta = zeta - lost * f.push - off * f.shift
                    delta = keep @ delta
                    delta[:, n + k] += keep @ rate - f.H @ zeta
                    if df is not None:
                        delta[:, -1] += f.shift * d_stop - lost * df.push - off * df.shift
                        delta[:, -1] -= (df.e_s @ before[k]) * f.push + (df.e_g @ before[k]) * f.shift
                else:
                    zeta = zeta + D[k] * f.push
                    delta[:, n + k] -= D[k] * (f.B @ f.push)
                    delta[:, n + K + k] += f.push
                    if df is not None:
                        delta[:, -1] += D[k] * df.push
            else:  # the end of a rest
                r = 2 * K + self.rests.index(k)
                F[r], rows[r] = f.pull @ zeta, f.pull @ delta
                rows[r, n + r] += f.pull @ f.H @ zeta
                delta[:, n + r] -= (f.pull @ zeta) * f.push
                if df is not None:
                    rows[r, -1] += df.pull @ zeta
            after.append(zeta)
            E = transition(held, end - begin)
            delta = E[:m, :m] @ delta
            delta[:, -1] += E[m:, :m] @ zeta if len(E) > m else 0.0
            zeta = E[:m, :m] @ zeta
        if df is not None:  # the last flight ends at t_1 + P
            delta[:n, -1] -= (f.B @ zeta)[:n] * self.P * self.slope.omega / self.q.omega
        return Pass(zeta[:n], F, rows, delta[:n], motion, before, after)

    def _repeated(self, sides, u) -> Pass:
        """The pass that repeats itself, with the sign sigma."""
        n, transition = 2 * len(self.q.along), functools.cache(self._transition)
        first = self._pass(sides, u, np.zeros(n), transition)
        start = np.linalg.solve(self.sigma * np.eye(n) - first.ends[:, :n], first.end)
        return self._pass(sides, u, start, transition)

    def evaluate(self, sides, u):
        """F, dF/du, dF/dp, and (K, 3) gap velocity, acceleration and jerk before each impact."""
        found = self._repeated(sides, u)
        J = self._closed(found, 1)
        return found.F, np.ascontiguousarray(J[:, :-1]), J[:, -1].copy(), found.motion

    def residual(self, sides, u):
        """F, dF/dp and the motion, as of `evaluate`."""
        F, _, Fp, motion = self.evaluate(sides, u)
        return F, Fp, motion

    def _closed(self, found: Pass, mu: float) -> np.ndarray:
        """Derivatives by u and the parameter, of what is multiplied by mu in each period."""
        n = len(found.end)
        states = np.linalg.solve(self.sigma * mu * np.eye(n) - found.ends[:, :n], found.ends[:, n:])
        return found.rows[:, n:] + found.rows[:, :n] @ states

    def linearised(self, mu: int, sides, u, _) -> np.ndarray:
        return self._closed(self._repeated(sides, u), mu)[:, :-1]

    def newton(self, sides, guesses) -> tuple[np.ndarray, np.ndarray]:
        """As `Equations.newton`."""
        ends, change = np.array(guesses, float), np.full(len(guesses), np.nan)
        for u, m in zip(ends, range(len(ends)), strict=True):
            change[m] = self._newton(sides, u)
        return ends, change

    def _newton(self, sides, u) -> float:
        K, before = len(sides), np.inf
        timed = np.r_[0:K, 2 * K : len(u)]
        for _ in range(MOST_STEPS):
            try:
                F, J, _, _ = self.evaluate(sides, u)
                step = np.linalg.solve(J, F)
            except np.linalg.LinAlgError:
                return np.nan
            speed = max(self.q.omega * np.hypot(self.steady.real, self.steady.imag), np.abs(u[K : 2 * K]).max())
            change = max(np.abs(step[timed]).max() / self.P, np.abs(step[K : 2 * K]).max() / speed)
            if not change < np.inf:
                return np.nan
            share = min(1.0, 0.02 / max(change, 1e-300))
            u -= share * step
            if any(end < begin for _, _, begin, end in self.pieces(sides, u)):
                return np.nan
            if share == 1.0 and (change <= 4e-16 or (change < 1e-9 and change >= 0.5 * before)):
                return float(change)
            before = change if share == 1.0 else np.inf
        return np.nan

    def multipliers(self, sides, u, _) -> np.ndarray:
        """(2N,) of the map over P, with the mirror for sigma = -1; two of them are 0."""
        found = self._repeated(sides, u)
        n = len(found.end)
        events = np.linalg.solve(found.rows[:, n:-1], found.rows[:, :n])
        values = self.sigma * np.linalg.eigvals(found.ends[:, :n] - found.ends[:, n:-1] @ events).astype(complex)
        values = values[np.lexsort((-values.imag, -np.abs(values)))]
        values[-2:] = 0.0
        return values

    def starts(self, sides, u):
        """[(kind, side, begin, end, zeta in contact coordinates)] of each piece; see flow.py."""
        to, found, n = contact_coordinates(self.q), self._repeated(sides, u), 2 * len(self.q.along)
        return [
            (kind, sides[k], begin, end, np.concatenate([to.of_masses(zeta), zeta[n:]]))
            for (kind, k, begin, end), zeta in zip(self.pieces(sides, u), found.after, strict=True)
        ]

    def fly(self, sides, u) -> tuple[np.ndarray, np.ndarray]:
        """As `Equations.fly`."""
        to, found, n = contact_coordinates(self.q), self._repeated(sides, u), 2 * len(self.q.along)
        states = np.hstack([to.of_masses(found.before), found.before[:, n:]])
        nearest = np.array([np.inf, 0.0, 0.0])
        released = False
        for kind, _, begin, end, zeta in self.starts(sides, u):
            if kind == "flight":
                _fly_free(flow(self.q), zeta, begin, end, released, (self.q.low, self.q.high), nearest)
            released = kind == "rest"
        return states, nearest

    def hold(self, sides, u) -> float:
        """The least free acceleration into the stop, at the beginning of a rest and where it turns within."""
        f, least = held_flow(self.q), np.inf
        for kind, side, begin, end, zeta in self.starts(sides, u):
            if kind == "rest":
                first = side * float(f.rows[0] @ zeta)
                bounds = (0.0, np.inf) if side > 0 else (-np.inf, 0.0)
                nearest = np.array([np.inf, 0.0, 0.0])
                room = flights.new_room(len(zeta))
                flights.fly_once(f, zeta, begin, max(end - begin, 0.0), *bounds, nearest, room)
                least = min(least, first, float(nearest[0]))
        return least


def _fly_free(f: Flow, zeta, begin: float, end: float, released: bool, stops, nearest) -> None:
    """Lower `nearest` to the turning points of a flight. After a rest it leaves the stop like the third power of time:
    as long as its third derivative dominates, the gap does not turn."""
    m = len(zeta)
    room = flights.new_room(m)
    if released:
        c = f.rows @ zeta
        orders, u = np.arange(4, ORDER + 1), min(f.width, end - begin)
        while np.sum(orders * np.abs(c[4:]) * u ** (orders - 3.0)) >= 3 * abs(c[3]) and u > 1e-9 * f.width:
            u /= 2
        out, at = np.empty((1, m)), np.array([begin + u])
        flights.sample_flights(f, zeta[None], np.array([begin]), np.zeros(1, int), at, out, room)
        zeta, begin = out[0], begin + u
    flights.fly_once(f, zeta, begin, end - begin, *stops, nearest, room)
