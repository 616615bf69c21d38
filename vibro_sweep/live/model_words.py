"""What the page shows of an oscillator: its numbers with ranges for their sliders, and what can be looked at."""

import sys
from typing import Any

import numpy as np

from vibro_sweep.live.requests import View
from vibro_sweep.live.views import SPEEDS, by_cycles, display_of_scene, heights
from vibro_sweep.oscillator.catalogue import BY_NAME
from vibro_sweep.oscillator.checked_numbers import range_of
from vibro_sweep.oscillator.contact_laws.compliant import LAW as COMPLIANT
from vibro_sweep.oscillator.models import MODELS
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.oscillator.stops import stop_of
from vibro_sweep.plotting.style import (
    ARROWS,
    BRANCHES,
    CHAOS,
    EXPONENTS,
    LONGER,
    LONGEST,
    NO_PERIOD,
    PERIODS,
    density_colours,
)
from vibro_sweep.scene import Scene
from vibro_sweep.tables.exponents import CERTAIN
from vibro_sweep.tables.outcomes import NOT_COMPUTED, NOT_SETTLED, STATUSES
from vibro_sweep.tables.parameters import CLEARANCE, CYCLES, FREQUENCY
from vibro_sweep.tables.quantity import NUMBER, POSITIVE, Parameter
from vibro_sweep.tables.units import Display, unit_in, unit_text, written_unit

DECADE = 10.0
WHOLE = 1.0  # of a range up to this a slider has all, as of R
LARGEST = sys.float_info.max
STIFFNESSES = {names[0] for names in COMPLIANT.names.values()}  # of stops: over decades, though one may be 0
_GREEK = {
    r"\mu": "μ", r"\zeta": "ζ", r"\omega": "ω", r"\tau": "τ", r"\epsilon": "ε", r"\bar f": "f̄", r"\tilde f": "f̃",
}  # fmt: skip
_UPRIGHT = r"\mathrm"
_BELOW = str.maketrans("0123456789cmk", "₀₁₂₃₄₅₆₇₈₉cmₖ")


def model_words(scene: Scene, view: View) -> dict[str, Any]:
    """All that a page needs to know of an oscillator, or of its mapping."""
    system = scene.system
    stops = system.options.get("stops", "both")
    other = FREQUENCY.name if by_cycles(view) else CYCLES.name  # of which one stands in place of the other
    display = display_of_scene(scene)
    numbers = [
        _slider(quantity, value, view, system, system.numbers.get(name, value) is None)
        | _shown(quantity.units, system, display.angular if name == FREQUENCY.name else display)
        for name, quantity in system.described.items()
        if name != other
        and isinstance(value := _value(system, view, quantity), (int, float))
        and not (name.endswith("_left") and stops != "both")
        and not (scene.dynamics == "map" and name.startswith(("offset", "R_left", "constant", "tau")))
    ]
    return {
        "numbers": numbers,
        "mapping": not system.linear.compliant,
        "heights": [[name, _label(name)] for name in heights(scene)],
        "units": {name: _shown(unit, system, display) for name, unit in _declared(scene).items()},
        "title": MODELS[system.model.name].title if system.model.name in MODELS else system.model.name,
        "stops": [float(stop) if np.isfinite(stop) else None for stop in system.linear.contact.stop((-1, 1))],
        "colours": _colours(),
        "statuses": {str(code): outcome.text for code, outcome in enumerate(STATUSES, NOT_COMPUTED)},
        "not_settled": NOT_SETTLED,
        "certain": CERTAIN,
    }


def _value(system: Oscillator, view: View, quantity: Parameter) -> Any:
    """What a number is; of one that is left out what it follows, or what a compliant stop has without it."""
    numbers_now = system.numbers | {CYCLES.name: system.frequency}
    if quantity.name == view.axis and isinstance(value := view.scene.system.get(quantity.name), (int, float)):
        return value  # and not the first one of the sweep
    for side in ("right", "left"):
        if quantity.name in COMPLIANT.names[side] and (stop := stop_of(numbers_now, side)).law is COMPLIANT:
            return stop.number(quantity.name.removesuffix("_left"), 0.0)
    value = numbers_now[quantity.name]
    return numbers_now[quantity.follows] if quantity.follows and value is None else value


