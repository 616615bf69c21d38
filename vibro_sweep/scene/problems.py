"""What is wrong with a scene, in words: one line per problem, with key path, value and what is allowed."""

import json
import re
from collections.abc import Iterable, Mapping
from itertools import islice

from pydantic import ValidationError

from vibro_sweep.checks.errors import VibroSweepError
from vibro_sweep.checks.meant import did_you_mean, meant
from vibro_sweep.checks.not_computed import why_not_computed
from vibro_sweep.checks.refusals import LONGEST, cut, shown
from vibro_sweep.tables.observables import WORDS

from . import slips
from .data import InvalidValue
from .fields import Form
from .form import StepAxis, tagged

MAX_LINES = 20
LONGEST_HINT = 300  # letters; a longer one repeats a long value
OBSERVATIONS = tuple(WORDS)

_TAGS = {"tau as a number", "tau as a word", "picture as a word"}
_AXIS_FORMS = "{start, stop, step}, {start, stop, num} or {values}"
_YAML_WORDS = {"NaN": ".nan", "Infinity": ".inf", "-Infinity": "-.inf"}


class SceneError(VibroSweepError, ValueError):
    """A scene that cannot be computed; `problems` holds one line for each thing that is wrong with it.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> with open("scene.yaml", "w") as file:
    ...     _ = file.write("system: {mu_m: 10}")
    >>> try:
    ...     vs.load_scene("scene.yaml")
    ... except vs.SceneError as error:
    ...     print(error.problems)
    ('orbit: missing; it must be given',)
    """

    def __init__(self, name: str, problems: list[str]):
        self.name, self.problems = name, tuple(problems)
        super().__init__(name, self.problems)

    def __str__(self):
        if len(self.problems) == 1:
            return f"{self.name}: {self.problems[0]}"
        shown = [f"  {line}" for line in self.problems[:MAX_LINES]]
        if len(self.problems) > MAX_LINES:
            shown.append(f"  and {len(self.problems) - MAX_LINES} more")
        return "\n".join([f"{self.name}: {len(self.problems)} problems", *shown])


def problem(path: str, value: object, text: str) -> str:
    """One line: the key path, the value as the user would write it, what is wrong and what is allowed."""
    shown = json.dumps(_shortened(value), ensure_ascii=False)
    shown = _YAML_WORDS.get(shown, shown)
    hint = value.hint if isinstance(value, InvalidValue) else ""
    return f"{cut(path)} = {cut(shown)}: {text}{hint}"


def _shortened(value: object, levels: int = LONGEST):
    """The part of a value that a message shows, for JSON."""
    if isinstance(value, list) and levels:
        return [_shortened(item, levels - 1) for item in value[:LONGEST]]
    if isinstance(value, dict) and levels:
        return {cut(str(key)): _shortened(item, levels - 1) for key, item in islice(value.items(), LONGEST)}
    if isinstance(value, float):
        return int(value) if value.is_integer() and abs(value) < 1e16 else value
    if isinstance(value, str):
        return value[:LONGEST]
    small = value is None or isinstance(value, bool) or (isinstance(value, int) and abs(value) < 10**LONGEST)
    return value if small else repr(value) if isinstance(value, InvalidValue) else shown(value)


def form_problems(error: ValidationError, form: type[Form], data: object = None) -> list[str]:
    """One line per problem that pydantic found in the data of a scene of this form."""
    items = error.errors()
    unknown = {item["loc"]: item for item in items if item["type"] == "extra_forbidden"}
    instead = {(*loc[:-1], meant(loc[-1], _place(loc, form)[0].model_fields)) for loc in unknown}
    begins = {loc for loc in unknown if len(loc) == 1 and meant(loc[0], _top_keys(form)) == "continue"}
    physical = [loc for loc in unknown if loc[0] == "system" and loc[-1] in slips.PHYSICAL]
    lines = []
    for item in items:
        if item["type"] == "missing" and (item["loc"] in instead or (begins and item["loc"] == ("orbit",))):
            continue  # the unknown key says it
        if len(physical) > 1 and item["loc"] in physical:
            names = ", ".join(str(loc[-1]) for loc in physical)
            lines.append(
                f"system: {names} are physical quantities; write system: {{physical: {{M1: ..., M2: ..., ...}}}}"
            )
        else:
            lines.append(_line(item, form, data))
    return list(dict.fromkeys(lines))


