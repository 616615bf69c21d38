"""Tangent vectors in a contact that follows the slow motion alone: the fast one still shrinks them, past all floats.

In the coordinates (phi, chi) of slow_manifold.py their flight is e^{F u} and e^{S u} side by side. The first vectors,
as many as there are slow directions, reach all of these. Of the last ones so much of the first is taken off that their
chi is zero: then e^{F u} is a factor of their growth, whose logarithm is added. Of two fast vectors the second is at
right angles to the first. The last one grows by what is left of the determinant, e^{(tr F) u}; with c the damping of
the stop, and r that of all else, tr F = -(c + r) - tr S, where c may be larger than all other numbers by far.
"""

import math

from vibro_sweep.engine.compliant.contact_vectors import put_after, set_before
from vibro_sweep.engine.compliant.slow_manifold import count_of, exchange, other_speed, part_of
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER
from vibro_sweep.engine.tables.twofold import add, multiply
from vibro_sweep.engine.variational.growth import add_log, shrink_volume
from vibro_sweep.engine.variational.orthonormal import collect, orthonormalise, place_of
from vibro_sweep.engine.variational.tangent_flight import apply_flight, only

STEEPEST = 1e4  # most of a first vector that is taken off a last one: else they have not found their order yet
THINNEST = 1e-9  # the part of the last vectors that is left
LONGEST = 1e200  # of what a vector does to the place of a stop that is at rest


def vectors_fields(masses: int) -> list:
    """The fields of `law_of` for them."""
    states = 2 * masses
    return [
        ("parted", float, (states, states)),  # columns: phi and chi of the vectors
        ("taken", float, (states, 2)),  # how much of each of the first is taken off the last ones
        ("flown", float, (2, states)),  # terms of a series
    ]


@jit
def set_vectors_apart(t, i, contact, side, n, kind):
    """phi and chi of the vectors, of the last ones without those of the first. Returns whether digits are left."""
    parted, taken, L, H = contact.parted, contact.taken, contact.L[part_of(n, kind)], contact.H[part_of(n, kind)]
    states, before, fast = len(parted), contact.before, count_of(kind)
    slow = states - fast
    if t.lost[i] > 0.0:
        return False
    apply_flight(t, only(i))
    for j in range(states):
        set_before(t, i, contact, side, j)
        before[0], before[1] = before[1], before[0]
        exchange(before, other_speed(contact, n, kind))
        for a in range(fast):
            for e in range(fast, states):
                before[a] -= L[a, e] * before[e]
        for e in range(fast, states):
            for a in range(fast):
                before[e] -= H[e, a] * before[a]
        for e in range(states):
            parted[e, j] = before[e]
    if not solve_for_last(contact, fast):
        return False
    for b in range(fast):
        for a in range(fast):
            for m in range(slow):
                parted[a, slow + b] -= parted[a, m] * taken[m, b]
    last = parted[0, slow]
    if fast == 2:
        last = last * parted[1, slow + 1] - parted[1, slow] * parted[0, slow + 1]
    return abs(last) > THINNEST


@jit
def solve_for_last(contact, fast):
    """How much of the first vectors makes up chi of the last ones: by elimination. Returns whether it is moderate."""
    work, taken, states = contact.old, contact.taken, len(contact.parted)
    slow = states - fast
    for e in range(slow):
        for j in range(states):
            work[e, j] = contact.parted[fast + e, j]
    for m in range(slow):
        pivot = m
        for e in range(m + 1, slow):
            if abs(work[e, m]) > abs(work[pivot, m]):
                pivot = e
        if work[pivot, m] == 0.0:
            return False
        for j in range(m, states):
            work[m, j], work[pivot, j] = work[pivot, j], work[m, j]
        for e in range(m + 1, slow):
            ratio = work[e, m] / work[m, m]
            for j in range(m, states):
                work[e, j] -= ratio * work[m, j]
    for b in range(fast):
        for m in range(slow - 1, -1, -1):
            total = work[m, slow + b]
            for e in range(m + 1, slow):
                total -= work[m, e] * taken[e, b]
            taken[m, b] = total / work[m, m]
            if not abs(taken[m, b]) < STEEPEST:
                return False
    return True


@jit
def fast_flight(F, fast, u):
    """e^{F u} = e^{-decay} (c + s (F + gamma)). Returns decay, c, s, gamma."""
    if fast == 1:
        return -F[0, 0] * u, 1.0, 0.0, 0.0
    gamma = -0.5 * (F[0, 0] + F[1, 1])
    det = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]
    square = det - gamma * gamma
    root = math.sqrt(abs(square))
    if square >= 0.0:
        return gamma * u, math.cos(root * u), math.sin(root * u) / root if root > 0.0 else u, gamma
    fall = math.expm1(-2.0 * root * u)
    return det / (gamma + root) * u, 1.0 + 0.5 * fall, -fall / (2.0 * root), gamma


