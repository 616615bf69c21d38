"""What people write in a scene by mistake, and what to write instead."""

import math
import re
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from vibro_sweep.checks.meant import meant
from vibro_sweep.checks.real import number_of
from vibro_sweep.oscillator.models import DEFAULT, MODELS
from vibro_sweep.oscillator.other_words import OTHER_WORDS
from vibro_sweep.tables.observables import ALONG_BRANCHES
from vibro_sweep.tables.parameters import CYCLES

PHYSICAL = ("M1", "M2", "K1", "K2", "C1", "C2", "P1", "P2", "Omega", "B", "B0")
NONDIMENSIONAL = (
    "mu_m = M2/M1, mu_k = K2/K1, zeta = C1/(2 sqrt(K1 M1)), f2 = P2/(P1 + P2), omega = Omega sqrt(M1/K1), "
    "b = B K1/(P1 + P2)"
)

AXIS = "{start: 6.5, stop: 6.9, num: 401}"
MATRICES = {option.name for model in MODELS.values() for option in model.options if option.kind == "matrix"}


def key_without_value(key: str) -> str | None:
    """The message for a key that has no value: YAML has made it of a missing space, or of a comma."""
    if match := re.fullmatch(r"(\w+)\s*[:=]\s*(.+)", key):
        return f"write `{match[1]}: {match[2]}`, with a colon and a space after it"
    if re.fullmatch(r"\d+", key):
        return f"a comma separates entries; a decimal number has a point: 0.{key}, not 0,{key}"
    return None


