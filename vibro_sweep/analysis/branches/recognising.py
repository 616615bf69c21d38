"""Whether an orbit lies on a branch that is known, as a rotation or as a mirror image too."""

import numpy as np

from vibro_sweep.analysis.branches.branch_orbits import Arrays, solution_of
from vibro_sweep.analysis.periodic.itinerary import word
from vibro_sweep.analysis.periodic.solution import Solution

SAME = 1e-7  # relative difference of the impact speeds of one orbit, found twice
MIRROR = str.maketrans("RLrl", "LRlr")
IMPACTS = ("impact_t", "impact_v", "impact_t_off")


def passes(arrays: Arrays, parameter: str, system, s: Solution) -> bool:
    """Whether an orbit of `system`, or its mirror image, lies on a branch: by Newton's method from its points on both
    sides."""
    if not _may_pass(arrays, s):
        return False
    offset = arrays["value"] - s.family.free[parameter]
    if len(offset) == 1:  # a branch that could not be followed
        return not offset[0] and alike(point_of(arrays, 0, system), s)
    for i in np.flatnonzero(offset[:-1] * offset[1:] <= 0):
        share = offset[i] / (offset[i] - offset[i + 1]) if offset[i] != offset[i + 1] else 0.0
        parts = [(1 - share) * arrays[name][i] + share * arrays[name][i + 1] for name in IMPACTS]
        found = solution_of(arrays, system, *parts).corrected()
        if found is not None and alike(found, s):
            return True
    return False


def point_of(arrays: Arrays, i: int, system) -> Solution:
    """The solution at a point of a branch, not corrected; `system` has the parameter's value there."""
    return solution_of(arrays, system, *(arrays[name][i] for name in IMPACTS))


def clearest(arrays: Arrays) -> int:
    """The point that is farthest from a fold: next to one Newton's method tells orbits badly apart."""
    p = arrays["value"]
    return int(np.argmax(np.abs(p[2:] - p[:-2]))) + 1 if len(p) > 2 else 0


def _may_pass(arrays: Arrays, s: Solution) -> bool:
    """Whether the orbit may be a rotation, or a mirror image, of those of a branch: by its period and its impacts."""
    halves = 1 if s.sigma == 1 else 2  # that the whole orbit consists of
    sides = [*s.sides, *(-side for side in s.sides)][: halves * s.K]
    rests = int(np.isfinite(arrays["impact_t_off"][0]).sum())
    known = len(arrays["impact_side"]), 2 * int(arrays["branch_period"]), 1 + int(arrays["branch_symmetric"]), rests
    if known != (len(sides), halves * s.half_periods, halves, halves * len(s.rests)):
        return False
    return rotates(word(arrays["impact_side"]), word(sides), s.family.linear.symmetric)


def rotates(known: str, own: str, mirrors: bool) -> bool:
    """Whether a word (R, L; r, l for grazes) is a rotation of one that is known, or of its mirror image."""
    images = [own, own.translate(MIRROR)] if mirrors else [own]
    return len(known) == len(own) and any(image in 2 * known for image in images)


def alike(a: Solution, b: Solution) -> bool:
    return apart(a, b) <= SAME * max(np.abs(a.jumps).max(initial=0.0), 1e-300)


def apart(a: Solution, b: Solution) -> float:
    """The largest difference of the impulses of two orbits, in the order of their size."""
    speeds = [np.sort(np.abs(s.whole().jumps)) for s in (a, b)]
    return float(np.abs(speeds[0] - speeds[1]).max(initial=0.0))