@jit
def fly_vectors_apart(t, i, contact, side, n, kind, u):
    """The vectors after the time u."""
    part, parted, taken, states = part_of(n, kind), contact.parted, contact.taken, len(contact.parted)
    S, L, H, F, after = contact.S[part], contact.L[part], contact.H[part], contact.F[part], contact.after
    fast = count_of(kind)
    slow = states - fast
    decay, c, s, gamma = fast_flight(F, fast, u)
    det = parted[0, slow]
    if fast == 2:
        det = det * parted[1, slow + 1] - parted[1, slow] * parted[0, slow + 1]
    for j in range(states):
        p, q = parted[0, j], parted[1, j] if fast == 2 else 0.0
        parted[0, j] = c * p + s * ((F[0, 0] + gamma) * p + F[0, 1] * q)
        if fast == 2:
            parted[1, j] = c * q + s * (F[1, 0] * p + (F[1, 1] + gamma) * q)
    fly_first(contact, S, fast, math.exp(-decay), u)
    slowly = 0.0
    for e in range(fast, states):
        slowly += S[e, e]
    shrink_volume(t, i, contact.damping[n], u)
    whole, low = multiply(-contact.damping[n], 0.0, u, 0.0)
    whole, low = add(whole, low, math.log(abs(det)) + (contact.trace[n] - slowly) * u, 0.0)
    t.volume[i] *= math.exp(slowly * u) / abs(det)
    along, lengths = 0.0, (whole, 0.0)
    if fast == 2:
        along, first = right_angled(parted, slow)
        first = math.log(first) - decay
        second, low = add(whole, low, -first, 0.0)
        lengths = first, second
        if det < 0.0:
            parted[0, slow + 1], parted[1, slow + 1] = -parted[0, slow + 1], -parted[1, slow + 1]
    else:
        parted[0, slow] /= abs(det)
    count_last(t, i, taken, slow, fast, along, lengths, low)
    move_places(t, i, taken, slow, fast, along, lengths)
    for j in range(states):
        for e in range(states):
            after[e] = parted[e, j]
        for e in range(fast, states):
            for a in range(fast):
                after[e] += H[e, a] * after[a]
        for a in range(fast):
            for e in range(fast, states):
                after[a] += L[a, e] * after[e]
        exchange(after, other_speed(contact, n, kind))
        after[0], after[1] = after[1], after[0]
        put_after(t, i, contact, side, j)
    t.mixed[i] = 1.0
    orthonormalise(t, only(i))


@jit
def count_last(t, i, taken, slow, fast, along, lengths, low):
    """Count the growth of the last vectors, and of how much of others they were made. lengths: logarithms; low: what
    rounding leaves of the last one."""
    if t.collected:
        states = slow + fast
        for m in range(len(t.normal)):
            t.normal[m, i] = 0.0
        for b in range(fast):
            for m in range(slow):
                t.normal[place_of(states, m, slow + b), i] = taken[m, b]
        if fast == 2:
            t.normal[place_of(states, slow, slow + 1), i] = along
        collect(t, 1 << i)
    for b in range(fast):
        add_log(t, slow + b, i, lengths[b], low if b == fast - 1 else 0.0)


@jit
def fly_first(contact, S, fast, shrunk, u):
    """The first vectors after the time u: chi by the series of e^{S u}."""
    parted, states = contact.parted, len(contact.parted)
    for j in range(states):
        first = j < states - fast
        for a in range(fast):
            parted[a, j] *= shrunk if first else 1.0
        for e in range(fast, states):
            contact.flown[0, e] = parted[e, j] = parted[e, j] if first else 0.0
        for k in range(ORDER if first else 0):
            term, then = contact.flown[k % 2], contact.flown[(k + 1) % 2]
            for e in range(fast, states):
                then[e] = 0.0
                for m in range(fast, states):
                    then[e] += S[e, m] * term[m]
                then[e] *= u / (k + 1.0)
                parted[e, j] += then[e]


@jit
def right_angled(parted, slow):
    """The two fast vectors, which have been flown, become unit vectors at right angles.

    Returns how much of the first was in the second, and the length of the first.
    """
    p, q, r, s = parted[0, slow], parted[1, slow], parted[0, slow + 1], parted[1, slow + 1]
    length = math.hypot(p, q)
    p, q = p / length, q / length
    parted[0, slow], parted[1, slow] = p, q
    parted[0, slow + 1], parted[1, slow + 1] = -q, p
    return (p * r + q * s) / length, length


@jit
def move_places(t, i, taken, slow, fast, along, lengths):
    """What the last vectors do to the places of stops."""
    size = len(t.growth)
    for first in range(0, len(t.places) - size + 1, size):
        for b in range(fast):
            place = t.places[first + slow + b, i]
            for m in range(slow):
                place -= taken[m, b] * t.places[first + m, i]
            t.places[first + slow + b, i] = place
        if fast == 2:
            t.places[first + slow + 1, i] -= along * t.places[first + slow, i]
        for b in range(fast):
            place = t.places[first + slow + b, i] * math.exp(min(-lengths[b], 600.0))
            t.places[first + slow + b, i] = min(max(place, -LONGEST), LONGEST)