def number_in_text(text: str) -> str | None:
    """The hint for a text that means a number."""
    stripped = text.strip()
    for pattern, write in (
        (r"[-+]?\d*,\d+([eE][-+]?\d+)?", lambda: f"a decimal number has a point: {stripped.replace(',', '.')}"),
        (r"[-+]?[\d.]+%", lambda: f"write {float(stripped[:-1]) / 100:g}"),
        (r"([-+]?[\d.]+)\s*/\s*([\d.]+)", lambda: f"write {_ratio(stripped)!r}"),
        (r"\d+(_\d+)+", lambda: f"write {stripped.replace('_', '')}"),
        (r"[-+\d.*/ ]*pi[-+\d.*/ ]*", lambda: f"write its value; pi is {math.pi!r}"),
        (r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", lambda: f"write {stripped} without quotes"),
        (r"[-+]?[\d.]+\s*[A-Za-z].*", lambda: "numbers have no units here"),
    ):
        if re.fullmatch(pattern, stripped):
            try:
                return write()
            except (ValueError, ZeroDivisionError):
                return None
    return None


def _ratio(text: str) -> float:
    above, below = text.split("/")
    return float(above) / float(below)


def other_form(path: str, value: object, words: Iterable[str] = ()) -> str | None:
    """The hint for a value of another form than its key needs, by the key."""
    key = path.rpartition(".")[2]
    if path == "start":
        return _start(value)
    if path == "observe":
        parts = re.split(r"[,;\s]+", value) if isinstance(value, str) else value
        names = [*parts] if isinstance(parts, (list, Mapping)) else []
        known = [name for name in (meant(name, words) for name in names) if name]
        return f"write observe: [{', '.join(known or ['section', 'lyapunov'])}]"
    if path == "system.stops" and str(value).lower() in ("none", "no", "false", "off", "free", "[]", "0"):
        return "the motion without stops is that with a large b, and `vibro-sweep grazing` says how large"
    if path == "system.stops" and isinstance(value, list) and _is_increasing_pair(value):
        lo, hi = value
        return f"write b: {(hi - lo) / 2:g} and offset: {(hi + lo) / 2:g}, with stops: both"
    if path == "system.stops" and isinstance(value, (Mapping, list)):
        sides = [side for side in ("left", "right") if side in list(value)]
        which = sides[0] if len(sides) == 1 else "both"
        return f"write stops: {which}; where the stops stand is said by b"
    if path == "start.box":
        return "write box: {x1: [-1, 1]}"
    if path.startswith("start.box."):
        return f"write {key}: [-1, 1]"
    if path == "continue.observe":
        return f"write observe: [{', '.join(ALONG_BRANCHES)}]"
    if path == "sweep":
        name = value if isinstance(value, str) else next(iter(value), "b") if isinstance(value, list) else "b"
        return f"write sweep: {{{name if str(name).isidentifier() else 'b'}: {AXIS}}}"
    if path.startswith("sweep.") and key == "values":
        return f"write values: [{value}]" if isinstance(value, (int, float)) else "write values: [6.5, 6.6, 6.7]"
    if path.startswith("sweep."):
        return _axis(key, value)
    if path.startswith("continue.parameter."):
        ends = list(value.values()) if isinstance(value, Mapping) else []
        return f"write {key}: [{', '.join(map(str, ends)) if len(ends) == 2 else '3.0, 4.5'}]"
    if path == "section":
        return f"write section: {{kind: {value if value in ('phase', 'impact') else 'phase'}}}"
    if path == "orbit":
        return "write orbit: {transient: 1000, record: 200}"
    return "write trajectory: {periods: 4, samples: 400}" if path == "trajectory" else None


def _is_increasing_pair(value: list) -> bool:
    return len(value) == 2 and all(number_of(number) is not None for number in value) and value[0] < value[1]


def of_list(path: str, value: object) -> str | None:
    """The hint for a list where a number of `system` belongs, or a number where a list does; None for another value."""
    place, _, key = path.partition(".")
    if place != "system":
        return None
    if key in MATRICES and number_of(value) is not None:
        return f"write {key}: [[{value}]], a list of lists"
    if key == "omega" and isinstance(value, list):
        return "the force has one frequency; values that vary stand in sweep"
    if key.startswith("contact_normal[") and isinstance(value, list):
        return "there is one contact, whose contact_normal is a list of numbers; several are not computed"
    if key == "stop_at" and isinstance(value, list):
        return (
            f"a contact between two masses is stop_between: {value}; of the type linear it has contact_normal: "
            "[..., -1, 1, ...]"
        )
    return None


def _start(value: object) -> str:
    if isinstance(value, list) and len(value) == 4:
        state = dict(zip(("x1", "v1", "x2", "v2"), value, strict=True))
        return f"write start: {{{', '.join(f'{name}: {value}' for name, value in state.items())}}}"
    if isinstance(value, str) and value.lower() in ("rest", "zero", "origin", "0"):
        return "write start: {x1: 0, v1: 0, x2: 0, v2: 0}, or leave it out, which is the same"
    forms = {"random": "{random: 16, seed: 1}", "follow": "{follow: up}"}
    return (
        f"write start: {forms.get(str(value), '{x1: 0, v1: 0, x2: 0, v2: 0}, {random: 16, seed: 1} or {follow: up}')}"
    )


def _axis(key: str, value: object) -> str | None:
    if isinstance(value, list) and value and all(isinstance(entry, (int, float)) for entry in value):
        whole = f"{{values: [{', '.join(map(str, value))}]}}" if len(value) < 7 else "{values: [...]}"
        if len(value) == 3 and is_number_of_values(*value):
            return f"write {key}: {{start: {value[0]}, stop: {value[1]}, num: {value[2]}}}; three values are {whole}"
        between = f", or {{start: {value[0]}, stop: {value[1]}, num: 101}}" if len(value) == 2 else ""
        return f"write {key}: {whole}{between}"
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return f"a number that does not vary stands in system; else write {key}: {AXIS}"
    return f"write {key}: {AXIS}"


def is_number_of_values(first: object, last: object, num: object) -> bool:
    """Whether the third of three numbers says how many values are meant: whole, above 2, and not one that goes on with
    the first two."""
    low, high, count = (number_of(value) for value in (first, last, num))
    whole = isinstance(num, (int, np.integer)) and not isinstance(num, bool)
    return bool(whole and None not in (low, high) and count > 2 and not min(low, high) <= count <= max(low, high))


def of_physical(key: str, system: object) -> str | None:
    """Why a physical quantity cannot be swept, and what can in its place; None for another key."""
    numbers = system.get("physical") if isinstance(system, Mapping) else None
    other = isinstance(system, Mapping) and system.get("type", DEFAULT) != DEFAULT
    if key not in PHYSICAL or other:
        return None
    scale = _scales(numbers).get(key) if isinstance(numbers, Mapping) else None
    if scale is not None:
        name, formula, factor = scale
        return f"nondimensional numbers are swept: write {name} = {formula} = {factor:.10g} {key}, and its values"
    return f"nondimensional numbers are swept: {NONDIMENSIONAL}"


CYCLES_ARE = "cycles per unit of time, Hz where that is the second"
HERTZ = ("f", "freq", "hz")


def of_frequency(key: str, value: object) -> str | None:
    """The hint for a frequency among physical quantities; None for another key."""
    hertz = number_of(value) if key.lower() in HERTZ and key != "F" else None
    if hertz is None:
        return None
    return f"if it is in Hz write Omega: {2 * math.pi * hertz:.10g}, which is 2 pi times as much"


def of_swept_frequency(key: str, value: object, system: object) -> str | None:
    """The hint for a sweep in Hz of a system in physical units; None for another key or system."""
    if not isinstance(system, Mapping) or key.lower() not in HERTZ or key == "F":
        return None
    if not isinstance(numbers := system.get("physical"), Mapping):
        return None if system.get("units") is None else f"write {CYCLES.name}, in {CYCLES_ARE}"
    unit = _scales(numbers).get("Omega", (None, None, None))[2]
    if not unit:
        return None
    counted = "in rad/s" if unit == 1 else f"here in units of {1 / unit:.6g} rad/s"
    first = number_of(value.get("start")) if isinstance(value, Mapping) else None
    hertz = 20.0 if first is None or not math.isfinite(first) else first
    return f"omega is swept, {counted}: {hertz:g} Hz is omega = {2 * math.pi * unit * hertz:.6g}"


ONE_MASS = "one mass is one_mass, or a chain of one, as `vibro-sweep new one_mass_si` writes it"


def of_damping(key: str, keys: Iterable[str]) -> str | None:
    """The hint for a damping ratio in a model of dampers, or the reverse; None for another key or model."""
    if key in ("c", "C", "damper") and {"m", "k", "zeta"} <= {*keys}:
        return "the damper is 2 zeta: write half the coefficient as zeta"
    if key not in ("zeta", "xi", "damping_ratio", "Q") or "c" not in keys:
        return None
    return "a damper is c = 2 zeta sqrt(k m); the type linear has modal_damping, a ratio for each mode"


def model_meant(system: Mapping[str, Any]) -> str | None:
    """The model whose keys these are, where some are none of the default's; None where there is no such, or several."""
    if "type" in system or "physical" in system:
        return None
    known = {name: {x.name for x in (*model.numbers, *model.options, *OTHER_WORDS)} for name, model in MODELS.items()}
    keys = set(map(str, system))
    needed = {
        name: {x.name for x in model.numbers if x.default is None and not x.optional and x.each}
        | {x.name for x in model.options if x.default is None and not x.optional}
        for name, model in MODELS.items()
    }
    fitting = [name for name in MODELS if keys <= known[name] and needed[name] <= keys]
    return fitting[0] if len(fitting) == 1 and not keys <= known[DEFAULT] else None


def has_words(value: object) -> bool:
    """Whether the values of a sweep are no numbers."""
    values = value.get("values") if isinstance(value, Mapping) else value
    return isinstance(values, list) and any(isinstance(entry, str) and not number_in_text(entry) for entry in values)


def _scales(numbers: Mapping[str, Any]) -> dict[str, tuple[str, str, float]]:
    try:
        frequency = math.sqrt(numbers["M1"] / numbers["K1"])
        length = numbers["K1"] / (numbers["P1"] + numbers["P2"])
    except (KeyError, TypeError, ValueError, ArithmeticError):
        return {}
    return {
        "Omega": ("omega", "Omega sqrt(M1/K1)", frequency),
        "B": ("b", "B K1/(P1 + P2)", length),
        "B0": ("offset", "B0 K1/(P1 + P2)", length),
    }
