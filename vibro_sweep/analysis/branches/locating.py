"""Where an event lies between two points of a branch."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vibro_sweep.analysis.continuation.chord import error_of, root
from vibro_sweep.analysis.continuation.errors import rounding_error
from vibro_sweep.analysis.continuation.point import Point, along
from vibro_sweep.analysis.continuation.tracer import Tracer

ROUNDED = 1e-9  # of a step, by which rounding may put an event behind its end
Test = Callable[[Point], float]


@dataclass
class Event:
    """Something that a step from a to b passes: the type, and a test that changes its sign there.

    vanishes : index of the impact that vanishes there, if one does
    limit : of the parameter, where it is that
    touches : whether a flight touches a stop there
    """

    type: str
    test: Test
    vanishes: int | None = None
    limit: float | None = None
    touches: bool = False


def locate(walk: Tracer, event: Event, a: Point, b: Point):
    """(event, distance from a, point, error): where the event lies between a and b; None if it cannot be found.

    The distance is that along the tangent at a.
    """
    point = None if event.limit is None else walk.at_value(a, b, 0, event.limit)
    if point is not None and 0 <= along(a, point) <= (1 + ROUNDED) * along(a, b):
        point.hold(event.limit)
        return event, along(a, point), point, 0.0
    size = max(abs(event.test(a)), abs(event.test(b)))
    if size == 0:
        return None

    def test(point: Point) -> float:
        return event.test(point) / size

    found = root(walk, a, b, test)
    if found is None:
        return None
    share, point = found
    if event.limit is not None:
        point.hold(event.limit)
    if event.vanishes is not None:  # one of the unknowns has a value: no test rounds
        point.touch(event.vanishes)
        error = rounding_error(walk, point, np.eye(1, 2 * walk.K + 3, walk.K + event.vanishes)[0])
    else:
        error = error_of(walk, a, b, test, share, point)
    return None if error is None else (event, along(a, point), point, error)
