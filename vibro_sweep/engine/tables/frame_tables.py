"""The frame of tangent vectors, and how far they may be flown between looks at them."""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER
from vibro_sweep.engine.tables.series import clear

VANISHED = 30.0  # logarithm of what is below rounding
SEPARATION = 4.0  # logarithm of what free flight may do to a tangent vector and not to another: two digits are lost
LOST = 200.0  # logarithm of what free flight may do to all of them
MOST_CELLS = 1_000_000_000


@jit
def fill_frame(q, psi, omega_squared, mu_m):
    """The metric in which free flight is a rotation times a decay (tangent.py)."""
    series, to_frame, from_frame = q.frame_series, q.to_frame, q.from_frame
    clear(to_frame[:])
    clear(from_frame[:])
    fastest, slowest, turning, q.vanishing = 0.0, np.inf, True, 0
    for j in range(2):
        eta = q.zeta * omega_squared[j]
        square = omega_squared[j] - eta * eta
        if (eta + math.sqrt(max(-square, 0.0))) * q.width > VANISHED:
            q.vanishing += 2 if square > 0.0 else 1
        fastest = max(fastest, eta + math.sqrt(max(-square, 0.0)))
        slowest = min(slowest, eta if square >= 0.0 else omega_squared[j] / (eta + math.sqrt(-square)))
        # near critical damping the plane shears instead of turning; any scale then serves
        scale = max(math.sqrt(abs(square)), 1e-3 * math.sqrt(omega_squared[j]))
        if scale == 0.0:  # a free mode
            scale = q.omega
        turning = turning and square > 1e-6 * omega_squared[j]
        q.frame_square[j], q.frame_scale[j] = square, scale
        series[0, 2 * j], series[1, 2 * j] = 1.0, -eta
        series[0, 2 * j + 1], series[1, 2 * j + 1] = 0.0, 1.0
        for n in range(ORDER - 2):
            for i in range(2 * j, 2 * j + 2):
                rate = 2.0 * eta * (n + 1.0) * series[n + 1, i] + omega_squared[j] * series[n, i]
                series[n + 2, i] = -rate / ((n + 1.0) * (n + 2.0))
        for i in range(2):
            mass = mu_m if i == 1 else 1.0
            to_frame[2 * j, 2 * i] = scale * psi[i, j] * mass
            to_frame[2 * j + 1, 2 * i] = eta * psi[i, j] * mass
            to_frame[2 * j + 1, 2 * i + 1] = psi[i, j] * mass
            from_frame[2 * i, 2 * j] = psi[i, j] / scale
            from_frame[2 * i + 1, 2 * j] = -eta * psi[i, j] / scale
            from_frame[2 * i + 1, 2 * j + 1] = psi[i, j]
    apart = (fastest - slowest) * q.width
    q.most_cells_mixed = max(1, int(SEPARATION / apart)) if apart > 1e-9 * SEPARATION else MOST_CELLS
    q.most_cells_in_planes = q.most_cells_mixed
    if turning:  # nothing then but the range of the floats asks for a look
        q.most_cells_in_planes = max(
            q.most_cells_mixed, int(min(LOST / (fastest * q.width), float(MOST_CELLS))) if fastest > 0.0 else MOST_CELLS
        )
