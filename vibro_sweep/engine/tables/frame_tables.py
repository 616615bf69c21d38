"""The frame of tangent vectors, and how far they may be flown between looks at them."""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER, decaying

VANISHED = 30.0  # logarithm of what is below rounding
SEPARATION = 4.0  # logarithm of what free flight may do to a tangent vector and not to another: two digits are lost
LOST = 200.0  # logarithm of what free flight may do to all of them
MOST_CELLS = 1_000_000_000


@jit
def fill_frame(q, nodes, point):
    """The frame of tangent vectors, from the pairs of roots of the point, and how far they may be flown in it."""
    masses, states = len(q.series), 2 * len(q.series)
    fastest, slowest, turning, q.vanishing = 0.0, np.inf, True, 0
    for j in range(masses):
        eta, square = point.frame_eta[j], point.frame_square[j]
        swift = eta + math.sqrt(max(-square, 0.0))
        product = square + eta * eta  # of both roots
        if swift * q.width > VANISHED:
            q.vanishing += 2 if square > 0.0 else 1
        fastest = max(fastest, swift)
        slowest = min(slowest, eta if square >= 0.0 else product / swift)
        turning = turning and square > 1e-6 * product
        q.frame_square[j], q.frame_scale[j] = square, point.frame_scale[j]
        series = q.frame_series
        series[0, 2 * j], series[1, 2 * j] = 1.0, -eta
        series[0, 2 * j + 1], series[1, 2 * j + 1] = 0.0, 1.0
        for n in range(ORDER - 2):
            for i in range(2 * j, 2 * j + 2):
                rate = 2.0 * eta * (n + 1.0) * series[n + 1, i] + product * series[n, i]
                series[n + 2, i] = -rate / ((n + 1.0) * (n + 2.0))
        for k in range(q.cells + 1):
            c, s, _, _ = decaying(eta, product, k * q.width)
            nodes[k].frame[2 * j], nodes[k].frame[2 * j + 1] = c, s
    for i in range(states):
        for j in range(states):
            q.to_frame[i, j], q.from_frame[i, j] = point.to_frame[i, j], point.from_frame[i, j]
    apart = (fastest - slowest) * q.width
    # with one rate of decay all vectors shrink alike: they must not leave the range of the floats
    most = max(1, int(min(LOST / (fastest * q.width), MOST_CELLS))) if fastest > 0.0 else MOST_CELLS
    q.most_cells_mixed = min(most, max(1, int(SEPARATION / apart))) if apart > 1e-9 * SEPARATION else most
    q.most_cells_in_planes = max(q.most_cells_mixed, most) if turning else q.most_cells_mixed
