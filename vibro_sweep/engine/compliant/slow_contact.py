"""A contact that lasts: once the fast motion is rounding, the slow one is followed alone.

There delta' = (L q)_0, delta = (L q)_1 and q' = S q (slow_manifold.py): a series that reaches as far as in free flight,
however stiff the stop, and where the contact ends is found in it as in others.
"""

import math

from vibro_sweep.engine.compliant.contact_series import dot_slow
from vibro_sweep.engine.compliant.slow_manifold import is_set_apart, part_of
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.tables.flight import ORDER, WIDTH

WORTHWHILE = 4.0  # times as long as other series in contact
DIED = 2.0**-53  # what is left of f - L q, of the terms of L q: rounding of their sum
DIED_BEFORE = 2.0**-48  # where f was L q at the beginning of the series before: rounding of that


@inline
def slow_step(contact, n, fast):
    """How far a series of the slow motion reaches."""
    return WIDTH / contact.slow_rate[part_of(n, fast)]


@jit
def fast_that_died(contact, n, omega):
    """How many coordinates in contact with stop n are fast, where this motion is rounding by now; else 0."""
    for fast in (2, 1):
        if not is_set_apart(contact, n, fast, omega) or slow_step(contact, n, fast) < WORTHWHILE * contact.step[n]:
            continue
        if drop_fast_motion(contact, n, fast):
            return fast
    return 0


@jit
def drop_fast_motion(contact, n, fast):
    """f becomes L q if phi is rounding by now. Returns whether it is.

    The first row of it follows from the equation of motion, delta'' = G_00 delta + G_01 delta' + a with delta'' of the
    slow motion: a, what presses the mass on the stop, may be a small difference of large terms, and L q by itself would
    part from it by a rounding of these.
    """
    part, G, y, low = part_of(n, fast), contact.equations[n], contact.y, contact.low
    L, F, states = contact.L[part], contact.F[part], len(contact.y)
    put_slow(contact, fast)
    bend, size = 0.0, 0.0
    for j in range(fast, states + 3):
        bend += contact.bend[part, j] * contact.term[0, j]
        size += abs(L[fast - 1, j] * contact.term[0, j])
    a = dot_slow(contact, G[0])
    if fast == 1:
        delta, speed = y[0], (bend - G[0, 0] * y[0] - a) / G[0, 1]
        left = abs((y[1] - speed) + low[1])
    else:
        speed = dot_slow(contact, L[0])
        delta = (bend - G[0, 1] * speed - a) / G[0, 0]
        rate = max(math.sqrt(abs(F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0])), abs(F[0, 0] + F[1, 1]))
        left = abs((y[0] - delta) + low[0]) + abs((y[1] - speed) + low[1]) / rate
    if not left <= (DIED_BEFORE if contact.fast == fast else DIED) * size:
        return False
    if fast == 2:
        y[0], low[0] = delta, 0.0
    y[1], low[1] = speed, 0.0
    return True


@jit
def put_slow(contact, fast):
    """q, as the first term of its series."""
    y, term, states = contact.y, contact.term[0], len(contact.y)
    for j in range(fast, states):
        term[j] = y[0] if j == 1 else y[j]
    term[states], term[states + 1], term[states + 2] = contact.phase[0], contact.phase[1], 1.0


@jit
def load_slow(contact, n, fast):
    """Taylor series from y on, of the slow motion."""
    S, L, c, y = contact.S[part_of(n, fast)], contact.L[part_of(n, fast)], contact.c, contact.y
    size = len(S)
    put_slow(contact, fast)
    for k in range(ORDER):
        term, after = contact.term[k % 2], contact.term[(k + 1) % 2]
        for m in range(1, len(c)):
            c[m, k] = term[2 * m]
        if fast == 1:
            c[0, k] = term[1]
        else:
            c[0, k] = 0.0
            for j in range(fast, size):
                c[0, k] += L[1, j] * term[j]
        for i in range(fast, size):
            after[i] = 0.0
            for j in range(fast, size):
                after[i] += S[i, j] * term[j]
            after[i] /= k + 1.0
    c[0, 0], c[0, 1] = y[0], y[1]
