"""Points of bifurcation curves in many digits."""

import numpy as np
from mpmath import mp, mpf
from reference.flow import matrix_of
from reference.gmp import expm
from reference.machine import machine_of

from support.in_digits import CONDITIONS, SLOW_IN_SIMULATION, moved_by, of_point, turning_points, vanishing, without
from support.oscillators import PAPER

SLOWEST = 1e-4  # impact speed: below it the reference's monodromy matrix is next to its pole
AT_AN_END = 1e-6  # of the extent of a curve


def types(curve):
    """Of the points of codimension two along a curve."""
    return [special.type for special in curve.special]


def first(branch, kind):
    """The first special point of a type."""
    return next(special for special in branch.special if special.type == kind)


def chosen(curve, count):
    """Indices of `count` points along the real part of a curve, where no impact but the grazing one is very slow; none
    that lie on its first or last one but for rounding, which are special: a curve of folds begins where two meet."""
    speeds = np.abs(curve.points.impact_v.values)
    if curve.type == "graze":
        speeds = np.delete(speeds, np.argmin(speeds.max(axis=0)), axis=1)
    at = np.stack([curve.points[name].values for name in curve.parameters], 1)
    extent = np.maximum(np.ptp(at, axis=0), np.finfo(float).tiny)
    apart = np.minimum(*(np.abs((at - end) / extent).max(axis=1) for end in (at[0], at[-1]))) > AT_AN_END
    apart[[0, -1]] = True
    allowed = np.flatnonzero(~curve.points.virtual.values & apart & (speeds.min(axis=1, initial=np.inf) > SLOWEST))
    return allowed[np.linspace(0, len(allowed) - 1, count).round().astype(int)]


def steepest(curve, k) -> str:
    """The parameter that changes least along the curve there: the one to solve for."""
    points = curve.points
    a, b = max(k - 1, 0), min(k + 1, points.sizes["point"] - 1)
    changes = [abs(float(points[name][b] - points[name][a])) / np.ptp(points[name].values) for name in curve.parameters]
    return curve.parameters[int(np.argmin(changes))]


def error_at(curve, k, orbit) -> float:
    """The relative error of one parameter of a point, the other one as it is; orbit: where the curve was begun."""
    motion, touches, name = of_point(curve, k, orbit), [], steepest(curve, k)
    if curve.type == "graze":
        motion = without(motion, vanishing(motion, SLOW_IN_SIMULATION))
        touches = turning_points(motion)[:1]
    value = float(curve.points[name][k])
    (off,) = moved_by(motion, {name: value}, CONDITIONS[curve.type], touches)
    return abs(off / value)


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
