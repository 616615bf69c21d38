"""Zeros and peaks of series, and of damped waves on series, eight orbits at once.

Of the form e^{-gamma u} (P cos kd u + Q sin kd u) + s(u) are the way behind a stop and its force where contacts have a
closed form (closed_form.py). Elsewhere both are Taylor series (by_series.py): there `wave` is None.
"""

import math

from vibro_sweep.engine.compliant.passage_series import expanded_at, turn
from vibro_sweep.engine.simd.jit import inline
from vibro_sweep.engine.simd.lanes import bits, select

LOOKS = 5  # at the end, each followed by a step towards it
CLOSE = 2.0**-54  # of the time, a fourth power: what a step of fourth order leaves
TOP_LOOKS = 12  # at a peak
NEAR_TOP = 2.0**-9  # rate times the last step to it: what is left is a fifth power over 120
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
def wave_at(gamma, kd, u):
    """e^{-gamma u} cos kd u and e^{-gamma u} sin kd u."""
    sin, cos = turn(0.5 * kd * u - 0.25 * math.pi)
    decay = decay_of(gamma * u)
    return -2.0 * sin * cos * decay, (1.0 - 2.0 * sin * sin) * decay


@inline
def look(series, count, wave, u):
    """Taylor coefficients at u, up to the fourth power, of a series of `count` terms with a damped wave on it.

    wave: gamma, kd, P and Q, or None.
    """
    f, f1, f2, f3, f4 = expanded_at(series, 0, count, u)
    if wave is not None:
        gamma, kd, P, Q = wave
        x, y = wave_at(gamma, kd, u)
        K = kd * kd + gamma * gamma
        w, w1 = P * x + Q * y, (kd * Q - gamma * P) * x - (kd * P + gamma * Q) * y  # w'' = -2 gamma w' - K w
        w2 = -2.0 * gamma * w1 - K * w
        w3 = -2.0 * gamma * w2 - K * w1
        w4 = -2.0 * gamma * w3 - K * w2
        f, f1, f2 = f + w, f1 + w1, f2 + 1.0 / 2.0 * w2
        f3, f4 = f3 + 1.0 / 6.0 * w3, f4 + 1.0 / 24.0 * w4
    return f, f1, f2, f3, f4


@inline
def seek(series, count, wave, u, rate, farthest, wanted):
    """The zero near u, where it falls, by steps of fourth order. Returns it, and which lanes found it."""
    found = wanted & ~wanted
    for _ in range(LOOKS):
        f, slope, curve, bend, _ = look(series, count, wave, u)
        inverse = 1.0 / slope
        newton, curve, bend = -f * inverse, curve * inverse, bend * inverse
        after = u + newton * (1.0 - newton * (curve - newton * (2.0 * curve * curve - bend)))
        wanted = wanted & (slope < 0.0) & (after > 0.0) & (after <= farthest)
        u = select(wanted, after, u)
        # what a step bends the course by, relatively: where a preload ends a contact far sooner than its rate
        bends = select(abs(curve) > rate, abs(curve), rate)
        left = newton * bends
        left = left * left
        now = wanted & (left * left <= CLOSE * (u * bends))
        found, wanted = found | now, wanted & ~now
        if bits(wanted) == 0:
            break
    return u, found


@inline
def peak(series, count, wave, top, rate, end, turning):
    """The largest value near `top`, where the lanes that are `turning` rise at 0 and fall at the `end`.

    Others have -inf. By steps of third order, or halves of the interval that the peak is in.
    """
    largest, low, high = -math.inf + 0.0 * top, 0.0 * top, end
    for _ in range(TOP_LOOKS):
        f, slope, curve, bend, more = look(series, count, wave, top)
        low, high = select(slope > 0.0, top, low), select(slope > 0.0, high, top)
        inverse = 1.0 / curve
        newton = -0.5 * slope * inverse
        step = newton * (1.0 - 1.5 * (newton * inverse) * bend)
        after = top + step
        inside = (curve < 0.0) & (after >= low) & (after <= high)
        change = select(inside, step * (slope + step * (curve + step * (bend + step * more))), 0.0)
        largest = select(turning, f + change, largest)
        turning = turning & ~(inside & (abs(step) * rate <= NEAR_TOP))
        if bits(turning) == 0:
            break
        top = select(inside, after, 0.5 * (low + high))
    return largest


@inline
def force_of(wave, k, c):
    """The wave of k delta + c delta' from that of delta."""
    gamma, kd, P, Q = wave
    return gamma, kd, k * P + c * (kd * Q - gamma * P), k * Q - c * (kd * P + gamma * Q)
