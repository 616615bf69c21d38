"""The two motions of a contact: one that is fast, and that of what changes slowly beside it.

With x = (delta', delta, w2, w2', ..., sin, cos, 1), of which f is fast and q is the rest, a contact is f' = A f + B q,
q' = C f + D q. Fast are both delta' and delta (`BOTH`); or delta' alone, where the stop is so strongly damped that
delta creeps (`SPEED`); or the velocity of the other mass that is damped most (`OTHER`), which then changes places with
delta' in x. Chang's transformation sets the two motions apart:

    f = phi + L q          A L + B = L S            S = D + C L
    phi' = F phi           F = A - L C

L follows from these by iteration where f is faster than q; nothing large is subtracted, and small entries keep their
digits. In a contact that lasts phi dies away, and the slow motion q' = S q is followed alone (slow_contact.py).
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import inline, jit

SPEED, BOTH, OTHER = 1, 2, 3  # what is fast
ROUNDS = 60  # of an iteration
SAME = 2.0**-50  # between two rounds, of the size: the next one is as exact as it gets


def slow_manifold_fields(masses: int) -> list:
    """The fields of `law_of` for them: of the left stop with what may be fast, and of the right one."""
    n = 2 * masses + 3
    return [
        ("apart", np.int64, 6),  # 1: they are set apart, -1: they cannot be, 0: not known yet
        ("slow_rate", float, 6),  # about how fast the slow motion is
        ("S", float, (6, n, n)),
        ("L", float, (6, 2, n)),
        ("F", float, (6, 2, 2)),
        ("bend", float, (6, n)),  # delta'' of the slow motion, by q: the row of delta' of L S
        ("whole", float, (n, n)),  # x' = whole x, of one of them
        ("old", float, (n, n)),  # what is replaced
        ("term", float, (2, n)),  # of a series of q
        ("fast", np.int64),  # of the motion that has died away, and is left out; 0: none
    ]


@inline
def part_of(n, kind):
    """The place of the fields of stop n where this is fast."""
    return 3 * n + kind - 1


@inline
def count_of(kind):
    """How many coordinates are fast."""
    return 2 if kind == BOTH else 1


@jit
def other_speed(contact, n, kind):
    """The place of the velocity that changes places with delta' in x; 0: none does."""
    place = 0
    if kind == OTHER:
        G = contact.equations[n]
        for m in range(1, len(G)):
            if place == 0 or G[m, 2 * m + 1] < G[place // 2, place]:
                place = 2 * m + 1
    return place


@jit
def is_set_apart(contact, n, kind, omega):
    """Whether the two motions can be set apart; they are, the first time that this is asked."""
    part, fast = part_of(n, kind), count_of(kind)
    if kind == OTHER and len(contact.push) < 2:
        return False
    if contact.apart[part] == 0:
        other = other_speed(contact, n, kind)
        fill_whole(contact, n, omega, other)
        contact.apart[part] = 1 if set_slow(contact, part, fast) else -1
        set_fast(contact, part, fast)
        creeping = 1 if kind == SPEED else max(other - 1, 0)
        contact.slow_rate[part] = slow_rate_of(contact, contact.S[part], creeping, omega)
        for j in range(fast, len(contact.whole)):
            contact.bend[part, j] = 0.0
            for e in range(fast, len(contact.whole)):
                contact.bend[part, j] += contact.L[part, 0, e] * contact.S[part, e, j]
    return contact.apart[part] > 0


@jit
def exchange(x, other):
    """Let delta' and another velocity change places, where there is one."""
    if other > 0:
        x[0], x[other] = x[other], x[0]


@jit
def fill_whole(contact, n, omega, other):
    """x' = whole x."""
    G, whole, masses = contact.equations[n], contact.whole, len(contact.push)
    states, size = 2 * masses, len(contact.whole)
    for i in range(size):
        for j in range(size):
            whole[i, j] = 0.0
    for m in range(masses):
        rate, place = (0, 1) if m == 0 else (2 * m + 1, 2 * m)
        whole[place, rate] = 1.0
        whole[rate, 0], whole[rate, 1] = G[m, 1], G[m, 0]
        for j in range(2, size):
            whole[rate, j] = G[m, j]
    whole[states, states + 1], whole[states + 1, states] = omega, -omega
    if other > 0:
        for i in range(size):
            exchange(whole[i], other)
        for j in range(size):
            whole[0, j], whole[other, j] = whole[other, j], whole[0, j]


@jit
def set_slow(contact, part, fast):
    """L = A^-1 (L S - B) and S = D + C L, from (A, B; C, D) = whole. Returns whether they converge."""
    whole, S, L, old, last = contact.whole, contact.S[part], contact.L[part], contact.old, False
    size = len(whole)
    for i in range(fast):
        for j in range(fast, size):
            L[i, j] = 0.0
    for _ in range(ROUNDS):
        for i in range(fast, size):
            for j in range(fast, size):
                S[i, j] = whole[i, j]
                for a in range(fast):
                    S[i, j] += whole[i, a] * L[a, j]
        if last:
            return True
        last = True
        for a in range(fast):
            for j in range(fast, size):
                old[a, j] = L[a, j]
        for j in range(fast, size):
            for a in range(fast):
                total = -whole[a, j]
                for e in range(fast, size):
                    total += old[a, e] * S[e, j]
                L[a, j] = total
            if fast == 2:  # A = (damping, stiffness; 1, 0)
                L[0, j], L[1, j] = L[1, j], (L[0, j] - whole[0, 0] * L[1, j]) / whole[0, 1]
            else:
                L[0, j] /= whole[0, 0]
        for a in range(fast):
            moved, extent = 0.0, 0.0
            for j in range(fast, size):
                moved, extent = moved + abs(L[a, j] - old[a, j]), extent + abs(L[a, j])
            last = last and moved <= SAME * extent
    return False


@jit
def set_fast(contact, part, fast):
    """F = A - L C."""
    whole, L, F = contact.whole, contact.L[part], contact.F[part]
    for a in range(fast):
        for b in range(fast):
            F[a, b] = whole[a, b]
            for e in range(fast, len(whole)):
                F[a, b] -= L[a, e] * whole[e, b]


@jit
def slow_rate_of(contact, S, creeping, omega):
    """About how fast the slow motion is: from the rows of velocities of S, and of the place that creeps, 0: none."""
    states, rate, creep = len(contact.y), omega, 0.0
    first = 1 if creeping > 0 else 2
    for m in range(1, len(contact.push)):
        stiff = damped = 0.0
        for j in range(first, states):
            if j % 2 == 1 and j > 1:
                damped += abs(S[2 * m + 1, j])
            else:
                stiff += abs(S[2 * m + 1, j])
        rate = max(rate, math.sqrt(stiff) + damped)
    if creeping > 0:
        for j in range(1, states):
            creep += abs(S[creeping, j])
    return max(rate, creep)
