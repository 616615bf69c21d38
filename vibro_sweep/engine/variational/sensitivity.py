"""Derivatives of the state at a section by the state and the parameters at the start, along an orbit that is known.

The impacts and rests on the way are given, as the event loop recorded them. With z' = A z between them (z in phase s =
omega t, see model/sensitivity.py) a derivative dz obeys the same equation with the source (A_p/dp) z. Where dz is kept
at a fixed phase, an event acts on it through the distance d = dx1 - dw by which it moves M1 towards the stop at w:

    impact   dx1 -> dx1 - (1 + R) d,     dv1 -> -R dv1 + d (a1+ + R a1-)/v1 - v1 dR,     dv2 -> dv2 - (1 + R) kappa d
    rest     dx1 -> dw,                  dv1 -> 0,                                       dv2 -> dv2 - kappa d

with kappa = 2 zeta/mu_m, v1 the speed before the impact, and a1-, a1+ the accelerations about it: the saltation matrix,
with the motion of the stop and of R. At a rest M2 receives through the damper what moves M1 to the stop at once. The
same holds where a chatter sequence that was summed up ends in a rest, at the last impact that was listed: the sum of
the terms kappa d of all that follow is what brings d to 0, whenever the rest begins. A release changes nothing, since
all is continuous there; neither does a graze that is no impact.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.simd.jit import entry, jit
from vibro_sweep.engine.variational.propagator import advance
from vibro_sweep.model import status

TAU_COLUMN = 11  # of dz: four of the state, then eight in the order of the parameters


class Equations(NamedTuple):
    """One oscillator, as derivatives need it. The derivatives A_p are empty where none by parameters is wanted."""

    A: np.ndarray  # (6, 6), in flight
    A_p: np.ndarray  # (5 or 0, 6, 6)
    A_held: np.ndarray  # while M1 rests on a stop
    A_held_p: np.ndarray
    rate: float  # the fastest of A and A_held
    omega: float
    walls: np.ndarray  # (2,): positions of the left stop and of the right one,
    restitution: np.ndarray  # (2,), and
    wall_slopes: np.ndarray  # (2, columns of dz) their derivatives
    restitution_slopes: np.ndarray  # (2, columns)
    kappa: float
    tau: float  # phase of the force at node 0 of the grid
    cells: int
    width: float  # of a cell


@jit
def set_phase(e, cell, offset, z, dz):
    """sin and cos there, and their derivative by tau."""
    phase = e.tau + 2.0 * np.pi * (cell / e.cells) + e.omega * offset
    z[4], z[5] = np.sin(phase), np.cos(phase)
    if dz.shape[1] > TAU_COLUMN:
        dz[4, TAU_COLUMN], dz[5, TAU_COLUMN] = z[5], -z[4]


@jit
def place_of(side):
    """Of a stop among the two."""
    return 1 if side > 0.0 else 0


@jit
def cross_impact(e, side, z, dz):
    """z and dz across an impact on this side."""
    n = place_of(side)
    R, v, before, after = e.restitution[n], z[1], 0.0, 0.0
    for k in range(6):
        before += e.omega * e.A[1, k] * z[k]
    z[1] = -R * v
    for k in range(6):
        after += e.omega * e.A[1, k] * z[k]
    steepness = (after + R * before) / v
    for j in range(dz.shape[1]):
        d = dz[0, j] - e.wall_slopes[n, j]
        dz[0, j] -= (1.0 + R) * d
        dz[1, j] = steepness * d - R * dz[1, j]
        dz[3, j] -= (1.0 + R) * e.kappa * d
        if e.restitution_slopes[n, j] != 0.0:
            dz[1, j] -= v * e.restitution_slopes[n, j]


@jit
def come_to_rest(e, side, z, dz):
    """z and dz where M1 comes to rest on the stop."""
    n = place_of(side)
    z[0], z[1] = e.walls[n], 0.0
    for j in range(dz.shape[1]):
        d = dz[0, j] - e.wall_slopes[n, j]
        dz[0, j] -= d
        dz[1, j] = 0.0
        dz[3, j] -= e.kappa * d


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
        advance(e.A_held, e.A_held_p, e.rate, angle, z, dz, w)
    else:
        advance(e.A, e.A_p, e.rate, angle, z, dz, w)
    set_phase(e, there[1], there[2], z, dz)
    for n in range(3):
        now[n] = there[n]


@jit
def follow(e, impacts, rests, now, end, z, dz, w):
    """Carry z and dz from the place `now` to `end`, through these impacts and rests."""
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
            z[0], z[1], z[2], z[3] = e.walls[place_of(row[3])], row[4], row[5], row[6]
            cross_impact(e, row[3], z, dz)
            i += 1
            continue
        row = rests[j]
        summed_up = row[3] != 0.0 and z[0] == e.walls[place_of(row[3])] and z[1] != 0.0
        if not summed_up:
            fly_to(e, resting, now, row, z, dz, w)
        if row[3] != 0.0:
            come_to_rest(e, row[3], z, dz)
        resting = row[3]
        j += 1
    fly_to(e, resting, now, end, z, dz, w)


@entry
def differentiate(e, first_cell, states, statuses, impacts, counts, rests, rest_counts, end, now, z, dz, w, out):
    """out (n, 4, 4 or 12): derivatives at the place `end` of n orbits that start in `states` (n, 4) at `first_cell`.

    impacts (n, m, 7) and rests (n, m, 4) as in `motion.orbits.Records`, of which the first `counts` (n,) and
    `rest_counts` (n,) are used. A place is (period, cell, offset). now (3,), z (6,), dz (6, 4 or 12) and w: scratch.
    NaN where a status is not `OK`.
    """
    for n in range(len(states)):
        if statuses[n] != status.OK:
            for i in range(4):
                for j in range(dz.shape[1]):
                    out[n, i, j] = np.nan
            continue
        now[0], now[1], now[2] = 0.0, first_cell, 0.0
        for i in range(6):
            z[i] = states[n, i] if i < 4 else 0.0
            for j in range(dz.shape[1]):
                dz[i, j] = 1.0 if i == j and i < 4 else 0.0
        set_phase(e, now[1], 0.0, z, dz)
        follow(e, impacts[n, : counts[n]], rests[n, : rest_counts[n]], now, end, z, dz, w)
        for i in range(4):
            for j in range(dz.shape[1]):
                out[n, i, j] = dz[i, j]
