"""The equations of periodic orbits for one oscillator, period and symmetry: tables, Newton, motion, multipliers."""

from copy import copy
from functools import cached_property, lru_cache

import numpy as np

from vibro_sweep.engine.impulses import equations, flights, multipliers, sections
from vibro_sweep.engine.impulses import flow as free_flight
from vibro_sweep.engine.impulses.green import (
    MOST_CELLS,
    ResonanceError,
    Train,
    cells_needed,
    free_modes,
    has_free_gap,
    space,
    space_slopes,
    train,
)
from vibro_sweep.model.linear import Keyed, Linear, amplitude_slopes, amplitudes, forcing_period

UNORDERED = 1e-9  # of the period: by so much rounding may exchange impacts


class Equations:
    """Orbits of `q` with z(t + P) = sigma z(t), P = halves T/2; derivatives where q changes by `slope`.

    sigma = +1 and an even number of halves, or sigma = -1 and an odd one (symmetric orbits).
    Raises ResonanceError, TooStiffError (green.py).
    """

    def __init__(self, q: Linear, sigma: int, halves: int, slope: Linear | None = None, many: bool = False):
        """many : of orbits with many impacts, whose equations hardly use the tables: they are made when they are."""
        self.q, self.sigma, self.halves, self.slope = q, sigma, halves, slope
        self.P = forcing_period(q) / 2 * halves
        if not many or cells_needed(q) * halves > MOST_CELLS:
            self.train = train(q, sigma, halves, slope)
        moved = slope is not None and not moves_stops_only(slope)
        self.steady = steady(q, sigma, halves, slope) if moved else _steady(Keyed(q, TABLES), sigma, halves)

    @cached_property
    def train(self) -> Train:
        return train(self.q, self.sigma, self.halves, self.slope)

    def with_stops(self, q: Linear, slope: Linear) -> "Equations":
        """The same tables for an oscillator that differs in its stops or restitution only."""
        changed = copy(self)
        changed.q, changed.slope = q, slope
        return changed

    @property
    def free(self) -> bool:
        return bool(self.steady.free)

    def contacts(self, sides) -> np.ndarray:
        return contacts_of(self.q, self.slope, sides)

    def size(self, sides) -> int:
        return 2 * len(sides) + self.free

    def evaluate(self, sides, u):
        """F, dF/du, dF/dp, and (K, 3) gap velocity, acceleration and jerk before each impact."""
        n = self.size(sides)
        J = np.empty((n, n))
        F, Fp, motion = self._filled(sides, u, J)
        return F, J, Fp, motion

    def residual(self, sides, u):
        """F, dF/dp and the motion, as of `evaluate`; of thousands of impacts, dF/du would fill 100 MB."""
        return self._filled(sides, u, np.empty((0, 0)))

    def _filled(self, sides, u, J):
        n = self.size(sides)
        check_unknowns(u, n)
        F, Fp, motion = np.empty(n), np.empty(n), np.empty((len(sides), 3))
        equations.evaluate(self.train, self.steady, self.contacts(sides), u, F, J, Fp, motion, np.empty((2, 4)))
        return F, Fp, motion

    def newton(self, sides, guesses, contacts=None) -> tuple[np.ndarray, np.ndarray]:
        """Newton's method from guesses (m, 2K) or (m, 2K + free): solutions, and the last change, NaN: none found.

        contacts : (m, K, 4), where the stops or the restitution are not those of `q`
        """
        n, K = self.size(sides), len(sides)
        starts = np.zeros((len(guesses), n))
        starts[:, : np.shape(guesses)[1]] = guesses
        ends, change = np.empty_like(starts), np.full(len(starts), 0.0)
        if K:
            if contacts is None:
                contacts = np.repeat(self.contacts(sides)[None], len(starts), 0)
            work = np.empty(n), np.empty((n, n)), np.empty(n), np.empty((K, 3)), np.empty((2, 4)), np.empty(n)
            equations.newton_batch(self.train, self.steady, contacts, starts, ends, change, *work)
        return ends, change

    def linearised(self, mu: int, sides, u, motion) -> np.ndarray:
        """J(mu) for mu = +1 or -1: singular where the orbit has the multiplier mu; bordered for mu = 1, free modes."""
        K = len(sides)
        if mu == 1:
            return self.evaluate(sides, u)[1]
        J = np.empty((2 * K, 2 * K))
        other = train(self.q, self.sigma / mu, self.halves)
        equations.linearised(other, self.contacts(sides), u, motion, J, np.empty((2, 4)))
        if self.sigma / mu == 1 and has_free_gap(self.q):
            J = np.block([[J, np.repeat([[1.0], [0.0]], K, 0)], [np.repeat([[0.0, 1.0]], K, 1), np.zeros((1, 1))]])
        return J


