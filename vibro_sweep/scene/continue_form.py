"""The form of a scene with `continue`: which branches or curves are followed, from where, along which numbers."""

from collections.abc import Iterable
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, FailFast, Field, Strict, create_model

from vibro_sweep.tables.bifurcations import CURVES, WAYS
from vibro_sweep.tables.coordinates import coordinates
from vibro_sweep.tables.observables import ALONG_BRANCHES
from vibro_sweep.tables.quantity import Parameter

from .fields import Form, Whole

ORIGINS = ("state", "itinerary", "sweep", "grazing", "free", "branches")  # keys of `from`, one of which is given
PAIR: Any = {"json_schema_extra": {"minItems": 2, "maxItems": 2}}
Numbers = Annotated[list[float], FailFast()]  # of a long list the first that is no number is enough


def _free(value):
    return {"free": True} if value == "free" else value


Words = Annotated[tuple[Literal[WAYS], ...], Strict(False)]
Observed = Annotated[tuple[Literal[ALONG_BRANCHES], ...], Strict(False)]
CurveWords = Annotated[tuple[Literal[CURVES], ...], Strict(False)]


def continue_form(numbers: Iterable[Parameter], masses: int) -> type[Form]:
    """The form of `continue` for oscillators with these numbers and so many masses."""
    state = create_model(
        "OrbitState",
        __base__=Form,
        __doc__="A state at t = 0 near the orbit.",
        **{quantity.name: (float, Field(default=0.0, description=quantity.text)) for quantity in coordinates(masses)},
    )
    origin = create_model(
        "FromForm",
        __base__=Form,
        __doc__="Where branches begin; `free` alone is the motion without impacts.",
        state=(state, Field(default=None, description="a periodic orbit near this state at t = 0")),
        itinerary=(str, Field(default=None, description="a periodic orbit with these impacts, such as LR")),
        periods=(Whole, Field(default=1, ge=1, description="of `state` or `itinerary`: period in forcing periods")),
        sweep=(str, Field(default=None, description="the windows of the file of a sweep")),
        largest=(Whole, Field(default=None, ge=1, description="of `sweep`: so many of its largest windows only")),
        grazing=(Whole, Field(default=None, ge=1, description="orbits born at grazing, up to this period")),
        free=(bool, Field(default=None, description="the motion without impacts")),
        branches=(str, Field(default=None, description="a special point of a file of branches, curves or windows")),
        special=(Whole, Field(default=None, ge=0, description="of `branches`: the point's number in `info`")),
    )
    parameter = create_model(
        "ParameterForm",
        __base__=Form,
        __doc__="The number that changes along branches, and its bounds; of two, curves, and branches in the first.",
        **{quantity.name: (Numbers, Field(default=None, description=quantity.text, **PAIR)) for quantity in numbers},
    )
    return create_model(
        "ContinueForm",
        __base__=Form,
        __doc__="Branches of periodic orbits, or curves on which they bifurcate, in place of a sweep.",
        **{
            "from": (Annotated[origin, BeforeValidator(_free)], Field(description="the orbits to begin with")),
            "parameter": (parameter, Field(description="the number that changes; two: bifurcation curves")),
            "of": (CurveWords, Field(default=CURVES, description="of two numbers: the bifurcations that are followed")),
            "follow": (Words, Field(default=WAYS, description="special points from which other branches are followed")),
            "depth": (Whole, Field(default=1, ge=0, le=100, description="how many special points away from the first")),
            "observe": (
                Observed,
                Field(
                    default=(),
                    description="of branches with compliant stops: largest force and penetration of their contacts",
                ),
            ),
        },
    )
