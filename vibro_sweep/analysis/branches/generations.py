"""`follow_branches`: from branch to branch, over grazes, pitchforks and flips, generation by generation."""

from collections.abc import Iterable
from dataclasses import dataclass

from vibro_sweep.analysis.branches import branch_text
from vibro_sweep.analysis.branches.branch import Branch, checked_observe, continue_orbit
from vibro_sweep.analysis.branches.branch_orbits import Arrays, outline
from vibro_sweep.analysis.branches.branch_search import Branches, beyond, followed
from vibro_sweep.analysis.branches.search import Task
from vibro_sweep.analysis.branches.seeds import packed, seed_of
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.continuation.starting_orbit import StartingOrbit
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.checks.arguments import check_call, check_type, checked_count, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.oscillator.family import family_of
from vibro_sweep.tables.bifurcations import WAYS


@dataclass(frozen=True, eq=False, repr=False)
class FollowedBranch:
    """A `branch`, and how it was reached.

    generation : 0 for the branch of the orbit given, 1 for those that are reached from its special points, ...
    parent : index of the branch from which it was reached; None for the first
    special : the special point of the parent at which it was reached; None for the first

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> first, second = vs.follow_branches(vs.periodic_orbit(system, itinerary="R"), "b", (3.0, 4.5))
    >>> second.generation, second.parent, second.special.type
    (1, 0, 'graze')
    """

    branch: Branch
    generation: int
    parent: int | None
    special: SpecialPoint | None

    def __repr__(self) -> str:
        return branch_text.of_followed(self)


@names_its_arguments
def follow_branches(
    orbit: PeriodicOrbit,
    parameter: str,
    bounds: tuple[float, float],
    follow=WAYS,
    depth: int = 1,
    progress=None,
    observe: Iterable[str] = (),
) -> list[FollowedBranch]:
    """The branch of an orbit and those that are reached from it over special points of the types `follow`.

    Branches come generation by generation, up to `depth`, each in the order of its parent's special points. A branch
    that is known is not followed again, as a rotation or a mirror image neither. Towards an onset of sticking branches
    without end follow each other, with one impact more on each: they are followed until the special point "sticking" is
    nearer to the graze before it than 1e-4 of the range. progress(branches, points, value) is called now and then.
    `observe` is that of `continue_orbit`.

    Raises ValueError for types that no branch leaves from, and as `continue_orbit` does for the orbit given. A branch
    that cannot be followed says so by its status.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> found = vs.follow_branches(vs.periodic_orbit(system, itinerary="R"), "b", (3.0, 4.5))
    >>> [(one.generation, one.branch.begins.type, one.branch.ends.type) for one in found]
    [(0, 'graze', 'boundary'), (1, 'graze', 'pitchfork')]
    """
    check_type("orbit", orbit, PeriodicOrbit, "a PeriodicOrbit, as `periodic_orbit` returns it")
    check_call("progress", progress, "progress(branches, points, value)", 0, 0, 0.0)
    if not isinstance(follow, (tuple, list)) or any(not isinstance(one, str) or one not in WAYS for one in follow):
        raise ArgumentError(not_allowed("follow", follow, f"a list of {', '.join(WAYS)}"))
    depth, words = checked_count("depth", depth, 0), checked_observe(observe, family_of(orbit.system).linear)
    branches: dict[str, Branch] = {}

    def tell(points: int, value: float) -> None:
        if progress is not None:
            progress(len(branches), points, value)

    first = continue_orbit(orbit, parameter, bounds, tell, observe=words)

    def evaluate(names: list[str], tasks: list[Task]) -> list[Arrays]:
        result = []
        for name, task in zip(names, tasks, strict=True):
            branches[name] = branch = followed(task, tell) if branches else first
            result.append(
                outline(branch._start, parameter, branch._frame, branch._rows)
                | packed(beyond(branch, task), (parameter,))
            )
        return result

    lo, hi = map(float, bounds)
    branching = Branches((parameter,), ((lo, hi),), tuple(follow), at_once=1, observe=words)
    nodes = branching.run([seed_of(orbit.system, StartingOrbit("orbit", orbit._solution))], depth, evaluate)
    found: list[FollowedBranch] = []
    for node in nodes:
        parent, special = node.seed.parent, None
        if parent >= 0:
            special = found[parent].branch.special[node.seed.special]
        found.append(FollowedBranch(branches[node.name], node.generation, parent if parent >= 0 else None, special))
    return found
