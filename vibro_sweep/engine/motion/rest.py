"""M1 on a stop: the chatter that brings it to rest, the rest, and the release."""

import numpy as np

from vibro_sweep.engine.motion.contact import first_contact, set_gap
from vibro_sweep.engine.motion.orbits import sample
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER, bounds, evaluate
from vibro_sweep.engine.variational import tangent

CHATTER = 2.0**-53  # of a period: the error allowed in time when the rest of a chatter sequence is summed up


@jit
def leading(c, first):
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
def release(q, t, i, w):
    """Carry tangent vectors over a rest of the time w within a cell."""
    xx, vx = evaluate(q.resting2[1], w)
    xv, vv = evaluate(q.resting2[2], w)
    tangent.release(t, i, xx, xv, vx, vv)


@jit
def begin_rest(f, o, records, t, k, s, side, w):
    """M1 comes to rest on the stop, after impacts that were summed up over the time w.

    To tangent vectors the rest begins with the first of these: the sum of all that they do to dv2 is what the whole of
    dx1 does.
    """
    o.X[1] = 0.0
    o.resting = side
    mark_rest(o, records, k, s, side)
    if t.wanted:
        q = f.oscillator[0]
        tangent.fly_to(t, o.lane, q, f.nodes, k, s - w)
        tangent.rest(t, o.lane, q.kappa)
        release(q, t, o.lane, w)
        t.cell[o.lane], t.offset[o.lane] = k, s


@jit
def stay_at_rest(f, o, records, t, k, s, left, sin, cos):
    """M1 rests from offset s of cell k on, M2 moves. Returns the time to the release, infinite if more than `left`.

    M1 is released where its free acceleration, which points into the stop, changes sign: a root found like a contact.
    """
    q, X, c1, c2, side = f.oscillator[0], o.X, o.c1, o.c2, o.resting
    a, b = q.resting1, q.resting2
    for n in range(ORDER):
        c1[n] = (a[0, n] * X[0] + a[1, n] * X[2]) + (a[2, n] * X[3] + a[3, n] * sin) + a[4, n] * cos
        c2[n] = (b[0, n] * X[0] + b[1, n] * X[2]) + (b[2, n] * X[3] + b[3, n] * sin) + b[4, n] * cos
    gap = max(side * c1[0], 0.0)
    n = 0 if gap > 0.0 else leading(c1, 1)
    d = 0.0
    if side * c1[n] > 0.0:
        set_gap(o.gap, c1, gap, -side, n)
        d = first_contact(o.gap, bounds(q, o.gap)[1], left)
    end = min(d, left)
    sample(o, records, k, s, s + end)
    X[2], X[3] = evaluate(c2, end)
    o.rest_time += end
    if t.wanted:
        release(q, t, o.lane, end)
        t.cell[o.lane], t.offset[o.lane] = k, s + end
    if d < np.inf:
        o.resting = 0.0
        mark_rest(o, records, k, s + d, 0.0)
    return d


@jit
def chatter(q, stops, o, third, side, left):
    """Time in which the impacts to come accumulate, if they do so within the cell and can be summed up; else infinite.

    With the acceleration a into the stop, flights last 2 v/a, 2 R v/a, ..., in all 2 v/(a (1 - R)) =: w. The change
    of a within w makes an error of about w (third w/a). The first flight, v^2/(2 a) high, must not reach the other
    stop.
    """
    speed, a = -side * o.X[1], 2.0 * side * o.c1[2]
    if a <= 0.0 or stops.R == 1.0:
        return np.inf
    w = 2.0 * speed / (a * (1.0 - stops.R))
    change = third * w / a
    stays_near = speed * speed < a * (stops.right - stops.left)
    if stays_near and w < left and change < 1e-3 and w * change <= CHATTER * q.width * q.cells:
        return w
    return np.inf
