"""Where an event lies between two points of a branch."""

from collections.abc import Callable
from dataclasses import dataclass

from vibro_sweep.analysis.branches.free_walk import FreePoint, FreeWalk
from vibro_sweep.analysis.branches.walk import Point, Walk, along
from vibro_sweep.analysis.continuation.chord import error_of, root

Test = Callable[[Point | FreePoint], float]


@dataclass
class Event:
    """Something that a step from a to b passes: the type, and a test that changes its sign there.

    index : of the impact that it belongs to, if any
    touches : whether a flight touches a stop there
    """

    type: str
    test: Test
    index: int | None = None
    touches: bool = False


def locate(walk: Walk | FreeWalk, event: Event, a: Point, b: Point):
    """(event, distance from a, point, error): where the event lies between a and b; None if it cannot be found.

    The distance is that along the tangent at a.
    """
    size = max(abs(event.test(a)), abs(event.test(b)))
    if size == 0:
        return None

    def test(point: Point) -> float:
        return event.test(point) / size

    found = root(walk, a, b, test)
    error = found and error_of(walk, a, b, test, *found)
    return None if error is None else (event, along(a, found[1]), found[1], error)
