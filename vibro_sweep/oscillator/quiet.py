"""Where a motion without contact exists along one number of an oscillator: its amplitude leaves room at every stop."""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.checks.arguments import checked_word, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.real import array_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.oscillator.checked_numbers import range_of
from vibro_sweep.oscillator.family import Family, stack_of
from vibro_sweep.oscillator.linear import Linear, roots
from vibro_sweep.oscillator.oscillator import Oscillator, checked_system
from vibro_sweep.oscillator.stacks import dot
from vibro_sweep.oscillator.steady import gap_responses, static_states, steady_amplitudes

VALUES = 2001  # of the number, between which the sign of the room changes once at most
BEYOND = 100.0  # times the bounds: so far a motion without contact is looked for outside of them
FINER = 65  # values between two of these, at each closer look
LOOKS = 4  # at a turning point of the room, near which it differs by the square of the distance
TINY = 1e-13  # part of its size below which the real part of a root is rounding


class Quiet(NamedTuple):
    """The values of a number at which a motion of period T without contact exists.

    ranges : of them within the bounds, rising
    below, above : the nearest such values up to the lower bound and from the upper one on; NaN where there is none as
        far as a hundred times them
    attracts : whether motions without contact fade towards it; without damping none does

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> [(round(lo, 6), round(hi, 6)) for lo, hi in vs.quiet(system, "b", (4, 7)).ranges]
    [(6.705717, 7.0)]
    """

    ranges: list[tuple[float, float]]
    below: float
    above: float
    attracts: bool


@names_its_arguments
def quiet(system: Oscillator, parameter: str, bounds: tuple[float, float]) -> Quiet:
    """Where a motion without contact exists while `parameter`, a number of the system, runs through bounds = (lo, hi).

    A `Quiet`: `ranges` of such values within the bounds; `below` and `above`, the nearest ones up to the lower bound
    and from the upper one on, or NaN; and whether such a motion `attracts` others.

    Raises ValueError for a name that is not a number of the system, and for bounds that are none.

    Examples
    --------
    A lever beside a stop, shaken by a force: it is quiet from 19.5 Hz on.

    >>> import vibro_sweep as vs
    >>> lever = vs.Oscillator(
    ...     2.4, 9500, 3, force=40, frequency=10, stop_right=1.5e-3, contact_normal=1, k_stop=1.8e5, c_stop=45
    ... )
    >>> found = vs.quiet(lever, "frequency", (5, 15))
    >>> found.ranges, round(found.above, 2)
    ([], 19.54)
    """
    checked_system(system)
    family = system.family
    parameter = checked_word("parameter", parameter, list(family.free))
    ends = array_of(bounds, 1)
    if ends is None or ends.shape != (2,) or not (np.isfinite(ends).all() and ends[0] < ends[1]):
        raise ArgumentError(not_allowed("bounds", bounds, "(lo, hi), lo < hi"))
    lo, hi = ends.tolist()
    allowed = range_of(system.described[parameter], system.options.get("stops", "both"))
    if not allowed.holds(np.array([lo, hi])).all():
        raise ArgumentError(f"bounds: {bounds!r} is not allowed; {parameter} must be {allowed.text}")
    inside = _ranges(family, parameter, np.linspace(lo, hi, VALUES))
    below = above = math.nan
    if lo > 0:
        lower = _ranges(family, parameter, np.geomspace(lo / BEYOND, lo, VALUES))
        upper = _ranges(family, parameter, np.geomspace(hi, hi * BEYOND, VALUES))
        below = lower[-1][1] if lower else math.nan
        above = upper[0][0] if upper else math.nan
    rates = roots(system.linear)
    return Quiet(inside, below, above, bool((rates.real < -TINY * np.abs(rates)).all()))


def free_motion(q: Linear) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of a stack of oscillators the middle of the free motion of the gap, its amplitude, and the room that it leaves
    before the nearest stop; NaN where there is no such motion."""
    middle, size = dot(q.contact.normal, static_states(q)), np.abs(gap_responses(q, steady_amplitudes(q)))
    room = np.minimum(np.asarray(q.contact.high) - middle, middle - np.asarray(q.contact.low)) - size
    return middle, size, room


def _ranges(family: Family, name: str, values: np.ndarray) -> list[tuple[float, float]]:
    """The ranges between the first and the last of these values in which there is room."""

    def room(value) -> np.ndarray:
        at = np.atleast_1d(np.asarray(value, float))
        left = free_motion(stack_of(family, at.shape, {name: at}))[2]
        return np.where(np.isnan(left), -np.inf, left)

    def finer(low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
        at = np.linspace(low, high, FINER)
        return at, room(at)

    known = room(values)
    middle, before, after = known[1:-1], known[:-2], known[2:]
    down, up = (
        (middle < before) & (middle <= after) & (middle > 0),
        (middle > before) & (middle >= after) & (middle < 0),
    )
    more = []
    for i in np.flatnonzero(down | up).tolist():  # between two values the room may vanish, or be there, for a moment
        sign, low, high = (1.0 if down[i] else -1.0), values[i], values[i + 2]
        for _ in range(LOOKS):
            at, left = finer(low, high)
            least = int(np.argmin(sign * left))
            low, high = at[max(least - 1, 0)], at[min(least + 1, FINER - 1)]
        more += [at[least]] if sign * left[least] < 0 else []
    values = np.unique(np.append(values, more))
    is_open, ends = room(values) >= 0, []
    for i in np.flatnonzero(is_open[1:] != is_open[:-1]):
        low, high = values[i], values[i + 1]
        while True:
            at, left = finer(low, high)
            after_change = max(int(np.argmax((left >= 0) != is_open[i])), 1)
            if not at[after_change] - at[after_change - 1] < high - low:
                break
            low, high = at[after_change - 1], at[after_change]
        ends.append(float(low if is_open[i] else high))
    ends = [*([float(values[0])] if is_open[0] else []), *ends, *([float(values[-1])] if is_open[-1] else [])]
    return list(zip(ends[::2], ends[1::2], strict=True))
