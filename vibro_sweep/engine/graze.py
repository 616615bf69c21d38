"""The impact next to a graze, in the expansion of the discontinuity mapping (eqs. 32-35, 38, 39).

Seen from the stop that is hit: psi is how far x1 lies beyond it, v the velocity towards it and a < 0 the acceleration,
all at the section. Order 1 is the paper's; `second` adds the next order (motion/discontinuity.py).
"""

import math

from vibro_sweep.engine.simd.jit import jit


@jit
def impact_near_graze(a, psi, v, second):
    """Speed w of the impact, 0 where there is none, and the time `late` by which the section is later than it."""
    # (34): w^2 = -2 a psi [+ v^2]
    square = -2.0 * a * psi + (v * v if second else 0.0)
    if not (square > 0.0 and a < 0.0):
        return 0.0, 0.0
    w = math.sqrt(square)
    # (33): late = [(w - v)/a]
    return w, (w - v) / a if second else 0.0


@jit
def impact_slopes(a, psi, v, w, late, second, da, d_psi, dv):
    """Derivatives of `w` and `late` in a direction in which a, psi and v have the derivatives da, d_psi and dv."""
    dw = ((v * dv if second else 0.0) - psi * da) / w - a / w * d_psi
    return dw, (dw - dv - late * da) / a if second else 0.0
