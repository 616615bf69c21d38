"""The form of a scene: which keys there are, of which type, and what they mean; its JSON Schema.

Numbers and words come from the tables of `model/`; how the keys must fit each other is said by `combinations.py`.
"""

from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Strict,
    Tag,
    WithJsonSchema,
    create_model,
)

from vibro_sweep.model.arguments import MAX_COUNT
from vibro_sweep.model.observables import WORDS
from vibro_sweep.model.parameters import BY_NAME, PARAMETERS, PHYSICAL, STOPS, Parameter
from vibro_sweep.model.pictures import PICTURES
from vibro_sweep.model.state import COORDINATES

from .slips import SYNONYMS


class Form(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


# 1e4 is a whole number for JSON Schema, and so for a person
Whole = Annotated[
    int,
    BeforeValidator(lambda value: int(value) if isinstance(value, float) and value.is_integer() else value),
]
Tau = Annotated[
    Annotated[float, Tag("tau as a number")] | Annotated[Literal["grazing"], Tag("tau as a word")],
    Discriminator(lambda value: "tau as a word" if isinstance(value, str) else "tau as a number"),
]
_TAU = (Tau, Field(default=BY_NAME["tau"].default, description=BY_NAME["tau"].described))
_STOPS = (Literal[STOPS], Field(default="both", description="which stops there are"))


def _number(parameter: Parameter) -> tuple[type, Any]:
    """The key of a parameter, which may be left out where it is swept."""
    field = Field(default=parameter.default, description=parameter.text, json_schema_extra=parameter.range.bounds)
    return float, field


def _given(description: str, **bounds) -> Any:
    return Field(description=description, json_schema_extra=bounds)


def _swept(description: str, bounds: dict[str, float]) -> Any:
    """Bounds of what is written of an axis; a stop need not be reached, and may lie outside."""
    properties = {"start": bounds, "values": {"items": bounds}}
    return Field(default=None, description=description, json_schema_extra={"properties": properties} if bounds else {})


SystemForm = create_model(
    "SystemForm",
    __base__=Form,
    __doc__="The impact oscillator in nondimensional numbers; a number that is swept may be left out.",
    **{one.name: _number(one) for one in PARAMETERS} | {"tau": _TAU, "stops": _STOPS},
)

PhysicalNumbers = create_model(
    "PhysicalNumbers",
    __base__=Form,
    __doc__="Physical quantities in any consistent units, as kg, m, s and N; C1/K1 = C2/K2 (proportional damping). "
    "All must be given; a sweep over `omega`, `b` or `R` replaces the value that follows from `Omega`, `B` or `R`.",
    **{one.name: (float, _given(one.text, **one.range.bounds)) for one in PHYSICAL},
)

PhysicalSystemForm = create_model(
    "PhysicalSystemForm",
    __base__=Form,
    __doc__="The impact oscillator in physical units, converted to nondimensional numbers.",
    physical=(PhysicalNumbers, Field(description="the quantities")),
    tau=_TAU,
    stops=_STOPS,
)


class StepAxis(Form):
    """start, start + step, ... up to stop, which is included where a whole number of steps leads to it."""

    start: float = _given("first value")
    stop: float = _given("end of the values")
    step: float = _given("positive upwards, negative downwards", **{"not": {"const": 0}})


class CountAxis(Form):
    """`num` equidistant values from start to stop, both included."""

    start: float = _given("first value")
    stop: float = _given("last value")
    num: Whole = _given("how many, at least 2", minimum=2)


class ListAxis(Form):
    """The values themselves, rising or falling."""

    values: list[float] = _given("at least one", minItems=1)


def _keys(value):
    return value.keys() if isinstance(value, dict) else set()


def _axis(value):
    keys = _keys(value)
    by_number = "num" in keys or ("step" not in keys and keys & {*SYNONYMS["num"]})
    return "axis of values" if "values" in keys else "axis by number" if by_number else "axis by step"


Axis = Annotated[
    Annotated[StepAxis, Tag("axis by step")]
    | Annotated[CountAxis, Tag("axis by number")]
    | Annotated[ListAxis, Tag("axis of values")],
    Discriminator(_axis),
]


class _Axes(Form):
    model_config = ConfigDict(json_schema_extra={"minProperties": 1, "maxProperties": 2})


SweepForm = create_model(
    "SweepForm",
    __base__=_Axes,
    __doc__="One key: a bifurcation diagram; two: a parameter plane, or a plane of initial states.",
    **{one.name: (Axis, _swept(one.text, one.range.bounds)) for one in PARAMETERS},
    **{one.name: (Axis, _swept(f"{one.text} at t = 0", {})) for one in COORDINATES},
)

StateStart = create_model(
    "StateStart",
    __base__=Form,
    __doc__="One state at t = 0, with mass 1 between the stops; rest where nothing is said.",
    **{one.name: (float, Field(default=0.0, description=one.text)) for one in COORDINATES},
)


class RandomStart(Form):
    """Several random states at every point of the sweep."""

    random: Whole = Field(ge=1, le=100_000, description="number of starts")
    seed: Whole = Field(default=0, ge=0, le=2**63 - 1, description="the same seed gives the same starts")


class FollowStart(StateStart):
    """Each point of the sweep starts where the last one ended; the first from a state, rest where nothing is said."""

    follow: Literal["up", "down", "both"] = Field(description="towards greater values, smaller values, or each in turn")


def _start(value):
    keys = _keys(value)
    return "random start" if keys & {"random", "seed"} else "followed start" if "follow" in keys else "one start"


class OrbitForm(Form):
    """How long every orbit is, in forcing periods T = 2 pi/omega."""

    transient: Whole = Field(ge=0, le=MAX_COUNT, description="periods that are computed first and not recorded")
    record: Whole = Field(ge=1, le=MAX_COUNT, description="periods that are recorded")


class SectionForm(Form):
    """Where an orbit becomes points."""

    kind: Literal["phase", "impact"] = Field(
        description="phase: the state at t = 0 mod T; impact: the state just before each impact on one stop"
    )
    stop: Literal["right", "left"] = Field(default="right", description="with `kind: impact`: the stop")


class TrajectoryForm(Form):
    """The continuous orbit after the last section point, for phase portraits and time histories."""

    periods: Whole = Field(ge=1, le=MAX_COUNT, description="its length in forcing periods")
    samples: Whole = Field(ge=2, le=MAX_COUNT, description="number of equidistant times")


# Each word with its text, which editors show.
_WORDS = {"anyOf": [{"const": word, "description": one.text} for word, one in WORDS.items()]}
Observation = Annotated[Literal[tuple(WORDS)], WithJsonSchema(_WORDS)]


class SceneForm(Form):
    """A scene of vibro-sweep: what to compute."""

    system: Annotated[
        Annotated[SystemForm, Tag("numbers")] | Annotated[PhysicalSystemForm, Tag("physical units")],
        Discriminator(lambda value: "physical units" if "physical" in _keys(value) else "numbers"),
    ] = Field(description="the oscillator")
    model: Literal["flow", "map"] = Field(
        default="flow",
        description="flow: the impact oscillator itself; map: its discontinuity mapping (eq. 41)",
    )
    order: Whole = Field(default=1, ge=1, le=2, description="with `model: map`: 1 is the paper's, 2 has the next term")
    expand_at: float = Field(
        default=None,
        json_schema_extra={"exclusiveMinimum": 0},
        description="with `model: map`: the clearance at which it is expanded, by default the exact b*",
    )
    sweep: SweepForm = Field(default=None, description="the parameters that vary; left out: one orbit")
    start: Annotated[
        Annotated[StateStart, Tag("one start")]
        | Annotated[RandomStart, Tag("random start")]
        | Annotated[FollowStart, Tag("followed start")],
        Discriminator(_start),
    ] = Field(default=StateStart(), description="where orbits begin")
    orbit: OrbitForm = Field(description="how long an orbit is")
    section: SectionForm = Field(default=SectionForm(kind="phase"), description="where an orbit becomes points")
    observe: Annotated[frozenset[Observation], Strict(False)] = Field(
        default=frozenset({"section"}), description="what is computed and stored; nothing else is"
    )
    trajectory: TrajectoryForm = Field(default=None, description="store the continuous orbit as well")
    picture: Literal[PICTURES] = Field(
        default=None, description="kind of picture that is drawn by default, if the file has what it needs"
    )


def json_schema() -> dict:
    """JSON Schema, draft 7, of a scene: what yaml-language-server reads."""
    schema = _draft_7(SceneForm.model_json_schema())
    return {"$schema": "http://json-schema.org/draft-07/schema#"} | schema


def _draft_7(node):
    if isinstance(node, list):
        return [_draft_7(item) for item in node]
    if not isinstance(node, dict):
        return node
    # `title` repeats the key; a null default only says that the key may be left out
    node = {
        key: _draft_7(value)
        for key, value in node.items()
        if not (key == "title" and isinstance(value, str)) and not (key == "default" and value is None)
    }
    if "$defs" in node:
        node["definitions"] = node.pop("$defs")
    if "$ref" in node:
        reference = {"$ref": node.pop("$ref").replace("#/$defs/", "#/definitions/")}
        return {"allOf": [reference]} | node if node else reference  # draft 7 ignores what stands beside a $ref
    return node
