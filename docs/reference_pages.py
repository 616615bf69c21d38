"""Pages of the reference, made from the declarations of the package:  python docs/reference_pages.py docs/reference"""

import inspect
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import typer

import vibro_sweep
from vibro_sweep import types
from vibro_sweep.cli.commands import app
from vibro_sweep.cli.console import EXIT_STATUSES
from vibro_sweep.cli.examples import examples, purpose
from vibro_sweep.oscillator.catalogue import NUMBERS
from vibro_sweep.oscillator.contact_laws import STOP_NUMBERS
from vibro_sweep.oscillator.models import DEFAULT, MODELS
from vibro_sweep.oscillator.models.two_mass import PARAMETERS
from vibro_sweep.oscillator.wording import sentence
from vibro_sweep.plotting.plot import KINDS
from vibro_sweep.scene import json_schema
from vibro_sweep.tables.bifurcations import CODIMENSION_TWO, CURVES, TYPES, WAYS, Bifurcation
from vibro_sweep.tables.coordinates import INITIAL
from vibro_sweep.tables.file_columns import BRANCHES, CHART, OF_CONTACTS, OF_EDGES, WINDOWS, columns
from vibro_sweep.tables.observables import DIMENSIONS, SETTLE, TRAJECTORY, VARIABLES, WORDS
from vibro_sweep.tables.outcomes import BRANCHES as OF_BRANCHES
from vibro_sweep.tables.outcomes import EDGES, NOT_COMPUTED, ORBITS, POINTS, REASONS, STATUSES, Outcome
from vibro_sweep.tables.parameters import FOLLOWING

NOTE = "<!-- made by `python docs/reference_pages.py docs/reference`; not edited by hand -->"
SEVERAL = ("anyOf", "oneOf", "allOf")
BOUNDS = {"exclusiveMinimum": "> {}", "minimum": ">= {}", "maximum": "<= {}"}
OBJECTS = """Scenes with `continue`, `vibro-sweep windows` and `.save` write this and the next two kinds of files.
`vibro_sweep.load` gives them as objects, `vibro_sweep.open` as an `xarray.Dataset`."""
MESSAGES = {  # a part of the message, and what to do
    "that is not complete": "The file is that of a run that was interrupted, or still goes on. Call the same "
    "command with `--resume`, or `mode='resume'` in Python.",
    "--overwrite replaces it": "A result or a picture has this name already. Choose another one by `-o`, or let "
    "`--overwrite` replace it.",
    "is not an HDF5 file, or it is damaged": "Copy the file again. `vibro-sweep info FILE.h5` names what is damaged, "
    "and which numbers are still those that were computed.",
    "did you mean": "A name is misspelt, or from another program. The message has the name that is closest.",
    "needs the package": "An optional package is not installed. The message has its name for `pip install`.",
    "a worker process died": "Most often the system had no memory left. Use fewer workers; `--resume` continues.",
}


# Markdown


def head(title: str, text: str) -> Iterator[str]:
    """The title of a page, and what it is for."""
    yield f"# {title}\n\n{NOTE}\n\n{text}\n"


def table(titles: tuple[str, ...], rows: Iterable[tuple]) -> Iterator[str]:
    for row in (titles, ["---"] * len(titles), *rows):
        cells = (str(cell).replace("|", "\\|") for cell in row)
        yield f"| {' | '.join(cells)} |"
    yield ""


def outcomes(found: Iterable[tuple[str, str, str]]) -> Iterator[str]:
    """A list of names, each with its meaning and what to do."""
    for name, text, advice in found:
        yield f"- **{name}**: {sentence(text)}" + (f"\n  *What to do:* {advice}" if advice else "")
    yield ""


def summary(text: str) -> str:
    """The first paragraph of a docstring or a help text."""
    return " ".join(inspect.cleandoc(text).partition("\n\n")[0].split())


