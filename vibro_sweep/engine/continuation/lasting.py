"""Events that last: a rest where R = 0, or a contact with a compliant stop. Which of them it is, is asked here alone.

`compliant` is `Problem.compliant`.
"""

import math

import numpy as np

from vibro_sweep.engine.continuation.moving_flow import ONE_PLUS_R_HIGH, ONE_PLUS_R_LOW, law_at
from vibro_sweep.engine.continuation.problem import GRAZE
from vibro_sweep.engine.continuation.relaxation import time_to_spare
from vibro_sweep.engine.continuation.workspace import TEST
from vibro_sweep.engine.simd.jit import jit

PER_TIME_CONSTANT = 1.5  # of a contact: what its rates count beside those of the free motion
ROUNDED = 1e-12  # of numbers of size 1, between polynomials, and of lengths
OUTWARDS = 1e-6  # speed, in units of a branch: more than what is left of it beside a graze


@jit
def is_contact(compliant, side):
    """Whether an event that lasts on this side is a contact."""
    if compliant is None:
        return False
    else:
        return compliant[1 if side > 0 else 0]


@jit
def put_force(f, compliant, side, values, free, force):
    """force: the acceleration that the stop takes from the gap, by Z (lasting_map.py); free: the gap's free one, which
    a rest takes whole."""
    n, law = f.A.shape[0], law_at(f, side)
    for k in range(n + 4):
        force[k] = 0.0 if is_contact(compliant, side) else free[k]
    if is_contact(compliant, side):
        force[0], force[n // 2], force[n + 2] = values[law], values[law + 1], side * values[law + 2]


@jit
def moves_on(compliant, side, r, N):
    """Whether coordinate r goes on when the event begins: its gap is at its stop, and a rest loses its velocity."""
    return r != 0 and (r != N or is_contact(compliant, side))


@jit
def rate_of(f, compliant, side):
    """The fastest rate of the force, beside those of the free motion."""
    return PER_TIME_CONSTANT * force_scale(f, compliant, side) if is_contact(compliant, side) else 0.0


@jit
def force_scale(f, compliant, side):
    """What the force is divided by in row 2: that of a contact is of the size of a speed then."""
    law = law_at(f, side)
    return math.sqrt(f.values[law]) + f.values[law + 1] if is_contact(compliant, side) else 1.0


@jit
def ends_by_force(f, compliant, side, length, speed):
    """Whether an event of this length that ends with this gap velocity ends where the force is 0: a rest, or a contact
    whose force vanishes before the gap is at its stop. With a preload, a contact without length has not begun."""
    law = law_at(f, side)
    if not is_contact(compliant, side):
        return True
    c, p = f.values[law + 1], f.values[law + 2]
    return f.by_force > 0 and c != 0.0 and (p == 0.0 or (length > ROUNDED and side * c * speed + p < 0.0))


@jit
def turns_at_graze(f, compliant, side):
    """Whether a branch turns where the length s of an event on this side is 0, and det G(mu) has the factor s.

    Without a preload a contact begins like its length squared: both signs of s are at one parameter.
    """
    if compliant is None:
        return False
    else:
        return is_contact(compliant, side) and f.values[law_at(f, side) + 2] == 0.0


@jit
def is_watched(f, c, i):
    """Whether event i grazes along the curve as a contact that begins smoothly: it is a turning point at its stop."""
    return c.kind == GRAZE and i == c.index and c.rests[i] and turns_at_graze(f, c.compliant, c.sides[i])


@jit
def corner_of(f, c, i):
    """The jump of the velocity of event i by its depth, where it is watched: the least contact that ends by force."""
    return f.values[law_at(f, c.sides[i]) + 1] if f.by_force > 0 and is_watched(f, c, i) else 0.0


@jit
def has_losses(f, c):
    """Whether something takes energy: a damper, an impact, or a contact."""
    N = f.A.shape[0] // 2
    for r in range(N):
        for k in range(N):
            if abs(f.A[N + r, N + k]) > ROUNDED:
                return True
    for i in range(len(c.sides)):
        high = c.sides[i] > 0
        if is_contact(c.compliant, c.sides[i]):
            if f.values[law_at(f, c.sides[i]) + 1] > ROUNDED:
                return True
        elif c.sides[i] != 0.0 and 2.0 - f.numbers[ONE_PLUS_R_HIGH if high else ONE_PLUS_R_LOW] > ROUNDED:
            return True
    return False


@jit
def contacts_begin(c, place, b):
    """Whether the gap moves into its stop where contacts begin, but for rounding."""
    if c.compliant is not None:
        for i in range(len(place.x)):
            pressed = c.rests[i] and is_contact(c.compliant, c.sides[i]) and place.x[i, -1] > 0.0
            if pressed and c.sides[i] * b.events[i].motion[0] < -OUTWARDS:
                return False
    return True


@jit
def speed_after(f, c, i, e, v):
    """The velocity v after event i; where the law of the contact gives it, without the motion's rounding."""
    if c.rests[i]:
        if c.compliant is not None and e.depth != 0.0:  # k s + c s' + p = 0
            law = law_at(f, c.sides[i])
            return -c.sides[i] * (f.values[law] * e.depth + f.values[law + 2]) / f.values[law + 1]
    elif f.numbers[ONE_PLUS_R_HIGH if c.sides[i] > 0 else ONE_PLUS_R_LOW] == 1.0:
        return 0.0
    return v


@jit
def leaves_slowly(c, i):
    """Whether the gap leaves its stop like the third power of time after event i: it has rested there."""
    return c.rests[i] and not is_contact(c.compliant, c.sides[i])


@jit
def speed_before(c, i, e):
    """The speed into the stop before a rest; inf of a contact, which begins without one too."""
    return c.sides[i] * e.motion[0] if leaves_slowly(c, i) else np.inf


@jit
def leaves_at_stop(c, i, e):
    """Whether event i is a contact that ends as it begins, with the gap at its stop."""
    return c.rests[i] and is_contact(c.compliant, c.sides[i]) and e.depth == 0.0


@jit
def forced(b):
    """How many contacts end by their force, before the gap is at its stop. Where this changes the lengths of contacts
    have a corner, and the motion is smooth."""
    count = 0.0
    for i in range(len(b.events)):
        if b.events[i].depth != 0.0:
            count += 1.0
    return count


@jit
def take_releases(f, c, place, b):
    """The tests `relaxed` and `forced`, of releases by force."""
    place.tests[TEST.relaxed], place.tests[TEST.forced] = least_to_spare(f, c.compliant, c, place, b), forced(b)


@jit
def least_to_spare(f, compliant, c, place, b):
    """`time_to_spare`, of which nothing is compiled where no event lasts."""
    if compliant is None:
        return np.inf
    else:
        return time_to_spare(f, c, place, b)


@jit
def sign_of_events(c, place):
    """The sign of prod_i D_i, of impulses and lengths; 0.0 where it is not known: two compliant contacts vanished."""
    sign, negative = 1.0, 0
    for i in range(len(place.x)):
        if not (place.x[i, -1] if c.rests[i] else -c.sides[i] * place.x[i, -1]) > 0.0:
            sign, negative = -sign, negative + 1
    return 0.0 if negative > 1 and (is_contact(c.compliant, -1.0) or is_contact(c.compliant, 1.0)) else sign


@jit
def factor_of_grazes(f, c, place):
    """The product of the lengths at which a branch turns (`turns_at_graze`); 1.0 where there is none."""
    result = 1.0
    if c.compliant is not None:
        for i in range(len(place.x)):
            if c.rests[i] and turns_at_graze(f, c.compliant, c.sides[i]) and not is_watched(f, c, i):
                result *= place.x[i, -1]
    return result


@jit
def has_rests(c):
    """Whether the orbit rests on a rigid stop."""
    for i in range(len(c.rests)):
        if leaves_slowly(c, i):
            return True
    return False
