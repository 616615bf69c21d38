"""One orbit through one cell, event by event to the cell's end."""

import math

import numpy as np

from vibro_sweep.engine.motion.energy_sums import add_flight, add_impact
from vibro_sweep.engine.motion.first_contact import first_contact, set_gap
from vibro_sweep.engine.motion.orbits import (
    advance,
    advance_exactly,
    is_finite,
    restitution_of,
    round_off,
    take_samples,
    wall_of,
)
from vibro_sweep.engine.motion.rest import begin_rest, chatter, first_nonzero, stay_at_rest
from vibro_sweep.engine.simd.jit import jit, noinline
from vibro_sweep.engine.simd.lanes import alike
from vibro_sweep.engine.simd.memory import row
from vibro_sweep.engine.tables.flight import ORDER, bounds, evaluate, load
from vibro_sweep.engine.tables.twofold import add
from vibro_sweep.engine.variational import tangent, tangent_flight
from vibro_sweep.tables import outcomes as status

MOST_EVENTS = 100_000  # impacts, grazes and rests in one forcing period; an orbit that needs more gets a status
EXPLAINED = 64.0 * 2.0**-52  # of the sizes of the terms of x1: a distance from a stop that rounding can explain


@jit
def contact_on(q, o, stops, side, n, reach, left):
    """Offset of the first contact with the stop on `side`, infinite if there is none; n: as in `set_gap`."""
    gap = stops.right - o.c[0, 0] if side > 0.0 else o.c[0, 0] - stops.left
    if n == 0 and gap > reach:
        return np.inf
    set_gap(o.gap, o.c[0], gap, side, n)
    return first_contact(o.gap, bounds(q, o.gap[:])[1], left)


@jit
def next_contact(q, o, stops, side, n, reach, left):
    """Offset and side of the first contact in the rest of the cell.

    side: of the stop that M1 leaves, or 0; the gap to it has a zero of order n.
    """
    right = contact_on(q, o, stops, 1.0, n if side > 0.0 else 0, reach, left)
    other = contact_on(q, o, stops, -1.0, n if side < 0.0 else 0, reach, min(left, right))
    if not (other >= right or right != right):  # NaN, too, is passed on
        return other, -1.0
    return right, 1.0


@jit
def log_impact(o, records, k, s, side, v1, X):
    """Log an impact with v1; X: the state, for the other masses."""
    if o.log_side == 0.0 or o.log_side == side:
        if o.impacts_logged < len(records.impacts):
            row = records.impacts[o.impacts_logged]
            row[0], row[1], row[2], row[3], row[4] = o.period, k, s, side, v1
            for j in range(2, 2 * len(o.c)):
                row[3 + j] = X[j]
        o.impacts_logged += 1


@jit
def count_impact(o, side, v):
    o.events += 1
    if side > 0.0:
        o.impacts_right += 1
    else:
        o.impacts_left += 1
    o.slowest, o.fastest = min(o.slowest, abs(v)), max(o.fastest, abs(v))


@jit
def watch_rebound(q, o, records, k, d, side, v, impulse):
    """Keep an impact at offset d of cell k, and samples in the cell: of the old flight, and what the impulse adds."""
    advance(o, d)
    log_impact(o, records, k, d, side, v, o.X)
    take_samples(o, records, k, 0.0, d)
    times, samples = records.times, records.samples
    first = o.samples_taken
    take_samples(o, records, k, 0.0, q.width)
    for i in range(first, o.samples_taken):
        for j in range(len(q.series)):
            x, v = evaluate(q.impulse[j], times[i, 1] - d)
            samples[i, 2 * j] += impulse * x
            samples[i, 2 * j + 1] += impulse * v


@jit
def impact(f, stops, o, records, t, k, s, side, sin, cos):
    """v1 -> -R v1, and what is observed of it."""
    q, X, R = f.oscillator[0], o.X, restitution_of(stops, side)
    before = X[1]
    log_impact(o, records, k, s, side, before, X)
    count_impact(o, side, before)
    add_impact(records.sums, R, before)
    X[1] = -R * before
    for j in range(1, len(o.c)):
        if q.push[j] != 0.0:
            X[2 * j + 1] -= q.push[j] * ((1.0 + R) * before)
    if t.wanted:
        a, states = q.force, 2 * len(o.c)
        after = a[0] * X[0] + a[1] * X[1]
        for j in range(2, states, 2):
            after += a[j] * X[j] + a[j + 1] * X[j + 1]
        after += a[states] * sin + a[states + 1] * cos
        if len(a) > states + 2:
            after += a[states + 2]
        tangent_flight.fly_to(t, o.lane, q, f.nodes, k, s)
        # a1+ + R a1-, since a1+ - a1- = -drag (1 + R) v1-; of the paper's oscillator drag = -2 zeta
        steepness = (1.0 + R) * (after / before + q.drag * R)
        tangent.saltate(t, tangent_flight.only(o.lane), alike(steepness), alike(R))


