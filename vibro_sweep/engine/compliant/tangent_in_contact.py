"""Tangent vectors through a contact: by the matrix of its flight between what touch and release do to them.

    touch            d(delta') += -(c V + p)/V d(delta)            relaxed, V = delta' at the touch
    touch at s > 0   d(delta') += -c (d(delta) - ds)               since F/m_e = c (delta' - s')
    release          d(delta') += (c V + p)/V d(delta), V < 0      where delta = 0
                     nothing, and ds = d(delta)                    where F = 0

All have determinant 1. With pi = delta' + c delta in place of delta' only the parts with p and ds are left.
"""

import math

from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.compliant.relaxing import GONE
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import alike
from vibro_sweep.engine.variational.orthonormal import (
    columns_of,
    count_growth,
    orthonormalise,
    orthonormalise_closely,
    place_of,
    watch,
)
from vibro_sweep.engine.variational.tangent import log_growth
from vibro_sweep.engine.variational.tangent_at_rest import motion_in
from vibro_sweep.engine.variational.tangent_flight import apply_flight, only

CONTINUED, RELAXED, UNRELAXED = range(3)  # how a contact begins
SHRUNK = 1.0  # as a logarithm: before a contact that shrinks vectors by more they are orthonormalised


@jit
def carry_over_contact(t, i, contact, side, w, ended):
    """Z over the time w in contact, from its beginning (`contact.begun`), to its end if it has `ended`.

    Returns the logarithm of the determinant of a touch of a stop that still relaxes.
    """
    apply_flight(t, only(i))
    log_volume = touch_relaxing(t, i, contact, side) if contact.begun == UNRELAXED else 0.0
    if contact.begun != UNRELAXED and contact.damping[lane_of(side)] * w > SHRUNK:
        orthonormalise(t, only(i))
    n, size, before, after, Z, to = lane_of(side), len(t.growth), contact.before, contact.after, t.Z, t.to_frame
    d, p, rate = contact.damping[n], contact.preload[n], contact.equations[n, 0, 1]
    for m in range(1, len(contact.push)):
        rate += contact.equations[n, m, 2 * m + 1]
    if contact.begun == RELAXED:
        t.alone[n, i] = 0.0
    for j in range(size):
        set_before(t, i, contact, side, j)
        if contact.begun == CONTINUED:
            before[1] += d * before[0]
        elif contact.begun == UNRELAXED:
            for a in range(size):
                before[a] = contact.vectors[a, j]
        elif contact.begun == RELAXED:
            if contact.touched > 0.0:
                before[1] -= p / contact.touched * before[0]
            if contact.by_force and p == 0.0:
                t.forgotten[j, i] += math.log1p(GONE * d * abs(t.places[n * size + j, i]))
        for a in range(size):
            after[a] = 0.0
            for b in range(size):
                after[a] += contact.matrix[a, b] * before[b]
        if ended and not contact.ends_by_force:
            if contact.y[1] < 0.0:
                after[1] += p / contact.y[1] * after[0]
        else:
            after[1] -= d * after[0]
        if ended:
            t.places[n * size + j, i] = after[0]
        from_contact(contact, side, after)
        for m in range(size):
            z = 0.0
            for a in range(size):
                z += to[size * m + a, i] * after[a]
            Z[size * m + j, i] = z
    t.mixed[i] = 1.0
    if contact.begun == UNRELAXED:
        orthonormalise(t, only(i))
    else:
        watch(t, only(i), alike(math.exp(rate * w)))
    return log_volume


@jit
def set_before(t, i, contact, side, j):
    """Vector j as (delta, delta', w2, ..)."""
    for m in range(len(contact.push)):
        contact.before[2 * m], contact.before[2 * m + 1] = motion_in(t, i, m, j)
    to_contact(contact, side, contact.before)


