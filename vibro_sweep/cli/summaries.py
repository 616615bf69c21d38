"""What commands print of their results."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.oscillator.contact_laws import LAWS
from vibro_sweep.oscillator.contact_laws.contact_law import ContactLaw
from vibro_sweep.oscillator.grazing import Grazing, grazing
from vibro_sweep.oscillator.linear import static_state
from vibro_sweep.oscillator.models import MODELS
from vibro_sweep.oscillator.models.declaration import Model, Option
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.oscillator.quiet import quiet
from vibro_sweep.tables.coordinates import state as names
from vibro_sweep.tables.outcomes import STATUSES
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY
from vibro_sweep.tables.quantity import Parameter
from vibro_sweep.tables.units import AS_STORED, Display, display_of, names_of, shown_unit, unit_in, unit_text

if TYPE_CHECKING:
    from vibro_sweep.driver.cost import Estimate
    from vibro_sweep.driver.sweep import RunReport
    from vibro_sweep.scene import Continuation, Scene


def grazing_of(scene: "Scene | Continuation", display: Display | None = None) -> str:
    """The output of `grazing`: of a sweep of one number on which the graze depends the curve; of one also where the gap
    is just filled. display : the units of lengths and of the swept number; None: those that the scene says"""
    from vibro_sweep.scene import Scene
    from vibro_sweep.scene.resolved_numbers import depends_on

    along, system = depends_on(scene) if isinstance(scene, Scene) else (), scene.system
    if display is None:
        display = display_of(getattr(scene, "picture_units", ())) or AS_STORED
    if display.units and system.units is None:
        raise ArgumentError(not_allowed("--units", names_of(display), "left out: the system has no units"))
    if len(along) == 1:
        return _grazing_curve(system, along[0], scene.sweep[along[0]], display)
    lines = [grazing_text(grazing(system), system, display)]
    if along:
        first = ", ".join(f"{key} = {getattr(system, key)!r}" for key in along)
        lines.insert(0, f"at the first point of the sweep: {first}")
    return "\n".join(lines)


def _grazing_curve(system: Oscillator, key: str, values: np.ndarray, display: Display) -> str:
    """A line for each value of a swept number; above them where the gap is just filled."""
    touches = [grazing(system.replace(**{key: value})) for value in values.tolist()]
    alike = all(touch.b_right == touch.b_left for touch in touches)
    name = CYCLES.name if display.in_cycles and key == FREQUENCY.name else key
    units = [unit_in(system.described[key].units, system.units), unit_in("m", system.units)]
    (of_key, key_unit), (of_size, size_unit) = (display.of(unit) for unit in units)
    lines = []
    if values.min() < values.max():
        found = quiet(system, key, (float(values.min()), float(values.max())))
        ends = {end * of_key for pair in found.ranges for end in pair if values.min() < end < values.max()}
        filled = ", ".join(f"{end:.12g}" for end in sorted(ends)) or "nowhere here"
        lines.append(f"# the gap is just filled at {name}{shown_unit(key_unit)} = {filled}")
    size = shown_unit(size_unit)
    lines.append(f"# {name}{shown_unit(key_unit)} {f'b*{size}' if alike else f'b_right{size} b_left{size}'} tau*")
    for value, touch in zip(values.tolist(), touches, strict=True):
        sizes = [touch.b] if alike else [touch.b_right, touch.b_left]
        lines.append(" ".join(map(repr, [value * of_key, *(b * of_size for b in sizes), touch.tau])))
    return "\n".join(lines)


def grazing_text(touch: Grazing, system: Oscillator, display: Display = AS_STORED) -> str:
    """The text of Theorem 1 that `grazing` prints, with the stops that there are."""
    factor, unit = display.of(unit_in("m", system.units))
    unit = f" {unit_text(unit)}" if unit_text(unit) else ""
    stops = system.options.get("stops", "both")
    alike = touch.b_right == touch.b_left
    if alike:
        lines = [f"b*    = {touch.b * factor!r}{unit}"]
    else:
        both = {"right": ("right",), "left": ("left",)}.get(stops, ("right", "left"))
        lines = [f"b at the {side} stop = {getattr(touch, f'b_{side}') * factor!r}{unit}" for side in both]
    state = np.array(touch.state)
    if stops == "left":  # half a period later, the motion is mirrored about its middle
        rest = static_state(system.linear)
        state = -state if rest is None or not rest.any() else 2 * np.stack([rest, 0 * rest], -1).ravel() - state
    where = {"right": "   (right stop, t = 0)", "left": "   (left stop, t = T/2)"}.get(stops, "   (right stop, t = 0)")
    where = "   (right stop; left stop: its negative)" if stops == "both" and alike else where
    values = zip(names(system.masses), state.tolist(), strict=True)
    named = ", ".join(f"{name}: {0 if value == 0 else value!r}" for name, value in values)
    holds = "holds" if touch.satisfied or (not alike and touch.determinant) else "does not hold"
    lines += [f"tau*  = {touch.tau!r}", f"state = {named}{where}"]
    return "\n".join([*lines, f"the existence condition (19) {holds}; determinant (15): {touch.determinant:.6g}"])


def cost_text(cost: "Estimate") -> str:
    """The cost of a scene as `check` prints it."""
    from vibro_sweep.driver.cost import duration

    compiled = (
        f"\n  compiled  in {duration(cost.compiling)} just now, once: no run needs it again" if cost.compiling else ""
    )
    longer = f"; up to {duration(cost.most)} if all orbits go on as far as `settle`" * (cost.most > cost.seconds)
    return (
        f"  file      {points(cost.orbits)}, {size_of(cost.bytes)}\n"
        f"  work      {cost.orbits:,} orbits, {cost.periods:,} forcing periods in all\n"
        f"  time      about {duration(cost.seconds)} here{longer}{compiled}"
    )


def model_list() -> str:
    """The output of `models`: a line for each model, and for each law of contact that its stops may have."""
    models = [f"{name:<16} {model.title}" for name, model in MODELS.items()]
    laws = [f"{name:<16} {law.title}: {', '.join(law.names['right'])}" for name, law in LAWS.items()]
    return "\n".join([*models, "", "stops, of every model:", *laws])


def law_text(law: ContactLaw) -> str:
    """The output of `models NAME` for a law of contact: its equation, numbers with their ranges, words and source."""
    rows = [(declared.name, declared.range.text, declared.text) for declared in law.numbers_of_both]
    rows += [
        (declared.name, " or ".join(declared.words), f"{declared.text} [{declared.words[0]}]")
        for declared in law.options
    ]
    wide = [max(len(row[column]) for row in rows) for column in (0, 1)]
    lines = [f"  {name:<{wide[0]}}  {allowed:<{wide[1]}}  {text}" for name, allowed, text in rows]
    return "\n".join(
        [f"{law.name} stop: {law.title}", "", f"    {law.equations}", "", *lines, "", f"source: {law.source}"]
    )


def model_text(model: Model) -> str:
    """The output of `models NAME`: equations, sketch, numbers with their ranges, options, source."""
    numbers = [(declared.name, declared.range.text, declared) for declared in model.numbers]
    options = [(declared.name, _allowed(declared), declared) for declared in model.options]
    wide = [max(len(row[column]) for row in numbers + options) for column in (0, 1)]
    rows = [
        f"  {name:<{wide[0]}}  {allowed:<{wide[1]}}  {declared.text}{_each(declared)}{_default(declared)}"
        for name, allowed, declared in numbers + options
    ]
    sketch, equations = model.sketch.strip("\n"), model.equations.strip("\n")
    return "\n".join(
        [f"{model.name}: {model.title}", "", sketch, "", equations, "", *rows, "", f"source: {model.source}"]
    )


def _allowed(declared: Option) -> str:
    kinds = {
        "whole": "a whole number",
        "pair": "two whole numbers",
        "matrix": "a matrix",
        "vector": "a list of numbers",
    }
    kinds["units"] = "SI, or three names or numbers"
    return kinds.get(declared.kind) or " or ".join(str(word).lower() for word in declared.words)


def _each(declared: Parameter | Option) -> str:
    each = getattr(declared, "each", "")
    return f"; a list, one for each {each}" if each else ""


def _default(declared: Parameter | Option) -> str:
    if declared.default is None:
        return ""
    return f" [{str(declared.default).lower() if isinstance(declared.default, bool) else declared.default}]"


def advice_on(scene: "Scene") -> str:
    """What a scene asks for in vain, and what it may mean; "" where there is no such thing."""
    sides = {"right": [1], "left": [-1]}.get(scene.system.options.get("stops", "both"), [1, -1])
    soft = scene.system.linear.contact.is_compliant(sides).all() and "contacts" not in scene.observe
    return (
        "impacts are those on rigid stops: observe contacts with these" if soft and "impacts" in scene.observe else ""
    )


TO_SETTLE = "`orbit: settle`, or a longer record, may tell"


def summary(output: Path, report: "RunReport", settle: int | None = None) -> str:
    """The summary that `run` prints at its end. settle : periods that the scene allows for that, if any"""
    from vibro_sweep.driver.cost import duration

    unsettled = report.statuses.get("not_settled", 0)
    bad = {name: count for name, count in report.statuses.items() if name not in ("ok", "not_settled") and count}
    named = ", ".join(f"{name} {count}" for name, count in bad.items())
    state = f"{report.bad} with a bad status ({named})" if report.bad else "none failed" if unsettled else "all ok"
    if unsettled:
        longer = f"`info` says how far from it; {settle:,} periods of `settle` were too few" if settle else TO_SETTLE
        state += f"; {unsettled:,} not settled yet: {longer}"
    if not report.computed:
        return f"{output} is complete already, from the same scene: {points(report.points)}, {state}"
    advice = [f"\n{outcome.name}: {outcome.advice}" for outcome in STATUSES if outcome.name in bad]
    here = "" if report.computed == report.points else f"{report.computed:,} of "
    return f"{output}: {here}{points(report.points)} in {duration(report.seconds)}, {state}{''.join(advice)}"


def points(count: int) -> str:
    return f"{count:,} point" + "s" * (count != 1)


def size_of(size: float) -> str:
    for unit in ("B", "kB", "MB"):
        if size < 1000:
            return f"{size:.3g} {unit}"
        size /= 1000
    return f"{size:.3g} GB"
