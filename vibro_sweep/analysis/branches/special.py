"""Special points of a branch: what they are, and what happens at a graze."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from vibro_sweep.analysis.branches import branch_text
from vibro_sweep.analysis.branches.touches_at_once import TouchesAtOnce
from vibro_sweep.analysis.continuation.chatter import Chatter
from vibro_sweep.analysis.periodic.contact_numbers import impulse_by_speed, is_smooth, one_plus_R
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.analysis.periodic.orbit_motion import OrbitMotion
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.seeds_of_free_motion import touching_at_once
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.linear import Linear


@dataclass(frozen=True, eq=False, repr=False)
class SpecialPoint:
    """A bifurcation on a branch, or the branch's end.

    type : fold, flip, pitchfork, neimark_sacker, graze, sticking, split, permanent_contact, unrelaxed, closed, boundary
        or failed
    parameters : the number that was followed, by its name
    multipliers : of the map that the type belongs to: the half map with the mirror where the orbit is symmetric
    error : own estimate of the parameter's error: two locations from the two sides differ by less
    stop : of a graze the stop, +1 or -1
    kind : of a graze "persistence" or "nonsmooth fold"
    impact : of a graze the index, in `orbit.impacts`, of the impact that vanishes (of a symmetric orbit the one in its
        first half), or None: one appears
    direction : of a graze +1 where the orbit without that impact exists at a larger parameter, -1 at a smaller one
    criticality : of a flip or pitchfork "super": the born orbit exists where its parent has the multiplier outside the
        unit circle; "sub": where it is inside. Of a neimark_sacker point "super": the circle that is born attracts the
        orbits near it in its plane. None where it cannot be decided, and for other types

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (3.0, 4.5))
    >>> graze = branch.begins
    >>> graze.type, graze.kind, graze.stop, round(graze.parameters["b"], 8), graze.error < 1e-12
    ('graze', 'nonsmooth fold', -1, 3.22190388, True)
    """

    type: str
    parameters: dict[str, float]
    orbit: PeriodicOrbit
    multipliers: np.ndarray
    error: float = np.nan
    stop: int | None = None
    kind: str | None = None
    impact: int | None = None
    direction: int | None = None
    criticality: str | None = None
    _chatter: Chatter | None = field(default=None, repr=False)

    def __repr__(self) -> str:
        return branch_text.of_special_point(self)


def table_of(special: list[SpecialPoint]) -> dict[str, list]:
    """The special points of a branch or a curve as columns: parameters, type, what tells it apart, orbit, error."""
    numbers = {name: [one.parameters[name] for one in special] for name in special[0].parameters}
    words = {name: [getattr(one, name) for one in special] for name in ("type", "kind", "criticality", "stop")}
    orbits = {name: [getattr(one.orbit, name) for one in special] for name in ("period", "itinerary")}
    return numbers | words | orbits | {"error": [one.error for one in special]}


@dataclass(frozen=True)
class Graze:
    """The same motion as an orbit without and with the impact that has zero speed."""

    without: Solution
    touching: Solution
    index: int  # of that impact in `touching`
    gone: np.ndarray  # indices of all that have zero speed there
    distance_slopes: np.ndarray  # d(distance from the stop)/dp of each of them, along the orbits without them
    speed_slope: float  # d(impact speed)/dp along the orbits with it; infinite where it begins like a square root
    multipliers: np.ndarray | None = None  # of the orbits with it, where all of the equations' are singular
    at_once: TouchesAtOnce | None = None  # `touching`, where it is free motion with several touches
    goes_on: bool | None = None  # where it touches both stops: whether orbits with some touches are on both sides

    @property
    def distance_slope(self) -> float:
        """That of the impact itself."""
        return float(self.distance_slopes[self.gone == self.index][0])

    @property
    def kind(self) -> str:
        """Whether the orbits with the impact, or with some of them, go on where those without it end."""
        goes_on = self.distance_slope * self.speed_slope < 0 if self.goes_on is None else self.goes_on
        return "persistence" if goes_on else "nonsmooth fold"


FORGOTTEN = 1e12  # ratio of speeds and distances, in 1/omega, that only rounding makes: the impact is forgotten
AT_ONCE = 1e-11  # the same, of impacts that vanish with another one, for all that rounding does
SHALLOW = 1e-13  # of the gap's size: the depth of contacts that do
TOUCHING = 2.0**-48  # of the gap's size, that counts as no distance from a stop


def vanishing(solution: Solution, impact: int) -> np.ndarray:
    """Indices of the impacts that vanish with `impact`: all where the free motion grazes, and where a simpler orbit
    does its repetitions."""
    if solution.only_touches:
        return np.arange(solution.K)
    slow = AT_ONCE * solution.family.linear.omega * solution.size_of_gap
    return np.union1d(np.flatnonzero((solution.pushes < slow) | shallow(solution)), [impact])


def shallow(solution: Solution) -> np.ndarray:
    """(K,) whether events are contacts that begin smoothly, with the speed v, and end before the depth v^2/(2 |a|) is
    more than rounding."""
    smooth = [is_smooth(solution.family.linear, side) for side in solution.sides]
    most = 2 * np.abs(solution.motion[:, 1]) * SHALLOW * solution.size_of_gap
    return np.array(smooth, bool) & (solution.pushes**2 <= most)


def graze_at(solution: Solution, name: str, impact: int | None, touching: Solution | None = None, index=0) -> Graze:
    """Unfold a graze: `impact` vanishes, or (None) the turning point nearest to its stop becomes an impact.

    touching : the free motion with several of them, in place of that, of which `index` is meant. Raises LinAlgError
    where the orbit without the impact is at a fold.
    """
    if touching is not None:
        without, gone = solution, np.arange(touching.K)
    elif impact is None:
        without, (touching, index) = solution, inserted(solution)
        gone = np.array([index])
    else:
        touching, index, gone = solution, impact, vanishing(solution, impact)
        without = bare(solution, gone)
    derivative = solution.family.derivative(name)
    watched = Linearised(touching, derivative, gone)
    away = np.array([watched.distance_slope(i) for i in gone.tolist()])
    begins = without, touching, index, gone, away
    goes_on = orbits_on_both_sides(without.family, derivative) if without.K == 0 and without.sigma == 1 else None
    side, q = touching.sides[index], solution.family.linear
    if len(gone) == touching.K > 1:
        at_once = TouchesAtOnce(touching, -away)
        every = np.ones(touching.K, bool)
        depths, impulses = at_once.begun(every)
        speed = float(impulses[index] / impulse_by_speed(q, side))
        if np.any(at_once.smooth):
            speed = math.copysign(np.inf, at_once.side_of(every) or depths[index])
        return Graze(*begins, speed, at_once.multipliers() if np.all(at_once.smooth) else None, at_once, goes_on)
    if is_smooth(q, side):  # the speed grows like the square root of the distance passed
        # and where it ends by force the damper adds to the motion what is proportional to that distance
        begun = Linearised(touching, derivative, gone, index)
        speed = math.copysign(np.inf, -begun.distance_slope(index))
        return Graze(*begins, speed, begun.multipliers(), goes_on=goes_on)
    speed = float(-side * slopes(touching, name)[touching.K + index] / one_plus_R(q, [side])[0])
    if abs(speed) > FORGOTTEN * q.omega * abs(watched.distance_slope(index)):
        speed = math.copysign(np.inf, -watched.distance_slope(index))
    return Graze(*begins, speed, goes_on=goes_on)


def orbits_on_both_sides(family: Family, derivative: Linear) -> bool | None:
    """Of free motion that touches both stops at once: whether orbits begin, or end, there on both sides. None: it
    touches one."""
    found = touching_at_once(Solution(family, 1, 2, (), np.empty(0)))
    if found is None:
        return None
    touching, gone = found[0], range(found[0].K)
    watched = Linearised(touching, derivative, gone)
    return TouchesAtOnce(touching, np.array([-watched.distance_slope(i) for i in gone])).goes_on()


def inserted(solution: Solution, slow=()) -> tuple[Solution, int]:
    """The same motion with the turning point nearest to its stop as an impact without speed, and its index.

    slow : indices of impacts without speed, whose own turning points are left out
    """
    _, time, side = OrbitMotion(solution, slow).certificate()[0] if len(slow) else solution.nearest
    index = int(np.searchsorted(solution.times, time))
    return solution.with_touch(index, float(time), int(side)), index


def bare(solution: Solution, gone) -> Solution:
    """The same motion as an orbit without impacts that have no speed; gone: the index of one, or rising ones."""
    gone, rests = np.atleast_1d(np.asarray(gone, int)), np.array(solution.rests, int)
    leave = np.isin(rests, gone)  # contacts, whose ends go with them
    sides = np.delete(solution.sides, gone)
    u = np.delete(solution.u, [*gone, *(solution.K + gone), *(2 * solution.K + np.flatnonzero(leave))])
    rests = rests[~leave]
    rests = tuple((rests - np.searchsorted(gone, rests)).tolist())
    return replace(solution, sides=tuple(sides.tolist()), u=u, rests=rests)


def slopes(solution: Solution, name: str) -> np.ndarray:
    """du/dp of an orbit that is not at a fold."""
    return Linearised(solution, solution.family.derivative(name)).slopes() if solution.K else np.zeros(0)
