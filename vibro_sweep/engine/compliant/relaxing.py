"""A massless stop that a mass has left by force: k s + c s' + p = 0 until it is relaxed, s = 0.

Without a preload it only comes near to that, and counts as relaxed where s is below rounding of what it began with.
"""

import math

from vibro_sweep.engine.motion.first_contact import first_contact
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.tables.flight import ORDER, WIDTH, bound_third_over

GONE = 2.0**-60  # of where the stop was left
ROUNDING = 2.0**-50


@jit
def rate_of_relaxing(contact, n):
    """k/c."""
    return contact.stiffness[n] / contact.damping[n]


@jit
def bring_stops(contact, o, k, s, width):
    """Where relaxing stops are at offset s of cell k."""
    for n in range(2):
        if contact.relaxed[n] > 0.0:
            cell = o.period * o.cells + k
            u = (cell - contact.cell[n]) * width + (s - contact.offset[n])
            if u > 0.0:
                contact.relaxed[n] = relaxed_after(contact, n, u)
                contact.cell[n], contact.offset[n] = cell, s


@jit
def place_at(contact, o, n, k, s, width):
    """Where stop n is at offset s of cell k; 0 where it does not relax."""
    if not contact.relaxed[n] > 0.0:
        return 0.0
    u = (o.period * o.cells + k - contact.cell[n]) * width + (s - contact.offset[n])
    return relaxed_after(contact, n, u) if u > 0.0 else contact.relaxed[n]


@inline
def relax_stops(law, o, u, k, offset):
    """Let stops relax by the time u, which ends at this offset of cell k. As the time of a flight it has more digits
    than times have."""
    if law is not None:
        contact, cell = law.orbits[o.lane], o.period * o.cells + k
        for n in range(2):
            if contact.relaxed[n] > 0.0:
                contact.relaxed[n] = relaxed_after(contact, n, u)
                contact.cell[n], contact.offset[n] = cell, offset


@inline
def place_of_stop(law, o, side):
    """delta where the stop on `side` is: 0 where it does not relax."""
    if law is not None:
        return law.orbits[o.lane].relaxed[1 if side > 0.0 else 0]
    return 0.0


@inline
def series_of_stops(law, o, k, s, width, left, last):
    """How far a series from offset s of cell k reaches beside stops that relax, which are brought there; and whether it
    reaches to the end of the cell."""
    if law is not None:
        contact = law.orbits[o.lane]
        bring_stops(contact, o, k, s, width)
        for n in range(2):
            if contact.relaxed[n] > 0.0:
                reach = reach_of_relaxing(contact, n, left)
                if s + reach == s < width:  # what is left of it takes no time
                    contact.relaxed[n] = 0.0
                else:
                    left, last = reach, last and not reach < left
    return left, last


@jit
def relaxed_after(contact, n, u):
    """s after the time u; 0 where it is relaxed."""
    rate, rest = rate_of_relaxing(contact, n), contact.preload[n] / contact.stiffness[n]
    if rate * u > 700.0:
        return 0.0
    s = contact.relaxed[n] * math.exp(-rate * u) + rest * math.expm1(-rate * u)
    gone = GONE * contact.left[n] if rest == 0.0 else ROUNDING * (contact.relaxed[n] + rest)
    return s if s > gone else 0.0


@jit
def log_of_one_and(x):
    """ln(1 + x), to rounding also where x is small (Kahan): of the C library kernels call few functions."""
    y = 1.0 + x
    return x if y == 1.0 else math.log(y) * (x / (y - 1.0))


@jit
def reach_of_relaxing(contact, n, left):
    """How far a series of s reaches, at most to where it is relaxed."""
    rate, rest = rate_of_relaxing(contact, n), contact.preload[n] / contact.stiffness[n]
    reach = min(left, WIDTH / rate)
    if rest > 0.0:
        reach = min(reach, log_of_one_and(contact.relaxed[n] / rest) / rate)
    return reach


@jit
def distance_to_touch(contact, o, side, delta, order, left):
    """Time of the first touch of a stop that relaxes; s - delta begins with a zero of this order, which is divided
    out."""
    n, c, gap = 1 if side > 0.0 else 0, o.c[0], o.gap
    rate, rest = rate_of_relaxing(contact, n), contact.preload[n] / contact.stiffness[n]
    term = contact.relaxed[n] + rest
    for m in range(ORDER):
        value = contact.relaxed[n] - delta if m == 0 else term - side * c[m]
        if m >= order:
            gap[m - order] = value
        term *= -rate / (m + 1.0)
    for m in range(ORDER - order, ORDER):
        gap[m] = 0.0
    if not gap[0] > 0.0:
        return 0.0
    return first_contact(gap, bound_third_over(gap, left), left)


@jit
def speed_of_stop(contact, n):
    """s'."""
    if contact.relaxed[n] == 0.0:
        return 0.0
    return -(contact.stiffness[n] * contact.relaxed[n] + contact.preload[n]) / contact.damping[n]
