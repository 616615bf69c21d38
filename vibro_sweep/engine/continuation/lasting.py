"""Events that last: a rest where R = 0, or a contact with a compliant stop. Which of them it is, is asked here alone.

`compliant` is `Problem.compliant`. Where it is None the branches with contacts are not compiled.
"""

import numpy as np

from vibro_sweep.engine.continuation.compliant_contact import contact, least_depth, press_gap
from vibro_sweep.engine.continuation.constrained_gap import constrain_gap, press, rest
from vibro_sweep.engine.continuation.contact_derivative import differentiate_contact
from vibro_sweep.engine.continuation.contact_power_series import press_series
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, ONE_PLUS_R_HIGH, ONE_PLUS_R_LOW, law_at
from vibro_sweep.engine.continuation.problem import GRAZE
from vibro_sweep.engine.continuation.relaxation import time_to_spare
from vibro_sweep.engine.continuation.workspace import TEST
from vibro_sweep.engine.simd.jit import jit

ROUNDED = 1e-12  # of numbers of size 1, between polynomials
OUTWARDS = 1e-6  # speed, in units of a branch: more than what is left of it beside a graze


@jit
def is_contact(compliant, side):
    """Whether an event that lasts on this side is a contact."""
    if compliant is None:
        return False
    else:
        return compliant[1 if side > 0 else 0]


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
    place.tests[TEST.relaxed], place.tests[TEST.forced] = np.inf, forced(b)
    if c.compliant is not None:
        place.tests[TEST.relaxed] = time_to_spare(f, c, place, b)


@jit
def sign_of_events(c, place):
    """The sign of prod_i D_i, of impulses and lengths; 0.0 where it is not known: two compliant contacts vanished."""
    sign, negative = 1.0, 0
    for i in range(len(place.x)):
        if not (place.x[i, -1] if c.rests[i] else -c.sides[i] * place.x[i, -1]) > 0.0:
            sign, negative = -sign, negative + 1
    return 0.0 if negative > 1 and c.compliant is not None else sign


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
def last(f, compliant, side, x, e, work):
    """`after`, `carry`, `pull` and `release` of an event that lasts."""
    if compliant is None:
        rest(f, side, x, e, work.resting)
    elif is_contact(compliant, side):
        contact(f, side, x, e, work)
    else:
        rest(f, side, x, e, work.resting)


@jit
def differentiate_last(f, compliant, side, x, e, through, work):
    """Add the terms of a contact to the derivative along a null vector; curves of orbits that rest are not followed."""
    if compliant is not None:
        differentiate_contact(f, side, x, e, through, work)


@jit
def last_series(f, compliant, side, x, e, y, work):
    """The state y after a contact, and its rows, as power series."""
    if compliant is not None:
        press_series(f, side, x, e, y, work)


@jit
def has_rests(c):
    """Whether the orbit rests on a rigid stop."""
    for i in range(len(c.rests)):
        if leaves_slowly(c, i):
            return True
    return False


@jit
def state_within(f, compliant, side, x, delay, e, work, state):
    """The whole motion (n,) so long after the event has begun."""
    n, room = f.A.shape[0], work.resting
    if compliant is None:
        constrain_gap(f, side, x, delay, e, room)
    elif is_contact(compliant, side):
        press_gap(f, side, x, delay, e, work)
        room[0, 0, n] += f.numbers[HIGH if side > 0 else LOW]
    else:
        constrain_gap(f, side, x, delay, e, room)
    for r in range(n):
        state[r] = room[0, r, n]


@jit
def hold_of(f, compliant, side, x, e, work):
    """What keeps it up: the least acceleration into the stop during a rest, the least depth of a contact."""
    if compliant is None:
        return press(f, side, x, e, work)
    elif is_contact(compliant, side):
        return least_depth(f, side, x, e, work)
    else:
        return press(f, side, x, e, work)
