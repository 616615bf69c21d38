"""Points of bifurcation curves in many digits, by shooting."""

import numpy as np
from mpmath import mp, mpf
from reference.gmp import expm
from reference.shooting import Shooting

from support.branches import NUMBERS
from support.oscillators import PAPER
from vibro_sweep.analysis.periodic.solution import Solution

SLOWEST = 1e-4  # impact speed: below it the reference's monodromy matrix is next to its pole


def types(curve):
    """Of the points of codimension two along a curve."""
    return [special.type for special in curve.special]


def first(branch, kind):
    """The first special point of a type."""
    return next(special for special in branch.special if special.type == kind)


def chosen(curve, count):
    """Indices of `count` points along the real part of a curve, where no impact but the grazing one is very slow."""
    points = curve.points
    speeds = np.abs(points.impact_v.values)
    if curve.type == "graze":
        speeds = np.delete(speeds, curve._solution_curve.problem.index, axis=1)
    allowed = np.flatnonzero(~points.virtual.values & (speeds.min(axis=1, initial=np.inf) > SLOWEST))
    return allowed[np.linspace(0, len(allowed) - 1, count).round().astype(int)]


def solution_at(curve, k) -> Solution:
    """The orbit of a point, from what `points` says."""
    points, start = curve.points, curve._solution_curve.orbit
    family = start.family.replace(**{name: float(points[name][k]) for name in curve.parameters})
    sides = points.impact_side[k].values
    D = -(1 + family.linear.restitution(sides)) * points.impact_v[k].values
    return Solution(
        family, start.sigma, start.half_periods, start.sides, np.concatenate([points.impact_t[k].values, D])
    )


def steepest(curve, k) -> str:
    """The parameter that changes least along the curve there: the one to solve for."""
    points = curve.points
    a, b = max(k - 1, 0), min(k + 1, points.sizes["point"] - 1)
    changes = [abs(float(points[name][b] - points[name][a])) / np.ptp(points[name].values) for name in curve.parameters]
    return curve.parameters[int(np.argmin(changes))]


def error_at(curve, k, digits=30) -> float:
    """The error of one parameter of a point, the other one as it is."""
    solution, name = solution_at(curve, k), steepest(curve, k)
    numbers = {key: solution.family.numbers[key] for key in NUMBERS}
    value = numbers[name]
    with mp.workdps(digits):
        shooting = Shooting(numbers, solution.sigma, solution.half_periods, solution.sides)
        x1, x2, v1, v2 = solution.states[0][:4]
        u = shooting.unknowns(solution.times, (x1, v1, x2, v2))
        if curve.type == "fold":
            found = shooting.where_multiplier(1, u, name, value)
        elif curve.type in ("flip", "pitchfork"):
            found = shooting.where_multiplier(-1, u, name, value)
        elif curve.type == "neimark_sacker":
            found = shooting.where_torus(u, name, value)
        else:
            found = shooting.where_vanishing(curve._solution_curve.problem.index, u, name, value)
        return float(abs(found - mpf(value)) / abs(value))


def exact_codimension_two(special, digits=40) -> dict[str, float]:
    """Both parameters of a point of codimension two with regular multipliers, by shooting."""
    solution, names = special.orbit._solution, list(special.parameters)
    numbers = {key: solution.family.numbers[key] for key in NUMBERS}
    with mp.workdps(digits):
        x1, x2, v1, v2 = solution.states[0][:4]
        shooting = Shooting(numbers, solution.sigma, solution.half_periods, solution.sides)
        u = shooting.unknowns(solution.times, (x1, v1, x2, v2))
        size = len(u)

        def equations(x):
            shooting.numbers[names[1]] = x[size + 1]
            A, n = shooting.system(names[0], x[size])
            return shooting.residual(A, n, x[:size]) + _conditions(special.type, shooting.monodromy(A, n, x[:size]))

        x = newton(equations, [*u, *(mpf(special.parameters[name]) for name in names)])
        return {name: abs(float(value - special.parameters[name])) for name, value in zip(names, x[size:], strict=True)}


def _conditions(kind, M):
    """Two equations for the monodromy matrix."""
    one = mp.eye(M.rows)

    def det(mu):
        return mp.det(M - mu * one)

    def slope(mu):
        return mp.diff(det, mu)

    def pair():
        values = mp.eig(M, left=False, right=False)  # real ones have an imaginary part of rounding
        return abs(min((mu for mu in values if mu.imag > 1e-9), key=lambda mu: abs(abs(mu) - 1))) ** 2 - 1

    if kind in ("resonance_1_3", "resonance_1_4"):
        value = det(mp.expjpi(mpf(2) / 3 if kind == "resonance_1_3" else mpf(1) / 2))
        return [value.real, value.imag]
    return {
        "fold_flip": lambda: [det(1), det(-1)],
        "resonance_1_1": lambda: [det(1), slope(1)],
        "resonance_1_2": lambda: [det(-1), slope(-1)],
        "fold_neimark_sacker": lambda: [det(1), pair()],
        "flip_neimark_sacker": lambda: [det(-1), pair()],
    }[kind]()


def newton(equations, x):
    """By differences, in the working precision."""
    h = mpf(10) ** (-mp.dps // 2)
    for _ in range(5):
        f = equations(x)
        J = mp.zeros(len(x))
        for j in range(len(x)):
            moved = list(x)
            moved[j] += h
            for i, (a, b) in enumerate(zip(equations(moved), f, strict=True)):
                J[i, j] = (a - b) / h
        step = mp.lu_solve(J, mp.matrix(f))
        x = [a - b for a, b in zip(x, step, strict=True)]
        if max(map(abs, step)) < mpf(10) ** (-mp.dps // 2):
            break
    return x


def exact_resonance(sigma, ratio, omega, digits=40) -> float:
    """omega near the given one where the free motion of the paper's oscillator has a resonant graze, in many digits.

    An impulse that is repeated every P with the sign `ratio` leaves the gap where it was: e_g (1 - ratio E(P))^-1 e_v
    = 0. sigma = -1: P = T/2.
    """
    with mp.workdps(digits):
        A = Shooting({key: PAPER_NUMBERS[key] for key in NUMBERS}, 1, 2, (1,)).system()[0][:4, :4]

        def gap(omega):
            P = (1 if sigma < 0 else 2) * mp.pi / omega
            return mp.lu_solve(mp.eye(4) - ratio * expm(A * P), mp.matrix([0, 0, 1, 0]))[0]

        return float(mp.findroot(gap, mpf(omega)))


PAPER_NUMBERS = {key: getattr(PAPER, key) for key in NUMBERS}
