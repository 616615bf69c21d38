"""A contact that lasts: once the fast motion is rounding, the slow one is followed alone.

There f = L q and q' = S q (slow_manifold.py): a series that reaches as far as in free flight, however stiff the stop or
damped another mass, and where the contact ends is found in it as in others.
"""

import math

from vibro_sweep.engine.compliant.contact_series import dot_slow
from vibro_sweep.engine.compliant.slow_manifold import (
    BOTH,
    OTHER,
    SPEED,
    count_of,
    exchange,
    is_set_apart,
    other_speed,
    part_of,
)
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.tables.flight import ORDER, WIDTH

WORTHWHILE = 4.0  # times as long as other series in contact
DIED = 2.0**-53  # what is left of f - L q, of the terms of L q: rounding of their sum
DIED_IN_FLOATS = 2.0**-50  # the same where the sum is one of floats: of another mass, which this hardly moves
DIED_BEFORE = 2.0**-48  # where f was L q at the beginning of the series before: rounding of that


@inline
def slow_step(contact, n, kind):
    """How far a series of the slow motion reaches."""
    return WIDTH / contact.slow_rate[part_of(n, kind)]


@jit
def fast_that_died(contact, o, n, omega):
    """What is fast in contact with stop n and rounding by now; 0: nothing."""
    for kind in (BOTH, SPEED, OTHER):
        if not is_set_apart(contact, n, kind, omega) or slow_step(contact, n, kind) < WORTHWHILE * contact.step[n]:
            continue
        if drop_fast_motion(contact, o, n, kind):
            return kind
    return 0


@jit
def drop_fast_motion(contact, o, n, kind):
    """f becomes L q if phi is rounding by now. Returns whether it is.

    Of delta' or delta that follows from the equation of motion, delta'' = G_00 delta + G_01 delta' + a with delta'' of
    the slow motion: a, what presses the mass on the stop, may be a small difference of large terms, and L q by itself
    would part from it by a rounding of these.
    """
    part, G, y, low = part_of(n, kind), contact.equations[n], contact.y, contact.low
    L, F, states, fast = contact.L[part], contact.F[part], len(contact.y), count_of(kind)
    put_slow(contact, o, n, kind)
    bend, value, size = 0.0, 0.0, 0.0
    for j in range(fast, states + 3):
        bend += contact.bend[part, j] * contact.term[0, j]
        value += L[fast - 1, j] * contact.term[0, j]
        size += abs(L[fast - 1, j] * contact.term[0, j])
    a, delta, speed, place = dot_slow(contact, o, G[0]), y[0], value, 1
    if kind == OTHER:
        place = other_speed(contact, n, kind)
    if kind == SPEED:
        speed = (bend - G[0, 0] * y[0] - a) / G[0, 1]
    if kind == BOTH:
        speed = dot_slow(contact, o, L[0])
        delta = (bend - G[0, 1] * speed - a) / G[0, 0]
    left = abs((y[place] - speed) + low[place])
    if kind == BOTH:
        rate = max(math.sqrt(abs(F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0])), abs(F[0, 0] + F[1, 1]))
        left = abs((y[0] - delta) + low[0]) + left / rate
    died = DIED_IN_FLOATS if kind == OTHER else DIED
    if not left <= (DIED_BEFORE if contact.fast == kind else died) * size:
        return False
    if kind == BOTH:
        y[0], low[0] = delta, 0.0
    y[place], low[place] = speed, 0.0
    return True


@jit
def put_slow(contact, o, n, kind):
    """q, as the first term of its series."""
    y, term, states = contact.y, contact.term[0], len(contact.y)
    term[0], term[1] = y[1], y[0]
    for j in range(2, states):
        term[j] = y[j]
    term[states], term[states + 1], term[states + 2] = o.phase[0], o.phase[1], 1.0
    exchange(term, other_speed(contact, n, kind))


@jit
def load_slow(contact, o, n, kind):
    """Taylor series from y on, of the slow motion."""
    S, L, c, y, fast = (
        contact.S[part_of(n, kind)], contact.L[part_of(n, kind)], o.c, contact.y, count_of(kind)
    )  # fmt: skip
    size = len(S)
    put_slow(contact, o, n, kind)
    for k in range(ORDER):
        term, after = contact.term[k % 2], contact.term[(k + 1) % 2]
        for m in range(1, len(c)):
            c[m, k] = term[2 * m]
        c[0, k] = term[1]
        if kind == BOTH:
            c[0, k] = 0.0
            for j in range(fast, size):
                c[0, k] += L[1, j] * term[j]
        for i in range(fast, size):
            after[i] = 0.0
            for j in range(fast, size):
                after[i] += S[i, j] * term[j]
            after[i] /= k + 1.0
    c[0, 0], c[0, 1] = y[0], y[1]
