"""Where a curve ends on the curve of another orbit.

A Neimark-Sacker curve ends where its pair meets at 1 (resonance 1:1) or at -1 (1:2): there the fold (flip) curve of the
same orbit has a second multiplier 1 (-1). A curve of an asymmetric or doubled orbit ends where that orbit is born, at a
point of codimension two of the pitchfork (flip) curve of the simpler orbit, or at the resonance 1:4 of its
Neimark-Sacker curve. The curve itself would go on from there as its own mirror image (repetition), and its equations
are singular at that point; so it is located on the other curve.
"""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.own_birth import halves_apart, turns
from vibro_sweep.analysis.branches.special import bare, inserted
from vibro_sweep.analysis.continuation.events import LocatedEvent
from vibro_sweep.analysis.continuation.first_point import first_place
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.continuation.starting_orbit import CONDITIONS, StartingOrbit
from vibro_sweep.analysis.curves.curve_events import event_near
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.problem import FOLD, GRAZE, TORUS
from vibro_sweep.engine.continuation.workspace import THETA, Place
from vibro_sweep.tables.bifurcations import CODIMENSION_TWO, name_of

NEAR = 0.2  # in the units of the curve: how far from the expected end the other curve is entered
SHORTEST = 1e-6
NEARER = 0.7  # of the angle of a, that of b, so that both tell where the angle vanishes
AIMED = 0.5  # distance of a strong resonance from where it is expected, of that which the last two steps have left
BEFORE = (1e-3, 1e-2, 0.1)  # of the step to a singular end: how near to it the curve is still looked at
ALIKE = 1e-6  # the difference of the halves, of one orbit taken twice
LEAST = 1e-4  # the same, where tests, which vanish like its square, still have their signs
NEARLY = 0.05  # the difference of the halves, in 1/omega and the fastest impulse, next to a birth
LENGTHS = (1e-6, 1e-5, 1e-4, 1e-3)  # in which the end is looked for there
ENDS = {
    kind: tuple(one.name for one in CODIMENSION_TWO if condition in one.ends) for condition, kind in CONDITIONS.items()
}


class End(NamedTuple):
    """The point of codimension two, on the solution curve `curve`.

    share : of the step from a to b, may be above 1; 0 where only a is known
    """

    curve: SolutionCurve
    found: LocatedEvent
    share: float = 0.0


def strong_resonance(curve: SolutionCurve, a: Place, b: Place) -> End | None:
    """The resonance 1:1 or 1:2 ahead of b, or passed by b, on the curve of folds or flips; None: there is none near."""
    towards_one = b.p[THETA] < math.pi / 2
    name, of_type = ("resonance_1_1", "fold") if towards_one else ("resonance_1_2", "flip")
    before, left = (place.p[THETA] if towards_one else math.pi - place.p[THETA] for place in (a, b))
    if not left < NEARER * before:
        return None
    share = before / (before - left)
    if left <= 0:
        b = _near(curve, a, b, share, (NEARER / 2,))
        if b is None:
            return None
        left = b.p[THETA] if towards_one else math.pi - b.p[THETA]
    # near the end all moves with the square of the angle that is left
    aim = curve.between(b, a, -(left**2) / (before**2 - left**2))
    moved = curve.difference(a, b)
    lengths = (np.linalg.norm(moved[:-1]), np.linalg.norm(moved))  # the other curve has no angle
    end = _on_other(curve, StartingOrbit(of_type, curve.solution(aim)), aim, lengths, (name,))
    if end is None or _is_repeated(end):
        return None
    size = np.ptp(curve.bounds, axis=1)
    missed, ahead = (np.linalg.norm((place.p - aim.p)[:2] / size) for place in (end.found.place, a))
    return end._replace(share=share) if missed < AIMED * ahead else None


def in_full(curve: SolutionCurve, end: End) -> Solution:
    """The orbit at the end with all impacts of the curve that ends there."""
    solution = end.curve.solution(end.found.place)
    while 2 * solution.K <= curve.K:
        solution = solution.repeated(2)
    if solution.K == curve.K:
        return solution
    touching, index = inserted(solution)  # both halves touch the stop, and that of the curve is meant
    k, half = curve.problem.index, solution.P / 2
    time = touching.times[index] + half * np.sign(k - index)
    return solution.with_touch(k, time, curve.problem.sides[k])


