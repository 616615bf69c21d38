"""Tangent vectors at the section while stops relax: a vector moves the places of these stops as well as the state.

A contact may shrink a vector z to e^-100 of itself that has moved another stop before. Where z is then made a unit
vector, it moves that stop by e^100: its growth up to the section says nothing of the multipliers, and rounding of the
state is multiplied by e^100. So multipliers are found from vectors that are orthonormal together with the places P,

    (Z; c P) = E R,    and the growth D U of Z over a period becomes    R_1 D U R_0^-1,    from E_0 to E_1,

with c the speed that a touch at the section would take from the mass for each unit of its place.
"""

import math

from vibro_sweep.engine.compliant.relaxing import place_at
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.variational.orthonormal import collect, place_of

TWICE = 2  # Gram-Schmidt, and where little but rounding was left of a vector again


@inline
def begin_with_places(law, t, i, o, width, E, R):
    """Fill E with the vectors with which a period begins, and begin their growth. width: of a cell."""
    copy_vectors(t, i, E)
    if law is not None:
        contact, size = law.orbits[i], len(t.growth)
        if watch_places(contact, o, width) and t.lost[i] == 0.0:
            orthonormalise_with_places(contact, t, i, E, R)
            invert(R, size)
            n = 0
            for j in range(size):
                t.logs[j, i] = math.log(R[j, j])
                for k in range(j + 1, size):
                    t.shear[n, i] = R[j, k] / R[j, j]
                    n += 1


@inline
def end_with_places(law, t, i, E, R, logs):
    """Fill E with the vectors with which a period ends, and set the logarithms of their growth."""
    copy_vectors(t, i, E)
    if law is not None:
        contact, size = law.orbits[i], len(t.growth)
        if (contact.unit[0] > 0.0 or contact.unit[1] > 0.0) and t.lost[i] == 0.0:
            orthonormalise_with_places(contact, t, i, E, R)
            for j in range(size):
                for k in range(j + 1, size):
                    t.normal[place_of(size, j, k), i] = R[j, k] / R[j, j]
            collect(t, 1 << i)
            for j in range(size):
                t.logs[j, i] += math.log(R[j, j])
                logs[j] = t.logs[j, i] + math.log(t.growth[j, i])


@inline
def copy_vectors(t, i, E):
    """The columns of Z, flat, and after them zeros."""
    for m in range(len(E)):
        E[m] = t.Z[m, i] if m < len(t.Z) else 0.0


@jit
def watch_places(contact, o, width):
    """Set the units of the places of both stops, 0 of one that does not relax. Returns whether one does."""
    for n in range(2):
        contact.unit[n], place = 0.0, place_at(contact, o, n, 0, 0.0, width)
        if place > 0.0:
            rest = contact.preload[n] / contact.stiffness[n]
            contact.unit[n] = contact.damping[n] * ((place + rest) / (contact.left[n] + rest))
    return contact.unit[0] > 0.0 or contact.unit[1] > 0.0


@jit
def orthonormalise_with_places(contact, t, i, E, R):
    """E R of the vectors in E and what they do to the places."""
    size = len(t.growth)
    for n in range(2):
        for j in range(size):
            E[size * (size + n) + j] = contact.unit[n] * t.places[size * n + j, i]
    for j in range(size):
        for k in range(size):
            R[k, j] = 0.0
        for _ in range(TWICE):
            for k in range(j):
                along = 0.0
                for m in range(k, len(E), size):
                    along += E[m] * E[m - k + j]
                R[k, j] += along
                for m in range(k, len(E), size):
                    E[m - k + j] -= along * E[m]
        for m in range(j, len(E), size):
            R[j, j] = math.hypot(R[j, j], E[m])
        for m in range(j, len(E), size):
            E[m] /= R[j, j]


@jit
def invert(R, size):
    """R^-1 in place of an upper triangular matrix R."""
    for j in range(size):
        R[j, j] = 1.0 / R[j, j]
        for k in range(j - 1, -1, -1):
            total = 0.0
            for m in range(k + 1, j + 1):
                total += R[k, m] * R[m, j]
            R[k, j] = -R[k, k] * total
