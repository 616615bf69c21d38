"""What the forms of a scene are made of: how a key is declared, and what JSON Schema says of it."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Discriminator, Field, Tag, WithJsonSchema

from vibro_sweep.oscillator.checked_numbers import OF_PI, phase_in_words
from vibro_sweep.oscillator.models.declaration import STOPS
from vibro_sweep.tables.parameters import PHASE
from vibro_sweep.tables.quantity import Parameter


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
    BeforeValidator(lambda value: phase_in_words(value) if isinstance(value, str) else value),
    WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "string", "pattern": f"^(grazing|cos|{OF_PI})$"}]}),
]
TAU = (Tau, Field(default=PHASE.default, description=PHASE.described))
WHICH = (Literal[STOPS], Field(default="both", description="which stops there are"))


def number(parameter: Parameter) -> tuple[type, Any]:
    """The key of a parameter, which may be left out where it is swept."""
    field = Field(default=parameter.default, description=parameter.text, json_schema_extra=parameter.range.bounds)
    return float, field


def described_field(description: str, **bounds) -> Any:
    return Field(description=description, json_schema_extra=bounds)


def swept(description: str, bounds: dict[str, float]) -> Any:
    """Bounds of what is written of an axis; a stop need not be reached, and may lie outside."""
    properties = {"start": bounds, "values": {"items": bounds}}
    return Field(default=None, description=description, json_schema_extra={"properties": properties} if bounds else {})


def keys(value) -> set:
    return value.keys() if isinstance(value, dict) else set()
