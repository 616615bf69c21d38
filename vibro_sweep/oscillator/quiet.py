"""Where a motion without contact exists along one number of an oscillator: its amplitude leaves room at every stop."""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from vibro_sweep.checks.arguments import checked_interval, checked_word, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.real import array_of
from vibro_sweep.oscillator.checked_numbers import range_of
from vibro_sweep.oscillator.linear import Family, Linear, roots, stack_of
from vibro_sweep.oscillator.oscillator import Oscillator, checked_system
from vibro_sweep.oscillator.stacks import dot
from vibro_sweep.oscillator.steady import gap_responses, static_states, steady_amplitudes

VALUES = 2001  # of the number, between which the sign of the room changes once at most
BEYOND = 100.0  # times the bounds: so far a motion without contact is looked for outside of them
TINY = 1e-13  # relative width to which an end is known


class Quiet(NamedTuple):
    """The values of a number at which a motion of period T without contact exists.

    ranges : of them within the bounds, rising
    below, above : the nearest such values outside of the bounds; NaN where there is none as far as a hundred times them
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

    A `Quiet`: `ranges` of such values within the bounds, `below` and `above` the nearest ones outside of them, or NaN,
    and whether such a motion `attracts` others.

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
    middle = float(ends.mean()) if ends is not None and ends.shape == (2,) else family.free[parameter]
    lo, hi = checked_interval("bounds", bounds, middle)
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
    middle, size = dot(q.normal, static_states(q)), np.abs(gap_responses(q, steady_amplitudes(q)))
    room = np.minimum(np.asarray(q.high) - middle, middle - np.asarray(q.low)) - size
    return middle, size, room


def _ranges(family: Family, name: str, values: np.ndarray) -> list[tuple[float, float]]:
    """The ranges between the first and the last of these values in which there is room."""

    def room(value) -> np.ndarray:
        at = np.atleast_1d(np.asarray(value, float))
        left = free_motion(stack_of(family, at.shape, {name: at}))[2]
        return np.where(np.isnan(left), -np.inf, left)

    def of_one(value: float) -> float:
        return float(np.clip(room(value)[0], -1e300, 1e300))

    known = room(values)
    middle, before, after = known[1:-1], known[:-2], known[2:]
    turning = np.flatnonzero(
        ((middle < before) & (middle <= after) & (middle > 0)) | ((middle > before) & (middle >= after) & (middle < 0))
    )
    more = []
    for i in turning.tolist():  # between two values the room may vanish, or be there, for a moment

        def signed(value: float, sign: float = math.copysign(1.0, known[i + 1])) -> float:
            return sign * of_one(value)

        least = float(minimize_scalar(signed, bounds=(values[i], values[i + 2]), method="bounded").x)
        more += [least] if signed(least) < 0 else []
    values = np.append(values, more)
    values = np.unique(values)
    open_ = room(values) >= 0
    ends = [
        float(brentq(of_one, values[i], values[i + 1], xtol=1e-300, rtol=4 * np.finfo(float).eps))
        for i in np.flatnonzero(open_[1:] != open_[:-1])
    ]
    ends = [*([float(values[0])] if open_[0] else []), *ends, *([float(values[-1])] if open_[-1] else [])]
    return list(zip(ends[::2], ends[1::2], strict=True))