def listed(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


# Scenes, with the numbers of the models


class Keys:
    """Tables of the keys of a scene: a key that means what it meant in a table above is named, not explained again."""

    def __init__(self, known: Iterable[tuple[str, str]]):
        self.known = dict.fromkeys(known, "")  # by key and meaning: what may stand there

    def of(self, form: dict) -> Iterator[str]:
        """A table, and below it the names of keys that are explained above."""
        either = form.get("anyOf", [{}])[0].get("required", [])  # of which another key may take the place
        required, rows, repeated = [*form.get("required", ()), *either], [], {}
        for key, schema in form["properties"].items():
            meaning, value = schema.get("description", ""), _value(schema)
            if (key, meaning) in self.known:
                other = value.startswith(("mapping", "list")) and value != self.known[key, meaning]
                repeated.setdefault(value if other else "", []).append(key)
                continue
            self.known[key, meaning] = value
            default = f"`{_yaml(schema['default'])}`" if "default" in schema else ""
            rows.append((f"`{key}`", meaning, value, "(required)" if key in required else default))
        yield from table(("key", "meaning", "value", "default"), rows) if rows else ()
        for value, names in repeated.items():
            yield f"{'Also, as' if rows else 'As'} above: {_shortly(names)}{f'; {value}' if value else ''}.\n"


def _shortly(names: list[str]) -> str:
    """Names of keys; those of the two groups in two words."""
    for group, words in ((PARAMETERS, "numbers of two masses"), (STOP_NUMBERS, "numbers of stops")):
        if {one.name for one in group} <= {*names}:
            rest = [name for name in names if name not in {one.name for one in group}]
            return f"the {words}{f', {listed(rest)}' if rest else ''}"
    return listed(names)


def scenes() -> Iterator[str]:
    schema = json_schema((DEFAULT,))
    definitions = schema["definitions"]
    paths = _paths(schema, definitions)
    numbers = (*PARAMETERS, *INITIAL[:4])
    said = {("tau", one.text) for one in PARAMETERS if one.name == "tau"}
    tables = Keys(said | {(one.name.removeprefix("start_"), one.described) for one in numbers})
    yield from head(
        "Keys of a scene, and numbers of the models",
        "A scene is a YAML file that says what to compute. `vibro-sweep new` writes an example, `vibro-sweep check`\n"
        "validates one. The numbers of an oscillator have the same names in scenes, in Python and in files.",
    )
    example = examples()["quickstart"].read_text(encoding="utf-8").strip().partition("\n\n")[2]
    yield f"An example, `vibro-sweep new quickstart`:\n\n```yaml\n{example}\n```\n\nThe keys are:\n"
    yield from tables.of(schema)
    yield from _numbers()
    for name, path in paths.items():
        if path == "sweep":
            yield from _other_models(tables)
        form = definitions[name]
        beside = [definitions[other] for other, where in paths.items() if where == path and other != name]
        title = path.replace(".", ": ")  # GitHub leaves dots out of links to a heading
        yield f"## `{title}`{_telling(form, beside)}\n\n{form['description']}\n"
        yield from tables.of(form)
    yield from _words()
    yield "## Scenes that come with the program\n"
    yield "`vibro-sweep new NAME` copies one of them into the current folder.\n"
    yield from table(("name", "what it is for"), ((f"`{name}`", purpose(path)) for name, path in examples().items()))


def _numbers() -> Iterator[str]:
    yield "## Numbers of two masses, and of a start\n"
    yield "In a file: an attribute where the number is the same at all points, else a coordinate. *Numbers of stops*"
    yield f"are {listed(one.name for one in STOP_NUMBERS)}.\n"
    more = (*(NUMBERS[name] for name in FOLLOWING if name != "tau"), *INITIAL[:4])
    rows = []
    for one in (*PARAMETERS, *more):
        default = "" if one.default is None else f"`{one.default}`"
        rows += [(f"`{one.name}`", one.described, one.range.text, default, f"${one.symbol}$", one.units, one.equation)]
    yield from table(("name", "meaning", "range", "default", "symbol", "units", "equation"), rows)


def _other_models(tables: Keys) -> Iterator[str]:
    yield "## `system` of other models\n\n`system: {type: NAME, ...}` in a scene, `vs.Oscillator.named(NAME, ...)` in"
    yield "Python. [Models](../how/models.md) shows each with its equations and a sketch. A number that is swept may be"
    yield "left out. Numbers are keys of `sweep`; those of a list count from 1: `m1` is the first of `m`. States have"
    yield "x1 .. vN.\n"
    forms = json_schema(tuple(MODELS))["definitions"]
    for name in MODELS:
        if name != DEFAULT:
            form = next(one for one in forms.values() if one.get("properties", {}).get("type", {}).get("const") == name)
            text = form["description"].removeprefix(f"The model {name}: ").partition(". A number that is swept")[0]
            yield f"### `{name}`\n\n{sentence(text)}\n"
            yield from tables.of(form)


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
    rows = [(f"`{word}`", text, listed(asked[word])) for word, text in WORDS.items()]
    yield from table(("word", "what is computed", "variables of the file"), rows)
    yield f"The key `{TRAJECTORY}` asks for the variables `{TRAJECTORY}_...`, `{SETTLE}` for {listed(asked[SETTLE])};"
    yield "`status` is always there.\n"


# Variables of files


def _of_mass_1(rows: Iterable) -> Iterator:
    """Without those of mass 2 that differ from a row of mass 1 in its number alone."""
    rows = [*rows]
    texts = {one.text for one in rows}
    return (
        one for one in rows if one.name[-1:] != "2" or re.sub(r"\b(mass |x|v)2\b", r"\g<1>1", one.text) not in texts
    )


def variables() -> Iterator[str]:
    yield from head(
        "Variables of files",
        "[Accuracy](../how/accuracy.md) says what the numbers allow to conclude, [files](files_and_limits.md) how a\n"
        "file is laid out. Rows of x1 and v1 stand for those of x2, v2 and further masses, too.",
    )
    yield "## A file of a sweep\n\nDimensions come after those of the sweep, and `start` if there are several.\n"
    yield "Units are those of a system in SI (`units: SI`). Of `physical`, and of other `units`, they have a factor, as"
    yield "`0.005 m`; without `units` all but radians are `1`.\n"
    found = _of_mass_1(VARIABLES)
    rows = ((f"`{one.name}`", sentence(one.text), ", ".join(one.dimensions), one.dtype, one.units) for one in found)
    yield from table(("name", "`description`", "dimensions", "type", "units"), rows)
    yield "## Dimensions\n"
    yield from table(("name", "meaning"), ((f"`{name}`", one.text) for name, one in DIMENSIONS.items()))
    known: set[str] = set()
    branches = (BRANCHES, ["b"], "branches", OF_CONTACTS)
    edges = (CHART, ["b", "omega"], "curves", OF_EDGES)
    for kind, parameters, name, more in (branches, (WINDOWS, ["b"], "windows", ()), edges):
        yield f"## A file of {name}\n"
        yield "Beside those of a file of branches.\n" if known else f"{OBJECTS}\n"
        found = [one for one in (*columns(kind, parameters, 2), *more) if one.name not in known]
        known = known or {one.name for one in found}
        found = _of_mass_1(found)
        rows = ((f"`{one.name}`", sentence(one.text), ", ".join(one.dimensions), one.dtype) for one in found)
        yield from table(("name", "`description`", "dimensions", "type"), rows)


# Statuses, and types of bifurcations


def statuses() -> Iterator[str]:
    yield from head(
        "Troubleshooting by status, and types of bifurcations",
        "What each status means, and what to do about it. Numbers that could not be computed are missing (NaN), never\n"
        "guessed, and a status says why.",
    )
    yield "## A point of a sweep (`status`)\n\nThe same names are the `status` of an orbit of `simulate`.\n"
    codes = enumerate(STATUSES, NOT_COMPUTED)
    yield from outcomes((f"`{one.name}` ({code})", one.text, one.advice) for code, one in codes)
    yield from _named("An orbit of a sweep in no window (`orbit_reason`)", REASONS)
    yield from _named("A periodic orbit (`PeriodicOrbit.status`)", ORBITS)
    yield from _named("A branch (`Branch.status`, `branch_status`)", OF_BRANCHES)
    yield from _named("A point of a branch or a curve (`status` of their files)", POINTS)
    yield "## Types of special points\n\nWhere a branch or a window ends, and of other points (`special_type`)."
    yield "In brackets: the letters that mark it in pictures; whether it is followed as a curve, by `bifurcation_curve`"
    yield "and in files (`branch_type`); and the word of `follow` by which scenes follow what branches off.\n"
    yield from outcomes((f"`{one.name}`{_uses(one)}", one.text, one.advice) for one in TYPES)
    yield "## Types of points of codimension two\n"
    yield "In `special_type` of files of curves, with the curves of orbits of a longer period that begin there. What to"
    yield "do where a curve ends is said above of branches.\n"
    rows = []
    for one in CODIMENSION_TWO:
        conditions = {condition for condition, _ in one.tests} | ({"torus"} if one.turn else set())
        rows += [(f"`{one.name}`", one.text, one.label, _types(conditions, one.sigma), _types(one.begins, 1))]
    yield from table(("type", "meaning", "in pictures", "on which curves", "begins"), rows)
    yield from _named("An edge of a plane (`edge_reason`)", EDGES)
    yield "## Exit status of the program\n"
    yield from outcomes(EXIT_STATUSES)
    yield "## Common messages\n"
    for part, advice in MESSAGES.items():
        yield f"- **... {part} ...**: {advice}"


def _named(title: str, found: Iterable[Outcome]) -> Iterator[str]:
    yield f"## {title}\n"
    yield from outcomes((f"`{one.name}`", one.text, one.advice) for one in found)


def _uses(one: Bifurcation) -> str:
    """Its mark, whether there is a curve of it, and its word of `follow`."""
    curve = "curve" if one.name in CURVES else "curve, not in files" if one.condition else ""
    uses = [one.label, curve, f"`follow: [{one.name}]`" if one.name in WAYS else ""]
    return f" ({'; '.join(filter(None, uses))})" if any(uses) else ""


def _types(conditions: Iterable[str], sigma: int) -> str:
    """The types of curves of orbits with this sigma, or any, along which one of these conditions holds."""
    return listed(one.name for one in TYPES if one.condition in conditions and sigma * one.sigma >= 0)


# Commands, pictures, the interface of Python


def commands() -> Iterator[str]:
    yield from head(
        "Commands",
        "`vibro-sweep --help` and `vibro-sweep COMMAND --help` print the same; `python -m vibro_sweep` is the same\n"
        "program. [Statuses](statuses.md#exit-status-of-the-program) has the exit statuses.",
    )
    for name, command in typer.main.get_command(app).commands.items():
        yield f"## `vibro-sweep {name}`\n"
        usage = " ".join(
            one.metavar + "..." * (one.nargs == -1) for one in command.params if one.param_type_name == "argument"
        )
        yield f"```text\nvibro-sweep {name} [OPTIONS] {usage}".rstrip() + "\n```\n"
        yield inspect.cleandoc(command.help) + "\n"
        rows = [(_option(one), one.help) for one in command.params if one.param_type_name == "option"]
        yield from table(("option", "meaning"), rows) if rows else ()


def _option(option) -> str:
    *short, long = option.opts
    return ", ".join(f"`{name}`" for name in (*short, long if option.is_flag else f"{long} {option.metavar}"))


def pictures() -> Iterator[str]:
    yield from head(
        "Kinds of pictures",
        "`vs.plot(data, kind)` and `vibro-sweep plot FILE.h5 --kind KIND` draw what a file holds. The default is the\n"
        "scene's `picture`, else the first kind that the file can show. The [gallery](../auto_gallery/index.rst) has\n"
        "examples, and [the command](commands.md#vibro-sweep-plot) all options.",
    )
    rows = ((f"`{kind}`", summary(one.panels.__doc__), summary(one.shows.__doc__)) for kind, one in KINDS.items())
    yield from table(("kind", "what it shows", "needs"), rows)
    yield "`--at NAME=VALUE` draws single orbits at that value of the sweep, of the kinds"
    yield f"{listed(kind for kind, one in KINDS.items() if one.of_orbits)}."


def api() -> Iterator[str]:
    """The public names: those of the package in the groups of its docstring."""
    yield from head(
        "Python interface",
        "Every public name: what it takes and returns, shapes, units, errors, and an example whose result is checked.\n"
        "At a prompt `help(vs.sweep)` says the same. `import vibro_sweep as vs`. Times are those of the numbers given\n"
        "(of `System`: nondimensional), phases in radians; with N masses a state is x1 v1 .. xN vN, (2N,).",
    )
    groups = re.findall(r"^(\S.*)\n((?: {4}.*\n)+)", vibro_sweep.__doc__, re.MULTILINE)
    known = [*vibro_sweep.__all__]
    for title, text in groups[:-1]:
        names = [one for one in dict.fromkeys(re.findall(r"\w+", text)) if one in known]
        known = [one for one in known if one not in names]
        yield from _autosummary(title, "vibro_sweep", names)
    yield "Each is also the error of Python that it is a case of. Those without a name of their own here, as of files"
    yield "that one cannot compute from, are a `VibroSweepError` and mostly a `ValueError`.\n"
    yield from _autosummary("Types", "vibro_sweep.types", types.__all__)
    yield "For annotations and `isinstance`: `from vibro_sweep.types import Branch`."


def _autosummary(title: str, module: str, names: Iterable[str]) -> Iterator[str]:
    yield f"## {title}\n\n```{{eval-rst}}\n.. currentmodule:: {module}\n\n.. autosummary::\n   :toctree: generated"
    yield "   :nosignatures:\n"
    yield from (f"   {name}" for name in names)
    yield "```\n"


PAGES: tuple[Callable[[], Iterator[str]], ...] = (scenes, variables, statuses, commands, pictures, api)


def pages() -> dict[str, str]:
    """The pages as Markdown, by the names of their files."""
    return {f"{page.__name__}.md": "\n".join(page()).rstrip() + "\n" for page in PAGES}


if __name__ == "__main__":
    for name, text in pages().items():
        (Path(sys.argv[1]) / name).write_text(text, encoding="utf-8")
