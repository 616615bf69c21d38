"""What a number at neighbouring points of a branch or a curve says of its zeros between them."""

import numpy as np

from vibro_sweep.engine.simd.jit import small

FARTHER = 2.0  # times: a number that is so much nearer to zero than at the points beside changes too fast between them


@small
def changes_sign(x, y):
    """Whether two numbers differ in sign; their product may underflow."""
    return (x > 0.0 > y) or (x < 0.0 < y)


@small
def dips(x, y, z, before, behind):
    """Whether a number with these values at three points, at the distances `before` and `behind` from the middle one,
    may vanish twice near the middle one: the parabola has an extremum nearer to zero by a quarter or more, or steps are
    too long for it to tell: the outer points are farther from zero by FARTHER. Or, where the last is nearest to zero,
    between the middle one and that: the parabola does so."""
    if y < 0.0:
        x, y, z = -x, -y, -z
    if not (y <= x and 0.0 < z and x + z < np.inf):
        return False
    left, right = (y - x) / before, (z - y) / behind
    slope, curve = left * behind + right * before, right - left  # both times the distance of the outer points
    depth = slope * slope / (before + behind)
    if z < y:
        return -slope < 2.0 * curve * behind and depth > 4.0 * curve * y
    return depth > curve * y or min(x, z) > FARTHER * y


@small
def turns_back(x, slope, y, later, length):
    """Whether a number that is positive at two points may be negative between them: where its tangents meet it is."""
    return slope < 0.0 < later and x * (slope - later) + slope * (y - x - later * length) > 0.0
