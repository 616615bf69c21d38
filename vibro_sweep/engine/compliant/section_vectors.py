"""Tangent vectors at the section while stops relax: a vector moves the places of these stops as well as the state.

A contact may shrink a vector z to e^-100 of itself that has moved another stop before. Where z is then made a unit
vector, it moves that stop by e^100: its growth up to the section says nothing of the multipliers, and rounding of the
state is multiplied by e^100. So multipliers are found from vectors that are orthonormal together with the places P,

    (Z; c P) = E R,    and the growth D U of Z over a period becomes    R_1 D U R_0^-1,    from E_0 to E_1,

with c the speed that a touch at the section would take from the mass for each unit of its place.

The place of the stop that was touched last follows from the state. That of the other one, while it relaxes, is a number
of its own, and motion has one multiplier more than there are states: to Z comes the vector that moves this stop
`alone`. The touch of this stop turns it into one that moves the other stop alone (touch_while_relaxing.py).
"""

import math

from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.compliant.relaxing import place_at
from vibro_sweep.engine.compliant.rotations import invert, rotate
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.variational.growth import add_log, log_growth, log_growth_in_two, start_in_two
from vibro_sweep.engine.variational.orthonormal import collect, columns_of, orthonormalise_closely, place_of

TURNED = 1e-13  # what vectors have found their directions better than, unless they turn for ever


@inline
def begin_with_places(law, t, i, o, width, E, R):
    """Fill E with the vectors with which a period begins, and begin their growth. width: of a cell."""
    if law is not None:
        start_in_two(t, i)
        begin_in_contact(law.orbits[i], t, i, o, width, E, R)
    else:
        for m in range(len(E)):
            for j in range(len(E)):
                E[m, j] = t.Z[len(E) * m + j, i]


@inline
def end_with_places(law, t, i, E, R, logs, low):
    """Fill E with the vectors with which a period ends, set the logarithms of their growth, in two floats,
    and return how many of them have not been lost by then because a stop was relaxed."""
    count = len(t.growth)
    if law is not None:
        count = end_in_contact(law.orbits[i], t, i, E, R)
        for j in range(len(t.growth)):
            logs[j], low[j] = log_growth_in_two(t, j, i)
    else:
        for m in range(len(E)):
            logs[m] = log_growth(t, m, i)
            for j in range(len(E)):
                E[m, j] = t.Z[len(E) * m + j, i]
    if count > len(t.growth):
        logs[count - 1] = t.alone_log[i]
    return count


@inline
def count_vectors(law, t, begins, ends, known):
    """From how many of the vectors of a period that are known at its end its multipliers are found."""
    if law is not None and known > len(t.growth) and not has_turned(t, begins, ends):
        return len(t.growth)
    return known


@jit
def copy_vectors(t, i, E):
    """The columns of Z, and after them zeros."""
    size = len(t.growth)
    for m in range(len(E)):
        for j in range(columns_of(t)):
            E[m, j] = t.Z[size * m + j, i] if m < size and j < size else 0.0


@jit
def begin_in_contact(contact, t, i, o, width, E, R):
    """`begin_with_places` where there are compliant stops."""
    size, columns = len(t.growth), columns_of(t)
    for n in range(2):
        t.alone[n, i] = 0.0
    t.alone_log[i] = t.alone_by_itself[i] = 0.0
    if not watch_places(contact, o, width) or t.lost[i] > 0.0:
        copy_vectors(t, i, E)
        return
    last = lane_of(contact.pressed) if contact.pressed != 0.0 else contact.touched_last
    if contact.unit[1 - last] > 0.0:
        t.alone[1 - last, i] = 1.0
    count = orthonormalise_with_places(contact, t, i, E, R)
    invert(R, count)
    for j in range(size):
        t.logs[j, i] = math.log(R[j, j])
        for k in range(j + 1, count):
            t.shear[place_of(columns, j, k), i] = R[j, k] / R[j, j]
    if count > size:
        t.alone_log[i] = math.log(R[size, size])


@jit
def end_in_contact(contact, t, i, E, R):
    """`end_with_places` where there are compliant stops."""
    size, columns = len(t.growth), columns_of(t)
    if not (contact.unit[0] > 0.0 or contact.unit[1] > 0.0) or t.lost[i] > 0.0:
        copy_vectors(t, i, E)
        return size
    orthonormalise_closely(t, i)
    count = orthonormalise_with_places(contact, t, i, E, R)
    for j in range(size):
        for k in range(j + 1, size):
            t.normal[place_of(size, j, k), i] = R[j, k] / R[j, j]
    collect(t, 1 << i)
    for j in range(size):
        if count > size:
            along = R[j, size] / R[j, j] * math.exp(t.alone_log[i] - log_growth(t, j, i))
            t.shear[place_of(columns, j, size), i] += along
        add_log(t, j, i, math.log(R[j, j]))
    if count > size:
        t.alone_log[i] += math.log(R[size, size])
    return count


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
    """Fill E and R: E R of the vectors Z, orthonormal, and what they do to the places; and of the one that moves a stop
    alone, if there is one. Returns how many there are.

    Rotations take the row of one place after the other up into R, which begins as 1 with Z in E. The last column of E
    is at right angles to all others then. Of the row of the `free` stop it is a tangent vector of the motion, too.
    """
    size, columns = len(t.growth), columns_of(t)
    free = 0 if t.alone[0, i] != 0.0 else 1
    for j in range(size):
        for m in range(len(E)):
            E[m, j] = 1.0 if m == j else 0.0
        for k in range(size):
            R[j, k] = 1.0 if j == k else 0.0
    for n in (1 - free, free):
        for m in range(len(E)):
            E[m, size] = 1.0 if m == size + n else 0.0
        for j in range(size):
            R[size, j] = contact.unit[n] * t.places[size * n + j, i]
        for j in range(size):
            if R[size, j] != 0.0:
                rotate(R, E, j, j, size)
    for j in range(columns):
        R[j, size], R[size, j] = contact.unit[free] * t.alone[free, i] * E[size + free, j], 0.0
    R[size, size] = contact.unit[free] * E[size + free, size]
    for j in range(columns):
        for m in range(size):
            contact.before[m] = 0.0
            for k in range(size):
                contact.before[m] += t.Z[size * m + k, i] * E[k, j]
        for m in range(size):
            E[m, j] = contact.before[m]
    for m in range(len(E)):
        E[m, size] *= t.alone[free, i]
    return columns if R[size, size] * t.alone[free, i] != 0.0 else size


@jit
def has_turned(t, begins, ends):
    """Whether the vectors span other directions than a period ago, as where their last multiplier is one of a complex
    pair: then the vector that moves a stop alone, the last one, has to be counted.
    """
    size = len(t.growth)
    for j in range(size):
        for row in range(len(ends)):
            apart = ends[row, j]
            for k in range(size):
                for m in range(len(ends)):
                    apart -= begins[row, k] * begins[m, k] * ends[m, j]
            if abs(apart) > TURNED:
                return True
    return False
