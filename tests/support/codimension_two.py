"""Points of codimension two that the monodromy matrix alone does not define, in many digits, by shooting."""

import numpy as np
from mpmath import eye, mp, mpf
from reference.normal_forms import SectionMap, fold, linearised, third_order
from reference.shooting import Shooting

from support.branches import NUMBERS
from vibro_sweep.analysis.branches.special import bare
from vibro_sweep.types import PeriodicOrbit

SLOW = 1e-9
STEP = mpf(10) ** -12  # of the differences of Newton's method


def error_of(special, digits=50) -> float:
    """By how much Newton's method, with the equations of the point's type, moves the parameters."""
    vanishing = special.type in ("resonant_graze", "neimark_sacker_graze") and not special.touches
    solution, touches = (special.orbit._solution, []) if vanishing else without_grazes(special)
    names = list(special.parameters)
    numbers = {key: solution.family.numbers[key] for key in NUMBERS}
    with mp.workdps(digits):
        shooting = Shooting(numbers, solution.sigma, solution.half_periods, solution.sides)
        x1, x2, v1, v2 = solution.states[0][:4]
        u = shooting.unknowns(solution.times, (x1, v1, x2, v2))
        extra = [mpf(time) for time, _ in touches]
        if vanishing:
            extra = [angle_at(special, shooting, u)]
        elif special.type.endswith("neimark_sacker"):
            mu = solution.multipliers
            extra = [mpf(float(np.angle(mu[np.argmin(np.where(mu.imag > 0, np.abs(np.abs(mu) - 1), np.inf))])))]
        size = len(u)

        def equations(x):
            shooting.numbers[names[1]] = x[size + 1]
            A, n = shooting.system(names[0], x[size])
            state, more = x[:size], x[size + 2 :]
            if vanishing:
                value = mp.det(linearised(shooting, A, n, state, mp.expj(more[0])))
                slow = slow_impacts(solution)[0]  # where several vanish at once, the others stay in proportion to it
                rows = [*shooting.residual(A, n, state), speed_of(shooting, A, n, state, slow), value.real]
                return [*rows, value.imag if special.type == "neimark_sacker_graze" else more[0] - extra[0]]
            rows = shooting.residual(A, n, state) + _conditions(special.type, shooting, A, n, state, more)
            for time, (_, side) in zip(more, touches, strict=False):
                rows += shooting.turning(A, n, state, time, side)
            return rows

        x, moved = [*u, *(mpf(special.parameters[name]) for name in names), *extra], []
        for _ in range(12):  # many beside another point; differences leave an error of 1e-12 of the step
            f, J = equations(x), mp.zeros(len(x))
            for j in range(len(x)):
                ahead = equations([a + STEP * (i == j) for i, a in enumerate(x)])
                for i, (a, b) in enumerate(zip(ahead, f, strict=True)):
                    J[i, j] = (a - b) / STEP
            step = mp.lu_solve(J, mp.matrix(f))
            x = [a - b for a, b in zip(x, step, strict=True)]
            moved.append(float(max(map(abs, step))))
            if moved[-1] < 1e-14:
                break
        assert moved[-1] < 1e-14, moved
        values = x[size : size + 2]
        return max(abs(float(value - special.parameters[name])) for name, value in zip(names, values, strict=True))


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


def angle_at(special, shooting, u):
    """theta of the critical multiplier: 0 or pi at a resonant graze."""
    A, n = shooting.system()
    angles = (
        [mpf(0), mp.pi] if special.type == "resonant_graze" else mp.linspace(mpf(1) / 100, mp.pi - mpf(1) / 100, 300)
    )
    one = linearised(shooting, A, n, u, mpf(1))
    slope = linearised(shooting, A, n, u, mpf(2)) - one
    return min(angles, key=lambda angle: abs(mp.det(one + (mp.expj(angle) - 1) * slope)))


def slow_impacts(solution) -> list[int]:
    least = SLOW * solution.family.linear.omega * solution.size_of_gap
    return [k for k in range(solution.K) if abs(solution.jumps[k]) < least]


def speed_of(shooting, A, n, u, index):
    """Of an impact, before it."""
    K = len(shooting.sides)
    t, z = u[:K], list(u[K:])
    for k in range(index):
        z[2] = -n["R"] * z[2]
        z = shooting.fly(A, n, t[k], z, t[k + 1] - t[k])
    return z[2]


def _conditions(kind, shooting, A, n, u, more):
    """What the point's type asks for besides the orbit and where it touches."""
    M = shooting.monodromy(A, n, u)
    if kind == "cusp":
        return list(fold(lambda x: shooting.residual(A, n, x), u))
    if kind == "degenerate_flip":
        return [mp.det(M + eye(4)), third_order(SectionMap(shooting, A, n, u), mpf(-1))]
    if kind == "degenerate_neimark_sacker":
        mu = mp.expj(more[0])
        value = mp.det(M - mu * eye(4))
        return [value.real, value.imag, third_order(SectionMap(shooting, A, n, u), mu)]
    multiplier = {"fold_graze": 1, "flip_graze": -1, "pitchfork_graze": -1}.get(kind)
    return [] if multiplier is None else [mp.det(M - multiplier * eye(4))]
