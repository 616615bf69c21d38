"""The reference page, made from the declarations:  python -m vibro_sweep.cli.reference > docs/reference.md"""

import inspect
import re
from collections.abc import Iterable, Iterator

from vibro_sweep.model.bifurcations import CODIMENSION_TWO, CURVES, EDGES, REASONS, TYPES, WAYS
from vibro_sweep.model.branch_file import BRANCHES, CHART, WINDOWS, columns
from vibro_sweep.model.catalogue import NUMBERS
from vibro_sweep.model.dimensions import DIMENSIONS
from vibro_sweep.model.models import DEFAULT, MODELS
from vibro_sweep.model.observables import VARIABLES, WORDS
from vibro_sweep.model.parameters import FOLLOWING, PARAMETERS
from vibro_sweep.model.state import INITIAL
from vibro_sweep.model.status import STATUSES
from vibro_sweep.model.trajectory_variables import TRAJECTORY
from vibro_sweep.model.wording import sentence
from vibro_sweep.plotting import KINDS
from vibro_sweep.scene import json_schema

HEAD = """# Reference

Made from the tables of `vibro_sweep/model/` by `python -m vibro_sweep.cli.reference > docs/reference.md`; not edited by
hand. What a number in a file allows to conclude is said in [accuracy.md](accuracy.md), how files are laid out in
[files.md](files.md).
"""

_SEVERAL = ("anyOf", "oneOf", "allOf")
_BOUNDS = {"exclusiveMinimum": "> {}", "minimum": ">= {}", "maximum": "<= {}"}


def page() -> str:
    """The page as Markdown."""
    return "\n".join(
        [
            *(HEAD, *_scene(), *_words(), *_variables(), *_columns()),
            *(*_numbers(), *_statuses(), *_bifurcations(), *_pictures()),
        ]
    )


def _table(head: tuple[str, ...], rows: Iterable[tuple]) -> Iterator[str]:
    for row in (head, ["---"] * len(head), *rows):
        yield f"| {' | '.join(str(cell).replace('|', '&#124;') for cell in row)} |"
    yield ""


def _scene() -> Iterator[str]:
    """Each form of the scene as a table of its keys."""
    schema = json_schema((DEFAULT,))
    yield "## Keys of a scene\n"
    yield from _keys(schema)
    for name, path in _paths(schema, schema["definitions"]).items():
        form = schema["definitions"][name]
        yield f"### `{path}`\n\n{form['description']}\n"
        yield from _keys(form)
    yield "## Other models\n\n`system: {type: NAME, ...}`; [models.md](models.md) shows what they are. Their numbers"
    yield "are keys of `sweep`; those of a list count from 1: `m1` is the first of `m`. States have x1 .. vN.\n"
    forms = json_schema(tuple(MODELS))["definitions"]
    for name in MODELS:
        if name != DEFAULT:
            form = next(one for one in forms.values() if one.get("properties", {}).get("type", {}).get("const") == name)
            yield f"### `{name}`\n\n{form['description']}\n"
            yield from _keys(form)


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
    return [name for several in _SEVERAL for one in schema.get(several, ()) for name in _references(one)]


def _keys(form: dict) -> Iterator[str]:
    required = form.get("required", ())
    rows = (
        (
            f"`{key}`",
            _value(schema),
            "(required)" if key in required else f"`{_yaml(schema['default'])}`" if "default" in schema else "",
            schema.get("description", ""),
        )
        for key, schema in form["properties"].items()
    )
    return _table(("key", "value", "default", "meaning"), rows)


def _value(schema: dict) -> str:
    """What may stand there, in words."""
    if _references(schema):
        return "mapping, see below"
    for several in _SEVERAL:
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
    bounds = " and ".join(text.format(schema[key]) for key, text in _BOUNDS.items() if key in schema)
    return " ".join(filter(None, [{"integer": "whole number"}.get(schema["type"], schema["type"]), bounds]))


def _yaml(value: object) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_yaml(one)}" for key, one in value.items()) + "}"
    return f"[{', '.join(map(_yaml, value))}]" if isinstance(value, list) else f"{value}"


def _words() -> Iterator[str]:
    yield "## Words of `observe`\n"
    asked = {
        word: [one.name for one in VARIABLES if word in one.asked_by and not one.at_impacts]
        for word in (*WORDS, TRAJECTORY)
    }
    rows = [(f"`{word}`", one.text, _names(asked[word])) for word, one in WORDS.items()]
    yield from _table(("word", "what is computed", "variables of the file"), rows)
    yield f"The key `{TRAJECTORY}` asks for {_names(asked[TRAJECTORY])}; `status` is always there.\n"


