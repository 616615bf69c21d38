"""One orbit through one cell: from contact to contact, through chatter and rest, to the cell's end."""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.kernels import status, tangent
from vibro_sweep.kernels.contact import first_contact
from vibro_sweep.kernels.flight import ORDER, evaluate, load
from vibro_sweep.kernels.jit import jit

MOST_EVENTS = 100_000  # impacts, grazes and rests in one forcing period; an orbit that needs more gets a status
CHATTER = 2.0**-53  # of a period: the error allowed in time when the rest of a chatter sequence is summed up


class Stops(NamedTuple):
    """The walls, infinite where there is none, and the coefficient of restitution."""

    left: float
    right: float
    R: float


# One orbit on its way, and what is counted of it.
ORBIT = np.dtype(
    [
        ("X", float, 4),  # x1, v1, x2, v2
        ("resting", float),  # side of the stop that M1 rests on, or 0
        ("c1", float, ORDER),  # Taylor coefficients of x1, or of the free acceleration of M1 at rest
        ("c2", float, ORDER),  # of x2
        ("period", np.int64),
        ("events", np.int64),  # impacts, grazes, and ends of rests in this period
        ("impacts_left", np.int64),
        ("impacts_right", np.int64),
        ("chatters", np.int64),  # sequences summed up
        ("slowest", float),  # least |v1| before an impact
        ("rest_time", float),
        ("log_volume", float),  # ln|det| of the jumps of the discontinuity mapping
        ("log_side", float),  # impacts on this side are logged; 0: on both
        ("impacts_logged", np.int64),  # or would have been, had there been room
        ("rests_logged", np.int64),
        ("samples_taken", np.int64),
    ]
)


class Records(NamedTuple):
    """What is kept of an orbit on its way; an observation that nobody wants has m = 0."""

    impacts: np.ndarray  # (m, 7): period, cell, offset, side, v1 before, x2, v2
    rests: np.ndarray  # (m, 4): period, cell, offset, side at the onset of a rest, 0 at its end
    times: np.ndarray  # (m, 2): cell and offset in this period at which the motion is sampled
    samples: np.ndarray  # (m, 4)


def new_records(impacts: int = 0, rests: int = 0, samples: int = 0) -> Records:
    """Room for so many entries of each kind."""
    return Records(np.empty((impacts, 7)), np.empty((rests, 4)), np.empty((samples, 2)), np.empty((samples, 4)))


@jit
def place(o, x1, v1, x2, v2):
    """Start an orbit here, with nothing counted yet."""
    o.X[0], o.X[1], o.X[2], o.X[3] = x1, v1, x2, v2
    o.resting = 0.0
    o.period = o.events = o.impacts_logged = o.rests_logged = o.samples_taken = 0
    start_count(o)


@jit
def start_count(o):
    """Count impacts and rest from here on."""
    o.impacts_left = o.impacts_right = o.chatters = 0
    o.slowest, o.rest_time, o.log_volume = np.inf, 0.0, 0.0


@jit
def advance(o, u):
    """The state at offset u of the series."""
    X, c1, c2 = o.X, o.c1, o.c2
    x1, v1, x2, v2 = c1[ORDER - 1], 0.0, c2[ORDER - 1], 0.0
    for n in range(ORDER - 2, -1, -1):
        v1 = v1 * u + x1
        x1 = x1 * u + c1[n]
        v2 = v2 * u + x2
        x2 = x2 * u + c2[n]
    X[0], X[1], X[2], X[3] = x1, v1, x2, v2


@jit
def sample(o, records, k, start, stop):
    """Take the samples that fall in cell k between the offset `start`, where the series begins, and `stop`."""
    times, samples = records.times, records.samples
    i = o.samples_taken
    while i < len(times) and times[i, 0] == k and times[i, 1] <= stop:
        u = max(times[i, 1] - start, 0.0)
        samples[i, 0], samples[i, 1] = evaluate(o.c1, u)
        samples[i, 2], samples[i, 3] = evaluate(o.c2, u)
        if o.resting != 0.0:
            samples[i, 0], samples[i, 1] = o.X[0], 0.0
        i += 1
    o.samples_taken = i


@jit
def sample_rebound(q, o, records, k, d, impulse):
    """The samples in cell k after an impact at offset d: of the old flight, and what the impulse adds to it."""
    times, samples = records.times, records.samples
    first = o.samples_taken
    sample(o, records, k, 0.0, q.width)
    for i in range(first, o.samples_taken):
        x1, v1 = evaluate(q.series1[1], times[i, 1] - d)
        x2, v2 = evaluate(q.series2[1], times[i, 1] - d)
        samples[i, 0] += impulse * x1
        samples[i, 1] += impulse * v1
        samples[i, 2] += impulse * x2
        samples[i, 3] += impulse * v2


