"""How far a mass is from a stop, in more digits than x1 has, and the state beside it.

A float holds x1 to an ulp of the place of the stop only, of which a short flight back to the same stop may be no higher
than a few. What presses the mass on a preloaded stop that it bounces on may be as small a difference of large forces.
From a contact on the state is therefore X + finer, a sum of two floats each, as long as the flight goes from series to
series; formed from the tables it is X alone.
"""

from vibro_sweep.engine.motion.orbits import round_off, wall_of
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.tables.twofold import add

NEAR = 2.0**-5  # of the size of x1: a flight that goes no further away needs these digits
SIDES = (-1.0, 1.0)


@jit
def delta_of(o, stops, side):
    """delta: how far the mass is behind the place of the stop; negative before it."""
    return side * ((o.X[0] - wall_of(stops, side)) + o.finer[0])


@jit
def set_delta(o, stops, side, delta):
    """Put the mass there."""
    o.X[0], o.finer[0] = add(wall_of(stops, side), 0.0, side * delta, 0.0)


@jit
def finer_at(o, k):
    """What x1 at node k has beside X[0]: nothing where the tables give it."""
    return o.finer[0] if k == o.base else 0.0


@jit
def begin_finely(law, o, k):
    """The state at node k: nothing beside X where the tables give it, or where all stops are rigid."""
    if law is None or k != o.base:
        round_off(o)


@inline
def keep_finer(law, o, q):
    """At the section, which is node `cells` and then node 0."""
    if law is not None:
        begin_finely(law, o, q.cells)


@inline
def is_close(law, o, q):
    """Whether the orbit, at a node, has just left a stop and may come back to it from so near that all digits of the
    gap are needed."""
    if law is not None:
        return is_close_to_stop(law.orbits[o.lane], o, q)
    return False


@jit
def is_close_to_stop(contact, o, q):
    """`is_close` where some stops are compliant."""
    if o.cell == o.base and o.period * o.cells + o.cell <= contact.close_until:
        for n in range(2):
            near, speed = contact.near[n], abs(o.X[1])
            if abs(o.X[0] - o.stops[n]) < near and speed * q.width < near and stays_near(q, o.X, speed, near):
                return True
    return False


@jit
def stays_near(q, X, speed, near):
    """Whether a flight from the state X may turn back before it has gone so far: by its acceleration, and by what that
    may become in a part of a period."""
    a = 0.0
    for j in range(len(q.force)):
        a += q.force[j] * X[j]
    return speed * speed <= 2.0 * near * (abs(a) + q.omega * speed)
