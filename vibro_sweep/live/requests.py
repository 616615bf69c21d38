"""What a page may ask for: names, types and sizes are checked here, before any other part of the program sees them.

A request holds no path and no code.
"""

import json
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

LONGEST = 16384  # bytes of a request
MOST_DOTS = 4 * 10**6  # section points of a diagram
MOST_PERIODS = 10**9  # of all orbits of a diagram
MOST_COLUMNS = 4000
MOST_TRANSIENT, MOST_RECORD = 10**6, 10**4  # forcing periods

Name = Annotated[str, Field(max_length=40)]


class RequestError(ValueError):
    """A text that is not a request."""


class _Checked(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


class Axis(_Checked):
    """The swept number, evenly."""

    start: float
    stop: float
    num: int = Field(ge=2, le=MOST_COLUMNS)


class Orbit(_Checked):
    """Forcing periods."""

    transient: int = Field(ge=0, le=MOST_TRANSIENT)
    record: int = Field(ge=1, le=MOST_RECORD)


class Picture(_Checked):
    """The units in which numbers are shown."""

    units: list[Name] = Field(max_length=10)


class SceneAsked(_Checked):
    """A scene of one number of an oscillator, or of its mapping, as in YAML. Only these keys are allowed: others name
    files, or take long."""

    system: dict[Name, Any] = Field(max_length=40)
    dynamics: Literal["flow", "map"] = "flow"
    order: Literal[1, 2] = 1
    expand_at: float | None = None
    sweep: dict[Name, Axis] = Field(min_length=1, max_length=1)
    start: dict[Name, str | int | float] = Field(default={}, max_length=40)
    orbit: Orbit
    picture: Picture | None = None

    @model_validator(mode="after")
    def _is_small(self) -> "SceneAsked":
        starts = self.start.get("random", 1)
        orbits = next(iter(self.sweep.values())).num * (starts if isinstance(starts, int) else 1)
        if orbits * self.orbit.record > MOST_DOTS:
            raise ValueError(f"at most {MOST_DOTS:.0e} section points: fewer columns, starts or recorded periods")
        if orbits * (self.orbit.record + self.orbit.transient) > MOST_PERIODS:
            raise ValueError(f"at most {MOST_PERIODS:.0e} periods: fewer columns, starts or periods")
        return self


class View(_Checked):
    """What a diagram shows.

    y : a coordinate, `gap`, `speed_right` or `speed_left`, at which the mass meets a stop, `contact_force_max` or
        `penetration_max`
    """

    scene: SceneAsked
    y: Name = "x1"

    @property
    def axis(self) -> str:
        """The swept number."""
        return next(iter(self.scene.sweep))

    @property
    def ends(self) -> tuple[float, float]:
        """From where to where it is swept."""
        axis = self.scene.sweep[self.axis]
        return axis.start, axis.stop


class _Request(_Checked):
    seq: int = Field(ge=0, lt=2**53)


class Sweep(_Request):
    """The diagram. `middle` is subtracted from what stands on the vertical axis, in double precision."""

    type: Literal["sweep"]
    view: View
    middle: float = 0.0


class OfOneOrbit(_Request):
    """`column` : of the last diagram, where that is complete: the orbit goes on from its end there; -1: none"""

    view: View
    value: float
    start: int = Field(default=0, ge=0, le=10**6)
    column: int = Field(default=-1, ge=-1, le=MOST_COLUMNS)


class ClickedOrbit(OfOneOrbit):
    """The orbit at a value of the swept number."""

    type: Literal["orbit"]


class WindowEnds(OfOneOrbit):
    """Why the window ends in which that orbit is."""

    type: Literal["window"]


class Open(_Request):
    """A scene to begin with, by its name, or the system of a view."""

    type: Literal["open"]
    name: Name | None = None
    view: View | None = None


class Save(_Request):
    """The view as a scene."""

    type: Literal["save"]
    view: View


Request = Sweep | ClickedOrbit | WindowEnds | Open | Save
_KINDS: dict[str, type[Request]] = {
    "sweep": Sweep, "orbit": ClickedOrbit, "window": WindowEnds, "open": Open, "save": Save,
}  # fmt: skip


def request_of(text: str) -> Request:
    """The request in a page's message. Raises RequestError."""
    if len(text) > LONGEST:
        raise RequestError(f"a request has at most {LONGEST} characters")
    try:
        data = json.loads(text, parse_constant=_no_constant)
        if not isinstance(data, dict):
            raise RequestError("a request is an object")
        kind = data.get("type")
        if not (isinstance(kind, str) and kind in _KINDS):
            raise RequestError(f"the type of a request is one of {', '.join(_KINDS)}")
        return _KINDS[kind].model_validate(data)
    except ValidationError as error:
        first = error.errors(include_url=False, include_context=False, include_input=False)[0]
        raise RequestError(f"{'.'.join(map(str, first['loc']))}: {first['msg']}") from None
    except (ValueError, RecursionError) as error:
        raise RequestError(f"not a request: {str(error)[:200]}") from None


def _no_constant(name: str) -> float:
    raise RequestError(f"{name} is not a number")
