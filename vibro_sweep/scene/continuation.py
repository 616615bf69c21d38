"""From a YAML text with `continue` to a `Continuation`: branches or curves to be followed."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from vibro_sweep.checks.refusals import ParameterError, not_allowed
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.oscillator.other_words import own_name
from vibro_sweep.oscillator.stops import NOT_PRESSED
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY

from .any_scene import AnyScene, parsed
from .combinations import units_problems
from .continue_form import ORIGINS
from .data import InvalidValue
from .fields import Form
from .form import continuation_form
from .problems import SceneError, form_problems, problem
from .system import in_own_words, kind_of, system_of
from .written import as_data, system_data

_IN_FILES = ("sweep", "branches")  # orbits of a file, which has the first number of `parameter`
_AT_SYSTEM = ("state", "itinerary", "free")  # orbits of `system` itself
BY_BRANCHES = (*_AT_SYSTEM, "grazing")  # origins of curves that are orbits; their branches have the special points
# Keys of `from` that belong to others
_WITH = {"periods": ("state", "itinerary"), "special": ("branches",), "largest": ("sweep",)}
LONGEST = 100  # entries of what is given


@dataclass(frozen=True, eq=False)
class Continuation(AnyScene):
    """Branches to be followed, or with two numbers bifurcation curves.

    origin : one of `ORIGINS`, and `begin` what is given with it: a state (2N,), an itinerary, a path, a period, None
    periods, special, largest : what belongs to it
    parameter : name -> (lo, hi) of the number that changes, or of two in the order of the text
    of : types of the curves in two numbers
    follow, depth : special points from which other branches are followed, and how far
    observe : what else is computed of each orbit of branches
    picture_units : names of units in which numbers are shown, whatever the system's are

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> text = "{system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 4}, "
    >>> text += "continue: {from: {itinerary: R}, parameter: {b: [3, 4.5]}}}"
    >>> with open("branch.yaml", "w") as file:
    ...     _ = file.write(text)
    >>> scene = vs.load_scene("branch.yaml")
    >>> scene.origin, scene.begin, scene.parameter
    ('itinerary', 'R', {'b': (3.0, 4.5)})
    """

    origin: str
    begin: Any
    periods: int
    special: int | None
    largest: int | None
    parameter: dict[str, tuple[float, float]]
    of: tuple[str, ...]
    follow: tuple[str, ...]
    depth: int
    observe: tuple[str, ...] = ()
    picture_units: tuple[str, ...] = ()

    def data(self) -> dict[str, Any]:
        """The data that its YAML holds; numbers that are the default are left out."""
        return _data_of({entry.name: getattr(self, entry.name) for entry in fields(self)})

    def replace(self, **changes) -> "Continuation":
        """A copy with other values of `system`, `origin`, `begin`, `parameter` and the other attributes.

        What belongs to another `origin`, as `periods`, `special` and `largest` may, is left out.

        Raises SceneError for what is not a scene.
        """
        self._check_names(changes)
        origin = changes.get("origin", self.origin)
        if not (isinstance(origin, str) and origin in ORIGINS):
            raise SceneError(self.name, [not_allowed("origin", origin, f"one of {', '.join(ORIGINS)}")])
        attributes = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        for key, value in changes.items():
            data = as_data(key, value)
            # nothing here is long: what is, is refused as a whole
            attributes[key] = InvalidValue(value) if isinstance(data, (list, dict)) and len(data) > LONGEST else data
        return replace(_continuation_of(_data_of(attributes), self.name), source=self.source)

    @property
    def inputs(self) -> list[Path]:
        """The files that its run must not write to: its own, and that in which its orbits are."""
        return [*super().inputs, *([Path(self.begin)] if self.origin in _IN_FILES else [])]

    def __str__(self) -> str:
        """A few lines on what is followed."""
        system = self._system_text(self.parameter)
        ranges = ", ".join(f"{key} = {lo:g} .. {hi:g}" for key, (lo, hi) in self.parameter.items())
        begin = "the free motion" if self.origin == "free" else f"{self.origin} {self.begin}"
        begin += f", special point {self.special}" if self.special is not None else ""
        begin += f", its {self.largest} largest windows" if self.largest is not None else ""
        if len(self.parameter) == 1:
            others = f"over {', '.join(self.follow)}, {self.depth} away at most" if self.depth else "no others"
            observed = f"\n  observe   {', '.join(self.observe)}" if self.observe else ""
            return f"branches in {ranges}\n{system}\n  from      {begin}\n  follow    {others}{observed}"
        lines = [f"curves in {ranges}", system, f"  from      {begin}"]
        lines.append(f"  of        {', '.join(self.of)}")
        if self.origin in BY_BRANCHES:
            over = f", over {', '.join(self.follow)}, {self.depth} away at most" if self.depth and self.follow else ""
            lines.append(f"  branches  in {next(iter(self.parameter))}{over}, on which curves start")
        away = f"at points of codimension two, {self.depth} away at most" if self.depth else "none"
        return "\n".join([*lines, f"  others    {away}"])


def is_continuation(data: object) -> bool:
    """Whether the data of a scene ask for branches."""
    return isinstance(data, dict) and "continue" in data


def parse_continuation(text: str, name: str = "scene", source: Path | None = None) -> Continuation:
    """A Continuation from YAML text. Raises SceneError."""
    return parsed(text, name, source, _continuation_of)


def _data_of(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """The data of the YAML text of a scene with these attributes, as it has them or as YAML does."""
    system, begin, origin = attributes["system"], attributes["begin"], attributes["origin"]
    if origin == "state" and isinstance(begin, (list, tuple)):
        begin = dict(zip(state(len(begin) // 2), begin, strict=False))
    more = {"periods": attributes["periods"]} if origin in ("state", "itinerary") else {}
    more |= {"special": attributes["special"]} if origin == "branches" else {}
    more |= {"largest": attributes["largest"]} if origin == "sweep" and attributes["largest"] is not None else {}
    parameter = attributes["parameter"]
    if isinstance(parameter, dict):
        parameter = {key: _listed(bounds) for key, bounds in parameter.items()}
    body = {"from": "free" if origin == "free" else {origin: begin, **more}, "parameter": parameter}
    if isinstance(parameter, dict) and len(parameter) == 2:
        body["of"] = _listed(attributes["of"])
    body |= {"follow": _listed(attributes["follow"]), "depth": attributes["depth"]}
    data = {"system": system_data(system, ()) if isinstance(system, Oscillator) else system, "continue": body}
    if attributes["observe"] not in ((), []):
        body["observe"] = _listed(attributes["observe"])
    units = _listed(attributes["picture_units"])
    return data if units in ([], None) else data | {"picture": {"units": units}}


def _listed(words: object) -> object:
    return list(words) if isinstance(words, tuple) else words


def _continuation_of(data: Any, name: str) -> Continuation:
    if not is_continuation(data):
        raise SceneError(name, ["continue: missing; a scene of branches or curves has it"])
    kind, masses = kind_of(data, name)
    scheme = continuation_form(kind, masses)
    try:
        form = scheme.model_validate(data)
    except ValidationError as error:
        raise SceneError(name, form_problems(error, scheme, data)) from None
    body = getattr(form, "continue")
    form, wrong_words = in_own_words(form)
    chosen, problems = _origin(getattr(body, "from"))
    ranges, more = _ranges(body.parameter, list(data["continue"]["parameter"]))
    problems += wrong_words + more
    if len(ranges) == 1 and "of" in body.model_fields_set:
        problems.append("continue.of: belongs to two keys of `parameter`; leave it out")
    if len(ranges) == 2 and body.observe:
        problems.append("continue.observe: belongs to one key of `parameter`; leave it out")
    first = next(iter(ranges), "")
    missing = first and chosen[0] in _IN_FILES and getattr(form.system, own_name(first), None) is None
    at_end = {first: ranges[first]} if missing else {}
    system, more = system_of(form, at_end, kind, masses) if not wrong_words else (None, [])
    problems += more
    if system is not None and body.observe and not system.linear.compliant:
        problems.append(problem("continue.observe", list(body.observe), f"{NOT_PRESSED}; leave it out"))
    for key, limits in ranges.items() if system is not None else ():
        numbers = system.family.free
        if key not in numbers:
            problems.append(problem("continue.parameter", key, f"must be a number of `system`: {', '.join(numbers)}"))
            continue
        problems += [line for value in limits for line in _outside(system, key, value)]
        value = numbers[key]
        if chosen[0] in _AT_SYSTEM and not limits[0] <= value <= limits[1]:
            problems.append(
                problem(f"system.{key}", value, f"must be in continue.parameter: {limits[0]:g} .. {limits[1]:g}")
            )
    units = getattr(form.picture, "units", None)
    problems += units_problems(units, system)
    if problems:
        raise SceneError(name, problems)
    begin = chosen[1]
    if chosen[0] == "state":
        begin = tuple(begin.model_dump().values())
    origin = getattr(body, "from")
    return Continuation(
        Path(name).stem, system, chosen[0], begin, origin.periods, origin.special, origin.largest,
        ranges, body.of, body.follow, body.depth, body.observe, tuple(units or ()),
    )  # fmt: skip


def _origin(origin: Form) -> tuple[tuple[str, Any], list[str]]:
    """The key of `from` that is given and its value, and what is wrong."""
    named_origins = [key for key in ORIGINS if key in origin.model_fields_set]
    if len(named_origins) != 1:
        named = f"has {', '.join(named_origins)}" if named_origins else "says nothing"
        return ("free", None), [f"continue.from: {named}; it must have one of {', '.join(ORIGINS)}"]
    problems = [
        f"continue.from.{key}: belongs to {' or '.join(others)}; leave it out"
        for key, others in _WITH.items()
        if key in origin.model_fields_set and named_origins[0] not in others
    ]
    if named_origins[0] == "branches" and origin.special is None:
        problems.append("continue.from.special: missing; it must be given with branches")
    if named_origins[0] == "itinerary" and set(origin.itinerary) - {"R", "L"}:
        problems.append(problem("continue.from.itinerary", origin.itinerary, "must be a word of R and L"))
    if named_origins[0] == "free" and origin.free is not True:
        problems.append("continue.from.free: must be true, or write `from: free`")
    return (named_origins[0], getattr(origin, named_origins[0])), problems


def _ranges(parameter: Form, keys: list[str]) -> tuple[dict[str, tuple[float, float]], list[str]]:
    """The ranges in the order of the text, and what is wrong."""
    if not 1 <= len(keys) <= 2:
        return {}, [problem("continue.parameter", keys, "must have one key, or two for curves")]
    if {CYCLES.name, FREQUENCY.name} <= set(keys):
        text = f"{CYCLES.name} stands in place of {FREQUENCY.name}; leave one out"
        return {}, [problem("continue.parameter", keys, text)]
    ranges = {key: tuple(getattr(parameter, key)) for key in keys}
    wrong = [
        problem(f"continue.parameter.{key}", list(bounds), "must be two numbers, the lower end and a greater one")
        for key, bounds in ranges.items()
        if not (len(bounds) == 2 and bounds[0] < bounds[1])
    ]
    return {} if wrong else ranges, wrong


def _outside(system: Oscillator, key: str, value: float) -> list[str]:
    try:
        system.replace(**{key: value})
    except ParameterError as error:
        return [problem(f"continue.parameter.{key}", value, f"must be {error.allowed}")]
    return []
