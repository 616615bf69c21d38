"""Numbers of the models, and of a start."""

from collections.abc import Iterator

from vibro_sweep.model.catalogue import NUMBERS
from vibro_sweep.model.models import DEFAULT, MODELS
from vibro_sweep.model.parameters import FOLLOWING, PARAMETERS
from vibro_sweep.model.state import INITIAL
from vibro_sweep.scene import json_schema

from .markdown import head, table
from .scene_page import keys


def page() -> Iterator[str]:
    yield from head(
        "Numbers of the models",
        "The numbers that an oscillator has: their names in scenes, in Python and in files, and their ranges.\n"
        "[Models](../how/models.md) shows each with its equations and a sketch.",
    )
    yield "## Two masses, and a start\n"
    yield "In a file: an attribute where the number is the same at all points, else a coordinate.\n"
    rows = (
        (f"`{one.name}`", one.described, one.range.text, f"${one.symbol}$", one.units, one.equation)
        for one in (*PARAMETERS, *(NUMBERS[name] for name in FOLLOWING if name != "tau"), *INITIAL[:4])
    )
    yield from table(("name", "meaning", "range", "symbol", "units", "equation"), rows)
    yield "## Other models\n\n`system: {type: NAME, ...}` in a scene, `vs.Oscillator.named(NAME, ...)` in Python."
    yield "Their numbers are keys of `sweep`; those of a list count from 1: `m1` is the first of `m`. States have"
    yield "x1 .. vN.\n"
    forms = json_schema(tuple(MODELS))["definitions"]
    for name in MODELS:
        if name != DEFAULT:
            form = next(one for one in forms.values() if one.get("properties", {}).get("type", {}).get("const") == name)
            yield f"### `{name}`\n\n{form['description']}\n"
            yield from keys(form)
