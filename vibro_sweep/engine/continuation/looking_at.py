"""What is looked at in each point of a branch or a curve, and what happens between two of them."""

from vibro_sweep.engine.continuation.branch_tests import (
    crosses_over,
    examine_branch,
    happens_on_branch,
    touches_on_branch,
)
from vibro_sweep.engine.continuation.corrector import assemble
from vibro_sweep.engine.continuation.curve_tests import examine_curve, happens_on_curve, touches_on_curve
from vibro_sweep.engine.continuation.problem import ORBIT, STICK
from vibro_sweep.engine.continuation.residual import fly_through
from vibro_sweep.engine.simd.jit import small


@small
def refresh(f, c, place, b):
    """Leave in b what tests of a corrected point need. False: singular.

    Of a branch, and of a chatter sequence, the equations have changed little since the last correction.
    """
    if c.kind == STICK or c.kind == ORBIT:
        fly_through(f, c, place, b)
        return True
    return assemble(f, c, place, b)


@small
def examine(f, c, place, b):
    """Tests and certificate of a corrected point. False: singular."""
    if c.kind == ORBIT:
        examine_branch(f, c, place, b)
        return True
    return examine_curve(f, c, place, b)


@small
def happens(c, a, b):
    """Whether something happens between two points, as far as their tests tell."""
    return happens_on_branch(c, a, b) if c.kind == ORBIT else happens_on_curve(c, a, b)


@small
def touches(path, c, a, b):
    """Whether something may happen twice beside a point of a branch, unseen by the tests."""
    return c.kind == ORBIT and touches_on_branch(path, a, b)


@small
def may_pass_twice(path, c, a, b):
    """The same of a curve."""
    return c.kind != ORBIT and touches_on_curve(path, a, b)


@small
def goes_over(c, a, b):
    """Whether b lies on another branch than a."""
    return c.kind == ORBIT and crosses_over(c, a, b)
