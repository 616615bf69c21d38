"""Points of a branch without impacts, and steps between them (as walk.py, of the others): the parameter is all there
is, in units of its range."""

from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vibro_sweep.analysis.branches.walk import Walk
from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.model.linear import Linear

ROUNDED = 16 * np.finfo(float).eps  # of the parameter


@dataclass(eq=False)
class FreePoint:
    """A point of a branch."""

    walk: "FreeWalk"
    x: np.ndarray  # (1,)
    tangent: np.ndarray  # (1,): 1 or -1
    held: float | None = None  # the parameter, where it is given

    releases, stays = np.empty(0), np.inf  # nothing rests
    residual, corrections = 0.0, 1

    @property
    def guess(self) -> np.ndarray:
        return self.x

    @property
    def p(self) -> float:
        return float(self.x[0] * self.walk.unit) if self.held is None else self.held

    def hold(self, value: float) -> None:
        """The parameter is `value`, to the last bit: rounding may put it beyond what is allowed."""
        self.held = value
        self.__dict__.pop("solution", None)

    def backwards(self) -> "FreePoint":
        """The same point of the branch in the other direction."""
        other = copy(self)
        other.tangent = -self.tangent
        return other

    @cached_property
    def solution(self) -> Solution:
        return self.walk.at(self.p)

    @property
    def rate(self) -> float:
        """Of the parameter, in its unit."""
        return float(self.tangent[0])

    @property
    def margin(self) -> float:
        """Least distance from the stops."""
        return self.solution.margin


class FreeWalk:
    """A branch through `start` in the parameter `name`."""

    def __init__(self, start: Solution, name: str, span: float):
        self.start, self.name, self.family, self.unit = start, name, start.family, span

    def oscillators(self, values: np.ndarray) -> list[Linear]:
        """At values of the parameter that points of the branch have."""
        return [self.family.replace(**{self.name: p}).linear for p in values.tolist()]

    def at(self, p: float) -> Solution:
        return replace(self.start, family=self.family.replace(**{self.name: p}))

    def correct(self, guess: np.ndarray, forwards: np.ndarray) -> FreePoint | None:
        """The point of the branch at `guess`; None where there is no such motion."""
        point = FreePoint(self, guess, np.sign(forwards))
        try:
            EventEquations.of(point.solution)
        except (np.linalg.LinAlgError, ValueError):  # a resonance, or a parameter beyond its range
            return None
        return point

    def first(self, forwards: float) -> FreePoint | None:
        """`start` itself; `forwards`: sign of the parameter's change."""
        point = self.correct(self.of(self.start), np.array([forwards]))
        if point is not None:
            point.hold(self.family.numbers[self.name])
        return point

    def step(self, point: FreePoint, length: float, _=None) -> FreePoint | None:
        """The point of the branch at a distance along the tangent at `point`."""
        return self.correct(point.x + length * point.tangent, point.tangent)

    def beside_start(self, length: float) -> FreePoint | None:
        """The point of the branch at a distance from the start."""
        return self.correct(self.of(self.start) + length, np.ones(1))

    @property
    def K(self) -> int:
        return 0

    def difference(self, a: FreePoint, b: FreePoint) -> np.ndarray:
        """(1,) from a to b."""
        return b.x - a.x

    def on_chord(self, near: FreePoint, a: FreePoint, b: FreePoint, share: float, *_) -> FreePoint | None:
        """The point at this share of the way from a to b beside a known one."""
        return self.correct(near.x + share * (b.x - a.x), b.x - a.x)

    def at_value(self, a: FreePoint, b: FreePoint, value: float) -> FreePoint | None:
        """The point where the parameter has this value, which lies between those of a and b."""
        return self.correct(np.array([value / self.unit]), b.x - a.x)

    def parameters(self, point: FreePoint) -> np.ndarray:
        """(1,)."""
        return np.array([point.p])

    def rounding(self, point: FreePoint, _) -> float:
        """What rounding does to the parameter of a point."""
        return float(ROUNDED * abs(point.p))

    def of(self, solution: Solution) -> np.ndarray:
        """A guess that is this motion."""
        return np.array([solution.family.numbers[self.name] / self.unit])


def walk_of(start: Solution, name: str, span: float) -> Walk | FreeWalk:
    """The branch through an orbit: `Walk`, or without impacts `FreeWalk`."""
    return (Walk if start.K else FreeWalk)(start, name, span)
