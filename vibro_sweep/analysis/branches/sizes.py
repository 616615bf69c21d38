"""How large a change of a parameter is, in parts of what changes the oscillator as a whole, in any units."""

import math
from operator import attrgetter

import numpy as np

from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.real import number_of
from vibro_sweep.checks.refusals import not_allowed

STEPS = (0.01, 10.0)  # factors of the lengths of steps: shorter ones fill the points of a branch, longer ones fail
WIDEST = 1e12  # times the size of a number: in wider bounds steps would be rounding
LEAST = 1e-3  # of what changes the oscillator as a whole: parameters nearer to 0 are as large


def size_of(solution: Solution, name: str) -> float:
    """The parameter's own size |p|, or near 0, where that says nothing, the least."""
    return max(abs(solution.family.free[name]), least_size(solution, name))


def least_size(solution: Solution, name: str) -> float:
    """A thousandth of what changes the oscillator as a whole: M, K + omega^2 M, C + omega M, n, a force by what moves
    the gap by its size, omega, tau by 1, R by 1, or a stop by the size of the gap."""
    q, slope, gap = solution.family.linear, solution.family.derivative(name), solution.size_of_gap
    M, along, omega = (np.abs(x).max() for x in (q.M, q.contact.normal, q.omega))
    inertia = omega**2 * M
    parts = {
        "M": M,
        "K": np.abs(q.K).max() + inertia,
        "C": np.abs(q.C).max() + omega * M,
        "contact.normal": along,
        **dict.fromkeys(("constant", "sine", "cosine"), inertia * gap / along),
        "omega": omega,
        **dict.fromkeys(("contact.low", "contact.high"), gap),
        **dict.fromkeys(("tau", "contact.R_low", "contact.R_high"), 1.0),
    }
    rates = [np.abs(attrgetter(part)(slope)).max() / size for part, size in parts.items()]
    rate = max((rate for rate in rates if math.isfinite(rate)), default=0.0)
    return float(LEAST / rate) if rate > 0 else LEAST  # of what changes nothing any size will do


def sizes_of(solution: Solution, names) -> np.ndarray:
    """`size_of` each of several parameters."""
    return np.array([size_of(solution, name) for name in names])


def check_width(key: str, solution: Solution, name: str, lo: float, hi: float) -> None:
    """Raises ValueError where bounds are too wide for steps in them."""
    size = size_of(solution, name)
    if hi - lo > WIDEST * size:
        raise ArgumentError(
            not_allowed(key, [lo, hi], f"at most {WIDEST:g} times as wide as {name} is large, {size:.3g}")
        )


def checked_step(value) -> float:
    """The factor of the lengths of steps. Raises ValueError."""
    number, (least, most) = number_of(value), STEPS
    if number is None or not least <= number <= most:
        raise ArgumentError(not_allowed("step", value, f"a number >= {least:g} and <= {most:g}"))
    return number
