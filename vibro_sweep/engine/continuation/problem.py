"""What is solved: a periodic orbit, so many free numbers of the oscillator, and perhaps a condition.

With no free number an orbit is alone, with one it lies on a branch; a condition takes one number away, so that with two
it lies on a bifurcation curve. A pair of multipliers on the unit circle takes two and adds its angle theta.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES

ORBIT, FOLD, FLIP, TORUS, GRAZE, STICK = range(6)
# conditions; ORBIT: none. FLIP is the pitchfork where sigma = -1; from GRAZE on an event has no jump


class Problem(NamedTuple):
    """The data that all points of a solution set share; K events."""

    kind: int  # of the condition
    index: int  # of the impact that grazes; 0 of an onset of sticking, where event 0 is the end of a chatter sequence
    sides: np.ndarray  # (K,); 0 of a turning point that is followed and takes part in nothing
    rests: np.ndarray  # (K,) whether the event lasts: a rest where R = 0, or a contact with a compliant stop
    sigma: float
    parameters: int  # numbers of the oscillator that are free
    unit: np.ndarray  # (2,) of these
    repeats: bool  # whether the second half of the orbit may repeat the first one
    mirrors: bool  # whether it may be its mirror image
    compliant: np.ndarray | None  # (2,) whether the left and the right stop is. None where no event lasts, since R > 0:
    # nothing of such events is compiled then


@jit
def is_critical(c):
    """Whether the condition is a critical multiplier."""
    return FOLD <= c.kind <= TORUS


@jit
def unknowns(c):
    """Free numbers, with theta."""
    return c.parameters + (1 if c.kind == TORUS else 0)


@jit
def conditions(c):
    """Scalar rows of the condition."""
    return 0 if c.kind == ORBIT else 2 if c.kind == TORUS else 1


@jit
def index_of(c, k):
    """The index in `Place.p` of unknown k of the free numbers and theta."""
    return k if k < c.parameters else 2


@jit
def width_of(n, parameters):
    """Columns of a panel that are in use, in whole vectors: xi_i (n), dphi_i, dD_i, xi_{i+1} (n), xi_1 (n), the free
    numbers, residual."""
    return LANES * ((3 * n + 2 + parameters) // LANES + 1)
