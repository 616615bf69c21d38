"""Tangent vectors through the touch of a stop that still relaxes (tangent_in_contact.py)."""

import math

from vibro_sweep.engine.compliant.contact_vectors import from_contact, set_before
from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.compliant.rotations import factorise
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.variational.growth import change_volume, log_growth
from vibro_sweep.engine.variational.orthonormal import columns_of, count_growth, orthonormalise_closely, place_of
from vibro_sweep.engine.variational.tangent_flight import only


@jit
def touch_relaxing(t, i, contact, side):
    """The touch of a stop that relaxes, which multiplies volumes by its determinant, 1 + c ds Z^-1 e.

    Returns what the vectors span in the frame after it: their growth has counted what they span in other coordinates.

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
    spanned = set_growth(t, i, R)
    change_volume(t, i, math.log(abs(determinant)))
    return abs(determinant) / spanned


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
def set_growth(t, i, R):
    """The vectors have been replaced by Q of Q R. Returns the determinant of R."""
    size, t.volume[i] = len(R), 1.0
    for j in range(size):
        t.volume[i] *= R[j, j]
        t.square_length[j, i] = R[j, j] * R[j, j]
        for k in range(j + 1, size):
            t.normal[place_of(size, j, k), i] = R[j, k] / R[j, j]
    spanned = t.volume[i]
    count_growth(t, only(i))
    return spanned