def fly(q: Linear, sigma: int, halves: int, sides, u) -> tuple[np.ndarray, np.ndarray]:
    """States (max(K, 1), 2N + 3) before each impact, in contact coordinates; and (distance, t, side) of the turning
    point of the gap nearest to its stop, inf where there is none."""
    f, close = flow(q), closing(q, sigma, halves)
    m, K = f.B.shape[0], len(sides)
    states, nearest, room = np.empty((max(K, 1) + 1, m)), np.empty(3), flights.new_room(m)
    P = forcing_period(q) / 2 * halves
    flights.fly_orbit(f, close, contacts_of(q, None, sides), u, P, q.low, q.high, states, nearest, room)
    return states[:-1], nearest


def sections_of(q: Linear, sigma: int, halves: int, unknowns, gaps) -> np.ndarray:
    """(m, 2n, 2N) states at the multiples of T/2 of orbits over n forcing periods, in contact coordinates.

    unknowns : (m, 2K), of orbits whose stops and restitutions may differ from those of `q`
    gaps : (m,) at the first impact
    """
    f, close = flow(q), closing(q, sigma, halves)
    m, count, K, T = len(f.B), halves if sigma == 1 else 2 * halves, np.shape(unknowns)[1] // 2, forcing_period(q)
    out, flying, room = np.empty((len(unknowns), count, m - 3)), np.empty((2, m)), flights.new_room(m)
    sections.sections(f, close, unknowns, gaps, K, float(sigma), T / 2 * halves, T, out, flying, room)
    return out


def multipliers_of(f: free_flight.Flow, sigma: int, P: float, contacts: np.ndarray, u, motion) -> np.ndarray:
    """(2N,) of the map over P, with the mirror for sigma = -1; by falling modulus, of a pair +im first.

    contacts : (K, 2 or more) stop, 1 + R
    They do not depend on the force: the flow may be that of an oscillator with another one.
    """
    n = f.B.shape[0] - 3
    if len(contacts) == 0:
        values = sigma * np.exp(np.linalg.eigvals(f.B[:n, :n]).astype(complex) * P)
        return values[np.lexsort((-values.imag, -np.abs(values)))]
    t = u[: len(contacts)]
    if not (np.all(t[1:] - t[:-1] > -UNORDERED * P) and t[-1] - t[0] < (1 + UNORDERED) * P):  # no orbit
        return np.full(n, np.nan, complex)
    product, columns, couplings = np.empty((n, n)), np.empty((n, n)), np.zeros(n)
    order, work, room = np.empty(n, np.int64), np.empty((3, n, n)), flights.new_room(n + 3)
    pieces = int((1 + len(t) * UNORDERED) * P * f.spread / multipliers.STRETCH)
    factors = np.empty((len(t) + pieces + 1, n, n))  # a piece more than the flights need but for rounding
    motion = np.ascontiguousarray(motion)
    multipliers.multiply(f, contacts, u, P, motion, product, columns, couplings, order, factors, work, room)
    values = sigma * multipliers.eigenvalues(product, columns, couplings)
    return values[np.lexsort((-values.imag, -np.abs(values)))]


def check_unknowns(u: np.ndarray, size: int) -> None:
    """Kernels write where they are told to, beyond the ends of arrays that are too short."""
    if len(u) != size:
        raise AssertionError(f"{len(u)} unknowns for {size} equations: the mean gap of a free mode is one of them")


def contacts_of(q: Linear, slope: Linear | None, sides) -> np.ndarray:
    """(K, 4) stop, 1 + R, and their derivatives by the parameter."""
    sides, result = np.asarray(sides), np.zeros((len(sides), 4))
    result[:, equations.STOP], result[:, equations.GAIN] = q.stop(sides), 1 + q.restitution(sides)
    if slope is not None:
        result[:, equations.STOP_SLOPE] = slope.stop(sides)
        result[:, equations.GAIN_SLOPE] = slope.restitution(sides)
    return result


