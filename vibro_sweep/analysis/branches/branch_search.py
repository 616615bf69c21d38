"""Branches from branches: a task follows one and switches at its special points.

Of the orbits that it finds beyond these, those that lie on a branch that is known are left out; so is a branch of the
same generation that an earlier one has passed.
"""

from vibro_sweep.analysis.branches.branch import Branch, continue_orbit, not_followed
from vibro_sweep.analysis.branches.branch_arrays import Arrays, arrays_of, sections_of
from vibro_sweep.analysis.branches.branch_switching import switch
from vibro_sweep.analysis.branches.recognising import clearest, passes, point_of
from vibro_sweep.analysis.branches.search import Node, Search, Task
from vibro_sweep.analysis.branches.seeds import Seed, packed, seed_of
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.continuation.starting_orbit import StartingOrbit
from vibro_sweep.analysis.periodic.one_thread import one_thread

LEAST = 1e-4  # distance of a graze from the onset of sticking, as a part of the range, to which branches are followed


@one_thread()
def compute_branch(task: Task) -> Arrays:
    """The branch of a task, with `section`, and with the seeds beyond it, as `packed` has them."""
    branch = followed(task)
    (origin,) = task.seed.place(task.names)
    arrays = arrays_of(branch, origin)
    arrays["section"] = sections_of(arrays, *task.names, task.seed.system)
    return arrays | packed(beyond(branch, task), task.names)


def followed(task: Task, progress=None) -> Branch:
    """The branch of a task; with the status failed where it cannot be followed, so that the others are not lost."""
    orbit, (parameter,), (bounds,) = task.seed.orbit(), task.names, task.bounds
    try:
        return continue_orbit(orbit, parameter, bounds, progress, observe=task.observe)
    except ValueError:  # no orbit beside a special point is within the bounds
        return not_followed(orbit, parameter, bool(task.observe))


def beyond(branch: Branch, task: Task) -> list[Seed]:
    """The orbits within the bounds beyond the special points of a branch at which others are looked for.

    Towards an onset of sticking branches without end follow each other, with one impact more on each: beyond grazes
    that are nearer to it than a small part of the range nothing is looked for.
    """
    (lo, hi), found = task.bounds[0], []
    for index, special in enumerate(branch.special):
        if special.type in task.of and not accumulates(branch, special, LEAST * (hi - lo)):
            seeds = [
                seed_of(orbit.system, StartingOrbit("orbit", orbit._solution), (), index) for orbit in switch(special)
            ]
            found += [seed for seed in seeds if lo <= seed.place(task.names)[0] <= hi]
    return found


def accumulates(branch: Branch, end: SpecialPoint, reach: float) -> bool:
    """Whether `end` is a graze of this branch within `reach` of the onset of sticking beyond it."""
    for outermost, last in ((branch.special[0], branch.begins), (branch.special[-1], branch.ends)):
        if end is last and outermost is not last:
            return abs(outermost.parameters[branch.parameter] - end.parameters[branch.parameter]) < reach
    return False


class Branches(Search):
    """A search for branches in one parameter."""

    def passes(self, arrays: Arrays, seed: Seed) -> bool:
        return passes(arrays, self.names[0], seed.system, seed.solution)

    def is_known(self, known: list[Node], arrays: Arrays, seed: Seed) -> bool:
        """Also where the seed could not decide that, which lies next to a birth or a fold."""
        i = clearest(arrays)
        system = seed.system.replace(**{self.names[0]: float(arrays["value"][i])})
        return self.lies_on(known, seed_of(system, StartingOrbit("orbit", point_of(arrays, i, system))))
