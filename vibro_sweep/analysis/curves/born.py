"""Curves of orbits with two or four times the period that begin at a point of codimension two.

The orbits are entered at a small amplitude in the critical direction, which Newton's method keeps. A fold of doubled
orbits begins at a degenerate flip, a Neimark-Sacker curve of doubled orbits where a flip meets a Neimark-Sacker point.
One begins also at the resonance 1:2 and at a fold-flip, in one of two cases: two multipliers of the doubled orbits of
amplitude r leave 1 as 1 +- i k r; or as 1 +- k r, and then none begins (Kuznetsov, Elements of Applied Bifurcation
Theory, 9.5.3; Kuznetsov, Meijer, van Veen, Int. J. Bifurcation Chaos 14 (2004) 2253).

At the resonance 1:4 the fourth iterate is, to third order (the same book, 9.5.4),

    z' = eps z + c |z|^2 z + d conj(z)^3,   A = c/|d|

Its other equilibria are at eps = -|d| |z|^2 (A + u), |u| = 1. Their Jacobian has trace 2 |d| |z|^2 Re(A - u) and
determinant -8 |d|^2 |z|^4 (1 + Re(A conj(u))). So there are two folds where |A| > 1, and one Neimark-Sacker curve,
u = Re A - i sign(Im A) (1 - (Re A)^2)^(1/2), where the determinant is positive. At the resonance 1:3 no curve of this
kind begins: the orbits of three times the period are saddles on all sides.

Where a flip (pitchfork) meets a graze, one half of the doubled (asymmetric) orbits comes nearer to the stop by their
amplitude r, so that they graze at a distance from the point that grows like r.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.births import repeated, with_amplitude
from vibro_sweep.analysis.branches.criticality import cubic_terms
from vibro_sweep.analysis.branches.sizes import size_of, sizes_of
from vibro_sweep.analysis.branches.special import SpecialPoint, bare, inserted
from vibro_sweep.analysis.continuation.first_point import converge, first_place, guess_of
from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve, branch_through
from vibro_sweep.analysis.continuation.starting_orbit import StartingOrbit
from vibro_sweep.analysis.curves.curve_record import CurvePoint
from vibro_sweep.analysis.curves.curve_start import as_special
from vibro_sweep.analysis.curves.pair import in_phase, in_time, rates_of_pair, second_order
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.curve_tests import TOUCHING
from vibro_sweep.engine.continuation.workspace import THETA, Place
from vibro_sweep.tables.bifurcations import CODIMENSION_TWO, name_of

AMPLITUDES = (0.01, 0.005, 0.0025, 0.00125, 0.02, 0.04)  # in the units of a curve, in the order in which they are tried
REACH = 0.2  # of the parameters around the point, relative
FARTHEST = 0.02  # relative distance of the point that is found, in both parameters
SECANTS = 8  # steps towards the fold of a doubled orbit
NEARLY = 0.01  # the last of them, of the square of the amplitude
ALIKE = 0.3  # relative difference from what the normal form says
BEGINS = {one.name: one.begins for one in CODIMENSION_TWO}


class Entry(NamedTuple):
    """A guess of a point of such a curve: the orbit and its change, as `Solution.u`, from the parent, taken several
    times; how far the parameters have moved, by the normal form (None: not known).
    """

    start: StartingOrbit
    change: np.ndarray
    moved: np.ndarray | None


def born(special: CurvePoint) -> list[SpecialPoint]:
    """Points of such curves that begin at a point of codimension two of a curve; [] where none does or is found."""
    solution = special.orbit._solution
    if solution is None:  # of an onset of sticking
        return []
    if "graze" in BEGINS[special.type] and not special.touches:
        solution = bare(solution, int(np.argmin(np.abs(solution.jumps))))
    flip = StartingOrbit(name_of("flip", solution.sigma), solution)
    quarter = StartingOrbit("neimark_sacker", solution, theta=np.pi / 2)
    found = []
    for i, condition in enumerate(BEGINS[special.type]):
        name, sign = name_of(condition, 1), -1 if condition in BEGINS[special.type][:i] else 1  # which of two folds
        parent, count = (quarter, 4) if special.type == "resonance_1_4" else (flip, 2)
        for amplitude in AMPLITUDES:
            points = [
                (guess := entry(special, name, parent, count, size, sign)) and entered(special, guess)
                for size in (amplitude, amplitude / 2)
            ]
            if None not in points and _leads_to(special, *points, 2 if name == "graze" else 4):
                found.append(points[0])
                break
    return found


def _leads_to(special: CurvePoint, one: SpecialPoint, nearer: SpecialPoint, ratio: int) -> bool:
    """Whether twice the amplitude is `ratio` times as far from the point, as on the curve that begins there."""
    values, far, near = (np.array(list(point.parameters.values())) for point in (special, one, nearer))
    size = sizes_of(special.orbit._solution, special.parameters)
    return bool(np.linalg.norm((far - values - ratio * (near - values)) / size) < np.linalg.norm((far - values) / size))


def entry(
    special: CurvePoint, name: str, parent: StartingOrbit, count: int, amplitude: float, sign: int
) -> Entry | None:
    """The guess for orbits with `count` times the period at this amplitude; sign: which of two folds. None: none
    exist."""
    names, values = tuple(special.parameters), np.array(list(special.parameters.values()))
    curve = SolutionCurve(parent, names, box_around(special))
    place = first_place(curve)
    if place is None:
        return None
    critical = place.v[:, -2:].T.ravel()  # of phases and jumps
    w, factor = in_time(curve, place, critical), amplitude / critical[np.argmax(np.abs(critical))]
    if count == 4:
        found = _quarter(curve, place, abs(factor), name, sign)
        if found is None:
            return None
        factor, moved, theta = found
        child, change = repeated(parent.solution, 4, factor * w, 1j)
        family = parent.solution.family.replace(**dict(zip(names, map(float, values + moved), strict=True)))
        child = replace(_bent(child, curve, place, factor, moved), family=family)
        return Entry(StartingOrbit(name, child, theta=theta), change, moved)
    child, change = repeated(parent.solution, 2, factor * w, -1.0)
    if name == "graze":  # at the turning point that is nearest to its stop
        touching, index = inserted(child)
        places = [index, child.K + index, *(2 * child.K + touching.rests.index(i) for i in {index} & {*touching.rests})]
        return Entry(StartingOrbit(name, touching, index), np.insert(change, places, 0.0), None)
    if special.type == "flip_neimark_sacker":
        mu = parent.solution.multipliers
        pair = mu[np.argmin(np.where(mu.imag > 1e-6, np.abs(np.abs(mu) - 1), np.inf))]
        return Entry(StartingOrbit(name, child, theta=abs(float(np.angle(pair**2)))), change, None)
    if name == "fold":
        found = _turning(curve, place, change, amplitude)
        return found and Entry(StartingOrbit(name, found), change, None)
    found = _doubled(curve, place, change)
    theta = found and _angle_near_one(found)
    return Entry(StartingOrbit(name, found, theta=theta), change, None) if theta else None


def _doubled(curve: SolutionCurve, place: Point, change: np.ndarray, distance: float = 0.0) -> Solution | None:
    """The doubled orbit with the amplitude `change`, at the flip `distance` along its curve from `place`."""
    flip = curve.correct(curve.moved(place, distance), place.direction) if distance else place
    if flip is None:
        return None
    child = flip.solution.repeated(2)
    child = replace(child, u=child.u + change)
    across = curve.names[int(np.argmin(np.abs(place.tangent_p[:2])))]
    return with_amplitude(branch_through(child, across, size_of(child, across)), child, change)


def _turning(curve: SolutionCurve, place: Point, change: np.ndarray, amplitude: float) -> Solution | None:
    """The doubled orbit with this amplitude that has a multiplier 1.

    A multiplier is 1 + 2 r^2 (k d + 2 c r^2) at the amplitude r and the distance d along the flip curve: hardly more
    than 1 at all of them, so that Newton's method for a fold goes astray from where d is not nearly right.
    """
    there, step, before = 0.0, amplitude**2, None
    for _ in range(SECANTS):
        found = _doubled(curve, place, change, there)
        if found is None:
            return None
        mu = found.multipliers
        beyond = float(mu[np.argmin(np.abs(mu - 1))].real - 1)
        if before is not None:
            if beyond == before:  # rounding
                return None
            step *= beyond / (before - beyond)
            if abs(step) < NEARLY * amplitude**2:
                return found
        before, there = beyond, there + step
    return None


def _angle_near_one(solution: Solution) -> float | None:
    """theta of the two multipliers nearest to 1; None where they are real or far from the unit circle."""
    mu = solution.multipliers
    near = mu[np.argsort(np.abs(mu - 1))[:2]]
    pair = np.log(near[np.argmax(near.imag)])
    return float(pair.imag) if pair.imag > abs(pair.real) else None


def entered(special: CurvePoint, guess: Entry) -> SpecialPoint | None:
    """The point of the curve with the amplitude of the guess, if it is near."""
    names, values = tuple(special.parameters), np.array(list(special.parameters.values()))
    curve = SolutionCurve(guess.start, names, box_around(special))
    place = guess_of(curve)
    row = None if place is None else np.append(in_phase(curve, place, guess.change), np.zeros(3))
    place = place and converge(curve, place, curve.unit_row(row))
    if place is None:
        return None
    far = np.abs(place.p[:2] - values) > FARTHEST * sizes_of(special.orbit._solution, names)
    if guess.moved is not None:
        far = np.abs(place.p[:2] - values - guess.moved) > ALIKE * np.abs(guess.moved).max()
    if np.any(far):
        return None
    if guess.start.theta and abs(place.p[THETA] - guess.start.theta) > ALIKE * guess.start.theta:
        return None
    found = replace(guess.start, solution=curve.solution(place))
    if found.type == "graze":
        without = bare(found.solution, found.index)
        if without.stop_distance < -TOUCHING * without.size_of_gap:  # the other half passes the stop
            return None
    return as_special(found, names, special.orbit.system, special.error)


def box_around(special: CurvePoint) -> np.ndarray:
    """(2, 2) of both parameters, around the point."""
    values = np.array(list(special.parameters.values()))
    reach = REACH * sizes_of(special.orbit._solution, special.parameters)
    return np.column_stack([values - reach, values + reach])


def _bent(child: Solution, curve: SolutionCurve, place: Place, z: complex, moved) -> Solution:
    """The child moved to second order in z: its multipliers, near 1, differ from 1 by as much as this changes them."""
    bend, mean = second_order(curve, place)
    K, s, count = curve.K, float(curve.orbit.sigma), child.K // curve.K
    turns, signs = (-1.0) ** np.arange(count)[:, None], s ** np.arange(count)[:, None]
    _, along = rates_of_pair(curve, place)
    each = 2 * turns * (z * z * bend).real + abs(z) ** 2 * mean + along @ moved  # (count, 2K + rests)
    times, impulses, ends = np.split(each, [K, 2 * K], axis=1)
    return replace(child, u=child.u + np.concatenate([times.ravel(), (signs * impulses).ravel(), ends.ravel()]))


def _quarter(curve: SolutionCurve, place: Place, size: float, name: str, sign: int):
    """z, in units of w with |z| = size, the parameters' change, and theta (0 of a fold); None: there are none."""
    curve.take_numbers(place)
    curve.run_task(stepper.EXAMINE, place)
    (c, d), _ = cubic_terms(curve.workspace, curve.problem, place)
    A = c / abs(d)
    u = _turn(A, name, sign)
    if u is None:
        return None
    z = size * np.exp(1j * (np.angle(d) - np.angle(u)) / 4)
    eps = -abs(d) * size**2 * (A + u)
    rates, _ = rates_of_pair(curve, place)
    moved = np.linalg.solve(np.array([rates.real, rates.imag]), [eps.real, eps.imag])
    determinant = -8 * (1 + (A * u.conjugate()).real)
    theta = 4 * abs(d) * size**2 * determinant**0.5 if name == "neimark_sacker" else 0.0
    return z, moved, theta


def _turn(A: complex, name: str, sign: int) -> complex | None:
    """u of a fold or of the Neimark-Sacker curve; None: there is none."""
    if name == "fold":
        return A / abs(A) * np.exp(1j * sign * np.arccos(-1 / abs(A))) if abs(A) > 1 else None
    if not abs(A.real) < 1:
        return None
    u = complex(A.real, -np.copysign((1 - A.real**2) ** 0.5, A.imag))
    return u if (A * u.conjugate()).real < -1 else None
