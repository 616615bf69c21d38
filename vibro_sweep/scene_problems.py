"""What is wrong with a scene, in words: one line per problem, with key path, value and what is allowed."""

import difflib
import json

from pydantic import ValidationError

from .scene_form import (
    CountAxis,
    FollowStart,
    Form,
    ListAxis,
    PhysicalSystemForm,
    RandomStart,
    SceneForm,
    StateStart,
    StepAxis,
    SystemForm,
)

MAX_LINES = 20

_TAGGED = {
    "numbers": SystemForm,
    "physical units": PhysicalSystemForm,
    "axis by step": StepAxis,
    "axis by number": CountAxis,
    "axis of values": ListAxis,
    "one start": StateStart,
    "random start": RandomStart,
    "followed start": FollowStart,
}
_TAGS = {*_TAGGED, "tau as a number", "tau as a word"}
_AXIS_FORMS = "{start, stop, step}, {start, stop, num} or {values}"
_YAML_WORDS = {"NaN": ".nan", "Infinity": ".inf", "-Infinity": "-.inf"}


class SceneError(ValueError):
    """A scene that cannot be computed; `problems` holds one line for each thing that is wrong with it."""

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
    shown = json.dumps(_whole(value), ensure_ascii=False, default=repr)
    shown = _YAML_WORDS.get(shown, shown)
    return f"{path} = {shown if len(shown) <= 60 else shown[:57] + '...'}: {text}"


def _whole(value):
    if isinstance(value, list):
        return [_whole(item) for item in value]
    return int(value) if isinstance(value, float) and value.is_integer() and abs(value) < 1e16 else value


def form_problems(error: ValidationError) -> list[str]:
    """One line per problem that pydantic found."""
    return list(dict.fromkeys(_line(item) for item in error.errors()))


def _line(item) -> str:
    kind, given, ctx = item["type"], item["input"], item.get("ctx", {})
    model, path = _place(item["loc"])
    keys = list(model.model_fields)
    if kind == "missing":
        return f"{path}: missing; it must be given"
    if kind == "extra_forbidden":
        hint = _suggest(item["loc"][-1], keys)
        return problem(path, given, f"unknown key; {hint}allowed here: {', '.join(keys)}")
    if kind == "literal_error":
        words = [word.strip("'") for word in ctx["expected"].replace(" or ", ", ").split(", ")]
        also = " or a number (radians)" if "tau as a word" in item["loc"] else ""
        return problem(path, given, f"{_suggest(given, words)}allowed: {', '.join(words)}{also}")
    if kind == "model_type":
        form = _AXIS_FORMS if model is StepAxis else f"the keys {', '.join(keys)}"
        return problem(path, given, f"must be a mapping with {form}")
    text = {
        "float_type": "must be a number",
        "int_type": "must be a whole number",
        "finite_number": "must be a finite number",
        "list_type": "must be a list of numbers",
        "frozen_set_type": "must be a list of section, lyapunov, impacts, attractors",
        "greater_than_equal": f"must be a whole number >= {ctx.get('ge')}",
        "less_than_equal": f"must be a whole number <= {ctx.get('le')}",
    }.get(kind, item["msg"])
    is_text = isinstance(given, str) and kind in ("float_type", "int_type")
    return problem(path, given, text + ", not text" * is_text)


def _place(loc) -> tuple[type[Form], str]:
    """The form in which the last key of `loc` stands (or which it is), and the key path without tags."""
    model, path = SceneForm, ""
    for part in loc:
        if part in _TAGGED:
            model = _TAGGED[part]
        elif isinstance(part, int):
            path += f"[{part}]"
        elif part not in _TAGS:
            path += f".{part}" if path else part
            field = model.model_fields.get(part)
            if field and isinstance(field.annotation, type) and issubclass(field.annotation, Form):
                model = field.annotation
    return model, path or "scene"


def _suggest(word: object, options: list[str]) -> str:
    by_lower = {option.lower(): option for option in options}
    close = difflib.get_close_matches(str(word).lower(), by_lower, n=1)
    return f"did you mean `{by_lower[close[0]]}`? " if close else ""
