"""The form of a scene: which keys there are, of which type, and what they mean; its JSON Schema.

Numbers and words come from `tables/` and the models; how the keys must fit each other is said by `combinations.py`.
"""

import functools
import operator
from collections.abc import Iterable
from typing import Annotated, Literal, get_args

from pydantic import ConfigDict, Discriminator, Field, InstanceOf, Strict, Tag, WithJsonSchema, create_model

from vibro_sweep.checks.arguments import MAX_COUNT
from vibro_sweep.checks.meant import SYNONYMS
from vibro_sweep.oscillator.function_model import FunctionModel
from vibro_sweep.oscillator.models import DEFAULT, MODELS
from vibro_sweep.oscillator.models.declaration import Model
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.tables.coordinates import coordinates
from vibro_sweep.tables.observables import WORDS
from vibro_sweep.tables.picture_kinds import PICTURES
from vibro_sweep.tables.quantity import Parameter

from .continue_form import continue_form
from .fields import Form, Whole, described_field, keys, swept
from .systems import PhysicalSystemForm, form_of

MADE = InstanceOf[Oscillator]
SHOWN = 8  # masses that the JSON Schema knows the coordinates of


class StepAxis(Form):
    """start, start + step, ... up to stop, which is included where a whole number of steps leads to it."""

    start: float = described_field("first value")
    stop: float = described_field("end of the values")
    step: float = described_field("positive upwards, negative downwards", **{"not": {"const": 0}})


class CountAxis(Form):
    """`num` equidistant values from start to stop, both included."""

    start: float = described_field("first value")
    stop: float = described_field("last value")
    num: Whole = described_field("how many, at least 2", minimum=2)


class ListAxis(Form):
    """The values themselves, rising or falling."""

    values: list[float] = described_field("at least one", minItems=1)


def _axis(value):
    known_keys = keys(value)
    by_number = "num" in known_keys or ("step" not in known_keys and known_keys & {*SYNONYMS["num"]})
    return "axis of values" if "values" in known_keys else "axis by number" if by_number else "axis by step"


Axis = Annotated[
    Annotated[StepAxis, Tag("axis by step")]
    | Annotated[CountAxis, Tag("axis by number")]
    | Annotated[ListAxis, Tag("axis of values")],
    Discriminator(_axis),
]


class _Axes(Form):
    model_config = ConfigDict(json_schema_extra={"minProperties": 1, "maxProperties": 2})


def _sweep_form(name: str, numbers: Iterable[Parameter], masses: int) -> type[Form]:
    return create_model(
        name,
        __base__=_Axes,
        __doc__="One key: a bifurcation diagram; two: a parameter plane, or a plane of initial states.",
        **{quantity.name: (Axis, swept(quantity.text, quantity.range.bounds)) for quantity in numbers},
        **{quantity.name: (Axis, swept(f"{quantity.text} at t = 0", {})) for quantity in coordinates(masses)},
    )


def _state_form(name: str, masses: int, base: type[Form] = Form, **more) -> type[Form]:
    return create_model(
        name,
        __base__=base,
        **more,
        **{quantity.name: (float, Field(default=0.0, description=quantity.text)) for quantity in coordinates(masses)},
    )


class RandomStart(Form):
    """Several random states at every point of the sweep, evenly in a box, of those with the gap between the stops.

    The box is |x_i - offset| < |b|, |v_i| < omega |b| where nothing is said of a coordinate.
    """

    random: Whole = Field(ge=1, le=100_000, description="number of starts")
    seed: Whole = Field(default=0, ge=0, le=2**63 - 1, description="the same seed gives the same starts")
    box: dict[str, list[float]] = Field(
        default={},
        description="the range of coordinates, as {x1: [-1, 1]}; of others |x_i - offset| < |b|, |v_i| < omega |b|",
    )


class FollowStart(Form):
    """Each point of the sweep starts where the last one ended; the first from a state, rest where nothing is said."""

    follow: Literal["up", "down", "both"] = Field(description="towards greater values, smaller values, or each in turn")


_REST = "One state at t = 0, with the gap between the stops; rest where nothing is said."


def _start(value):
    named = keys(value)
    return "random start" if named & {"random", "seed"} else "followed start" if "follow" in named else "one start"


