"""What happens where a mass is at a compliant stop, or inside it, and where it has left one."""

from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.compliant.pressing import begin_contact
from vibro_sweep.engine.compliant.relaxing import speed_of_stop
from vibro_sweep.engine.compliant.stop_laws import BREAKS, relaxes, value_of
from vibro_sweep.engine.motion.distance import delta_of
from vibro_sweep.engine.motion.impacts import EXPLAINED
from vibro_sweep.engine.motion.orbits import wall_of
from vibro_sweep.engine.motion.rest import begin_rest, first_nonzero
from vibro_sweep.engine.simd.jit import jit

NEAR = 8.0 * 2.0**-52  # of the place of a stop, or the depth of its preload: lower bounces are a rest on it


@jit
def after_contact(contact, X, side):
    """After a contact: the side of the stop that the mass is at without speed, or of the one that it leaves, and the
    order of the zero with which it does."""
    n = lane_of(side)
    if contact.then[n, contact.ended_by] == BREAKS:
        return 0.0, 0.0, 0
    if contact.relaxed[n] > 0.0:
        return 0.0, side, 2
    if X[1] != 0.0:
        return 0.0, side, 1
    return side, 0.0, 1


@jit
def meet(law, f, stops, o, records, t, k, s, side, hit, released):
    """The mass is at a compliant stop, or starts inside: contact begins, or a rest on its preload (0); or it starts by
    leaving a stop that relaxes (-1); or the order of the zero with which the mass leaves it."""
    contact, n, X, c1 = law.orbits[o.lane], lane_of(side), o.X, o.c[0]
    speed, inside, p = side * X[1], delta_of(o, stops, side), contact.preload[n]
    relative, unrelaxed = speed - speed_of_stop(contact, n), contact.relaxed[n] > 0.0
    if not hit and inside - contact.relaxed[n] > EXPLAINED * (abs(X[0]) + abs(wall_of(stops, side))):
        if relaxes(contact, n) and value_of(contact.force[n], inside, speed) < 0.0:
            contact.relaxed[n] = contact.left[n] = inside
            contact.cell[n], contact.offset[n] = o.period * o.cells + k, s
            return -1
        contact.relaxed[n] = 0.0
        begin_contact(law, f, stops, o, t, k, s, side, False)
        return 0
    a = 2.0 * side * c1[2]
    if not unrelaxed and p > 0.0 and 0.0 < a < p:
        height = speed * speed / (2.0 * min(a, p - a))
        size = max(abs(wall_of(stops, side)), p / contact.stiffness[n])
        if relative > 0.0 and height < NEAR * size:
            X[1] = o.finer[1] = relative = 0.0
            o.chatters += 1
    if relative > 0.0:
        begin_contact(law, f, stops, o, t, k, s, side, not unrelaxed)
        return 0
    if relative < 0.0 or unrelaxed:
        return 1
    if released and a > 0.5 * p > 0.0:  # what pressed it on exceeds the preload from here on: delta'' is zero
        begin_contact(law, f, stops, o, t, k, s, side, True)
        contact.least = 3
        return 0
    order = first_nonzero(c1, 3 if released else 2)
    if side * c1[order] <= 0.0:
        return order
    if order > 2 or a < p:
        if p > 0.0:
            begin_rest(f, o, records, t, k, s, side, 0.0)
            return 0
    begin_contact(law, f, stops, o, t, k, s, side, True)
    return 0
