"""Tangent vectors through a contact: by the matrix of its flight between what touch and release do to them.

    touch            d(delta') += -(c V + p)/V d(delta)            relaxed, V = delta' at the touch
    touch at s > 0   d(delta') += -c (d(delta) - ds)               since F/m_e = c (delta' - s')
    release          d(delta') += (c V + p)/V d(delta), V < 0      where delta = 0
                     nothing, and ds = d(delta)                    where F = 0

All have determinant 1. With pi = delta' + c delta in place of delta' only the parts with p and ds are left.
"""

import math

from vibro_sweep.engine.compliant.contact_vectors import put_after, set_before
from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.compliant.relaxing import GONE
from vibro_sweep.engine.compliant.touch_while_relaxing import touch_relaxing
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import alike
from vibro_sweep.engine.variational.growth import shrink_volume
from vibro_sweep.engine.variational.orthonormal import orthonormalise, watch
from vibro_sweep.engine.variational.tangent_flight import apply_flight, only

CONTINUED, RELAXED, UNRELAXED = range(3)  # how a contact begins
SHRUNK = 1.0  # as a logarithm: before a contact that shrinks vectors by more they are orthonormalised


@jit
def carry_over_contact(t, i, contact, side, w, ended):
    """Z over the time w in contact, from its beginning (`contact.begun`), to its end if it has `ended`."""
    apply_flight(t, only(i))
    spanned = touch_relaxing(t, i, contact, side) if contact.begun == UNRELAXED else 1.0
    if contact.begun != UNRELAXED and contact.damping[lane_of(side)] * w > SHRUNK:
        orthonormalise(t, only(i))
    n, size, before, after = lane_of(side), len(t.growth), contact.before, contact.after
    d, p = contact.damping[n], contact.preload[n]
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
        put_after(t, i, contact, side, j)
    t.mixed[i] = 1.0
    shrink_volume(t, i, d, w)
    shrunk = math.exp(contact.trace[n] * w - d * w)
    if contact.begun == UNRELAXED:
        t.volume[i] = spanned * shrunk
        orthonormalise(t, only(i))
    else:
        watch(t, only(i), alike(shrunk))