@jit
def bounds(q, c):
    """Over a cell: how far x can move, and a bound on its third derivative. Summed by fours, for the vector unit."""
    reach, third = q.reach, q.third
    r0, r1, r2, r3, t0, t1, t2, t3 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for n in range(0, ORDER, 4):
        a0, a1, a2, a3 = abs(c[n]), abs(c[n + 1]), abs(c[n + 2]), abs(c[n + 3])
        r0 += reach[n] * a0
        r1 += reach[n + 1] * a1
        r2 += reach[n + 2] * a2
        r3 += reach[n + 3] * a3
        t0 += third[n] * a0
        t1 += third[n + 1] * a1
        t2 += third[n + 2] * a2
        t3 += third[n + 3] * a3
    return (r0 + r1) + (r2 + r3), (t0 + t1) + (t2 + t3)


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
def next_contact(stops, c, side, reach, third, start, left):
    """Offset and side of the first contact in the rest of the cell; `side` is the stop that M1 leaves, or 0."""
    gap = 0.0 if side > 0.0 else stops.right - c[0]
    right = first_contact(c, gap, 1.0, third, start, left) if gap <= reach else np.inf
    gap = 0.0 if side < 0.0 else c[0] - stops.left
    if gap <= reach:
        other = first_contact(c, gap, -1.0, third, start, min(left, right))
        if not (other >= right or right != right):  # NaN, too, is passed on
            return other, -1.0
    return right, 1.0


@jit
def log_impact(o, records, k, s, side, v1, x2, v2):
    if o.log_side == 0.0 or o.log_side == side:
        if o.impacts_logged < len(records.impacts):
            row = records.impacts[o.impacts_logged]
            row[0], row[1], row[2], row[3], row[4], row[5], row[6] = o.period, k, s, side, v1, x2, v2
        o.impacts_logged += 1


@jit
def count_impact(o, side, v):
    o.events += 1
    if side > 0.0:
        o.impacts_right += 1
    else:
        o.impacts_left += 1
    o.slowest = min(o.slowest, abs(v))


@jit
def impact(f, stops, o, records, t, k, s, side, sin, cos):
    """v1 -> -R v1, and what is observed of it."""
    q, X, R = f.oscillator[0], o.X, stops.R
    before = X[1]
    log_impact(o, records, k, s, side, before, X[2], X[3])
    count_impact(o, side, before)
    X[1] = -R * before
    if t.wanted:
        a = q.force
        after = (a[0] * X[0] + a[1] * X[1]) + (a[2] * X[2] + a[3] * X[3]) + (a[4] * sin + a[5] * cos)
        tangent.fly(t, q, f.nodes, k, s)
        # a1+ + R a1-, since a1+ - a1- = 2 zeta (1 + R) v1-
        tangent.saltate(t, q, R, (1.0 + R) * (after / before - 2.0 * q.zeta * R))


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
        tangent.fly(t, f.oscillator[0], f.nodes, k, s)
        tangent.rest(t, f.oscillator[0])


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
        tangent.release(t, q, xx, xv, vx, vv)
        t.cell, t.offset = k, s + end
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


@jit
def speed_and_acceleration(c, u):
    """First and second derivative of a series at u; even and odd terms go side by side."""
    w = u * u
    even, slope_even = (ORDER - 1.0) * c[ORDER - 1], 0.0
    odd, slope_odd = (ORDER - 2.0) * c[ORDER - 2], 0.0
    for n in range(ORDER - 3, 1, -2):
        slope_even = slope_even * w + even
        even = even * w + n * c[n]
        slope_odd = slope_odd * w + odd
        odd = odd * w + (n - 1.0) * c[n - 1]
    slope_even = slope_even * w + even
    even = even * w + c[1]
    return even + u * odd, odd + 2.0 * (u * slope_even + w * slope_odd)


