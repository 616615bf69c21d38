"""`follow_branches`: from branch to branch, over grazes, pitchforks and flips, generation by generation."""

from dataclasses import dataclass

import numpy as np

from vibro_sweep.analysis.branches.continuation import Branch, continue_orbit
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.branches.switching import switch
from vibro_sweep.analysis.periodic.itinerary import LETTERS
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.model.arguments import check_type, checked_count

WAYS = ("graze", "pitchfork", "flip")
LEAST = 1e-4  # distance of a graze from the onset of sticking, as a part of the range, to which branches are followed
SAME = 1e-7  # relative difference of the impact speeds of one orbit, found twice


@dataclass(frozen=True, eq=False)
class Followed:
    """A branch, and how it was reached.

    generation : 0 for the branch of the orbit given, 1 for those that are reached from its special points, ...
    parent : index of the branch from which it was reached; None for the first
    special : the special point of the parent at which it was reached; None for the first
    """

    branch: Branch
    generation: int
    parent: int | None
    special: SpecialPoint | None


def follow_branches(
    orbit: PeriodicOrbit, parameter: str, bounds: tuple[float, float], follow=WAYS, depth: int = 1, progress=None
) -> list[Followed]:
    """The branch of an orbit and those that are reached from it over special points of the types `follow`.

    Branches come generation by generation, up to `depth`, each in the order of its parent's special points. A branch
    that is known is not followed again, as a rotation or a mirror image neither. Towards an onset of sticking branches
    without end follow each other, with one impact more on each: they are followed until the special point "sticking" is
    nearer to the graze before it than 1e-4 of the range. progress(branches, points, value) is called now and then.

    Raises ValueError for types that no branch leaves from, and as `continue_orbit` does.
    """
    check_type("orbit", orbit, PeriodicOrbit, "a PeriodicOrbit, as `periodic_orbit` returns it")
    if not isinstance(follow, (tuple, list)) or any(kind not in WAYS for kind in follow):
        raise ValueError(f"follow: {follow!r} is not allowed; it must be a list of {', '.join(WAYS)}")
    depth = checked_count("depth", depth, 0)
    found: list[Followed] = []

    def add(orbit, generation, parent, special):
        tell = progress and (lambda points, value: progress(len(found), points, value))
        found.append(Followed(continue_orbit(orbit, parameter, bounds, tell), generation, parent, special))

    add(orbit, 0, None, None)
    for generation in range(1, depth + 1):
        for parent, item in list(enumerate(found)):
            if item.generation != generation - 1:
                continue
            for special in item.branch.special:
                if special.type not in follow or _accumulates(item.branch, special, LEAST * (bounds[1] - bounds[0])):
                    continue
                for beyond in switch(special):
                    value = beyond._solution.family.numbers[parameter]
                    inside = bounds[0] <= value <= bounds[1]
                    if inside and not any(passes(known.branch, beyond) for known in found):
                        add(beyond, generation, parent, special)
    return found


def _accumulates(branch: Branch, end: SpecialPoint, reach: float) -> bool:
    """Whether `end` is a graze of this branch within `reach` of the onset of sticking beyond it."""
    for outermost, last in ((branch.special[0], branch.begins), (branch.special[-1], branch.ends)):
        if end is last and outermost is not last:
            return abs(outermost.parameters[branch.parameter] - end.parameters[branch.parameter]) < reach
    return False


def passes(branch: Branch, orbit: PeriodicOrbit) -> bool:
    """Whether an orbit, or its mirror image, lies on a branch: by Newton's method from its points on both sides."""
    start, rows = branch._walk.start, branch._rows
    s, value = orbit._solution, orbit._solution.family.numbers[branch.parameter]
    if kind_of(start) != kind_of(s):
        return False
    offset = rows.p - value
    for i in np.flatnonzero(offset[:-1] * offset[1:] <= 0):
        share = offset[i] / (offset[i] - offset[i + 1]) if offset[i] != offset[i + 1] else 0.0
        u = [(1 - share) * values[i] + share * values[i + 1] for values in (rows.t, rows.D, rows.ends)]
        u = np.concatenate([*u, np.zeros(start.size - 2 * start.K - len(start.rests))])
        found = Solution(s.family, start.sigma, start.halves, start.sides, u, 0.0, start.rests).corrected()
        if found is not None and alike(found, s):
            return True
    return False


def kind_of(s: Solution) -> tuple:
    """Equal for orbits that may be rotations or mirror images of each other."""
    whole = s.whole()
    letters = "".join(LETTERS[side] for side in whole.sides)
    mirrored = "".join(LETTERS[-side] for side in whole.sides) if s.family.linear.symmetric else letters
    words = [word[k:] + word[:k] for word in (letters, mirrored) for k in range(max(len(word), 1))]
    return min(words), whole.halves, s.sigma, len(whole.rests)


def alike(a: Solution, b: Solution) -> bool:
    speeds = [np.sort(np.abs(s.jumps)) for s in (a, b)]
    return bool(np.abs(speeds[0] - speeds[1]).max(initial=0.0) <= SAME * max(speeds[0].max(initial=0.0), 1e-300))