def steady(q: Linear, sigma: int, halves: int, slope: Linear | None) -> equations.Steady:
    """g_lin of the equations. Raises ResonanceError where an undamped mode is driven at its own frequency."""
    try:
        X = amplitudes(q)
    except np.linalg.LinAlgError:
        raise ResonanceError("the force drives an undamped mode at its own frequency") from None
    turn = np.exp(1j * q.tau)
    gain = q.along @ X * turn
    shapes, seen = free_modes(q)
    P = forcing_period(q) / 2 * halves
    s = space(q)
    free = bool(sigma == 1 and np.any(seen))
    if sigma == 1 and np.any(np.abs(q.constant @ shapes[:, int(free) :]) > 1e-13 * np.abs(q.constant).max(initial=0)):
        raise ResonanceError("a constant force acts on a free mode that the contact does not hold")
    rest = _static(q, q.constant)
    mean = 0.0 if free else q.along @ rest
    momentum = P * (shapes[:, 0] @ q.constant) / (s.effective_mass * seen[0]) if free else 0.0
    d_gain, d_mean, d_momentum, d_omega = 0j, 0.0, 0.0, 0.0
    if slope is not None:
        d_omega = float(slope.omega)
        d_gain = (slope.along @ X + q.along @ amplitude_slopes(q, slope)) * turn + 1j * slope.tau * gain
        if free:
            d_momentum = _momentum_slope(q, slope, shapes[:, 0], seen[0], P)
        else:
            d_mean = slope.along @ rest + q.along @ _static(q, slope.constant - slope.K @ rest)
    if not np.isfinite(gain):
        raise ResonanceError("the force drives an undamped mode at its own frequency")
    numbers = (q.omega, mean, gain.real, gain.imag, d_omega, d_mean, d_gain.real, d_gain.imag)
    return equations.Steady(*map(float, numbers), free, float(momentum), float(d_momentum))


def _static(q: Linear, force: np.ndarray) -> np.ndarray:
    """Displacement under a constant force, without free modes."""
    return np.linalg.lstsq(q.K, force)[0] if np.any(force) else np.zeros(len(force))


def _momentum_slope(q: Linear, slope: Linear, shape, seen, P) -> float:
    if abs(shape @ slope.K @ shape) > 1e-13 * np.abs(slope.K).max(initial=0):
        raise ValueError("this parameter holds a free mode: the equations change their kind here")
    d_shape = -np.linalg.lstsq(q.K, slope.K @ shape)[0]
    s, ds = space(q), space_slopes(q, slope).effective_mass
    force, weight = shape @ q.constant, s.effective_mass * seen
    d_force = d_shape @ q.constant + shape @ slope.constant
    d_weight = ds * seen + s.effective_mass * (d_shape @ q.along + shape @ slope.along)
    dP = -P * slope.omega / q.omega
    return (dP * force + P * d_force) / weight - P * force * d_weight / weight**2


TABLES = ("M", "K", "C", "along", "constant", "sine", "cosine", "omega", "tau")


def moves_stops_only(slope: Linear) -> bool:
    """Whether a parameter changes the stops and the restitution, and no table."""
    return not any(np.any(getattr(slope, name)) for name in TABLES)


@lru_cache(maxsize=16)
def _flow(key: Keyed) -> free_flight.Flow:
    return free_flight.flow(key.q)


@lru_cache(maxsize=16)
def _held_flow(key: Keyed) -> free_flight.Flow:
    return free_flight.held_flow(key.q)


@lru_cache(maxsize=64)
def _closing(key: Keyed, sigma: int, halves: int) -> np.ndarray:
    return free_flight.closing(key.q, sigma, halves)


@lru_cache(maxsize=64)
def _steady(key: Keyed, sigma: int, halves: int) -> equations.Steady:
    return steady(key.q, sigma, halves, None)


def flow(q: Linear) -> free_flight.Flow:
    return _flow(Keyed(q, TABLES))


def held_flow(q: Linear) -> free_flight.Flow:
    return _held_flow(Keyed(q, TABLES))


def closing(q: Linear, sigma: int, halves: int) -> np.ndarray:
    return _closing(Keyed(q, ("M", "K", "C", "along", "omega")), sigma, halves)
