"""Points of bifurcation curves in many digits."""

import numpy as np
from mpmath import mp, mpf
from reference.flow import matrix_of
from reference.gmp import expm
from reference.machine import machine_of

from support.branches import located
from support.compliant_bifurcations import ANGLES, CONDITIONS
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


def error_at(curve, k) -> float:
    """The error of one parameter of a point, the other one as it is."""
    solution, name = solution_at(curve, k), steepest(curve, k)
    kinds = {"fold": "fold", "flip": "flip", "pitchfork": "flip", "neimark_sacker": "pair"}
    condition = kinds.get(curve.type) or ("vanishing", curve._solution_curve.problem.index)
    return abs(located(solution, [name], [condition])[0] / solution.family.numbers[name])


def exact_codimension_two(special) -> dict[str, float]:
    """By how much both parameters of a point of codimension two with regular multipliers are off."""
    names, angle = list(special.parameters), ANGLES.get(special.type)
    off = located(special.orbit._solution, names, CONDITIONS[special.type], angle=angle)
    return {name: abs(value) for name, value in zip(names, off, strict=True)}


def exact_resonance(sigma, ratio, omega, digits=40) -> float:
    """omega near the given one where the free motion of the paper's oscillator has a resonant graze, in many digits.

    An impulse that is repeated every P with the sign `ratio` leaves the gap where it was: e_g (1 - ratio E(P))^-1 e_v
    = 0. sigma = -1: P = T/2.
    """
    with mp.workdps(digits):
        A = matrix_of(machine_of(PAPER.linear))[:4, :4]

        def gap(omega):
            P = (1 if sigma < 0 else 2) * mp.pi / omega
            return mp.lu_solve(mp.eye(4) - ratio * expm(A * P), mp.matrix([0, 1, 0, 0]))[0]

        return float(mp.findroot(gap, mpf(omega)))