def _variables() -> Iterator[str]:
    yield "## Variables of a file\n\nDimensions after those of the sweep, and `start` if there are several.\n"
    yield (
        "Units are those of a system in SI (`units: SI`). Of `physical`, and of other `units`, they have a factor, as\n"
        "`0.005 m`; without `units` all but radians are `1`.\n"
    )
    rows = (
        (f"`{one.name}`", ", ".join(one.dimensions), one.dtype, one.units, one.label, sentence(one.text))
        for one in VARIABLES
    )
    yield from _table(("name", "dimensions", "type", "units", "`long_name`", "`description`"), rows)
    yield "## Dimensions\n"
    yield from _table(("name", "meaning"), ((f"`{name}`", one.text) for name, one in DIMENSIONS.items()))


def _columns() -> Iterator[str]:
    """Variables of the other kinds of files, of branches in b and curves in b and omega."""
    known: set[str] = set()
    for kind, parameters in ((BRANCHES, ["b"]), (WINDOWS, ["b"]), (CHART, ["b", "omega"])):
        yield f"## Variables of a file of {kind}\n"
        yield "Beside those of a file of branches.\n" if known else ""
        found = [one for one in columns(kind, parameters, 2) if one.name not in known]
        known = known or {one.name for one in found}
        rows = ((f"`{one.name}`", ", ".join(one.dimensions), one.dtype, one.label, sentence(one.text)) for one in found)
        yield from _table(("name", "dimensions", "type", "`long_name`", "`description`"), rows)


def _numbers() -> Iterator[str]:
    yield "## Numbers of a system and a start\n"
    yield "In a file: an attribute where it is the same at all points, else a coordinate.\n"
    rows = (
        (f"`{one.name}`", f"${one.symbol}$", one.units, one.range.text, one.equation, one.described)
        for one in (*PARAMETERS, *(NUMBERS[name] for name in FOLLOWING if name != "tau"), *INITIAL[:4])
    )
    yield from _table(("name", "symbol", "units", "range", "equation", "meaning"), rows)


def _statuses() -> Iterator[str]:
    yield "## Status codes\n"
    rows = ((code, f"`{one.name}`", one.text) for code, one in STATUSES.items())
    yield from _table(("code", "name", "meaning"), rows)


def _bifurcations() -> Iterator[str]:
    yield "## Types of special points\n"
    yield "Of branches (`special_type`), and which of them are followed as curves: by `bifurcation_curve`, and in files"
    yield "(`branch_type`).\n"
    rows = (
        (
            f"`{one.name}`",
            one.label,
            one.text,
            "yes" if one.name in CURVES else "not in files" if one.condition else "",
            f"`{one.name}`" if one.name in WAYS else "",
        )
        for one in TYPES
    )
    yield from _table(("type", "in pictures", "meaning", "curve", "word of `follow`"), rows)
    yield "## Types of points of codimension two\n"
    yield "Of curves (`special_type` of their files), with the curves of orbits of a longer period that begin there.\n"
    rows = (
        (
            f"`{one.name}`",
            one.label,
            _types({condition for condition, _ in one.tests} | ({"torus"} if one.turn else set()), one.sigma),
            one.text,
            _types(one.begins, 1),
        )
        for one in CODIMENSION_TWO
    )
    yield from _table(("type", "in pictures", "on which curves", "meaning", "begins"), rows)
    for title, words in (
        ("Reasons of orbits of a sweep in no window (`orbit_reason`)", REASONS),
        ("Reasons of edges of a plane (`edge_reason`)", EDGES),
    ):
        yield f"## {title}\n"
        yield from _table(("name", "meaning"), ((f"`{name}`", text) for name, text in words.items()))


def _types(conditions: Iterable[str], sigma: int) -> str:
    """The types of curves of orbits with this sigma, or any, along which one of these conditions holds."""
    return _names(one.name for one in TYPES if one.condition in conditions and sigma * one.sigma >= 0)


def _pictures() -> Iterator[str]:
    yield "## Kinds of pictures\n"
    yield (
        "`vibro-sweep plot FILE.h5 --kind KIND`; the default is the scene's `picture`, else the first that a file can "
        "show. `--at NAME=VALUE` draws single orbits at that value of the sweep, `--variable NAME` another variable (a "
        "wrong name lists those of the file), `--xlim LOW HIGH` and `--ylim LOW HIGH` a part, `--size WIDTH HEIGHT` "
        "(inches), `--width MM` (85: one column of a journal) and `--dpi N` set how large it is.\n"
    )
    rows = ((f"`{kind}`", _summary(one.shows), _summary(one.draw)) for kind, one in KINDS.items())
    yield from _table(("kind", "needs", "what it shows"), rows)


def _summary(function) -> str:
    """The first paragraph of a docstring."""
    return " ".join(inspect.getdoc(function).partition("\n\n")[0].split())


def _names(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


if __name__ == "__main__":
    print(page(), end="")
