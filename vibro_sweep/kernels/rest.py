"""M1 on a stop: the chatter that brings it to rest, the rest, the release, and a departure without speed."""

import numpy as np

from vibro_sweep.kernels import tangent
from vibro_sweep.kernels.contact import first_contact
from vibro_sweep.kernels.flight import ORDER, bounds, evaluate
from vibro_sweep.kernels.jit import jit
from vibro_sweep.kernels.orbits import sample

CHATTER = 2.0**-53  # of a period: the error allowed in time when the rest of a chatter sequence is summed up


@jit
def leading(c, first):
    """Index of the first coefficient from `first` on that is not zero; ORDER - 1 if there is none."""
    n = first
    while n < ORDER - 1 and c[n] == 0.0:
        n += 1
    return n


@jit
def departure(q, c, n, left):
    """An offset up to which a polynomial that starts as c_n u^n does not come back to 0."""
    others, power = 0.0, 1.0
    for m in range(n + 1, ORDER):
        others += abs(c[m]) * power
        power *= q.step
    return min(left, 0.5 * abs(c[n]) / others) if others > 0.0 else left


@jit
def mark_rest(o, records, k, s, side):
    """Log the beginning of a rest on `side`, or (0) its end."""
    o.events += 1
    if o.rests_logged < len(records.rests):
        row = records.rests[o.rests_logged]
        row[0], row[1], row[2], row[3] = o.period, k, s, side
    o.rests_logged += 1


@jit
def begin_rest(f, o, records, t, k, s, side):
    """M1 comes to rest on the stop."""
    o.X[1] = 0.0
    o.resting = side
    mark_rest(o, records, k, s, side)
    if t.wanted:
        tangent.fly_to(t, o.lane, f.oscillator[0], f.nodes, k, s)
        tangent.rest(t, o.lane)


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
        start = departure(q, c1, n, left) if n > 1 else 0.0
        d = first_contact(c1, gap, -side, bounds(q, c1)[1], start, left)
    end = min(d, left)
    sample(o, records, k, s, s + end)
    X[2], X[3] = evaluate(c2, end)
    o.rest_time += end
    if t.wanted:
        xx, vx = evaluate(q.resting2[1], end)
        xv, vv = evaluate(q.resting2[2], end)
        tangent.release(t, o.lane, xx, xv, vx, vv)
        t.cell[o.lane], t.offset[o.lane] = k, s + end
    if d < np.inf:
        o.resting = 0.0
        mark_rest(o, records, k, s + d, 0.0)
    return d


@jit
def chatter(q, stops, o, third, side, left):
    """Time in which the impacts to come accumulate, if they do so within the cell and can be summed up; else infinite.

    With the acceleration a into the stop, flights last 2 v/a, 2 R v/a, ..., in all 2 v/(a (1 - R)) =: w. The change
    of a within w makes an error of about w (third w/a).
    """
    speed, a = -side * o.X[1], 2.0 * side * o.c1[2]
    if a <= 0.0 or stops.R == 1.0:
        return np.inf
    w = 2.0 * speed / (a * (1.0 - stops.R))
    change = third * w / a
    if w < left and change < 1e-3 and w * change <= CHATTER * q.width * q.cells:
        return w
    return np.inf
