"""M1 on a stop: the chatter that brings it to rest, the rest, in which the other masses move, and the release."""

import numpy as np

from vibro_sweep.engine.motion.first_contact import first_contact, set_gap
from vibro_sweep.engine.motion.orbits import restitution_of, round_off
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER, bound_third_over, evaluate
from vibro_sweep.engine.tables.series import clear, fill_taylor
from vibro_sweep.engine.variational import tangent_at_rest, tangent_flight

CHATTER = 2.0**-53  # of a period: the error allowed in time when the rest of a chatter sequence is summed up
FADED = 1e-7  # of the fastest impact of the sequence: heights and energies of slower ones are rounding


@jit
def first_nonzero(c, first):
    """Index of the first coefficient from `first` on that is not zero; ORDER - 1 if there is none."""
    n = first
    while n < ORDER - 1 and c[n] == 0.0:
        n += 1
    return n


@jit
def mark_rest(o, records, k, s, side):
    """Log the beginning of a rest on `side`, or (0) its end."""
    o.events += 1
    if o.rests_logged < len(records.rests):
        row = records.rests[o.rests_logged]
        row[0], row[1], row[2], row[3] = o.period, k, s, side
    o.rests_logged += 1


@jit
def begin_rest(f, o, records, t, k, s, side, w):
    """M1 comes to rest on the stop, after impacts that were summed up over the time w.

    To tangent vectors the rest begins with the first of these: the sum of all that they do to dv2, ... is what the
    whole of dx1 does.
    """
    o.X[1] = o.fastest = 0.0
    o.resting = side
    round_off(o)
    mark_rest(o, records, k, s, side)
    if t.wanted:
        q = f.oscillator[0]
        tangent_flight.fly_to(t, o.lane, q, f.nodes, k, s - w)
        tangent_at_rest.rest(t, o.lane, q.kappa, q.push)
        carry_tangent(t, o, q, w)
        t.cell[o.lane], t.offset[o.lane] = k, s


@jit
def load_rest(q, o):
    """Series of the free acceleration of M1 in c[0], and of x2, ... in the other rows."""
    c, a, X, states, sin, cos = o.c, q.force, o.X, 2 * len(o.c), o.phase[0], o.phase[1]
    for n in range(1, ORDER):
        c[0, n] = 0.0
    for i in range(len(c)):
        c[i, 0] = X[2 * i]
        if i > 0:
            c[i, 1] = X[2 * i + 1]
    fill_taylor(q.held, 1, 0.0, sin, cos, 1.0, q.omega, c)
    start = a[0] * c[0, 0] + a[states + 2] if len(a) > states + 2 else a[0] * c[0, 0]
    for n in range(ORDER):
        total = a[states] * sin + a[states + 1] * cos
        for j in range(1, len(c)):
            total += a[2 * j] * c[j, n]
            if n < ORDER - 1:
                total += a[2 * j + 1] * ((n + 1.0) * c[j, n + 1])
        c[0, n] = total + start if n == 0 else total
        sin, cos = q.omega * cos / (n + 1.0), -q.omega * sin / (n + 1.0)


@jit
def carry_tangent(t, o, q, w):
    """Tangent vectors over a rest of the time w within a cell. Takes the series of the orbit for scratch."""
    c = o.c
    while w > 0.0:
        step = min(w, q.rest_step)
        w -= step
        clear(t.constrained)
        for column in range(2, 2 * len(c)):
            for i in range(len(c)):
                for n in range(ORDER):
                    c[i, n] = 0.0
            c[column // 2, column % 2] = 1.0
            fill_taylor(q.held, 1, 0.0, 0.0, 0.0, 0.0, q.omega, c)
            for i in range(1, len(c)):
                t.constrained[2 * i, column], t.constrained[2 * i + 1, column] = evaluate(c[i], step)
        tangent_at_rest.hold(t, o.lane)


@jit
def first_release(o, left, most):
    """Time at which the free acceleration, which points into the stop, changes sign: a root found like a contact; or is
    `most`, infinite of a rigid stop, beyond which the preload of a compliant one does not hold M1."""
    side, c1 = o.resting, o.c[0]
    gap = max(side * c1[0], 0.0)
    n = 0 if gap > 0.0 else first_nonzero(c1, 1)
    if side * c1[n] <= 0.0:
        return 0.0
    set_gap(o.gap, c1, gap, -side, n)
    d = first_contact(o.gap, bound_third_over(o.gap, left), left)
    if most < np.inf:
        gap = most - side * c1[0]
        n = 0 if gap > 0.0 else first_nonzero(c1, 1)
        if n > 0 and side * c1[n] > 0.0:
            return 0.0
        set_gap(o.gap, c1, gap, side, n)
        d = min(d, first_contact(o.gap, bound_third_over(o.gap, left), left))
    return d


@jit
def end_rest(o, records, k, s):
    """The stop lets M1 go."""
    o.resting = 0.0
    mark_rest(o, records, k, s, 0.0)


@jit
def chatter(q, stops, o, third, side, left):
    """Time in which the impacts to come accumulate, if they do so within the cell and can be summed up; else infinite.
    They are summed up where no height and no energy that is shown is left to them: at `FADED` speeds.

    With the acceleration a into the stop, flights last 2 v/a, 2 R v/a, ..., in all 2 v/(a (1 - R)) =: w. The change
    of a within w makes an error of about w (third w/a). The first flight, v^2/(2 a) high, must not reach the other
    stop.
    """
    speed, a = -side * o.X[1], 2.0 * side * o.c[0, 2]
    R = restitution_of(stops, side)
    if a <= 0.0 or R == 1.0 or speed > FADED * o.fastest:
        return np.inf
    w = 2.0 * speed / (a * (1.0 - R))
    change = third * w / a
    stays_near = speed * speed < a * (stops.right - stops.left)
    if stays_near and w < left and change < 1e-3 and w * change <= CHATTER * q.width * q.cells:
        return w
    return np.inf