@jit
def end_chatter(q, stops, o, records, k, s, side, w):
    """The impacts of the time w from offset s on are summed up: M1 stays at the stop, and M2 is where they leave it.

    A flight without them goes beyond the stop; through the damper that moves M2 by kappa = 2 zeta/mu_m of the way.
    """
    X, wall = o.X, wall_of(stops, side)
    o.resting, X[0] = side, wall
    take_samples(o, records, k, s, s + w)
    add_flight(records.sums, o, w)
    advance(o, w)
    for j in range(1, len(o.c)):
        X[2 * j + 1] -= q.kappa[j] * (X[0] - wall)
        if q.push[j] != 0.0:
            X[2 * j] -= q.push[j] * (X[0] - wall)
            X[2 * j + 1] -= q.push[j] * X[1]
    X[0] = wall
    o.chatters += 1


@jit
def size_at(c, u):
    """The sum of the sizes of the terms of the polynomial c at u."""
    size = 0.0
    for n in range(ORDER - 1, -1, -1):
        size = size * u + abs(c[n])
    return size


@jit
def is_beyond(stops, o, f, k):
    """Whether M1 is further behind a stop at node k than the rounding of its flight from node `base` explains.

    Of the flight that ended at node `base` no more is known than that it took up to a period.
    """
    q, nodes = f.oscillator[0], f.nodes
    beyond = max(o.X[0] - stops.right, stops.left - o.X[0])
    if beyond <= 0.0:
        return False
    size = abs(o.X[0])
    if k == o.base:
        size += abs(o.X[1]) * q.width * q.cells + q.largest
    else:
        E = nodes[k - o.base].E
        size += 0.0 if o.from_base else abs(nodes[k].z[0])
        for j in range(len(E)):
            size += abs(E[j, 0] * (o.start[j] if o.from_base else o.y[j]))
    return beyond > EXPLAINED * size


@noinline
def cross_cell(f, stops, o, records, t, k, s):
    """Follow the orbit from offset s in cell k to the cell's end, through all that happens. Returns a status."""
    q, node, X, c1 = f.oscillator[0], f.nodes[k], o.X, o.c[0]
    released, s_low = False, 0.0
    round_off(o)
    if s == 0.0 and is_beyond(stops, o, f, k):
        return status.BEYOND_STOP
    while o.events < MOST_EVENTS:
        left = (q.width - s) - s_low
        last = left <= 1.001 * q.step
        left = left if last else q.step
        sin, cos = node.z[2 * len(o.c)], node.z[2 * len(o.c) + 1]
        if s > 0.0:
            swing, turn = math.sin(q.omega * s), math.cos(q.omega * s)
            sin, cos = sin * turn + cos * swing, cos * turn - sin * swing
        if o.resting != 0.0:
            d = stay_at_rest(f, o, records, t, k, s, sin, cos, np.inf)
            if d != d:
                return status.UNRESOLVED
            if d == np.inf:
                return status.OK
            s += d
            released = True
            continue
        side = 1.0 if X[0] >= stops.right else (-1.0 if X[0] <= stops.left else 0.0)
        if side != 0.0:
            round_off(o)
        if side * X[1] > 0.0:
            impact(f, stops, o, records, t, k, s, side, sin, cos)
        load(q.series, row(X, 0), sin, cos, o.c)
        reach, third = bounds(q, c1)
        n = 1
        if side != 0.0 and X[1] == 0.0:
            n = first_nonzero(c1, 3 if released else 2)
            if side * c1[n] > 0.0:
                begin_rest(f, o, records, t, k, s, side, 0.0)
                continue
        elif side != 0.0:
            w = chatter(q, stops, o, third, side, left)
            if w < np.inf:
                end_chatter(q, stops, o, records, k, s, side, w)
                s += w
                begin_rest(f, o, records, t, k, s, side, w)
                continue
        d, side = next_contact(q, o, stops, side, n, reach, left)
        if d != d:
            return status.UNRESOLVED
        take_samples(o, records, k, s, s + min(d, left))
        add_flight(records.sums, o, min(d, left))
        if q.exact:
            advance_exactly(o, min(d, left))
        else:
            advance(o, min(d, left))
        if d == np.inf and (last or not is_finite(o)):
            return status.OK if is_finite(o) else status.NOT_FINITE
        if q.exact:
            s, s_low = add(s, s_low, min(d, left), 0.0)
        else:
            s += min(d, left)
        released = False
        if d == np.inf:
            continue
        wall = wall_of(stops, side)
        miss = abs(X[0] - wall)
        if miss > EXPLAINED * size_at(c1, d):
            return status.BEYOND_STOP
        o.miss = max(o.miss, miss)
        X[0] = wall
        if side * X[1] <= 0.0:  # it touched the stop without speed: a graze is not an impact
            X[1] = 0.0
            o.events += 1
    return status.EVENT_LIMIT