class OrbitForm(Form):
    """The length of every orbit in forcing periods T = 2 pi/omega."""

    transient: Whole = Field(ge=0, le=MAX_COUNT, description="periods that are computed first and not recorded")
    settle: Whole | None = Field(
        default=None,
        ge=1,
        le=MAX_COUNT,
        description="orbits that are still under way after their transient go on, up to so many periods before the "
        "record; the file says how many each took",
    )
    record: Whole = Field(
        ge=1, le=MAX_COUNT, description="periods that are recorded; at a section of impacts at most so many of them"
    )


class SectionForm(Form):
    """The section, on which an orbit becomes points."""

    kind: Literal["phase", "impact"] = Field(
        description="phase: the state at t = 0 mod T; impact: the state just before each impact on one stop"
    )
    stop: Literal["right", "left"] = Field(default="right", description="with `kind: impact`: the stop")


TrajectoryForm = create_model(
    "TrajectoryForm",
    __base__=Form,
    __doc__="The continuous orbit, for phase portraits and time histories.",
    periods=(Whole, Field(ge=1, le=MAX_COUNT, description="its length in forcing periods")),
    samples=(Whole, Field(ge=2, le=MAX_COUNT, description="number of equidistant times")),
    **{
        "from": (
            Literal["end", "start"],
            Field(
                default="end", description="end: after the last section point; start: from t = 0, where orbits begin"
            ),
        )
    },
)


class UnitsForm(Form):
    """The units in which numbers are shown."""

    units: list[str] = Field(
        default=None,
        description="units in which pictures, tables and the page show numbers, whatever the system's are: [mm, Hz]",
    )


class PictureForm(UnitsForm):
    """The picture that is drawn by default, and the units in which numbers are shown."""

    kind: Literal[tuple(PICTURES)] = Field(default=None, description="kind of picture, if the file has what it needs")


Picture = Annotated[
    Annotated[Literal[tuple(PICTURES)], Tag("picture as a word")] | Annotated[PictureForm, Tag("picture and units")],
    Discriminator(lambda value: "picture and units" if isinstance(value, dict) else "picture as a word"),
]


# Each word with its text, which editors show.
_WORDS = {"anyOf": [{"const": word, "description": text} for word, text in WORDS.items()]}
Observation = Annotated[Literal[tuple(WORDS)], WithJsonSchema(_WORDS)]


@functools.cache
def scene_form(name: str, masses: int, made: bool = False) -> type[Form]:
    """The form of scenes of a model, with so many masses. made : its `system` is an Oscillator"""
    model = MODELS[name]
    return _scene_form(MADE if made else _systems([model]), model.flat(masses).values(), masses)


def form_of_function(system: FunctionModel) -> type[Form]:
    """The form of a sweep whose oscillators a function makes."""
    return _scene_form(MADE, system.described.values(), system.masses)


def _scene_form(system, numbers: Iterable[Parameter], masses: int) -> type[Form]:
    state = _state_form("StateStart", masses, __doc__=_REST)
    follow = _state_form("FollowStart", masses, FollowStart, __doc__=FollowStart.__doc__)
    start = Annotated[
        Annotated[state, Tag("one start")]
        | Annotated[RandomStart, Tag("random start")]
        | Annotated[follow, Tag("followed start")],
        Discriminator(_start),
    ]
    return create_model(
        "SceneForm",
        __base__=Form,
        __doc__="A scene of vibro-sweep: what to compute.",
        system=(system, Field(description="the oscillator; or the name of another scene's file, which has it")),
        dynamics=(
            Literal["flow", "map"],
            Field(
                default="flow",
                description="flow: the impact oscillator itself; map: its discontinuity mapping (eq. 41)",
            ),
        ),
        order=(
            Whole,
            Field(default=1, ge=1, le=2, description="with `dynamics: map`: 1 is the paper's, 2 has the next term"),
        ),
        expand_at=(
            float,
            Field(
                default=None,
                json_schema_extra={"exclusiveMinimum": 0},
                description="with `dynamics: map`: the clearance at which it is expanded, by default the exact b*",
            ),
        ),
        sweep=(
            _sweep_form("SweepForm", numbers, masses),
            Field(default=None, description="the parameters that vary; left out: one orbit"),
        ),
        start=(start, Field(default=state(), description="where orbits begin")),
        orbit=(OrbitForm, Field(description="how long an orbit is")),
        section=(SectionForm, Field(default=SectionForm(kind="phase"), description="where an orbit becomes points")),
        observe=(
            Annotated[frozenset[Observation], Strict(False)],
            Field(default=frozenset({"section"}), description="what is computed and stored; nothing else is"),
        ),
        trajectory=(TrajectoryForm, Field(default=None, description="store the continuous orbit as well")),
        picture=(
            Picture,
            Field(default=None, description="kind of picture that is drawn by default, if the file has what it needs"),
        ),
    )


