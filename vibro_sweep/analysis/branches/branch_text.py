"""What `repr` says of branches and their special points."""

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.analysis.periodic.orbit_text import (
    itinerary_of,
    motion,
    multipliers_text,
    repr_text,
    span,
    system_text,
)
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit

if TYPE_CHECKING:
    from vibro_sweep.analysis.branches.branch import Branch
    from vibro_sweep.analysis.branches.generations import FollowedBranch
    from vibro_sweep.analysis.branches.special import SpecialPoint


def of_special_point(point: "SpecialPoint") -> str:
    lines = [f"<{type(point).__name__} {event(point)}"]
    if len(point.multipliers):
        lines.append(f"multipliers {multipliers_text(point.multipliers)}")
    return repr_text([*lines, f"of {motion(point.orbit)}", system_text(point.orbit.system)])


def of_branch(branch: "Branch") -> str:
    points = branch.points
    p, unstable = points[branch.parameter].values, points.unstable.values
    stable = int(np.count_nonzero(unstable == 0))
    largest = np.hypot(points.multiplier_re.values, points.multiplier_im.values).max(axis=1, initial=0.0)
    where = f"{branch.parameter} from {p.min():.10g} to {p.max():.10g}"
    lines = [
        f"<Branch of {itinerary_of(_orbit_on(branch))} along {where}, {len(p):,} points, status {branch.status}",
        f"stable at {stable:,} of {len(p):,} points; largest modulus of multipliers {span(largest)}",
        *way_of(branch.begins, branch.special, branch.ends, branch.closed),
    ]
    return repr_text(lines)


def _orbit_on(branch: "Branch") -> PeriodicOrbit:
    """One of its own orbits: at a birth it is that of the parent."""
    return PeriodicOrbit(branch._start.family, "ok", branch._start)


def way_of(begins: "SpecialPoint", special: "Sequence[SpecialPoint]", ends: "SpecialPoint", closed: bool) -> list[str]:
    """The lines that say where a branch or a curve begins and ends, and what lies between."""
    inner = [point for point in special if point is not begins and point is not ends]
    return [
        f"begins with {event(begins)}",
        *([f"in between {counted(inner)}"] if inner else []),
        f"ends with {event(ends)}" + (", where it began" if closed else ""),
    ]


def of_followed(followed: "FollowedBranch") -> str:
    """One line, as these come in lists."""
    branch = followed.branch
    ends = f"{branch.begins.type} .. {branch.ends.type}"
    reached = "" if followed.special is None else f" over {event(followed.special)} of branch {followed.parent}"
    p = span(branch.points[branch.parameter].values)
    kind = f"{itinerary_of(_orbit_on(branch))}, {branch.parameter} {p}, {ends}, status {branch.status}"
    return f"<FollowedBranch, generation {followed.generation}{reached}: {kind}>"


def event(point: "SpecialPoint") -> str:
    """The type of a special point and where it is."""
    more = [point.kind, {1: "right", -1: "left"}.get(point.stop), point.criticality]
    if point.type == "boundary":
        more = ["not followed beyond"]
    kind = point.type + (f" ({', '.join(filter(None, more))})" if any(more) else "")
    error = f" +- {point.error:.1e}" if np.isfinite(point.error) and point.error > 0 else ""
    return f"{kind} at {', '.join(f'{name} = {value:.16g}' for name, value in point.parameters.items())}{error}"


def counted(points: "list[SpecialPoint]") -> str:
    return ", ".join(f"{n} {kind}" for kind, n in Counter(one.type for one in points).items())
