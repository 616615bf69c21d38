"""What a scene describes, in a few lines: how the machine moves alone, what is swept, whether it touches its stops."""

import math
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.oscillator.function_model import BUILD, FunctionModel
from vibro_sweep.oscillator.grid import linears
from vibro_sweep.oscillator.linear import Linear, mapped, roots, selected
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.oscillator.quiet import Quiet, free_motion, quiet
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.scene import parse_scene
from vibro_sweep.tables.exponents import ARRIVED
from vibro_sweep.tables.outcomes import is_valid
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY
from vibro_sweep.tables.units import AS_STORED, Display, display_of, range_text, unit_in

if TYPE_CHECKING:
    from vibro_sweep.scene import Continuation, Scene

FEW = 4  # modes that are named
PLACES = 10_000  # values of the swept number, or points of two, at which the free motion is looked at
DENSE = 2001  # the same along branches
FINER = 3  # times that a peak of it is looked at more closely, at so many values:
BESIDE = 400
COUNTS = ("impacts_right", "impacts_left", "contacts_right", "contacts_left")
FREE = 1e-8  # of the fastest mode: a slower one is free


def description(scene: "Scene | Continuation") -> list[str]:
    """At most six lines."""
    system = scene.system
    display = display_of(getattr(scene, "picture_units", ())) or AS_STORED
    axes = _axes(scene)
    q = linears(system, axes)
    lines = [_modes(system, q), _force(system, q), _motion(system, q, display)]
    if len(axes) == 1 and not isinstance(system, FunctionModel):
        ((key, values),) = axes.items()
        bounds = float(values[0]), float(values[-1])
        lines += (
            [quiet_text(quiet(system, key, bounds), system, key, bounds, display)] if values[0] < values[-1] else []
        )
    if (transient := getattr(scene, "transient", None)) is not None:
        lines.append(_settling(q, max(transient, scene.settle or 0)))
    return [f"  {'' if i else 'machine':<10}{line}" for i, line in enumerate(lines)]


def _axes(scene: "Scene | Continuation") -> dict[str, np.ndarray]:
    """Values of what changes, rising: those of a sweep, or some of them; all along a branch, most where the free motion
    is largest."""
    system = scene.system
    if ends := getattr(scene, "parameter", {}):
        axes = {
            key: np.linspace(*bounds, DENSE if len(ends) == 1 else math.isqrt(PLACES)) for key, bounds in ends.items()
        }
        for key in axes if len(axes) == 1 else ():
            for _ in range(FINER):
                _, size, _ = free_motion(linears(system, axes))
                peak, values = int(np.argmax(np.nan_to_num(size, nan=0.0))), axes[key]
                beside = values[max(peak - 1, 0)], values[min(peak + 1, len(values) - 1)]
                axes[key] = np.union1d(values, np.linspace(*beside, BESIDE))
        return axes
    axes = {key: np.sort(values) for key, values in scene.sweep.items() if key in system.described}
    return {key: _some(values, len(axes)) for key, values in axes.items()}


def _some(values: np.ndarray, axes: int) -> np.ndarray:
    """Values of an axis, spread evenly, both ends among them."""
    count = min(len(values), PLACES if axes == 1 else math.isqrt(PLACES))
    return values[np.unique(np.linspace(0, len(values) - 1, count).round().astype(int))]


def _frequencies(low: float, high: float, system: Oscillator) -> str:
    """Angular frequencies; of a system with units in Hz."""
    if system.units is None:
        return range_text(low, high, "1")
    return range_text(low / (2 * math.pi), high / (2 * math.pi), unit_in("Hz", system.units))


def _modes(system: Oscillator, q: Linear) -> str:
    """Natural frequencies and damping ratios, of the modes of the motion without damping."""
    with np.errstate(all="ignore"):  # of numbers at the ends of the floats
        size = 1 / np.sqrt(np.einsum("...ii->...i", q.M))
        root = np.linalg.cholesky(q.M * size[..., :, None] * size[..., None, :])
        inverse = np.linalg.inv(root) * size[..., None, :]
        turned = np.swapaxes(inverse, -1, -2)
        squares, shapes = np.linalg.eigh(inverse @ q.K @ turned)
        omega = np.sqrt(np.maximum(squares, 0))
        ratios = np.einsum("...ij,...ik,...kj->...j", shapes, inverse @ q.C @ turned, shapes) / (2 * omega)
        omega, ratios = (values.reshape(-1, system.masses) for values in (omega, ratios))
        free = (omega <= FREE * omega.max(axis=1, keepdims=True)).any(axis=0)
    sprung = np.flatnonzero(~free)
    ends = [(values[:, i].min(), values[:, i].max()) for values in (omega, ratios) for i in sprung[:FEW]]
    half, more = len(ends) // 2, f" and {len(sprung) - FEW} more" if len(sprung) > FEW else ""
    named = ", ".join(_frequencies(low, high, system) for low, high in ends[:half])
    damping = ", ".join(f"{low:.3g}" if low == high else f"{low:.3g} to {high:.3g}" for low, high in ends[half:])
    many, angular = "s" * (len(sprung) > 1), " (as omega)" if system.units is None else ""
    of_modes = "natural frequencies" if many else "natural frequency"
    parts = [f"{of_modes} {named}{more}{angular}; damping ratio{many} {damping}{more}"] if len(sprung) else []
    count = int(free.sum())
    parts += [f"{count} mode{'s' * (count > 1)} without a spring"] if count else []
    return "; ".join(parts)


