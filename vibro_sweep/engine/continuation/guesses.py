"""Orbits alone, from guesses of the phases and velocity jumps of their impacts, by Newton's method.

For given phases and jumps the states before the impacts follow linearly: with r what jumps and constant force add to
the state 0 over a period,

    y_1 = (sigma - E(P))^-1 r = closing (r, gap)

so that each step begins with states that fly to one another, as if phases and jumps were the only unknowns. What a free
mode leaves open of y_1 is the gap there, which moves with Newton's steps.

Towards the end of a chatter sequence flights and speeds vanish. From one impact to the next, after a short flight from
the same stop, only what changes is summed up, so that rounding shrinks with the flight.
"""

import math

import numpy as np

from vibro_sweep.engine.continuation.corrector import in_order
from vibro_sweep.engine.continuation.factors import factorise, substitute
from vibro_sweep.engine.continuation.flight_tables import flight
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, NUMBERS, OMEGA, ONE_PLUS_R_HIGH, ONE_PLUS_R_LOW
from vibro_sweep.engine.continuation.reflections import put_last, take_apart
from vibro_sweep.engine.continuation.residual import approach, eliminate, grown, is_short, land, leave
from vibro_sweep.engine.simd.jit import jit

MOST_STEPS = 30
LAST = 5  # of them
MORE = 100  # beside a fold, where rounding throws steps about: one of them leads to the solution
THROWN = 1e-5  # sizes of these steps
ROUNDING = 1e-13  # of the gap's size


@jit
def length_after(f, place, i):
    """The length of the flight after event i."""
    n, x, omega = f.A.shape[0], place.x, f.numbers[OMEGA]
    following = x[i + 1, n] if i + 1 < len(x) else x[0, n] + math.pi * f.half_turns
    return (following - x[i, n]) / omega


@jit
def close(f, c, place, b):
    """The motion through all events, with the states that follow from phases, jumps and the gap at the first one."""
    K, n, N, work = len(place.x), f.A.shape[0], f.A.shape[0] // 2, b.work[0]
    y, end, gap = work.flying[0], work.flying[1], place.x[0, 0]
    for r in range(n):
        y[r] = 0.0
    for i in range(K):
        e = b.events[i]
        e.length = length_after(f, place, i)
        flight(f, e.length, e.E, work.other)
        y[N] += place.x[i, n + 1]
        for r in range(n):
            end[r] = e.E[0, r, n]
            for j in range(n):
                end[r] += e.E[0, r, j] * y[j]
        for r in range(n):
            y[r] = end[r]
    for r in range(n):
        place.x[0, r] = f.closing[r, n] * gap
        for j in range(n):
            place.x[0, r] += f.closing[r, j] * y[j]
    for i in range(K):
        e, x, last = b.events[i], place.x[i], i + 1 == K
        approach(f, x, e)
        if i > 0 and is_short(f, c, b, i - 1):
            before = b.events[i - 1]
            e.gap = before.gap + grown(f, before, before.turn, 0)
            e.motion[0] = before.motion[0] + place.x[i - 1, n + 1] + grown(f, before, before.turn, N)
        leave(f, c, i, x, e, work)
        land(f, e)
        for r in range(n):
            e.defect[r] = 0.0
            if last:
                e.defect[r] = c.sigma * place.x[0, r] - e.landing[r]
            else:
                place.x[i + 1, r] = e.landing[r]


@jit
def solve(f, c, place, b):
    """`events.changes[0]`: Newton's change. False where the equations are singular."""
    n, work = f.A.shape[0], b.work[0]
    if eliminate(f, c, place, b, False) == 0.0:
        return False
    put_last(c, b, n)
    for r in range(n):
        work.null[r] = work.ends[r, n]
        for j in range(n):
            work.system[r, j] = work.ends[r, j]
    if not abs(factorise(work.system, n, work.order)) > 0.0:
        return False
    substitute(work.system, n, work.order, work.null)
    take_apart(f, c, b, 0, work.null, work.step_p[0], True)
    return True


