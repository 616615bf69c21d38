"""The forms of `system`: one for each model, in its own numbers; and the paper's oscillator in physical units."""

import functools
from typing import Any, Literal

from pydantic import ConfigDict, Field, create_model
from pydantic.config import JsonDict

from vibro_sweep.oscillator.models import DEFAULT, MODELS
from vibro_sweep.oscillator.models.declaration import OF_STOPS, WHICH_STOPS, Option
from vibro_sweep.oscillator.other_words import OTHER_WORDS
from vibro_sweep.oscillator.physical import OMEGA, PHYSICAL
from vibro_sweep.tables.parameters import CYCLES, PHASE
from vibro_sweep.tables.quantity import POSITIVE, Parameter

from .fields import TAU, WHICH, Form, Whole, described_field, number


def _required(quantity: Parameter) -> tuple[Any, Any]:
    return float, described_field(quantity.text, **quantity.range.bounds)


_UNITS: JsonDict = {
    "anyOf": [
        {"const": "SI"},
        {"type": "array", "items": {"type": "number", "exclusiveMinimum": 0}, "minItems": 3, "maxItems": 3},
        {
            "type": "object",
            "properties": {name: {"type": "string"} for name in ("mass", "length", "time", "force")},
            "additionalProperties": False,
            "minProperties": 3,
            "maxProperties": 3,
        },
    ]
}


def _option(quantity: Option) -> tuple[Any, Any]:
    if quantity.kind == "units":
        return Any, Field(default=None, description=quantity.text, json_schema_extra=_UNITS)
    kind = {
        "word": Literal[quantity.words] if quantity.words else str,
        "choice": Literal[quantity.words] if quantity.words else bool,
        "pair": list[Whole],
        "whole": Whole,
        "matrix": list[list[float]],
        "vector": list[float],
    }[quantity.kind]
    required = quantity.default is None and not quantity.optional
    return kind, Field(default=... if required else quantity.default, description=quantity.text)


PhysicalNumbers = create_model(
    "PhysicalNumbers",
    __base__=Form,
    __doc__="Physical quantities in SI units: kg, m, s and N. "
    "All but B0 and the numbers of the stops must be given, and of these R or k_stop; a sweep over `omega`, `b`, "
    "`offset` or `R` replaces the value that follows from `Omega`, `B`, `B0` or `R`.",
    **{
        quantity.name: number(quantity) if quantity.optional or quantity.default is not None else _required(quantity)
        for quantity in PHYSICAL
    }
    | {quantity.name: number(quantity) for quantity in (OMEGA, CYCLES)},
)

PhysicalSystemForm = create_model(
    "PhysicalSystemForm",
    __base__=Form,
    __doc__="The impact oscillator in physical units, converted to nondimensional numbers.",
    physical=(PhysicalNumbers, Field(description="the quantities")),
    tau=TAU,
    stops=WHICH,
    **{quantity.name: _option(quantity) for quantity in OF_STOPS},
)


# Two stops have a middle, from which both are as far away; one alone may stand anywhere.
_ALONE = {
    "if": {"properties": {"stops": {"enum": ["right", "left"]}}, "required": ["stops"]},
    "else": {"properties": {"b": POSITIVE.bounds}},
}


class _Stopped(Form):
    model_config = ConfigDict(json_schema_extra=_ALONE)


@functools.cache
def form_of(name: str) -> type[Form]:
    """The form of a model; a number that is swept may be left out."""
    model, default = MODELS[name], name == DEFAULT
    kind = (Literal[(model.name,)], Field(default=DEFAULT if default else ..., description="the model"))
    title = "".join(word.capitalize() for word in model.name.split("_")) + "Form"
    return create_model(
        "SystemForm" if default else title,
        __base__=_Stopped if WHICH_STOPS in model.options else Form,
        __doc__="The impact oscillator in nondimensional numbers; a number that is swept may be left out."
        if default
        else f"The model {model.name}: {model.title}. A number that is swept may be left out.",
        **{quantity.name: _number(quantity) for quantity in model.numbers},
        **{word.name: number(word) for word in OTHER_WORDS},
        **{quantity.name: _option(quantity) for quantity in model.options},
        type=kind,
    )


def _number(quantity: Parameter) -> tuple[Any, Any]:
    if quantity.name == PHASE.name:
        return TAU
    if not quantity.each:
        return number(quantity)
    of_each = {"items": {"type": "number"} | quantity.range.bounds} if quantity.range.bounds else {}
    text = f"{quantity.text}; a list, one for each {quantity.each}" + ("; left out: 0" if quantity.default == 0 else "")
    return list[float], Field(default=None, description=text, json_schema_extra=of_each)
