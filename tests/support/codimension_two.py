"""Points of codimension two that the monodromy matrix alone does not define, in many digits."""

import numpy as np
from mpmath import mp
from reference.closed_orbit import ClosedOrbit
from reference.machine import machine_of

from support.branches import closed_of, located
from support.compliant_bifurcations import CONDITIONS
from vibro_sweep.analysis.branches.special import bare
from vibro_sweep.types import PeriodicOrbit

SLOW = 1e-9


def error_of(special) -> float:
    """By how much Newton's method, with the equations of the point's type, moves the parameters."""
    vanishing = special.type in ("resonant_graze", "neimark_sacker_graze") and not special.touches
    solution, touches = (special.orbit._solution, []) if vanishing else without_grazes(special)
    conditions, theta = CONDITIONS.get(special.type, []), None
    if vanishing:
        theta = angle_at(special, solution)
        kind = "pair" if special.type == "neimark_sacker_graze" else "flip" if theta else "fold"
        # where several vanish at once, the others stay in proportion to the first
        conditions = [kind, ("vanishing", slow_impacts(solution)[0])]
    return max(map(abs, located(solution, list(special.parameters), conditions, touches, theta)))


def without_grazes(special):
    """The orbit without impacts that have no speed, and [(time, side)] where it touches a stop instead."""
    solution, count = special.orbit._solution, int(special.touches)
    for k in reversed(slow_impacts(solution)):
        solution, count = bare(solution, k), count + 1
    first, P = solution.times[0], solution.P
    times = first + np.linspace(0, P, 40_001)[1:-1]
    gap = PeriodicOrbit(special.orbit.system, "ok", solution, (0, 0)).sample(times)[:, 0]
    q, found = solution.family.linear, []
    for i in np.flatnonzero(np.diff(np.sign(np.diff(gap)))) + 1:
        side = 1 if gap[i] > gap[i - 1] else -1
        at_impact = np.abs(solution.times - times[i]).min() < 2 * (times[1] - times[0])
        found += [] if at_impact else [(side * (q.stop([side])[0] - gap[i]), times[i], side)]
    return solution, [(time, side) for _, time, side in sorted(found)[:count]]


def angle_at(special, solution) -> float:
    """theta of the critical multiplier: 0 or pi at a resonant graze."""
    angles = [0, mp.pi] if special.type == "resonant_graze" else mp.linspace(0.01, mp.pi - 0.01, 300)
    d = closed_of(solution)
    closed = ClosedOrbit(machine_of(d.q), *d.of)
    J = closed.residual_and_jacobian([a for part in d.guess for a in part])[1]
    return float(min(angles, key=lambda angle: abs(mp.det(closed.linearised(J, mp.expj(angle))))))


def slow_impacts(solution) -> list[int]:
    least = SLOW * solution.family.linear.omega * solution.size_of_gap
    return [k for k in range(solution.K) if abs(solution.jumps[k]) < least]
