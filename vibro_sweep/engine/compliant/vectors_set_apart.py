"""Tangent vectors in a contact that follows the slow motion alone: the fast one still shrinks them, past all floats.

The first vectors, as many as there are slow directions, span these by then: their f is L q (slow_manifold.py), and
their q flies by e^{S u}. The last ones are at right angles to them before and after, and grow by what is left of the
determinant. With c the damping of the stop, and r that of all else, that is

    e^{(tr F) u},    tr F = -(c + r) - tr S,

less what the first ones grow by; c may be larger than all other numbers by far. How two last vectors turn, and what the
first of them grows by, phi = f - L q says: it flies by e^{F u}, whatever slow motion is in them.
"""

import math

from vibro_sweep.engine.compliant.contact_vectors import put_after, set_before
from vibro_sweep.engine.compliant.slow_manifold import count_of, exchange, other_speed, part_of
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER
from vibro_sweep.engine.tables.twofold import add, multiply
from vibro_sweep.engine.variational.growth import add_log, shrink_volume
from vibro_sweep.engine.variational.orthonormal import count_growth, orthogonalise, orthonormalise_closely, place_of
from vibro_sweep.engine.variational.tangent_flight import apply_flight, only

APART = 1e-12  # what of a unit vector may be beside L q
LONGEST = 1e200  # of what a vector does to the place of a stop that is at rest


def vectors_fields(masses: int) -> list:
    """The fields of `law_of` for them."""
    return [
        ("flown", float, (2, 2 * masses)),  # terms of a series
        ("begins", float, (2, 2)),  # phi of the two last vectors before a flight, and
        ("ends", float, (2, 2)),  # of those in whose directions it ends
    ]


@jit
def set_vectors_apart(t, i, contact, side, n, kind):
    """Whether the first vectors span the slow directions, to rounding."""
    if t.lost[i] > 0.0:
        return False
    apply_flight(t, only(i))
    orthonormalise_closely(t, i)
    L, x, size, fast = contact.L[part_of(n, kind)], contact.before, len(t.growth), count_of(kind)
    for j in range(size - fast):
        set_before(t, i, contact, side, j)
        to_slow(contact, n, kind, x)
        for a in range(fast):
            for e in range(fast, size):
                x[a] -= L[a, e] * x[e]
            for m in range(size):  # the unit vector of f is one of q1' or of q1 in the frame, to its size
                if not abs(x[a] * t.to_frame[size * m + place_of_fast(contact, n, kind, a), i]) <= APART:
                    return False
    return True


@jit
def to_slow(contact, n, kind, x):
    """(delta, delta', w2, ...) becomes (f, q)."""
    x[0], x[1] = x[1], x[0]
    exchange(x, other_speed(contact, n, kind))


@jit
def place_of_fast(contact, n, kind, a):
    """The place of f_a among (q1, q1', q2, ...)."""
    other = other_speed(contact, n, kind)
    return other if other > 0 else 1 - a


@jit
def fly_vectors_apart(t, i, contact, side, n, kind, u):
    """The vectors after the time u."""
    size, fast, turned = len(t.growth), count_of(kind), 0.0
    slow, lengths = size - fast, t.square_length
    if fast == 2:
        fill_fast(t, i, contact, side, n, kind, contact.begins)
    for j in range(slow):
        fly_slowly(t, i, contact, side, n, kind, j, u)
    t.mixed[i] = 1.0
    orthogonalise(t, only(i))
    for j in range(slow):
        turned += 0.5 * math.log(lengths[j, i])
        for b in range(fast):
            t.normal[place_of(size, j, slow + b), i] = 0.0
    shrink_volume(t, i, contact.damping[n], u)
    whole, low = multiply(-contact.damping[n], 0.0, u, 0.0)
    whole, low = add(whole, low, contact.trace[n] * u - turned, 0.0)
    grows = whole
    if fast == 2:
        fill_fast(t, i, contact, side, n, kind, contact.ends)
        grows = turn_fast(t, i, contact, contact.F[part_of(n, kind)], u)
        whole, low = add(whole, low, -grows, 0.0)
    t.volume[i] = 1.0
    for j in range(size):
        t.volume[i] *= math.sqrt(lengths[j, i])
    count_growth(t, only(i))
    for b in range(fast):
        length = 0.5 * math.log(lengths[slow + b, i])
        more = grows if b < fast - 1 else whole
        add_log(t, slow + b, i, more - length, low if b == fast - 1 else 0.0)
        for first in range(0, len(t.places) - size + 1, size):
            place = t.places[first + slow + b, i] * math.exp(min(length - more, 600.0))
            t.places[first + slow + b, i] = min(max(place, -LONGEST), LONGEST)