def _line(item, form, data) -> str:
    kind, entry, ctx = item["type"], item["input"], item.get("ctx", {})
    model, path = _place(item["loc"], form)
    keys = list(model.model_fields)
    if kind == "missing":
        needs_two = path.startswith("sweep.") and path.endswith(".step")
        alone = f"; {slips.ONE_MASS}" if path == "system.physical.M2" else ""
        return f"{path}: missing; {'step or num' if needs_two else 'it'} must be given{alone}"
    if kind == "extra_forbidden":
        is_begin = len(item["loc"]) == 1 and meant(item["loc"][0], _top_keys(form)) == "continue"
        known = _top_keys(form) if is_begin else keys
        return problem(path, entry, _unknown(item["loc"], known, entry, data))
    if kind == "literal_error":
        words = [word.strip("'") for word in ctx["expected"].replace(" or ", ", ").split(", ")]
        words = [{"True": "true", "False": "false"}.get(word, word) for word in words]
        also = ", a number (radians), cos, or a text such as pi/2" if "tau as a word" in item["loc"] else ""
        hint = slips.other_form(path, entry) or (slips.number_in_text(entry) if also else None)
        return problem(path, entry, f"{did_you_mean(entry, words)}allowed: {', '.join(words)}{also}{_and(hint)}")
    if kind == "model_type":
        form = _AXIS_FORMS if model is StepAxis else f"the keys {', '.join(keys)}"
        return problem(path, entry, f"must be a mapping with {form}{_and(slips.other_form(path, entry))}")
    beyond = isinstance(entry, int) and not isinstance(entry, bool)
    text = {
        "float_type": "must be a number in the range of the floats" if beyond else "must be a number",
        "int_type": "must be a whole number",
        "finite_number": "must be a finite number",
        "dict_type": "must be a mapping",
        "list_type": f"must be a list of {'names' if path.endswith('units') else 'numbers'}",
        "tuple_type": "must be a list of words",
        "string_type": "must be a text",
        "bool_type": "must be true or false",
        "frozen_set_type": f"must be a list of {', '.join(WORDS)}",
        "greater_than_equal": f"must be a whole number >= {ctx.get('ge')}",
        "less_than_equal": f"must be a whole number <= {ctx.get('le')}",
    }.get(kind, item["msg"])
    if kind in ("frozen_set_type", "list_type", "tuple_type", "dict_type"):
        text += _and(slips.other_form(path, entry, OBSERVATIONS))
    text += _and(slips.of_list(path, entry))
    is_text = isinstance(entry, str) and kind in ("float_type", "int_type")
    return problem(path, entry, text + (f", not text{_and(slips.number_in_text(entry))}" if is_text else ""))


def _unknown(loc, keys: list[str], entry, data) -> str:
    """The message for a word that is not a key, and the key that may be meant."""
    key, place = str(loc[-1]), loc[0]
    if entry is None and (hint := slips.key_without_value(cut(key))):
        return hint
    if key in ("step", "num") and {"step", "num"} & set(keys):
        return f"step and num exclude each other; write {_AXIS_FORMS}"
    if place == "sweep" and len(loc) == 2 and (hint := slips.of_physical(key, data.get("system"))):
        return f"unknown key; {hint}"
    if place == "sweep" and len(loc) == 2 and (hint := slips.of_swept_frequency(key, entry, data.get("system"))):
        return f"unknown key; {hint}"
    if place == "sweep" and len(loc) == 2 and slips.has_words(entry):
        return "unknown key; only numbers are swept: make a run for each word"
    if place == "system" and (hint := slips.of_damping(key, keys)):
        return f"unknown key; {hint}"
    if place == "system" and (hint := why_not_computed(key)):
        return f"unknown key; {hint}"
    if "Omega" in keys and (hint := slips.of_frequency(key, entry)):
        return f"unknown key; {hint}"
    return f"unknown key; {did_you_mean(key, keys)}allowed here: {', '.join(keys)}"


def _top_keys(form) -> list[str]:
    """The keys of a scene: also that of one of another kind."""
    keys = list(form.model_fields)
    return [*keys, "continue"] if "continue" not in keys else keys


def _and(hint: str | None) -> str:
    return f"; {hint}" if hint and len(hint) <= LONGEST_HINT else ""


def located(problems: Iterable[str], lines: Mapping[str, int]) -> list[str]:
    """The same problems, with the line of the text at which the key stands, or where it is missing."""
    return [f"{text} (line {line})" if (line := _line_of(text, lines)) else text for text in problems]


def _line_of(text: str, lines: Mapping[str, int]) -> int | None:
    paths = [text[: end.start()] for end in re.finditer(r" =|:", text)]  # a key may hold either
    known_paths = [path for path in paths if path in lines]
    return lines.get(known_paths[-1] if known_paths else re.split(r" =|: ", text)[0].rpartition(".")[0])


def _place(loc, form: type[Form]) -> tuple[type[Form], str]:
    """The form in which the last key of `loc` stands (or which it is), and the key path without tags."""
    model, path, forms = form, "", tagged(form)
    for part in loc:
        if part in forms:
            model = forms[part]
        elif isinstance(part, int):
            path += f"[{part}]"
        elif part not in _TAGS:
            path += f".{part}" if path else part
            field = model.model_fields.get(part)
            if field and isinstance(field.annotation, type) and issubclass(field.annotation, Form):
                model = field.annotation
    return model, path or "scene"
