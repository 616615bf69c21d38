"""Points of a branch of periodic orbits, and steps between them, on the continuation core.

Distances along a branch are measured over phases, over impulses in units of omega times the size of the gap, and over
the parameter in that of its range.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibro_sweep.analysis.continuation.first_point import first_direction, guess_of
from vibro_sweep.analysis.continuation.start import Start
from vibro_sweep.analysis.continuation.tracer import Tracer, copied
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.moving_flow import OMEGA
from vibro_sweep.engine.continuation.workspace import TEST, Place
from vibro_sweep.model.linear import Linear

SLOW = 1e-5  # impulse, relative to the largest, of an impact that is next to a graze
STILL = 1e-5  # in units of a walk: an orbit that Newton's method takes farther off is another one


@dataclass(eq=False)
class Point:
    """A point of a branch. What it is measured by: K phases, K impulses and the parameter, in units of the walk."""

    walk: "Walk"
    guess: Place
    held: float | None = None  # the parameter, where it is given

    @property
    def p(self) -> float:
        return self.held if self.held is not None else float(self.guess.p[0])

    def hold(self, value: float) -> None:
        """The parameter is `value`, to the last bit: rounding may put it beyond what is allowed."""
        self.held = self.guess.p[0] = value
        self.__dict__.pop("solution", None)

    def touch(self, index: int) -> None:
        """The impact `index` vanishes, to the last bit."""
        self.guess.jumps[index] = 0.0
        self.__dict__.pop("solution", None)

    def backwards(self) -> "Point":
        """The same point of the branch in the other direction."""
        return Point(self.walk, self.walk.turned(self.guess), self.held)

    @property
    def x(self) -> np.ndarray:
        """(2K + 3,): as `tangent`, the last two 0."""
        place = self.guess
        return np.concatenate([place.phases, place.jumps, [place.p[0] / self.walk.unit, 0.0, 0.0]])

    @property
    def tangent(self) -> np.ndarray:
        """(2K + 3,) unit tangent: phases, impulses, the parameter in its unit."""
        return self.walk.tracer.direction(self.guess)

    @property
    def rate(self) -> float:
        """Of the parameter, in its unit."""
        return float(self.guess.tangent_p[0])

    @cached_property
    def solution(self) -> Solution:
        return self.walk.solution(self.guess)

    @property
    def residual(self) -> float:
        """The last change of Newton's method."""
        return self.solution.change

    @property
    def rounding(self) -> float:
        """What rounding of the equations does to the parameter of the point, on the plane across the tangent."""
        return self.walk.rounding(self, self.tangent)

    @property
    def margin(self) -> float:
        """Least distance of the flights from the stops."""
        return float(self.guess.tests[TEST.margin] * self.walk.tracer.units.length)

    @cached_property
    def releases(self) -> np.ndarray:
        """(K,) acceleration away from the stop just after an impact with R = 0; infinite for other impacts."""
        return self.walk.releases(self.guess)

    @property
    def stays(self) -> float:
        """The least of what makes a rest: its length, the acceleration into the stop and the speed before it."""
        return float(
            min(self.guess.jumps[list(self.walk.start.rests)].min(initial=np.inf), self.guess.tests[TEST.hold])
        )


def along(a: Point, b: Point) -> float:
    """How far b lies ahead of a, along the tangent there."""
    return float((b.x - a.x) @ a.tangent)


