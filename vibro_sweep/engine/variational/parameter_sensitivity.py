"""Derivatives of the state at a section by the state and the parameters at the start, along an orbit that is known.

The impacts and rests on the way are given, as the event loop recorded them. With z' = A z between them (z in phase s =
omega t, in the coordinates of the masses: sensitivity.py of the oscillator) a derivative dz obeys the same equation
with the source (A_p/dp) z. Where dz is kept at a fixed phase, an event acts on it through the distance d = n.dx - dw
by which it moves the gap n.x towards the stop at w, with p = M^-1 n/(n.M^-1 n):

    impact   dx -> dx - (1 + R) p d,     dv -> dv + (a+ - a-) d/g' - p ((1 + R) dg' + g' dR) - (1 + R) g' dp
    rest     dx -> dx - p d,             dv -> dv - p n.dv - g' dp + (1 - p n^T) M^-1 C p d

with g' the speed of the gap before, dg' = n.dv - n.a- d/g' its change at the contact, and a-, a+ the accelerations
about it: the saltation matrix, with the motion of the stop, of R and of p. At a rest the others receive through the
dampers what moves the gap to the stop at once. The same holds where a chatter sequence that was summed up ends in a
rest, at the last impact that was listed: the sum of these terms over all that follow is what brings d to 0, whenever
the rest begins. A release changes nothing, since all is continuous there; neither does a graze that is not an impact.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.simd.jit import exported, jit
from vibro_sweep.engine.variational.propagator import advance
from vibro_sweep.tables import outcomes as status


class Equations(NamedTuple):
    """One oscillator, as derivatives need it. dz has 2 N columns by the state, and one for each wanted parameter."""

    A: np.ndarray  # (k, k) with k = 2 N + 3, in flight
    A_p: np.ndarray  # (m, k, k): derivatives by the parameters that change the motion,
    constrained: np.ndarray  # while a stop holds the gap
    constrained_p: np.ndarray
    columns: np.ndarray  # (m,): which stand in these columns of dz
    rate: float  # the fastest of A and `constrained`
    omega: float
    normal: np.ndarray  # (N,): n
    push: np.ndarray  # (N,): p
    drag: np.ndarray  # (N,): (1 - p n^T) M^-1 C p
    walls: np.ndarray  # (2,): positions of the left stop and of the right one,
    restitution: np.ndarray  # (2,)
    push_slopes: np.ndarray  # (N, columns of dz) derivatives of p,
    wall_slopes: np.ndarray  # (2, columns)
    restitution_slopes: np.ndarray  # (2, columns)
    omega_slopes: np.ndarray  # (columns,)
    tau_slopes: np.ndarray  # (columns,)
    tau: float  # phase of the force at node 0 of the grid
    cells: int
    width: float  # of a cell


@jit
def set_phase(e, cell, offset, z, dz):
    """sin, cos and 1 there, and their derivatives."""
    phase, states = e.tau + 2.0 * np.pi * (cell / e.cells) + e.omega * offset, 2 * len(e.normal)
    z[states], z[states + 1], z[states + 2] = np.sin(phase), np.cos(phase), 1.0
    for j in range(dz.shape[1]):
        dz[states, j], dz[states + 1, j] = z[states + 1] * e.tau_slopes[j], -z[states] * e.tau_slopes[j]
        dz[states + 2, j] = 0.0


@jit
def place_of(side):
    """The index of a stop among the two."""
    return 1 if side > 0.0 else 0


@jit
def acceleration_of(e, i, z):
    """x_i''."""
    total = 0.0
    for k in range(len(z)):
        total += e.omega * e.A[2 * i + 1, k] * z[k]
    return total


@jit
def gap_of(e, column, first):
    """n.x (first = 0) or n.v (first = 1) of a column like z."""
    total = 0.0
    for i in range(len(e.normal)):
        total += e.normal[i] * column[2 * i + first]
    return total


@jit
def cross_impact(e, side, speed, z, dz, bend):
    """z and dz across an impact on this side with this speed of the gap. bend (2, N): scratch for a- and a+."""
    n, masses = place_of(side), len(e.normal)
    R, pull = e.restitution[n], 0.0
    for i in range(masses):
        bend[0, i] = acceleration_of(e, i, z)
        pull += e.normal[i] * bend[0, i]
    for i in range(masses):
        z[2 * i + 1] -= (1.0 + R) * speed * e.push[i]
    for i in range(masses):
        bend[1, i] = acceleration_of(e, i, z)
    for j in range(dz.shape[1]):
        late = (e.wall_slopes[n, j] - gap_of(e, dz[:, j], 0)) / speed  # time by which the contact comes later
        faster = gap_of(e, dz[:, j], 1) + pull * late
        lost = (1.0 + R) * faster + speed * e.restitution_slopes[n, j]
        for i in range(masses):
            dz[2 * i, j] += (1.0 + R) * speed * late * e.push[i]
            dz[2 * i + 1, j] += (bend[0, i] - bend[1, i]) * late - e.push[i] * lost
            dz[2 * i + 1, j] -= (1.0 + R) * speed * e.push_slopes[i, j]


@jit
def come_to_rest(e, side, z, dz):
    """z and dz where the gap comes to rest on the stop."""
    n, masses = place_of(side), len(e.normal)
    beyond, speed = gap_of(e, z, 0) - e.walls[n], gap_of(e, z, 1)
    for i in range(masses):
        z[2 * i] -= e.push[i] * beyond
        z[2 * i + 1] -= e.push[i] * speed
    for j in range(dz.shape[1]):
        d, faster = gap_of(e, dz[:, j], 0) - e.wall_slopes[n, j], gap_of(e, dz[:, j], 1)
        for i in range(masses):
            dz[2 * i, j] -= e.push[i] * d
            dz[2 * i + 1, j] += e.drag[i] * d - e.push[i] * faster - speed * e.push_slopes[i, j]


@jit
def is_before(row, other):
    """Whether the event `row` is earlier than `other`; both begin with period, cell, offset."""
    for n in range(2):
        if row[n] != other[n]:
            return row[n] < other[n]
    return row[2] < other[2]


@jit
def fly_to(e, resting, now, there, z, dz, w):
    """Carry z and dz to the place `there` (period, cell, offset)."""
    cells = (there[0] - now[0]) * e.cells + (there[1] - now[1])
    angle = 2.0 * np.pi * (cells / e.cells) + e.omega * (there[2] - now[2])
    if resting != 0.0:
        advance(e.constrained, e.constrained_p, e.rate, angle, z, dz, e.columns, w)
    else:
        advance(e.A, e.A_p, e.rate, angle, z, dz, e.columns, w)
    set_phase(e, there[1], there[2], z, dz)
    for n in range(3):
        now[n] = there[n]


@jit
def follow(e, leaving, impacts, rests, now, end, z, dz, bend, w):
    """Carry z and dz from the place `now` to `end`, through these impacts and rests.

    leaving: the gap is at a stop and its speed is not zero; then a rest that is next follows a chatter summed up.
    """
    i, j, resting = 0, 0, 0.0
    while i < len(impacts) or j < len(rests):
        if j == len(rests):
            impact_next = True
        elif i == len(impacts):
            impact_next = False
        else:  # at the same time: an impact without restitution before its rest, and a release before all else
            impact_next = is_before(impacts[i], rests[j]) or (resting == 0.0 and not is_before(rests[j], impacts[i]))
        if impact_next:
            row = impacts[i]
            fly_to(e, resting, now, row, z, dz, w)
            for k in range(2 * len(e.normal)):
                z[k] = row[5 + k]
            cross_impact(e, row[3], row[4], z, dz, bend)
            leaving = e.restitution[place_of(row[3])] * row[4] != 0.0
            i += 1
            continue
        row = rests[j]
        if not (row[3] != 0.0 and leaving):
            fly_to(e, resting, now, row, z, dz, w)
        if row[3] != 0.0:
            come_to_rest(e, row[3], z, dz)
        resting, leaving = row[3], False
        j += 1
    fly_to(e, resting, now, end, z, dz, w)


@exported
def differentiate(
    e, first_cell, states, leaving, statuses, impacts, counts, rests, rest_counts, end, now, z, dz, bend, w, out
):
    """out (n, 2 N, columns): derivatives at the place `end` of n orbits that start in `states` (n, 2 N).

    They start at `first_cell`; leaving (n,): see `follow`. impacts (n, m, 5 + 2 N): period, cell, offset, side, speed
    of the gap before it and the state there; rests (n, m, 4) as in `motion.orbits.Records`; of both the first `counts`
    (n,) and `rest_counts` (n,) are used. A place is (period, cell, offset). now (3,), z (k,), dz (k, columns), bend
    (2, N) and w: scratch. NaN where a status is not `OK`.
    """
    count = states.shape[1]
    for n in range(len(states)):
        if statuses[n] != status.OK:
            for i in range(count):
                for j in range(dz.shape[1]):
                    out[n, i, j] = np.nan
            continue
        now[0], now[1], now[2] = 0.0, first_cell, 0.0
        for i in range(count):
            z[i] = states[n, i]
            for j in range(dz.shape[1]):
                dz[i, j] = 1.0 if i == j else 0.0
        set_phase(e, now[1], 0.0, z, dz)
        follow(e, leaving[n], impacts[n, : counts[n]], rests[n, : rest_counts[n]], now, end, z, dz, bend, w)
        for i in range(count):
            for j in range(dz.shape[1]):
                out[n, i, j] = dz[i, j]
