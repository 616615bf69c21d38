"""The motion without impacts along a parameter: steps in which its response changes little, and where it touches.

The gap's amplitude |n.X| with Z X = f, Z = K - omega^2 M + i omega C, has peaks as narrow as the losses are small.
Where Z^-1 Z' times the step is small, X follows its tangent within the step, and so no peak is passed unseen.
"""

import numpy as np

from vibro_sweep.analysis.branches.walk import Point, Walk
from vibro_sweep.analysis.continuation.chord import root
from vibro_sweep.analysis.periodic.steady_gap import steady_gap, steady_gap_slopes
from vibro_sweep.model.linear import dynamic_stiffness

SHARE = 0.25  # by which Z may change in a step, relative to itself
SHORTEST = 1e-7  # step: an undamped mode that is not driven in its resonance does not stop the walk


def longest_step(point: Point) -> float:
    """In which Z changes by `SHARE`, in the units of a walk."""
    walk = point.walk
    q = point.solution.family.linear
    slope = walk.family.replace(**{walk.name: point.p}).derivative(walk.name, q)
    turned = slope.omega * (1j * q.C - 2 * q.omega * q.M)
    change = slope.K - q.omega**2 * slope.M + 1j * q.omega * slope.C + turned
    if not np.any(change):
        return np.inf
    root = np.linalg.cholesky(q.M)  # in the norm of the kinetic energy, which units do not change
    Z, change = (np.linalg.solve(root, np.linalg.solve(root, of_z).T).T for of_z in (dynamic_stiffness(q), change))
    share = np.linalg.norm(np.linalg.lstsq(Z, change)[0], 2) * walk.unit
    return max(SHARE / share, SHORTEST) if share > 0 else np.inf


def touching(walk: Walk, a: Point, b: Point) -> Point | None:
    """The point between a and b, which stay inside, at which the motion is farthest beyond a stop."""
    if a.solution.is_free or min(a.solution.margin, b.solution.margin) <= 0:
        return None
    forwards = a.rate
    for side in (1, -1):
        if _distance(a, side)[1] * forwards < 0 < _distance(b, side)[1] * forwards:
            found = root(walk, a, b, lambda point, side=side: _distance(point, side)[1])
            if found is not None and found[1].margin < 0:
                return found[1]
    return None


def _distance(point: Point, side: int) -> tuple[float, float]:
    """Of the steady motion from its stop, and the derivative by the parameter."""
    family, walk = point.solution.family, point.walk
    q, slope = family.linear, family.derivative(walk.name)
    now, moved = steady_gap(q), steady_gap_slopes(q, slope)
    size = abs(now.swing)
    growth = (now.swing.conjugate() * moved.swing).real / size if size > 0 else 0.0
    return side * (float(q.stop(side)) - now.mean) - size, side * (float(slope.stop(side)) - moved.mean) - growth
