"""The phase of the force at the nodes, which a slow contact over many cells needs to more digits than a float has.

The nodes' own sin and cos are those of a phase rounded to an ulp of up to 10: a small jump from cell to cell, which a
mass that hardly moves on a stop would follow.
"""

import math

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.twofold import TURN, TURN_LOW, add, divide, multiply


@jit
def force_at_node(q, tau, k):
    """sin and cos of omega t + tau at node k."""
    part, part_low = divide(float(k), 0.0, float(q.cells))
    turn, turn_low = multiply(part, part_low, TURN, TURN_LOW)
    phase, low = add(turn, turn_low, tau, 0.0)
    sin, cos = math.sin(phase), math.cos(phase)
    return sin + low * cos, cos - low * sin
