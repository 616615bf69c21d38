"""A point of a branch or a curve."""

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.analysis.continuation.rounding import rounding_error
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.workspace import TEST, Place

if TYPE_CHECKING:
    from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve


class Point(Place):
    """A `Place` with the solution set on which it lies: a point that was corrected and examined, or a guess of one."""

    curve: "SolutionCurve"

    def __new__(cls, curve: "SolutionCurve", place: Place) -> "Point":
        point = super().__new__(cls, *place)
        point.curve = curve
        return point

    @property
    def value(self) -> float:
        """The parameter of a branch; of a curve, the first."""
        return float(self.p[0])

    def hold(self, value: float) -> None:
        """The parameter is `value`, to the last bit: rounding may put it beyond what is allowed."""
        self.p[0] = value
        self.__dict__.pop("solution", None)

    def touch(self, index: int) -> None:
        """The impact `index` vanishes, to the last bit."""
        self.jumps[index] = 0.0
        self.__dict__.pop("solution", None)

    def backwards(self) -> "Point":
        """The same point in the other direction."""
        other = self.curve.copied(self)
        for values in (other.tangent, other.tangent_p, other.tests[TEST.rate : TEST.rate + 1]):
            values *= -1
        return other

    @property
    def rate(self) -> float:
        """The rate of the parameter along the tangent, in its unit."""
        return float(self.tangent_p[0])

    @cached_property
    def solution(self) -> Solution:
        return self.curve.solution(self)

    @property
    def rounding(self) -> float:
        """The error of the parameters by rounding of the equations, on the plane across the tangent."""
        return rounding_error(self.curve, self, self.direction)

    @property
    def stop_distance(self) -> float:
        """Least distance of the flights from the stops."""
        return float(self.tests[TEST.stop_distance] * self.curve.units.length)

    @cached_property
    def releases(self) -> np.ndarray:
        """(K,) acceleration away from the stop just after an impact with R = 0; infinite for other impacts."""
        return self.curve.releases(self)

    @property
    def presses(self) -> np.ndarray:
        """(K,) sizes of impulses, negative for one that pulls, and lengths of contacts: at a graze one of them is 0."""
        return np.where(self.solution.contacts, self.jumps, self.solution.pushes)

    @property
    def stays(self) -> float:
        """The least of what makes a rest: its length, the acceleration into the stop and the speed before it."""
        rests = self.curve.problem.rests & ~self.solution.contacts
        return float(min(self.jumps[rests].min(initial=np.inf), self.tests[TEST.hold]))

    @property
    def relaxed(self) -> float:
        """Above 0 where each stop that a contact left by force is at rest again at its next touch."""
        return float(self.tests[TEST.relaxed])


def along(a: Point, b: Point) -> float:
    """The distance of b ahead of a, along the tangent at a."""
    return float(a.curve.difference(a, b) @ a.direction)
