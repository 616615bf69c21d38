"""A contact that lasts: once the fast motion is rounding, the slow one is followed alone.

There delta' = (L q)_0, delta = (L q)_1 and q' = S q (slow_manifold.py): a series that reaches as far as in free flight,
however stiff the stop, and where the contact ends is found in it as in others.
"""

import math

import numpy as np

from vibro_sweep.engine.compliant.slow_manifold import is_set_apart, part_of
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.tables.flight import ORDER, WIDTH
from vibro_sweep.engine.tables.twofold import add, multiply

WORTHWHILE = 4.0  # times as long as other series in contact
DIED = 2.0**-50  # what is left of f - L q, of the terms of L q: rounding


def slow_contact_fields(masses: int) -> list:
    """The fields of `law_of` for it."""
    return [
        (
            "fast",
            np.int64,
        ),  # coordinates of the motion that has died away, so that the slow one is followed alone; or 0
        ("term", float, (2, 2 * masses + 3)),  # of a series of q
    ]


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
        if has_died(contact, n, fast):
            return fast
    return 0


@jit
def slow_part(contact, L, fast, a):
    """(L q) of row a in twice the digits, and the sum of the sizes of its terms."""
    y, states = contact.y, len(contact.y)
    total, low, size = L[a, states + 2], 0.0, abs(L[a, states + 2])
    for j in range(fast, states):
        place = 0 if j == 1 else j  # delta stands first in y
        term, term_low = multiply(L[a, j], 0.0, y[place], contact.low[place])
        total, low = add(total, low, term, term_low)
        size += abs(term)
    for j in range(2):
        term, term_low = multiply(L[a, states + j], 0.0, contact.phase[j], contact.phase_low[j])
        total, low = add(total, low, term, term_low)
        size += abs(term)
    return total, low, size


@jit
def has_died(contact, n, fast):
    """Whether phi is rounding by now. Then f becomes L q."""
    L, F, y, low = contact.L[part_of(n, fast)], contact.F[part_of(n, fast)], contact.y, contact.low
    speed, speed_low, size = slow_part(contact, L, fast, 0)
    fast_speed = abs((y[1] - speed) + (low[1] - speed_low))
    if fast == 1:
        if not fast_speed <= DIED * size:
            return False
    else:
        delta, delta_low, size = slow_part(contact, L, fast, 1)
        rate = max(math.sqrt(abs(F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0])), abs(F[0, 0] + F[1, 1]))
        if not abs((y[0] - delta) + (low[0] - delta_low)) + fast_speed / rate <= DIED * size:
            return False
        y[0], low[0] = delta, delta_low
    y[1], low[1] = speed, speed_low
    return True


@jit
def load_slow(contact, n, fast):
    """Taylor series from y on, of the slow motion."""
    S, L, c, y = contact.S[part_of(n, fast)], contact.L[part_of(n, fast)], contact.c, contact.y
    size, states = len(S), len(y)
    for j in range(fast, states):
        contact.term[0, j] = y[0] if j == 1 else y[j]
    contact.term[0, states], contact.term[0, states + 1] = contact.phase[0], contact.phase[1]
    contact.term[0, states + 2] = 1.0
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
