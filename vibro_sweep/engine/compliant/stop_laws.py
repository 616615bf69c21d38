"""Laws of contact: the force of a compliant stop, and where a contact with it ends. No other room knows them.

A law is data: the force is a linear form of (delta, delta', 1), and so is each guard, which is positive as long as the
contact lasts. Where the first of them is zero the contact ends, and then

    AT_PLACE  delta = 0: the mass leaves the stop where it has touched it
    RELAXES   the stop stays behind at delta, without a force, and relaxes to delta = 0
    BREAKS    the force ceases at once, where the mass is before the stop, delta < 0

A contact begins where delta = 0, or where the relaxing stop is.
"""

import numpy as np

from vibro_sweep.engine.simd.jit import jit

DISPLACEMENT, FORCE = range(2)  # release
AT_PLACE, RELAXES, BREAKS = range(3)


def law_fields() -> list:
    """The fields of `law_of` for them, of the left stop and the right one."""
    return [
        ("force", float, (2, 3)),  # F/m_e
        ("guards", np.int64, 2),  # how many there are
        ("guard", float, (2, 2, 3)),
        ("then", np.int64, (2, 2)),  # what comes where it is zero
    ]


@jit
def set_law_of_stop(contact, n, numbers, release):
    """The law of stop n. numbers: k, c and p, over m_e."""
    k, c, p = numbers[0], numbers[1], numbers[2]
    contact.stiffness[n], contact.damping[n], contact.preload[n] = k, c, p
    set_form(contact.force[n], k, c, p)
    contact.guards[n] = 0
    by_force = release == FORCE and c > 0.0  # without a damper the force is zero where delta is, or before
    if by_force:
        add_guard(contact, n, RELAXES, k, c, p)
    if not by_force or p > 0.0:
        add_guard(contact, n, AT_PLACE, 1.0, 0.0, 0.0)


@jit
def add_guard(contact, n, then, of_delta, of_speed, one):
    """A guard of contacts with stop n."""
    i = contact.guards[n]
    set_form(contact.guard[n, i], of_delta, of_speed, one)
    contact.then[n, i] = then
    contact.guards[n] += 1


@jit
def set_form(form, of_delta, of_speed, one):
    form[0], form[1], form[2] = of_delta, of_speed, one


@jit
def value_of(form, delta, speed):
    return form[0] * delta + form[1] * speed + form[2]


@jit
def relaxes(contact, n):
    """Whether a contact with stop n may leave it behind, relaxing."""
    found = False
    for i in range(contact.guards[n]):
        found = found or contact.then[n, i] == RELAXES
    return found


@jit
def is_shared(contact, n):
    """Whether contacts by pieces (contact_pieces.py) know the ends of those with stop n."""
    known = True
    for i in range(contact.guards[n]):
        known = known and contact.then[n, i] != BREAKS
    return known
