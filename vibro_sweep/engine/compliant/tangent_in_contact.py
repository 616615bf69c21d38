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
from vibro_sweep.engine.variational.orthonormal import orthonormalise, watch
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
    if contact.damping[lane_of(side)] * w > SHRUNK:
        orthonormalise(t, only(i))
    volume = touch_volume(t, i, contact, side) if contact.begun == UNRELAXED else 1.0
    n, size, before, after, Z, to = lane_of(side), len(t.growth), contact.before, contact.after, t.Z, t.to_frame
    d, p, rate = contact.damping[n], contact.preload[n], contact.equations[n, 0, 1]
    for m in range(1, len(contact.push)):
        rate += contact.equations[n, m, 2 * m + 1]
    for j in range(size):
        for m in range(len(contact.push)):
            before[2 * m], before[2 * m + 1] = motion_in(t, i, m, j)
        to_contact(contact, side, before)
        if contact.begun == CONTINUED:
            before[1] += d * before[0]
        elif contact.begun == UNRELAXED:
            before[1] += d * (contact.decay * t.places[n * size + j, i])
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
    watch(t, only(i), alike(abs(volume) * math.exp(rate * w)))
    return math.log(abs(volume))


@jit
def touch_volume(t, i, contact, side):
    """det of the touch of a stop that relaxes, 1 + c ds Z^-1 e with the direction e of delta' alone."""
    A, size, n, e, to = contact.solve, len(t.growth), lane_of(side), contact.before, t.to_frame
    for m in range(size):
        e[m] = 0.0
    e[1] = 1.0
    from_contact(contact, side, e)
    for m in range(size):
        for j in range(size):
            A[m, j] = t.Z[size * m + j, i]
        A[m, size] = 0.0
        for a in range(size):
            A[m, size] += to[size * m + a, i] * e[a]
    for m in range(size):  # Gauss's elimination, with the largest pivot
        largest = m
        for k in range(m + 1, size):
            largest = k if abs(A[k, m]) > abs(A[largest, m]) else largest
        for j in range(m, size + 1):
            A[m, j], A[largest, j] = A[largest, j], A[m, j]
        for k in range(size):
            if k != m and A[m, m] != 0.0:
                share = A[k, m] / A[m, m]
                for j in range(m, size + 1):
                    A[k, j] -= share * A[m, j]
    total = 1.0
    for m in range(size):
        if A[m, m] != 0.0:
            total += contact.damping[n] * contact.decay * t.places[n * size + m, i] * (A[m, size] / A[m, m])
    return total


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