def _systems(models: Iterable[Model]):
    """A `system` of one of these models; of the default also in physical units."""
    forms = [Annotated[form_of(model.name), Tag(f"the model {model.name}")] for model in models]
    if DEFAULT in (model.name for model in models):
        forms.append(Annotated[PhysicalSystemForm, Tag("physical units")])
    if len(forms) == 1:
        return get_args(forms[0])[0]
    return Annotated[functools.reduce(operator.or_, forms), Discriminator(_system)]


@functools.cache
def continuation_form(name: str, masses: int) -> type[Form]:
    """The form of scenes of branches of a model, with so many masses."""
    model = MODELS[name]
    body = continue_form(model.flat(masses).values(), masses)
    return create_model(
        "ContinuationForm",
        __base__=Form,
        __doc__="A scene of branches: what to follow.",
        system=(_systems([model]), Field(description="the oscillator")),
        picture=(UnitsForm, Field(default=None, description="units in which pictures and tables show numbers")),
        **{"continue": (body, Field(description="branches of periodic orbits"))},
    )


def _system(value) -> str:
    if "physical" in keys(value):
        return "physical units"
    return f"the model {value.get('type', DEFAULT) if isinstance(value, dict) else DEFAULT}"


def tagged(form: type[Form]) -> dict[str, type[Form]]:
    """The forms that a key of a scene may have, by the words that distinguish them in errors."""
    forms_of_axes = {"axis by step": StepAxis, "axis by number": CountAxis, "axis of values": ListAxis}
    for key in ("system", "start", "picture"):
        for member in get_args(form.model_fields[key].annotation) if key in form.model_fields else ():
            kind, tag = get_args(member)
            if isinstance(kind, type) and issubclass(kind, Form):
                forms_of_axes[tag.tag] = kind
    return forms_of_axes


def json_schema(names: Iterable[str] = tuple(MODELS)) -> dict:
    """JSON Schema, draft 7, of a scene of these models: what yaml-language-server reads."""
    models = [MODELS[name] for name in names]
    masses = SHOWN if len(models) > 1 else 2
    numbers = {key: quantity for model in reversed(models) for key, quantity in model.flat(masses).items()}
    schema = _draft_7(_scene_form(_systems(models), numbers.values(), masses).model_json_schema())
    _add_branches(schema, numbers.values(), masses)
    return {"$schema": "http://json-schema.org/draft-07/schema#"} | schema


def _add_branches(schema: dict, numbers: Iterable[Parameter], masses: int) -> None:
    """The key `continue`, with which a scene has no orbit and nothing that belongs to one."""
    body = _draft_7(continue_form(numbers, masses).model_json_schema())
    schema["definitions"] |= body.pop("definitions")
    origin = body["properties"]["from"]
    named = {"description": origin.pop("description")} if "description" in origin else {}
    reference = origin["allOf"][0] if "allOf" in origin else origin
    body["properties"]["from"] = {"anyOf": [{"const": "free"}, reference]} | named
    schema["definitions"]["ContinueForm"] = body
    text = "branches of periodic orbits, in place of a sweep and its orbits"
    schema["properties"]["continue"] = {
        "allOf": [{"$ref": "#/definitions/ContinueForm"}],
        "description": text,
    }
    schema["required"].remove("orbit")
    of_orbits = [key for key in schema["properties"] if key not in ("system", "continue")]
    schema["anyOf"] = [
        {"required": ["orbit"], "not": {"required": ["continue"]}},
        {"required": ["continue"], "not": {"anyOf": [{"required": [key]} for key in of_orbits]}},
    ]


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
