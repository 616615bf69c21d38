"""Keys of a scene, and the words of `observe`."""

import re
from collections.abc import Iterator

from vibro_sweep.model.models import DEFAULT
from vibro_sweep.model.observables import SETTLE, VARIABLES, WORDS
from vibro_sweep.model.trajectory_variables import TRAJECTORY
from vibro_sweep.scene import json_schema

from ..examples import examples, purpose
from .markdown import head, listed, table

SEVERAL = ("anyOf", "oneOf", "allOf")
BOUNDS = {"exclusiveMinimum": "> {}", "minimum": ">= {}", "maximum": "<= {}"}


def page() -> Iterator[str]:
    """Each form of the scene as a table of its keys."""
    schema = json_schema((DEFAULT,))
    yield from head(
        "Keys of a scene",
        "A scene is a YAML file that says what to compute. `vibro-sweep new` writes an example, `vibro-sweep check`\n"
        "validates one. Systems of other models have [keys of their own](model_numbers.md).",
    )
    example = examples()["quickstart"].read_text(encoding="utf-8").strip().partition("\n\n")[2]
    yield f"An example, `vibro-sweep new quickstart`:\n\n```yaml\n{example}\n```\n\nThe keys are:\n"
    yield from keys(schema)
    paths = _paths(schema, schema["definitions"])
    for name, path in paths.items():
        form = schema["definitions"][name]
        beside = [schema["definitions"][other] for other, where in paths.items() if where == path and other != name]
        yield f"## `{path}`{_telling(form, beside)}\n\n{form['description']}\n"
        yield from keys(form)
    yield from _words()
    yield "## Scenes that come with the program\n"
    yield "`vibro-sweep new NAME` copies one of them into the current folder.\n"
    yield from table(("name", "what it is for"), ((f"`{name}`", purpose(path)) for name, path in examples().items()))


def _telling(form: dict, beside: list[dict]) -> str:
    """The key by which a form is told from others in the same place."""
    own = (key for key in form["properties"] if not any(key in other["properties"] for other in beside))
    key = next(own, "") if beside else ""
    return f" with `{key}`" if key else ""


def _paths(form: dict, definitions: dict, path: str = "") -> dict[str, str]:
    """The place in a scene of each definition, in order; one that several keys share, at KEY."""
    found = {}
    for key, schema in form["properties"].items():
        for name in _references(schema):
            here = f"{path}{'KEY' if name in found else key}"
            found[name] = here
            found |= _paths(definitions[name], definitions, f"{here}.")
    return found


def _references(schema: dict) -> list[str]:
    """Names of the definitions that a value may follow."""
    if "$ref" in schema:
        return [schema["$ref"].rpartition("/")[2]]
    return [name for several in SEVERAL for one in schema.get(several, ()) for name in _references(one)]


def keys(form: dict) -> Iterator[str]:
    required = form.get("required", ())
    rows = (
        (
            f"`{key}`",
            schema.get("description", ""),
            _value(schema),
            "(required)" if key in required else f"`{_yaml(schema['default'])}`" if "default" in schema else "",
        )
        for key, schema in form["properties"].items()
    )
    return table(("key", "meaning", "value", "default"), rows)


def _value(schema: dict) -> str:
    """What may stand there, in words."""
    if _references(schema):
        return "mapping, see below"
    for several in SEVERAL:
        if several in schema:
            return " or ".join(_value(one) for one in schema[several])
    if "const" in schema:
        return f"`{schema['const']}`"
    if "enum" in schema:
        return " or ".join(f"`{word}`" for word in schema["enum"])
    if schema["type"] == "array":
        items = re.sub(r"^(number|list)\b", r"\1s", _value(schema["items"]).replace(" or ", ", "))
        exact = schema.get("minItems") == schema.get("maxItems")
        return " ".join(filter(None, ["list of", str(schema.get("minItems", "")) if exact else "", items]))
    bounds = " and ".join(text.format(schema[key]) for key, text in BOUNDS.items() if key in schema)
    return " ".join(filter(None, [{"integer": "whole number"}.get(schema["type"], schema["type"]), bounds]))


def _yaml(value: object) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_yaml(one)}" for key, one in value.items()) + "}"
    return f"[{', '.join(map(_yaml, value))}]" if isinstance(value, list) else f"{value}"


def _words() -> Iterator[str]:
    yield "## Words of `observe`\n"
    asked = {
        word: [one.name for one in VARIABLES if word in one.asked_by and not one.at_impacts]
        for word in (*WORDS, TRAJECTORY, SETTLE)
    }
    rows = [(f"`{word}`", one.text, listed(asked[word])) for word, one in WORDS.items()]
    yield from table(("word", "what is computed", "variables of the file"), rows)
    yield f"The key `{TRAJECTORY}` asks for {listed(asked[TRAJECTORY])}; `{SETTLE}` for {listed(asked[SETTLE])}; "
    yield "`status` is always there.\n"