@jit
def converge(f, c, place, b):
    """Newton's method from phases, jumps and the gap at the first impact. Relative size of the last step; NaN: none.

    Steps longer than a quarter of the least distance between impacts are shortened. It has converged where steps grow
    no smaller; steps up to 1e-7, as slow impacts leave them, count if the equations hold to rounding. Near a fold each
    step is half of the one before: that is not an end yet. Of many impacts rounding leaves more, beside a fold most:
    where the last steps of all are small and shrink no more, the largest of them says how much.
    """
    K, n, omega, earlier, last, before = len(place.x), f.A.shape[0], f.numbers[OMEGA], 0.0, 0.0, np.inf
    swing, period = math.hypot(f.Z[0].real, f.Z[0].imag), math.pi * f.half_turns
    size = swing
    for i in range(K):
        size = max(size, abs(f.numbers[HIGH if c.sides[i] > 0 else LOW]))
    for count in range(MOST_STEPS + MORE):
        if not in_order(f, c, place):
            return np.nan
        if count == MOST_STEPS:
            if max(earlier, last) < 1e-7 and last > 0.25 * earlier:
                return max(earlier, last)
            if not last < THROWN:
                return np.nan
        close(f, c, place, b)
        if not solve(f, c, place, b):
            return np.nan
        left, longest, reach, speed, kick = 0.0, 0.0, np.inf, omega * swing, 0.0
        for i in range(K):
            e, D = b.events[i], place.x[i, n + 1]
            high = c.sides[i] > 0
            off = e.gap - f.numbers[HIGH if high else LOW]
            lost = D + f.numbers[ONE_PLUS_R_HIGH if high else ONE_PLUS_R_LOW] * e.motion[0]
            left = max(left, abs(off), abs(lost) / omega)
            longest, reach, speed = max(longest, abs(e.changes[0, n])), min(reach, e.length * omega), max(speed, abs(D))
        for i in range(K):
            change = abs(b.events[i].changes[0, n + 1])
            kick = max(kick, change / (speed + change))
        change = max(longest / period, kick)
        if not change < np.inf:
            return np.nan
        most = 1e-7 if left <= ROUNDING * size else 1e-9
        damping = min(1.0, 0.25 * reach / longest) if longest > 0.0 else 1.0
        e = b.events[0]
        place.x[0, 0] -= damping * (e.changes[0, 0] + e.rate[0] * e.changes[0, n])
        for i in range(K):
            for r in range(n, n + 2):
                place.x[i, r] -= damping * b.events[i].changes[0, r]
        if damping == 1.0 and (
            change <= 4e-16 or (change < most and change >= (0.5 if change < 1e-12 else 0.8) * before)
        ):
            return change if in_order(f, c, place) else np.nan
        before = change if damping == 1.0 else np.inf
        if count >= MOST_STEPS - LAST:
            last = max(last, before)
        elif count >= MOST_STEPS - 2 * LAST:
            earlier = max(earlier, before)
    return np.nan


@jit
def converge_all(f, c, place, guesses, b):
    """`converge` from many guesses, of oscillators that differ in their contact alone.

    guesses : one after the other, each `place.x`, of which a guess has phases, jumps and the gap at the first impact
    less the steady motion, and all become those of the orbit; the last change; `numbers`
    """
    K, width = place.x.shape
    size = K * width
    each = guesses.reshape((-1, size + 1 + NUMBERS))
    for m in range(len(each)):
        for i in range(NUMBERS):
            f.numbers[i] = each[m, size + 1 + i]
        for k in range(size):
            place.x[k // width, k % width] = each[m, k]
        each[m, size] = converge(f, c, place, b)
        if each[m, size] < np.inf:
            close(f, c, place, b)
        for k in range(size):
            each[m, k] = place.x[k // width, k % width]
