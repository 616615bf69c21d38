"""Births that the steps along a branch have passed without an event.

Beside its birth a branch is singular: multipliers, tangents and places of points are rounding there. So steps may go on
behind it, on the mirror image of the branch, or on the branch of its parent, and no test says so. Then what tells the
two halves of an orbit apart turns round; on the parent's branch, where it is rounding, it does so all the time.
"""

from collections.abc import Iterable

import numpy as np

from vibro_sweep.analysis.branches.compiled_stepper import CompiledStepper
from vibro_sweep.analysis.branches.own_birth import may_be_born, over_birth
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.recorded import Rows
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.continuation.starting_orbit import keeps_symmetry

BACK = 16  # points, at most, to one that lies before what rounding does beside a birth


def passed(curve: SolutionCurve, rows: list[Rows], behind: Point | None) -> list[int]:
    """The number of these points before each place where the difference of the halves turns round.

    behind : the point to which steps have led; None where there is none
    """
    start, family, (name,), found = curve.orbit, curve.orbit.family, curve.names, []
    signs = [sigma for sigma in (1, -1) if may_be_born(start, sigma)]
    if -1 in signs and not keeps_symmetry(family, name):
        signs.remove(-1)
    if not signs:
        return found
    last = [] if behind is None else [behind]
    p = np.concatenate([*(part.p for part in rows), [point.value for point in last]])
    t = np.concatenate([*(part.t for part in rows), *(point.solution.times[None] for point in last)])
    D = np.concatenate([*(part.D for part in rows), *(point.solution.jumps[None] for point in last)])
    omega = family.linear.omega + curve.oscillators.slopes[0].omega * (p - family.free[name])
    half, speed = start.K // 2, family.linear.omega * start.size_of_gap
    delay = omega[:, None] * (t[:, half:] - t[:, :half]) - start.half_periods * np.pi / 2
    for sigma in signs:
        apart = np.hstack([delay, (D[:, half:] - sigma * D[:, :half]) / speed])
        found += (np.flatnonzero(np.sum(apart[:-1] * apart[1:], axis=1) < 0) + 1).tolist()
    return sorted(found)


def before_passed(curve: SolutionCurve, compiled: CompiledStepper, rows: Rows, counts: Iterable[int], first: Point):
    """(points before a birth, the last of them, a point behind it); None where no birth is found.

    counts : of points that lie before one perhaps, as `passed` gives them
    first : the point that the first of `rows` is
    """
    for last in counts:
        for count in range(last, max(0, last - BACK), -1):
            kept = rows.taken(np.s_[:count])
            a = compiled.point_behind(kept) if count > 1 else first
            over = None if a is None else over_birth(curve, a)
            if over is not None:
                return kept, a, over[0]
    return None


def how_many_on(rows: Rows, special: list[SpecialPoint]) -> int:
    """The number of special points, given in order, that lie on this part of a branch."""
    least = 0
    for count, one in enumerate(special):
        (value,) = one.parameters.values()
        there = np.flatnonzero(rows.p[least:] == value)
        if not len(there):
            return count
        least += int(there[0])
    return len(special)
