"""What lies between two points of a branch or a curve."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from vibro_sweep.analysis.continuation.point import Point

Test = Callable[[Point], float]


@dataclass(frozen=True)
class Event:
    """Something that a step passes: its type, and a test that changes its sign there.

    index : of the test where it is one of the engine's (`TEST`) along a curve, else None
    impact : index of the impact that vanishes there, else None
    touches : whether a flight touches a stop there
    boundary : of the parameter, where it is that
    """

    type: str
    test: Test
    index: int | None = None
    impact: int | None = None
    touches: bool = False
    boundary: float | None = None


class LocatedEvent(NamedTuple):
    """An event, located."""

    event: Event
    share: float  # of the step
    place: Point
    error: float  # of the parameters
