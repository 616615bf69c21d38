"""A solution of the equations of periodic orbits, and what follows from it."""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations, groupby
from operator import attrgetter

import numpy as np

from vibro_sweep.analysis.periodic.contact_numbers import is_smooth, one_plus_R
from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.itinerary import is_mirrored, repetitions
from vibro_sweep.analysis.periodic.joined_contacts import ROUNDING, without_flights
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.analysis.periodic.orbit_motion import OrbitMotion
from vibro_sweep.analysis.periodic.orbit_multipliers import contacts_of, multipliers_of
from vibro_sweep.analysis.periodic.resting_orbit import RestingOrbit
from vibro_sweep.analysis.periodic.steady_gap import steady_gap
from vibro_sweep.engine.impulses.flow import flow
from vibro_sweep.engine.impulses.free_modes import has_free_gap
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.linear import MOTION, KeyOfFields, forcing_period

# Relative difference below which two halves (periods) of an orbit are the same. An orbit that is born at a pitchfork or
# flip differs by so much at a distance of some 1e-12; nearer to it Newton's method does not distinguish the two orbits.
ALIKE = 1e-6
tables = attrgetter(*MOTION)  # of an oscillator
NO_SPEED = 1e-9  # impulse, relative to omega times the gap, below which an impact is not counted as one


