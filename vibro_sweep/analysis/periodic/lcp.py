"""Which orbits are born where the steady motion grazes: a linear complementarity problem.

To lowest order in the distance b - b* the impacts happen where the steady motion touches the stops, at t_j = j T/2
(both stops) or j T (one stop), with impulses d_j >= 0, and the gaps there are w_j >= 0:

    w = (b - b*) 1 + M d,   w.d = 0,   M_jk = s_j s_k gamma_nT(t_j - t_k)

Each solution with w + d > 0 is an orbit of period n T that exists on one side of b*, with speeds proportional to the
distance.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.itinerary import canonical_start
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, found_orbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.analysis.periodic.steady_gap import steady_gap
from vibro_sweep.checks.arguments import checked_count, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.engine.impulses import flights
from vibro_sweep.engine.impulses.flow import closing, flow
from vibro_sweep.engine.impulses.free_modes import has_free_gap
from vibro_sweep.oscillator.family import rigid_family_of
from vibro_sweep.oscillator.linear import Linear, forcing_period

BESIDE = (1e-4, 1e-5, 1e-6, 1e-7)  # distances from b*, over the amplitude of the gap, at which an orbit is confirmed
NEAR = 0.1  # relative difference of the impulses there from those of lowest order
MOST_PLACES = 20  # for impacts: all 2^20 subsets of them are gone through
CHUNK = 1 << 14


@dataclass(frozen=True, eq=False)
class Born:
    """An orbit born at the graze of the steady motion.

    orbit : at a small distance from b*, confirmed by Newton's method
    born : "below" or "above" b*
    speed_per_distance : (impacts,) impact speeds over |b - b*|, in the order of `orbit.impacts`

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> born = vs.born_at_grazing(system, periods=1)[0]
    >>> born.itinerary, born.speed_per_distance.round(4)
    ('R', array([0.9558]))
    """

    orbit: PeriodicOrbit
    born: str
    speed_per_distance: np.ndarray

    @property
    def period(self) -> int:
        """Of `orbit`, in forcing periods."""
        return self.orbit.period

    @property
    def itinerary(self) -> str:
        """Of `orbit`: the stops that it hits, as "LR"."""
        return self.orbit.itinerary


class _Graze(NamedTuple):
    """The touches of the steady motion at the stops."""

    b: float
    amplitude: float  # of the gap
    first: float  # time
    side: int  # then
    per_period: int  # touches in a forcing period, of the stops in turn
    mirrors: bool  # whether mirror images of orbits are orbits

    def touches(self, n: int, T: float) -> tuple[np.ndarray, np.ndarray]:
        """Times and sides within the period n T."""
        j = np.arange(n * self.per_period)
        return self.first + T / self.per_period * j, self.side * (-1) ** (j * (self.per_period - 1))


@names_its_arguments
def born_at_grazing(system, periods: int = 6) -> list[Born]:
    """All orbits of least period 1 .. `periods` that are born where the steady motion grazes, mirror images once.

    `system` gives the oscillator; its clearance plays no part. Where the motion touches the two stops at different
    clearances, the graze at the larger one is meant. Sorted by period, number of impacts and itinerary.

    Raises ValueError where no steady motion exists or the gap is at rest in it, and for more periods than 2^20 sets
    of impacts allow.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> [(one.itinerary, one.period, one.born) for one in vs.born_at_grazing(system, periods=1)]
    [('R', 1, 'below'), ('LR', 1, 'below')]
    """
    family = rigid_family_of(system, "born at grazing")
    periods = checked_count("periods", periods, 1)
    if "b" not in family.numbers:
        raise ArgumentError(not_allowed("system", system, "one with a clearance b"))
    if has_free_gap(family.linear):
        raise ArgumentError(not_allowed("system", system, "one without a free mode, which has no steady motion"))
    graze = _graze(family.linear, family.numbers["b"])
    if graze.amplitude == 0:
        raise ArgumentError(not_allowed("system", system, "one whose gap a force moves, so that it grazes"))
    most = MOST_PLACES // graze.per_period
    if periods > most:
        raise ArgumentError(not_allowed("periods", periods, f"at most {most}"))
    result = []
    for n in range(1, periods + 1):
        result += _of_period(system, family, graze, n)
    return result


def _graze(q: Linear, b: float) -> _Graze:
    s = steady_gap(q)
    amplitude = abs(s.swing)
    right = b + s.mean + amplitude - q.contact.high  # -inf without that stop
    left = b + q.contact.low - s.mean + amplitude
    double = abs(right - left) <= 1e-12 * amplitude
    first = -(np.angle(s.swing) + q.tau) / q.omega
    side = 1 if right >= left or double else -1
    first += 0 if side > 0 else forcing_period(q) / 2
    return _Graze(max(right, left), amplitude, first, side, 1 + double, double and q.contact.R_low == q.contact.R_high)


def _of_period(system, family, graze: _Graze, n: int) -> list[Born]:
    q = family.linear
    EventEquations(q, 1, 2 * n, ())  # or there are no such orbits
    times, sides = graze.touches(n, forcing_period(q))
    count = len(times)
    j, gamma = np.arange(count), _gamma(q, n, count)
    M = sides[:, None] * sides * gamma[(j[:, None] - j) % count]
    result = [
        _confirmed(system, family, graze, n, times[hit], sides[hit], d, side)
        for hit, d, side in complementary(M, representatives(count, graze.per_period, graze.mirrors))
    ]
    return sorted(result, key=lambda item: (len(item.speed_per_distance), item.itinerary, item.born))


def _gamma(q: Linear, n: int, count: int) -> np.ndarray:
    """(count,) the gap's response at 0, P/count, 2 P/count, ... to a unit impulse repeated every P = n T."""
    states, f, P = 2 * q.masses, flow(q), n * forcing_period(q)
    E = np.empty((count, states, states))
    flights.flight_matrices(f, P / count * np.arange(1, count + 1), E, flights.new_workspace(states + 3))
    before = closing(q, 1, 2 * n)[:, :states] @ E[-1, :, states // 2]
    after = before + np.eye(states)[states // 2]
    return np.append(before[0], E[:-1, 0] @ after)


def representatives(count: int, per_period: int, mirrors: bool) -> np.ndarray:
    """Sets of places, (m, count) bool: one of all its rotations by forcing periods, and by halves where mirror images
    count once (then the one with most impacts on the first stop); none that repeats itself earlier."""
    masks = np.arange(1, 1 << count, dtype=np.int64)
    full = (1 << count) - 1
    keep = np.ones(len(masks), bool)

    def rank(mask):
        first = np.zeros(len(mask), np.int64)
        for i in range(0, count, per_period):
            first += mask >> i & 1
        return first * (1 << count) + (full - mask)

    own = rank(masks)
    for places in range(1, count):
        rotated = (masks << places | masks >> (count - places)) & full
        if places % per_period == 0:
            keep &= rotated != masks
        if places % per_period == 0 or mirrors:
            keep &= rank(rotated) <= own
    chosen = masks[keep]
    return (chosen[:, None] >> np.arange(count) & 1).astype(bool)


def complementary(M: np.ndarray, sets: np.ndarray):
    """Solutions of w = side 1 + M d, w >= 0, d >= 0, w.d = 0, w + d > 0 with d > 0 just on one of `sets`.

    Yields (set, d on it, side), side = +1 or -1.
    """
    sizes = sets.sum(1)
    for size in np.unique(sizes):
        group = sets[sizes == size]
        for begin in range(0, len(group), CHUNK):
            chosen = group[begin : begin + CHUNK]
            inside = np.nonzero(chosen)[1].reshape(-1, size)
            blocks = M[inside[:, :, None], inside[:, None, :]]
            regular = np.linalg.cond(blocks) < 1e12
            chosen, inside = chosen[regular], inside[regular]
            y = np.linalg.solve(blocks[regular], np.ones((len(chosen), size, 1)))[..., 0]
            gaps = np.einsum("mjk,mk->mj", M[:, inside].transpose(1, 0, 2), y)
            for side in (-1, 1):
                pushes = np.all(-side * y > 0, axis=1)
                opens = np.all((side * (1 - gaps) > 0) | chosen, axis=1)
                for i in np.flatnonzero(pushes & opens):
                    yield chosen[i], -side * y[i], side


def _confirmed(system, family, graze: _Graze, n: int, t, sides, d, side: int) -> Born:
    """The orbit at a small distance on its side, by Newton's method from what lowest order says."""
    P = n * forcing_period(family.linear)
    R = family.linear.contact.restitution(sides)
    orbit = PeriodicOrbit(system, "not_converged")
    for share in BESIDE:
        distance = share * graze.amplitude
        changed = family.replace(b=graze.b + side * distance)
        u = np.concatenate([t, -sides * d * distance])
        found = Solution(changed, 1, 2 * n, tuple(map(int, sides)), u).corrected()
        if found is None or np.abs(found.jumps / u[len(t) :] - 1).max() > NEAR:
            continue
        orbit = found_orbit(system.replace(b=changed.numbers["b"]), found)
        if orbit.ok:
            break
    first = canonical_start(sides, t if found is None else found.times, P / n, P)
    speeds = np.roll(d / (1 + R), -first)
    return Born(orbit, "above" if side > 0 else "below", speeds)