def just_before(curve: SolutionCurve, a: Place, b: Place, end: End) -> Place | None:
    """A point of the curve between a and its singular end, as near to the end as Newton's method allows."""
    return _near(curve, a, b, end.share, BEFORE)


def _near(curve: SolutionCurve, a: Place, b: Place, share: float, parts) -> Place | None:
    """The first point that is found of those in front of an end by these parts of the way from a.

    With theta = 0 or pi the equations hold all along the curve of folds or flips, and with equal halves all along the
    graze curve of the simpler orbit; these are not meant.
    """
    row = curve.unit_row(curve.difference(a, b))
    for part in parts:
        guess = curve.between(a, b, (1 - part) * share)
        place, angle = curve.correct(guess, row), guess.p[THETA]
        turn = abs(angle - math.pi * round(angle / math.pi))
        if place is None or (curve.problem.kind == TORUS and not abs(place.p[THETA] - angle) < 0.5 * turn):
            continue
        if _apart(curve, place) >= max(LEAST, 0.5 * _apart(curve, guess)):
            return place
    return None


def struck(curve: SolutionCurve, solution: Solution) -> Solution:
    """A point's orbit without the touch that only one of its two halves can have: a graze, of an odd number."""
    of_graze = curve.problem.kind == GRAZE and solution.K % 2
    return bare(solution, curve.problem.index) if of_graze else solution


def _apart(curve: SolutionCurve, place: Place) -> float:
    """The difference of the halves of an orbit; inf where it cannot be a simpler one, taken twice."""
    if not (curve.problem.repeats or curve.problem.mirrors):
        return math.inf
    solution = struck(curve, curve.solution(place))
    return float(np.linalg.norm(halves_apart(solution, 1 if curve.problem.repeats else -1)))


def _is_repeated(end: End) -> bool:
    """Whether the orbit is a simpler one, taken twice: then its own curve tells which point this is."""
    solution = end.curve.solution(end.found.place)
    parts = [halves_apart(solution, sigma) for sigma in (1, -1)]
    return any(part is not None and np.linalg.norm(part) < ALIKE for part in parts)


def birth(curve: SolutionCurve, a: Place, b: Place) -> End | None:
    """The end where the orbit of the curve is born between a and b, on the curve of its parent."""
    for sigma, share in turns(*(struck(curve, curve.solution(place)) for place in (a, b))):
        aim = curve.between(a, b, share)
        end = _first_found(curve, aim, sigma, (curve.distance(a, b),))
        return end and end._replace(share=share)
    return None


def birth_near(curve: SolutionCurve, a: Place) -> End | None:
    """The same, where the steps end just before it: Newton's method may fail so near to the singular point."""
    for sigma in (1, -1):
        parts = halves_apart(struck(curve, curve.solution(a)), sigma)
        if parts is not None and np.linalg.norm(parts) < NEARLY:
            return _first_found(curve, a, sigma, LENGTHS)
    return None


def _first_found(curve: SolutionCurve, aim: Place, sigma: int, lengths) -> End | None:
    solution, kind = struck(curve, curve.solution(aim)), curve.problem.kind
    starts = []
    if sigma > 0 and solution.K % 4 == 0 and solution.half_periods % 4 == 0 and kind in (FOLD, TORUS):
        mirrored = solution.sides[solution.K // 4] == -solution.sides[0]
        quarter = solution.part(4, -1 if mirrored else 1, alike=0.1, exact=False)
        if quarter is not None:
            starts.append((StartingOrbit("neimark_sacker", quarter, theta=math.pi / 2), ("resonance_1_4",)))
    parent = solution.part(2, sigma, alike=0.1, exact=False)
    if parent is not None and name_of("flip", sigma):
        starts.append((StartingOrbit(name_of("flip", sigma), parent), ENDS[kind]))
    for start, types in starts:
        found = _on_other(curve, start, aim, lengths, types)
        if found is not None:
            return found
    return None


def _on_other(curve: SolutionCurve, start: StartingOrbit, aim: Place, lengths, types) -> End | None:
    """The event on the curve from `start` that is nearest to its first point, which is near `aim`."""
    other = SolutionCurve(start, curve.names, curve.bounds)
    first = first_place(other)
    if first is None or np.abs((first.p - aim.p)[:2] / np.ptp(curve.bounds, axis=1)).max() > NEAR:
        return None
    for length in lengths:
        found = event_near(other, first, max(float(length), SHORTEST), types)
        if found is not None:
            return End(other, found)
    return None
