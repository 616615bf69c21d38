"""The form of a scene: which keys there are, of which type, and what they mean; its JSON Schema.

What a number may be is said by `system.py`; how the keys must fit each other, by `scene.py`.
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
)

MAX_COUNT = 10**12  # periods; far beyond what anybody waits for, and still a machine integer


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
_TAU = Field(
    default="grazing",
    description="phase of the force at t = 0 in radians, or `grazing`: the phase at which the non-impacting "
    "steady motion is at its right extreme (eq. 18)",
)
_STOPS = Field(default="both", description="which stops there are")


def _number(description: str, **bounds) -> Any:
    return Field(default=None, description=description, json_schema_extra=bounds)


class SystemForm(Form):
    """The impact oscillator in nondimensional numbers; a number that is swept may be left out."""

    mu_m: float = _number("mass ratio M2/M1", exclusiveMinimum=0)
    mu_k: float = _number("stiffness ratio K2/K1", exclusiveMinimum=0)
    zeta: float = _number("damping ratio C1/(2 sqrt(K1 M1)); damping is proportional", minimum=0)
    f2: float = _number("share of the force on the second mass, P2/(P1 + P2)", minimum=0, maximum=1)
    omega: float = _number("forcing frequency Omega sqrt(M1/K1)", exclusiveMinimum=0)
    R: float = _number("coefficient of restitution", minimum=0, maximum=1)
    b: float = _number("clearance on each side, B K1/(P1 + P2)", exclusiveMinimum=0)
    tau: Tau = _TAU
    stops: Literal["both", "right", "left"] = _STOPS


class PhysicalNumbers(Form):
    """Physical quantities in any consistent units; C1/K1 = C2/K2 (proportional damping)."""

    M1: float = Field(description="mass between the stops")
    M2: float = Field(description="second mass")
    K1: float = Field(description="stiffness between the masses")
    K2: float = Field(description="stiffness between the second mass and the ground")
    C1: float = Field(description="damping between the masses")
    C2: float = Field(description="damping between the second mass and the ground")
    P1: float = Field(description="amplitude of the force on the first mass")
    P2: float = Field(description="amplitude of the force on the second mass")
    Omega: float = Field(description="angular frequency of the force")
    R: float = Field(description="coefficient of restitution, 0 to 1")
    B: float = Field(description="clearance on each side")


class PhysicalSystemForm(Form):
    """The impact oscillator in physical units, converted to nondimensional numbers."""

    physical: PhysicalNumbers
    tau: Tau = _TAU
    stops: Literal["both", "right", "left"] = _STOPS


class StepAxis(Form):
    """start, start + step, ... up to stop, which is included where a whole number of steps leads to it."""

    start: float
    stop: float
    step: float = Field(description="positive upwards, negative downwards")


class CountAxis(Form):
    """`num` equidistant values from start to stop, both included."""

    start: float
    stop: float
    num: Whole


class ListAxis(Form):
    """The values themselves, rising or falling."""

    values: list[float]


def _keys(value):
    return value.keys() if isinstance(value, dict) else set()


def _axis(value):
    keys = _keys(value)
    return "axis of values" if "values" in keys else "axis by number" if "num" in keys else "axis by step"


Axis = Annotated[
    Annotated[StepAxis, Tag("axis by step")]
    | Annotated[CountAxis, Tag("axis by number")]
    | Annotated[ListAxis, Tag("axis of values")],
    Discriminator(_axis),
]


class SweepForm(Form):
    """One key: a bifurcation diagram; two: a parameter plane, or a plane of initial states."""

    model_config = ConfigDict(json_schema_extra={"minProperties": 1, "maxProperties": 2})

    mu_m: Axis = _number("mass ratio")
    mu_k: Axis = _number("stiffness ratio")
    zeta: Axis = _number("damping ratio")
    f2: Axis = _number("share of the force on the second mass")
    omega: Axis = _number("forcing frequency")
    R: Axis = _number("coefficient of restitution")
    b: Axis = _number("clearance")
    tau: Axis = _number("phase of the force at t = 0 in radians")
    x1: Axis = _number("displacement of the first mass at t = 0, between the stops")
    v1: Axis = _number("its velocity")
    x2: Axis = _number("displacement of the second mass at t = 0")
    v2: Axis = _number("its velocity")


class StateStart(Form):
    """One state at t = 0; rest where nothing is said."""

    x1: float = Field(default=0.0, description="displacement of the first mass, between the stops")
    v1: float = Field(default=0.0, description="its velocity")
    x2: float = Field(default=0.0, description="displacement of the second mass")
    v2: float = Field(default=0.0, description="its velocity")


class RandomStart(Form):
    """Several random states at every point of the sweep."""

    random: Whole = Field(ge=1, le=100_000, description="number of starts")
    seed: Whole = Field(default=0, ge=0, le=2**63 - 1, description="the same seed gives the same starts")


class FollowStart(Form):
    """Each point of the sweep starts where the last one ended; the first from rest."""

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


Observation = Literal["section", "lyapunov", "impacts", "attractors", "convergence"]


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
