"""A damped wave on a slow series, eight orbits at once: e^{-gamma u} (P cos kd u + Q sin kd u) + s(u).

Of this form are the way behind a stop, its force, and their derivatives (closed_form.py). A zero is found by
Chebyshev's method, a peak by Newton's.
"""

import math

from vibro_sweep.engine.compliant.passage_series import derivatives_at, turn
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import bits, select
from vibro_sweep.engine.simd.memory import row

LOOKS = 5  # at the end, each followed by a step towards it
CLOSE = 2.0**-54  # of the time, a third power: what a step of third order leaves
TOP_LOOKS = 6  # at a peak
NEAR_TOP = 3e-5  # kd times the last step to it: what is left is a third power
HALVES = 5  # of e^-x, x below DECAY
LOG2_E, LOG_2 = 1.4426950408889634, (0.6931471803691238, 1.9082149292705877e-10)  # ln 2 in two parts
FACTORIALS = tuple(1.0 / math.factorial(n) for n in range(15))


@inline
def decay_of(x):
    """e^-x for 0 <= x < 3.1."""
    n = math.floor(x * LOG2_E + 0.5)
    r = (n * LOG_2[0] - x) + n * LOG_2[1]
    square = r * r
    even, odd = FACTORIALS[14] + 0.0 * x, FACTORIALS[13] + 0.0 * x
    for m in range(12, -1, -2):
        even = even * square + FACTORIALS[m]
        if m > 0:
            odd = odd * square + FACTORIALS[m - 1]
    scale = select(n >= 1.0, 0.5, 1.0 + 0.0 * x)
    for m in range(2, HALVES):
        scale = select(n >= float(m), 0.5, 1.0) * scale
    return (even + r * odd) * scale


@inline
def wave(gamma, kd, u):
    """e^{-gamma u} cos kd u and e^{-gamma u} sin kd u."""
    sin, cos = turn(0.5 * kd * u - 0.25 * math.pi)
    decay = decay_of(gamma * u)
    return -2.0 * sin * cos * decay, (1.0 - 2.0 * sin * sin) * decay


@inline
def look(series, count, gamma, kd, P, Q, u):
    """A damped wave on a slow series at u, its derivative, and half its second one."""
    x, y = wave(gamma, kd, u)
    f, slope, curve = derivatives_at(series, 0, count, u)
    P1, Q1 = kd * Q - gamma * P, -kd * P - gamma * Q
    P2, Q2 = kd * Q1 - gamma * P1, -kd * P1 - gamma * Q1
    return P * x + Q * y + f, P1 * x + Q1 * y + slope, 0.5 * (P2 * x + Q2 * y) + curve


@inline
def seek(series, count, gamma, kd, P, Q, u, farthest, wanted):
    """The zero near u, where it falls, by Chebyshev's method. Returns it, and which lanes found it."""
    found = wanted & ~wanted
    for _ in range(LOOKS):
        f, slope, curve = look(series, count, gamma, kd, P, Q, u)
        inverse = 1.0 / slope
        newton = -f * inverse
        after = u + (newton - curve * inverse * newton * newton)
        wanted = wanted & (slope < 0.0) & (after > 0.0) & (after <= farthest)
        u = select(wanted, after, u)
        left = abs(newton) * kd
        now = wanted & (left * left * left <= CLOSE * (u * kd))
        found, wanted = found | now, wanted & ~now
        if bits(wanted) == 0:
            break
    return u, found


@jit
def peak_of(series, count, gamma, kd, P, Q, top, end, wanted):
    """The largest value of what rises at 0 and has fallen at the `end`, near `top`, by Newton's method."""
    largest = P + row(series, 0)
    turns = wanted & (kd * Q - gamma * P + row(series, 1) > 0.0)
    for _ in range(TOP_LOOKS):
        f, slope, curve = look(series, count, gamma, kd, P, Q, top)
        step = -0.5 * slope / curve
        f = f + 0.5 * slope * step
        largest = select(turns & (f > largest), f, largest)
        after = top + step
        turns = turns & (curve < 0.0) & (after > 0.0) & (after < end) & (abs(step) * kd > NEAR_TOP)
        if bits(turns) == 0:
            break
        top = select(turns, after, top)
    return largest


@inline
def force_of(k, c, gamma, kd, P, Q):
    """P and Q of k delta + c delta'."""
    return k * P + c * (kd * Q - gamma * P), k * Q - c * (kd * P + gamma * Q)
