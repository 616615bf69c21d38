"""Impacts on rigid stops, one by one or many at once, and what is observed of them."""

from vibro_sweep.engine.motion.energy_sums import add_flight, add_impact
from vibro_sweep.engine.motion.orbits import (
    advance,
    restitution_of,
    take_samples,
    wall_of,
)
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import alike
from vibro_sweep.engine.tables.flight import evaluate
from vibro_sweep.engine.variational import tangent, tangent_flight

EXPLAINED = 64.0 * 2.0**-52  # of the sizes of the terms of x1: a distance from a stop that rounding can explain


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
def impact(f, stops, o, records, t, k, s, side):
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
        after += a[states] * o.phase[0] + a[states + 1] * o.phase[1]
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
