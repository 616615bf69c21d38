"""Tangent vectors through a contact: by the matrix of its flight between what touch and release do to them.

    touch            d(delta') += -(c V + p)/V d(delta)            relaxed, V = delta' at the touch
    touch at s > 0   d(delta') += -c (d(delta) - ds)               since F/m_e = c (delta' - s')
    release          d(delta') += F/g' dg                          F/m_e = k delta + c delta' + p, the guard g = 0
                     d(delta') += (c V + p)/V d(delta), V < 0      so where g = delta
                     nothing, and ds = d(delta)                    and where g = F/m_e

With pi = delta' + c delta in place of delta' only the parts with p and ds are left. All have determinant 1, but for a
release where g contains delta' and F is not zero.
"""

import math

from vibro_sweep.engine.compliant.contact_vectors import put_after, set_before
from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.compliant.relaxing import GONE
from vibro_sweep.engine.compliant.stop_laws import RELAXES, relaxes, value_of
from vibro_sweep.engine.compliant.touch_while_relaxing import touch_relaxing
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import alike
from vibro_sweep.engine.variational.growth import change_volume, shrink_volume
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
    by_delta, by_pi = jump_at_release(contact, n) if ended else (-d, 0.0)
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
            if p == 0.0 and relaxes(contact, n):
                t.forgotten[j, i] += math.log(1.0 + GONE * d * abs(t.places[n * size + j, i]))
        for a in range(size):
            after[a] = 0.0
            for b in range(size):
                after[a] += contact.matrix[a, b] * before[b]
        delta, pi = after[0], after[1]
        after[1] = pi + by_delta * delta + by_pi * pi
        if ended:
            t.places[n * size + j, i] = delta
        put_after(t, i, contact, side, j)
    t.mixed[i] = 1.0
    shrink_volume(t, i, d, w)
    shrunk = math.exp(contact.trace[n] * w - d * w) * abs(1.0 + by_pi)
    if by_pi != 0.0:
        change_volume(t, i, math.log(abs(1.0 + by_pi)))
    if contact.begun == UNRELAXED:
        t.volume[i] = spanned * shrunk
        orthonormalise(t, only(i))
    else:
        watch(t, only(i), alike(shrunk))


@jit
def jump_at_release(contact, n):
    """What a release does to delta': it becomes (1 + by_pi) pi + by_delta delta. Returns by_delta, by_pi."""
    guard, then = contact.guard[n, contact.ended_by], contact.then[n, contact.ended_by]
    d, speed, bend = contact.damping[n], contact.y[1], contact.acceleration
    slope = guard[0] * speed + guard[1] * bend
    if then == RELAXES:
        return -d, 0.0
    if not slope < 0.0:
        return 0.0, 0.0
    # c d(delta) is taken off F dg/g' symbolically: where the guard is delta alone, nothing of the size of c is left
    elastic = value_of(contact.force[n], contact.y[0], 0.0)
    by_pi = (elastic + d * speed) * guard[1] / slope
    return (guard[0] * elastic - d * guard[1] * bend) / slope - d * by_pi, by_pi