@dataclass(frozen=True)
class Solution:
    """z(t + P) = sigma z(t), P = half_periods T/2, with impacts u = (t_1 .. t_K, D_1 .. D_K) on `sides`.

    Events that last are `rests`: with R = 0 the mass may rest after an impact, and a contact with a compliant stop
    lasts from touch to release. Of them D is minus the velocity at the beginning, and u goes on with their ends.
    """

    family: Family
    sigma: int
    half_periods: int
    sides: tuple[int, ...]
    u: np.ndarray
    change: float = 0.0  # of the last Newton step
    rests: tuple[int, ...] = ()

    @cached_property
    def resting(self) -> RestingOrbit:
        """The motion of an orbit with rests."""
        return RestingOrbit(self)

    @cached_property
    def _motion(self) -> OrbitMotion:
        return self.resting if self.rests else OrbitMotion(self)

    @property
    def K(self) -> int:
        return len(self.sides)

    @property
    def P(self) -> float:
        return forcing_period(self.family.linear) / 2 * self.half_periods

    @property
    def is_free(self) -> bool:
        """Whether the contact sees a free mode, which no rest holds."""
        return self.sigma == 1 and not self.rests and has_free_gap(self.family.linear)

    @property
    def times(self) -> np.ndarray:
        return self.u[: self.K]

    @property
    def jumps(self) -> np.ndarray:
        return self.u[self.K : 2 * self.K]

    @property
    def ends(self) -> np.ndarray:
        """The ends of the rests."""
        return self.u[2 * self.K : 2 * self.K + len(self.rests)]

    @cached_property
    def contacts(self) -> np.ndarray:
        """(K,) whether events are contacts with compliant stops."""
        return self.family.linear.contact.is_compliant(np.array(self.sides, int))

    @property
    def events(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """(K,) sides, times, velocity jumps and ends, NaN of what does not last."""
        ends = np.full(self.K, np.nan)
        ends[list(self.rests)] = self.ends
        return np.array(self.sides, int), self.times, self.jumps, ends

    def with_events(self, sides, times, jumps, ends) -> "Solution":
        """A solution, or a guess, with these `events`."""
        lasting = np.isfinite(ends)
        u, rests = np.concatenate([times, jumps, ends[lasting]]), tuple(np.flatnonzero(lasting).tolist())
        return replace(self, sides=tuple(int(side) for side in sides), u=u, change=0.0, rests=rests)

    @cached_property
    def hold(self) -> float:
        """The least free acceleration into the stop during the rests, over omega^2; inf without a rest."""
        return self._certificate[1]

    @cached_property
    def relaxes(self) -> bool:
        """Whether each stop that a contact left by force is at rest again at its next touch."""
        return self._certificate[2] > 0

    @cached_property
    def motion(self) -> np.ndarray:
        """(K, 3) gap velocity, acceleration and jerk before each impact; the velocity as the jump says."""
        q = self.family.linear
        B = flow(q).B
        N, states = q.masses, self.states[: self.K]
        rates, v = states @ B.T, -self.jumps / one_plus_R(q, self.sides)
        return np.column_stack([np.where(v != 0, v, states[:, N]), rates[:, N], rates @ B[N]])

    @cached_property
    def _regular(self) -> "Solution":
        """This orbit, without a flight of no length between two contacts, at which its equations are singular."""
        return without_flights(self)

    @property
    def _only_touched(self) -> list[int]:
        """Contacts of no length with stops at which they begin smoothly: their own equations are singular there."""
        q, lengths = self.family.linear, self.ends - self.times[list(self.rests)]
        return [
            i
            for i, length in zip(self.rests, lengths, strict=True)
            if length <= ROUNDING * self.P and is_smooth(q, self.sides[i])
        ]

    @cached_property
    def _certificate(self) -> tuple[np.ndarray, float, float]:
        return (self._regular if self.rests else self)._motion.certificate()

    @cached_property
    def states(self) -> np.ndarray:
        """The states before each impact, in contact coordinates."""
        return self._motion.states

    @property
    def nearest(self) -> tuple[float, float, int]:
        """Distance, time and side of the turning point nearest to its stop."""
        distance, time, side = self._certificate[0]
        return float(distance), float(time), int(side)

    @property
    def stop_distance(self) -> float:
        return self.nearest[0]

    @cached_property
    def multipliers(self) -> np.ndarray:
        """Multipliers of the map over P, with the mirror for sigma = -1."""
        if touches := self._only_touched:
            return Linearised(self, watched=touches, corner=touches[0]).multipliers()
        if self.rests:
            return self._regular.resting.multipliers()
        q = self.family.linear
        return multipliers_of(flow(q), self.sigma, self.P, contacts_of(q, self.sides), self.u, self.motion)

    @cached_property
    def products(self) -> np.ndarray:
        """mu_i mu_j, i < j."""
        with np.errstate(invalid="ignore"):  # an infinite one times zero
            return np.array([a * b for a, b in combinations(self.multipliers, 2)])

    @cached_property
    def torus(self) -> float:
        """prod_{i<j} (1 - mu_i mu_j): zero at a Neimark-Sacker point, and at a neutral saddle. 1 without losses."""
        with np.errstate(invalid="ignore"):
            if abs(abs(np.prod(self.multipliers)) - 1) < 1e-9:
                return 1.0
            return float(np.prod(1 - self.products).real)

    @property
    def pushes(self) -> np.ndarray:
        """(K,) sizes of the impulses; negative for one that pulls."""
        return -np.asarray(self.sides, float) * self.jumps

    @property
    def only_touches(self) -> bool:
        """Whether no impact has a speed: the free motion, which grazes."""
        return bool(np.all(self.pushes < NO_SPEED * self.family.linear.omega * self.size_of_gap))

    @property
    def real(self) -> bool:
        """Whether every impulse pushes and every flight stays inside, to rounding."""
        rounding = 1e-13 * self.size_of_gap
        speed = self.family.linear.omega * rounding
        q = self.family.linear
        sticks = self.hold > -rounding and np.all(self.ends >= self.times[list(self.rests)])
        sticks = sticks and np.all(one_plus_R(q, np.array(self.sides)[list(self.rests)]) == 1)
        return bool(np.all(self.pushes > -speed) and self.stop_distance > -rounding and sticks and self.relaxes)

    @cached_property
    def size_of_gap(self) -> float:
        """A scale of the gap: of the stops that are hit, the steady motion, and what impulses do in 1/omega."""
        q = self.family.linear
        stops, moved = np.abs(q.contact.stop(np.array(self.sides, int))), np.abs(self.jumps) / q.omega
        return max(float(stops.max(initial=0.0)), abs(steady_gap(q).swing), float(moved.max(initial=0.0)))

    @cached_property
    def units(self) -> np.ndarray:
        """(2K + rests,) of the unknowns: 1/omega, and omega times the size of the gap."""
        omega = self.family.linear.omega
        return np.repeat([1 / omega, omega * self.size_of_gap, 1 / omega], [self.K, self.K, len(self.rests)])

    def corrected(self) -> "Solution | None":
        """The solution that Newton's method finds from this one; None without convergence."""
        if self.K == 0:
            return self
        if self.rests:
            try:
                u, change = replace(self).resting.newton()
            except np.linalg.LinAlgError:
                return None
            return replace(self, u=u, change=float(change)) if np.isfinite(change) else None
        return corrected([self])[0]

    def with_touch(self, index: int, time: float, side: int) -> "Solution":
        """The same motion with one impact more, which has no speed."""
        end = time if self.family.linear.contact.is_compliant(side) else np.nan  # a contact ends as it begins
        new = zip(self.events, (side, time, 0.0, end), strict=True)
        return self.with_events(*(np.insert(values, index, value) for values, value in new))

    def whole(self) -> "Solution":
        """The same orbit over its whole period, sigma = +1."""
        return self if self.sigma == 1 else self.repeated(2)

    def repeated(self, count: int) -> "Solution":
        """The same orbit taken `count` times."""
        turns, K = np.arange(count)[:, None], self.K
        later, signs = self.P * turns, float(self.sigma) ** turns
        u = np.concatenate([(self.times + later).ravel(), (signs * self.jumps).ravel(), (self.ends + later).ravel()])
        sides = tuple(self.sigma**k * side for k in range(count) for side in self.sides)
        rests = tuple(k + K * i for i in range(count) for k in self.rests)
        return Solution(self.family, self.sigma**count, self.half_periods * count, sides, u, self.change, rests)

    def part(self, count: int, sigma: int, alike: float = ALIKE, exact: bool = True) -> "Solution | None":
        """The first of `count` equal parts (mirrored ones for sigma = -1), if they are equal to the share `alike`.

        exact : corrected by Newton's method, which fails at a fold; otherwise the mean of the parts
        """
        K, P, rests = self.K // count, self.P / count, self.rests[: len(self.rests) // count]
        if self.rests != tuple(k + K * i for i in range(count) for k in rests):
            return None
        t, D = self.times.reshape(count, K), self.jumps.reshape(count, K)
        signs = float(sigma) ** np.arange(count)[:, None]
        shifted, aligned = t - P * np.arange(count)[:, None], D * signs
        scale = np.abs(D).max(initial=1e-300)
        if np.ptp(shifted, 0).max() > alike * P or np.ptp(aligned, 0).max() > alike * scale:
            return None
        u = np.concatenate([shifted.mean(0), aligned.mean(0), self.ends[: len(rests)]])
        found = Solution(self.family, sigma, self.half_periods // count, tuple(self.sides[:K]), u, 0.0, rests)
        if not exact:
            return found
        found = found.corrected()
        if found is None or np.abs(found.times - shifted[0]).max() > 10 * alike * P:
            return None
        return found

    def reduced(self, exact: bool = True) -> "Solution":
        """The solution with its least period, and as half an orbit where it is symmetric; exact: as of `part`."""
        family = self.family
        if self.K == 0:
            symmetric = family.linear.symmetric
            return Solution(family, -1 if symmetric else 1, 1 if symmetric else 2, (), self.u, 0.0)
        whole = self.whole()
        for count in repetitions(whole.sides):
            if whole.half_periods // 2 % count == 0:
                found = whole.part(count, 1, exact=exact)
                if found is not None:
                    whole = found
                    break
        if self.family.linear.symmetric and whole.half_periods % 4 == 2 and is_mirrored(whole.sides):
            half = whole.part(2, -1, exact=exact)
            if half is not None:
                return half
        return whole


def corrected(solutions: list[Solution]) -> list[Solution | None]:
    """`Solution.corrected` of orbits with the same impacts, together where only their contacts differ."""
    result: list[Solution | None] = []
    for _, group in groupby(solutions, lambda one: KeyOfFields(one.family.linear, tables(one.family.linear))):
        some = list(group)
        if not some[0].K or some[0].rests:
            result += [one.corrected() for one in some]
            continue
        guesses, oscillators = np.array([one.u for one in some]), [one.family.linear for one in some]
        found = EventEquations.of(some[0]).newton(guesses, oscillators)
        for one, u, change in zip(some, *found, strict=True):
            result.append(replace(one, u=u, change=float(change)) if np.isfinite(change) else None)
    return result