@jit
def touch_relaxing(t, i, contact, side):
    """The touch of a stop that relaxes. Returns the logarithm of its determinant, 1 + c ds Z^-1 e.

    e is the direction of delta' alone. ds may be large, and all vectors lie close to e then: they are Q R from here on,
    found by rotations in (pi, delta, w2, ..), whose first row alone is large.
    """
    orthonormalise_closely(t, i)
    size, n, e, to, R = len(t.growth), lane_of(side), contact.before, t.to_frame, contact.touch
    share = contact.damping[n] * contact.decay
    for m in range(size):
        e[m] = 1.0 if m == 1 else 0.0
    from_contact(contact, side, e)
    determinant, along = 1.0, contact.after
    for j in range(size):
        along[j] = 0.0
        for m in range(size):
            for a in range(size):
                along[j] += t.Z[size * m + j, i] * (to[size * m + a, i] * e[a])
        determinant += share * t.places[n * size + j, i] * along[j]
    touch_alone(t, i, n, share, determinant, along)
    for j in range(size):
        set_before(t, i, contact, side, j)
        for a in range(size):
            R[a, j] = contact.before[a]
        R[1, j] += share * t.places[n * size + j, i]
    factorise(R, contact.vectors)
    set_growth(t, i, R)
    return math.log(abs(determinant))


@jit
def touch_alone(t, i, n, share, determinant, along):
    """The touch of stop n, which relaxes, for the vector y that moves this stop alone.

    It becomes c ds e = Z' r, with Z' = Z after the touch, r = c ds Z^-1 e/det: y - Z' r moves the other stop alone.
    """
    size, place, ds = len(t.growth), 0.0, t.alone[n, i]
    t.alone[n, i] = 0.0
    if ds == 0.0 or determinant == 0.0:
        return
    for m in range(size):
        r = share * ds * along[m] / determinant
        place -= t.places[size * (1 - n) + m, i] * r
        t.shear[place_of(columns_of(t), m, size), i] += r * math.exp(t.alone_log[i] - log_growth(t, m, i))
    if place != 0.0:
        t.alone[1 - n, i] = math.copysign(1.0, place)
        t.alone_log[i] += math.log(abs(place))
        t.alone_by_itself[i] += math.log(abs(place))


@jit
def factorise(R, Q):
    """R becomes that of Q R, with a diagonal that is not negative.

    Its second row may be large, and stay the only such: others are brought to Hessenberg's form without it first.
    """
    size = len(R)
    for a in range(size):
        for j in range(size):
            Q[a, j] = 1.0 if a == j else 0.0
    swap_rows(R)
    for first in (1, 0):
        for j in range(size - first):
            for m in range(j + first + 1, size):
                if R[m, j] != 0.0:
                    rotate(R, Q, j, j + first, m)
    for j in range(size):
        if R[j, j] < 0.0:
            for a in range(size):
                R[j, a], Q[a, j] = -R[j, a], -Q[a, j]
    swap_rows(Q)


@jit
def rotate(R, Q, j, n, m):
    """Rotate entry j of row m of R into row n, and the columns of Q with them."""
    length = math.hypot(R[n, j], R[m, j])
    cos, sin = R[n, j] / length, R[m, j] / length
    for k in range(j, len(R)):
        x, y = R[n, k], R[m, k]
        R[n, k], R[m, k] = cos * x + sin * y, cos * y - sin * x
    R[m, j] = 0.0
    for a in range(len(R)):
        x, y = Q[a, n], Q[a, m]
        Q[a, n], Q[a, m] = cos * x + sin * y, cos * y - sin * x


@jit
def swap_rows(A):
    """Exchange the first two rows."""
    for j in range(len(A)):
        A[0, j], A[1, j] = A[1, j], A[0, j]


@jit
def set_growth(t, i, R):
    """The vectors have been replaced by Q of Q R."""
    size = len(R)
    for j in range(size):
        t.square_length[j, i] = R[j, j] * R[j, j]
        for k in range(j + 1, size):
            t.normal[place_of(size, j, k), i] = R[j, k] / R[j, j]
    count_growth(t, only(i))


@jit
def to_contact(contact, side, x):
    """(q1, q1', q2, ..) as (delta, delta', w2, ..)."""
    for m in range(1, len(contact.push)):
        x[2 * m] -= contact.push[m] * x[0]
        x[2 * m + 1] -= contact.push[m] * x[1]
    x[0], x[1] = side * x[0], side * x[1]


@jit
def from_contact(contact, side, x):
    """(delta, delta', w2, ..) as (q1, q1', q2, ..)."""
    x[0], x[1] = side * x[0], side * x[1]
    for m in range(1, len(contact.push)):
        x[2 * m] += contact.push[m] * x[0]
        x[2 * m + 1] += contact.push[m] * x[1]