@jit
def strike(f, stops, o, records, t, k):
    """Cross cell k from its node if there is one impact in it, or none, and nothing more can follow.

    The motion goes on as if there were no stop, and what the impulse -(1 + R) v1 does is added at the cell's end.
    Returns "free" 0 (the state is left alone), "struck" 1, or 2: it takes a closer look (`cross_cell`).
    """
    q, node, X, c, R = f.oscillator[0], f.nodes[k], o.X, o.c1, stops.R
    load(q.series1, X[0], X[1], X[2], X[3], node.sin, node.cos, c)
    reach, third = bounds(q, c)
    d, side = next_contact(stops, c, 0.0, reach, third, 0.0, q.width)
    watched = len(records.times) > 0 or len(records.impacts) > 0
    if watched:
        load(q.series2, X[0], X[1], X[2], X[3], node.sin, node.cos, o.c2)
    if d == np.inf:
        sample(o, records, k, 0.0, q.width)
        return 0
    v, a = speed_and_acceleration(c, d)
    left, impulse, after = q.width - d, -(1.0 + R) * v, a + 2.0 * q.zeta * (1.0 + R) * v
    third += abs(impulse) * q.impulse_third
    rebound = R * abs(v)
    stays_off = rebound > 0.5 * left * (max(side * after, 0.0) + left * third / 3.0)
    stays_short = left * (rebound + 0.5 * left * (abs(after) + left * third / 3.0)) < stops.right - stops.left
    if not (side * v > 0.0 and stays_off and stays_short):
        return 2
    count_impact(o, side, v)
    if watched:
        x2, v2 = evaluate(o.c2, d)
        log_impact(o, records, k, d, side, v, x2, v2)
        sample(o, records, k, 0.0, d)
        sample_rebound(q, o, records, k, d, impulse)
    if t.wanted:
        tangent.fly(t, q, f.nodes, k, d)
        tangent.saltate(t, q, R, (after + R * a) / v)
    E, r, end = f.nodes[1].E, node.r, f.nodes[k + 1].r
    y0, y1, y2, y3 = X[0] - r[0], X[1] - r[1], X[2] - r[2], X[3] - r[3]
    x1, v1 = evaluate(q.series1[1], left)
    x2, v2 = evaluate(q.series2[1], left)
    X[0] = (E[0, 0] * y0 + E[0, 1] * y1) + (E[0, 2] * y2 + E[0, 3] * y3) + (end[0] + impulse * x1)
    X[1] = (E[1, 0] * y0 + E[1, 1] * y1) + (E[1, 2] * y2 + E[1, 3] * y3) + (end[1] + impulse * v1)
    X[2] = (E[2, 0] * y0 + E[2, 1] * y1) + (E[2, 2] * y2 + E[2, 3] * y3) + (end[2] + impulse * x2)
    X[3] = (E[3, 0] * y0 + E[3, 1] * y1) + (E[3, 2] * y2 + E[3, 3] * y3) + (end[3] + impulse * v2)
    return 1


@jit
def cross_cell(f, stops, o, records, t, k, s):
    """Follow the orbit from offset s in cell k to the cell's end, through all that happens. Returns a status."""
    q, node, X, c1 = f.oscillator[0], f.nodes[k], o.X, o.c1
    released = False
    while o.events < MOST_EVENTS:
        left = q.width - s
        last = left <= 1.001 * q.step
        left = left if last else q.step
        sin, cos = node.sin, node.cos
        if s > 0.0:
            swing, turn = math.sin(q.omega * s), math.cos(q.omega * s)
            sin, cos = sin * turn + cos * swing, cos * turn - sin * swing
        if o.resting != 0.0:
            d = stay_at_rest(f, o, records, t, k, s, left, sin, cos)
            if d != d:
                return status.UNRESOLVED
            released = d < np.inf
            if last and not released:
                return status.OK
            s += min(d, left)
            continue
        side = 1.0 if X[0] >= stops.right else (-1.0 if X[0] <= stops.left else 0.0)
        if side * X[1] > 0.0:
            impact(f, stops, o, records, t, k, s, side, sin, cos)
        load(q.series1, X[0], X[1], X[2], X[3], sin, cos, c1)
        load(q.series2, X[0], X[1], X[2], X[3], sin, cos, o.c2)
        reach, third = bounds(q, c1)
        start = 0.0
        if side != 0.0 and X[1] == 0.0:
            n = leading(c1, 3 if released else 2)
            if side * c1[n] > 0.0:
                begin_rest(f, o, records, t, k, s, side)
                continue
            start = departure(q, c1, n, left)
        elif side != 0.0:
            w = chatter(q, stops, o, third, side, left)
            if w < np.inf:
                sample(o, records, k, s, s + w)
                advance(o, w)
                X[0] = stops.right if side > 0.0 else stops.left
                s += w
                o.chatters += 1
                begin_rest(f, o, records, t, k, s, side)
                continue
        d, side = next_contact(stops, c1, side, reach, third, start, left)
        if d != d:
            return status.UNRESOLVED
        sample(o, records, k, s, s + min(d, left))
        advance(o, min(d, left))
        if d == np.inf and (last or not math.isfinite(X[1] + X[3])):
            return status.OK if math.isfinite(X[1] + X[3]) else status.NOT_FINITE
        s += min(d, left)
        released = False
        if d == np.inf:
            continue
        X[0] = stops.right if side > 0.0 else stops.left
        if side * X[1] <= 0.0:  # it touched the stop without speed: a graze is no impact
            X[1] = 0.0
            o.events += 1
    return status.EVENT_LIMIT