def _slider(quantity: Parameter, value: float, view: View, system: Oscillator, left_out: bool) -> dict[str, Any]:
    """A number and the range of its slider: where its values can be at all, around the one that it has; left out, it
    follows another one."""
    allowed, least = range_of(quantity, system.options.get("stops", "both")), _least_reach(quantity, value, system)
    logarithmic = allowed.bounds == POSITIVE.bounds or (quantity.name in STIFFNESSES and value > 0)
    bounds = allowed.bounds
    if bounds.get("maximum", LARGEST) <= WHOLE:
        low, high = bounds["minimum"], bounds["maximum"]
    elif logarithmic:
        low, high = value / DECADE, value * DECADE
    elif "minimum" in bounds:
        low, high = bounds["minimum"], max(4 * value, least)
    else:
        reach = max(least, 2 * abs(value))
        low, high = value - reach, value + reach
    if quantity.name == view.axis:
        low, high, logarithmic = *view.ends, False
    words = {"name": quantity.name, "symbol": _plain(quantity.symbol), "label": quantity.label}
    words |= {"text": quantity.text, "value": value}
    low, high = max(low, -LARGEST), min(high, LARGEST)
    words |= {"leader": quantity.follows, "follows": bool(quantity.follows) and left_out}
    return words | {"low": low, "high": high, "log": logarithmic, "allowed": (allowed or NUMBER).text}


def _least_reach(quantity: Parameter, value: float, system: Oscillator) -> float:
    """How far a slider reaches at least: 1 where there are no units; of a number with a unit that is 0 what mass, gap
    and frequency of the force make of it, as a force m b omega^2."""
    powers, q = written_unit(quantity.units).powers, system.linear
    if not powers or system.units is None:
        return 1.0
    sizes = {"kg": np.abs(q.M).max(), "m": abs(system.numbers.get(CLEARANCE.name) or 1.0), "s": 1 / q.omega}
    with np.errstate(all="ignore"):
        reach = float(np.prod([sizes[base] ** power for base, power in powers.items()]))
    return 0.0 if value else reach if 0 < reach < LARGEST else 1.0


def _declared(scene: Scene) -> dict[str, str]:
    """The units, in SI, of what stands on axes beside the numbers of the system."""
    speed = BY_NAME["v1"].units
    of_heights = {name: speed if name in SPEEDS else BY_NAME[name].units for name in heights(scene)}
    return of_heights | {name: BY_NAME[name].units for name in ("gap", "lyapunov")} | {"gap_velocity": speed}


def _shown(declared: str, system: Oscillator, display: Display) -> dict[str, Any]:
    """The unit of a number on the page, and the factor by which that of the system is multiplied to be in it."""
    scale, unit = display.of(unit_in(declared, system.units))
    return {"unit": unit_text(unit), "scale": scale}


def _label(name: str) -> str:
    if name in SPEEDS:
        return f"impact speed at the {SPEEDS[name]} stop"
    return f"{BY_NAME[name].label}"


def _plain(symbol: str) -> str:
    """A symbol of TeX in letters."""
    for word, letter in _GREEK.items():
        symbol = symbol.replace(word, letter)
    head, _, below = symbol.replace("{}", "").replace("{", "").replace("}", "").partition("_")
    return f"{head} {below.removeprefix(_UPRIGHT)}" if below.startswith(_UPRIGHT) else head + below.translate(_BELOW)


def _colours() -> dict[str, Any]:
    """Those of the pictures."""
    table = (255 * density_colours()(np.arange(256))[:, :3]).astype(int)
    return {
        "density": table.ravel().tolist(),
        "exponents": list(EXPONENTS),
        "exponents_dark": ["#ff7a85", "#6ab4f4", "#a9a9ff", "#e0a030"],
        "branches": [[ARROWS[way], colour] for way, colour in BRANCHES.items()],
        "chaos": CHAOS,
        "periods": list(PERIODS[:LONGEST]),
        "longer": LONGER,
        "no_period": NO_PERIOD,
    }