class Walk:
    """A branch through `start`, an orbit with impacts, in the parameter `name`."""

    def __init__(self, start: Solution, name: str, span: float):
        self.start, self.name, self.family, self.unit = start, name, start.family, span
        self._taus = [(start.family.numbers[name], float(start.family.linear.tau))]

    @cached_property
    def tracer(self) -> Tracer:
        """Raises NoPlaneError, ResonanceError."""
        value = self.family.numbers[self.name]
        return Tracer(Start("orbit", self.start), (self.name,), [(value - self.unit, value + self.unit)], [self.unit])

    def oscillators(self, values: np.ndarray) -> list[Linear]:
        """At values of the parameter that points of the branch have."""
        return [self.family.replace(**{self.name: p}).linear for p in values.tolist()]

    def correct(self, guess: Place, row: np.ndarray) -> Point | None:
        """The point on the plane through `guess` across `row`, to which its tangent leads; None if Newton's method
        fails."""
        place = self.tracer.correct(guess, row)
        return place and Point(self, place)

    def turned(self, place: Place) -> Place:
        """The same place with its tangent backwards."""
        other = copied(place)
        other.tangent[:], other.tangent_p[:], other.tests[TEST.rate] = (
            -place.tangent,
            -place.tangent_p,
            -place.tests[TEST.rate],
        )
        return other

    def first(self, forwards: float) -> Point | None:
        """`start` itself; `forwards`: sign of the parameter's change.

        None where Newton's method fails, or leads to another orbit, as at a fold to that from which it was born.
        """
        point = self._first
        return point if point is None or forwards == 1 else point.backwards()

    @cached_property
    def _first(self) -> Point | None:
        try:
            guess = guess_of(self.tracer)
        except ValueError:
            return None
        point = guess and (self.correct(guess, self.tracer.axis(0)) or self._across(guess))
        if point is None or np.abs(point.x - Point(self, guess).x).max() > STILL:
            return None
        point.hold(self.family.numbers[self.name])
        return point

    def _across(self, guess: Place) -> Point | None:
        """The start on the plane across its tangent, where impacts are so slow that the parameter hardly tells them."""
        speeds = np.abs(self.start.jumps)
        row = first_direction(self.tracer, guess) if speeds.min() < SLOW * speeds.max() else None
        return None if row is None else self.correct(guess, np.copysign(1.0, row[-3]) * row)

    def step(self, point: Point, length: float, near: Place | None = None) -> Point | None:
        """The point of the branch whose projection on the tangent at `point` is `length`; near: a guess."""
        tangent = point.tangent
        if near is not None:
            length -= float(tangent @ (Point(self, near).x - point.x))
        guess = self.tracer.moved(near or point.guess, length, point.guess)
        return self.correct(guess, tangent)

    def beside_start(self, length: float) -> Point | None:
        """The point of the branch at a distance from the start, also where that is a fold."""
        guess = guess_of(self.tracer)
        row = guess and first_direction(self.tracer, guess)
        if row is None:
            return None
        return self.correct(self.tracer.moved(guess, length), row)

    @property
    def K(self) -> int:
        return self.start.K

    def difference(self, a: Point, b: Point) -> np.ndarray:
        """(2K + 3,) from a to b."""
        return self.tracer.difference(a.guess, b.guess)

    def on_chord(self, near: Point, a: Point, b: Point, share: float, row: np.ndarray, exact: bool) -> Point | None:
        """The point on the plane across `row` at this share of the chord from a to b beside a known point."""
        place = self.tracer.on_chord(near.guess, a.guess, b.guess, share, row, exact)
        return place and Point(self, place)

    def at_value(self, a: Point, b: Point, value: float) -> Point | None:
        """The point between a and b where the parameter has this value."""
        place = self.tracer.at_value(a.guess, b.guess, 0, value)
        return place and Point(self, place)

    def parameters(self, point: Point) -> np.ndarray:
        """(1,)."""
        return np.array([point.p])

    def rounding(self, point: Point, row: np.ndarray) -> float:
        """What rounding of the equations does to the parameter of a point on the plane across `row`."""
        return self.tracer.rounding(point.guess, row)

    def of(self, solution: Solution) -> Place | None:
        """A guess that is this orbit."""
        return guess_of(self.tracer, solution, self.tau(solution.family.numbers[self.name]))

    def solution(self, guess: Place) -> Solution:
        """The orbit of a guess."""
        return self.tracer.solution(guess, self.tau(float(guess.p[0])))

    def tau(self, p: float) -> float:
        """The phase of the force, a continuous function of the parameter: times of impacts do not jump."""
        if not self._phase_moves:
            return self._taus[0][1]
        near = min(self._taus, key=lambda known: abs(known[0] - p))
        if near[0] == p:
            return near[1]
        tau = float(self.family.replace(**{self.name: p}).linear.tau)
        self._taus.append((p, tau + 2 * np.pi * round((near[1] - tau) / (2 * np.pi))))
        return self._taus[-1][1]

    @cached_property
    def _phase_moves(self) -> bool:
        return bool(self.family.derivative(self.name).tau)

    def ahead(self, point: Point) -> Solution:
        """The orbit to which the tangent leads, at the distance 1, with the parameter of the point."""
        guess = self.tracer.moved(point.guess, 1.0)
        guess.p[0] = point.p
        return self.solution(guess)

    def releases(self, place: Place) -> np.ndarray:
        """`Point.releases`."""
        w, sides = self.tracer, np.array(self.start.sides, float)
        R = self.family.replace(**{self.name: float(place.p[0])}).linear.restitution(sides)
        if np.all(R > 0):
            return np.full(len(sides), np.inf)
        w.assemble(place)
        N, events = w.n // 2, w.bench.events
        after = events["motion"][:, 1] + w.planes[0]["numbers"][OMEGA] * events["bend"][:, N]
        return np.where((R == 0) & ~w.problem.rests, -sides * after, np.inf)