def _force(system: Oscillator, q: Linear) -> str:
    """The frequency of the force, or its range."""
    low, high = float(np.min(q.omega)), float(np.max(q.omega))
    if system.units is None:
        return f"force at omega = {range_text(low, high, '1')}"
    angular = range_text(low, high, unit_in(FREQUENCY.units, system.units))
    return f"force at {_frequencies(low, high, system)}, omega = {angular}"


def _motion(system: Oscillator, q: Linear, display: Display) -> str:
    """How far the free motion reaches beside the room that it has."""
    middle, size, room = (np.ravel(values) for values in free_motion(q))
    known = np.isfinite(size)
    if not known.any():
        return "no free motion of period T: undamped resonance, or a force that no spring holds"
    unit = unit_in("m", system.units)

    def text(values: np.ndarray) -> str:
        return range_text(float(values[known].min()), float(values[known].max()), unit, display)

    gap = np.minimum(np.ravel(q.contact.high) - middle, middle - np.ravel(q.contact.low))
    about = f" about {text(middle)}" if np.any(middle[known]) else ""
    touched = room[known] < 0
    some = "touched at some of these values"
    which = "never touched" if not touched.any() else "always touched" if touched.all() else some
    return f"free motion {text(size)}{about}, gap {text(gap)}: {which}"


def quiet_text(
    found: Quiet, system: Oscillator, key: str, bounds: tuple[float, float], display: Display = AS_STORED
) -> str:
    """Where there is a motion without contact, in words."""
    unit = unit_in(system.described[key].units, system.units)
    name = CYCLES.name if display.in_cycles and key == FREQUENCY.name else key

    def text(low: float, high: float) -> str:
        return range_text(low, high, unit, display)

    if not found.ranges:
        where = f"nowhere in {text(*bounds)}"
        where += f"; up to {text(found.below, found.below)}" if found.below == found.below else ""
        where += f"; from {text(found.above, found.above)} on" if found.above == found.above else ""
    elif found.ranges == [bounds]:
        where = "everywhere"
    else:
        where = f"{name} = " + " and ".join(text(lo, hi) for lo, hi in found.ranges)
    return f"without contact: {where}" + ("" if found.attracts else "; nothing fades to it, for want of damping")


def quiet_line(sweep: Sweep) -> list[str]:
    """The line on where a sweep over one number of its machine is without contact, and how many orbits are there."""
    if len(sweep.keys) != 1:
        return []
    key = sweep.keys[0]
    if sweep.attrs.get("type") == BUILD or sweep.attrs.get("dynamics", "flow") != "flow":
        return []
    system = parse_scene(sweep.data.attrs["scene"]).system
    values = sweep.data[key].values.astype(float) if key in system.described else np.zeros(1)
    if values.min() == values.max():
        return []
    bounds = float(values.min()), float(values.max())
    found = quiet(system, key, bounds)
    line = f"quiet        {quiet_text(found, system, key, bounds, sweep.display)}"
    counts = [name for name in COUNTS if name in sweep]
    if found.ranges and counts:
        there = np.any([(lo <= values) & (values <= hi) for lo, hi in found.ranges], axis=0)
        struck = np.array([sweep.values(name)[there] for name in counts])
        valid = is_valid(sweep.values("status")[there])
        still = int((valid & (struck == 0).all(axis=0)).sum())
        line += f"; there {still:,} of {int(valid.sum()):,} orbits move so"
    return [line]


def _settling(q: Linear, transient: int) -> str:
    """How many forcing periods the slowest mode needs, and how many there are."""
    flat = _each(q)
    rates = [roots(one) for one in flat]
    slowest = min(float(-rate.real.max() * 2 * math.pi / one.omega) for rate, one in zip(rates, flat, strict=True))
    if np.isnan(rates).any():
        return "the modes are beyond the range of the floats"
    if slowest <= FREE:
        return f"without contact nothing settles: a mode has no damping; transient {transient:,}"
    needed = math.log(1 / ARRIVED) / slowest
    return f"the slowest mode settles in {float(f'{needed:.2g}'):,.0f} forcing periods; transient {transient:,}"


def _each(q: Linear) -> list[Linear]:
    """The first and the last oscillator of a stack, and that in the middle."""
    shape = np.shape(q.omega)
    count = math.prod(shape)
    flat = mapped(lambda name, x: None if x is None else np.reshape(x, (count, *np.shape(x)[len(shape) :])), q)
    return [selected(flat, i) for i in sorted({0, count // 2, count - 1})]