@jit
def fill_fast(t, i, contact, side, n, kind, phi):
    """phi = f - L q of the two last vectors, one in each column."""
    L, x, size = contact.L[part_of(n, kind)], contact.before, len(t.growth)
    for b in range(2):
        set_before(t, i, contact, side, size - 2 + b)
        to_slow(contact, n, kind, x)
        for a in range(2):
            phi[a, b] = x[a]
            for e in range(2, size):
                phi[a, b] -= L[a, e] * x[e]


@jit
def turn_fast(t, i, contact, F, u):
    """The two last vectors, which are at right angles to all others and to each other, become unit vectors in the
    directions in which those before have flown. Returns the logarithm of the growth of the first of them.

    What flies by e^{F u} is phi alone: in the present ones, with phi in `ends`, those before are phi^-1 e^{F u} phi_0.
    """
    size, lengths, before, phi = len(t.growth), t.square_length, contact.begins, contact.ends
    slow, (decay, c, s, gamma) = size - 2, fast_flight(F, u)
    r, q = math.sqrt(lengths[slow, i]), math.sqrt(lengths[slow + 1, i])
    det = phi[0, 0] * phi[1, 1] - phi[0, 1] * phi[1, 0]
    for b in range(2):
        x, y = before[0, b], before[1, b]
        x, y = c * x + s * ((F[0, 0] + gamma) * x + F[0, 1] * y), c * y + s * (F[1, 0] * x + (F[1, 1] + gamma) * y)
        before[0, b] = r * (phi[1, 1] * x - phi[0, 1] * y) / det
        before[1, b] = q * (phi[0, 0] * y - phi[1, 0] * x) / det
    length = math.hypot(before[0, 0], before[1, 0])
    x, y = before[0, 0] / length, before[1, 0] / length
    t.normal[place_of(size, slow, slow + 1), i] = (x * before[0, 1] + y * before[1, 1]) / length
    for m in range(size):
        a, b = t.Z[size * m + slow, i] / r, t.Z[size * m + slow + 1, i] / q
        t.Z[size * m + slow, i], t.Z[size * m + slow + 1, i] = x * a + y * b, x * b - y * a
    lengths[slow, i] = lengths[slow + 1, i] = 1.0
    return math.log(length) - decay


@jit
def fast_flight(F, u):
    """e^{F u} = e^{-decay} (c + s (F + gamma)). Returns decay, c, s, gamma."""
    gamma = -0.5 * (F[0, 0] + F[1, 1])
    det = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]
    square = det - gamma * gamma
    root = math.sqrt(abs(square))
    if square >= 0.0:
        return gamma * u, math.cos(root * u), math.sin(root * u) / root if root > 0.0 else u, gamma
    fall = math.expm1(-2.0 * root * u)
    return det / (gamma + root) * u, 1.0 + 0.5 * fall, -fall / (2.0 * root), gamma


@jit
def fly_slowly(t, i, contact, side, n, kind, j, u):
    """Vector j after the time u: q by the series of e^{S u}, and f = L q."""
    part, x, size, fast = part_of(n, kind), contact.after, len(t.growth), count_of(kind)
    S, L = contact.S[part], contact.L[part]
    set_before(t, i, contact, side, j)
    to_slow(contact, n, kind, contact.before)
    for e in range(fast, size):
        contact.flown[0, e] = x[e] = contact.before[e]
    for k in range(ORDER):
        term, then = contact.flown[k % 2], contact.flown[(k + 1) % 2]
        for e in range(fast, size):
            then[e] = 0.0
            for m in range(fast, size):
                then[e] += S[e, m] * term[m]
            then[e] *= u / (k + 1.0)
            x[e] += then[e]
    for a in range(fast):
        x[a] = 0.0
        for e in range(fast, size):
            x[a] += L[a, e] * x[e]
    exchange(x, other_speed(contact, n, kind))
    x[0], x[1] = x[1], x[0]
    put_after(t, i, contact, side, j)
