"""The modes of a plain oscillator (plain_points.py), and what rounding leaves of their numbers."""

import math

import numpy as np

from vibro_sweep.engine.points.frame import CLASSICAL
from vibro_sweep.engine.points.metric import ROUNDING
from vibro_sweep.engine.points.symmetric import diagonalise
from vibro_sweep.engine.simd.jit import jit

UNKNOWN, COUPLED, PLAIN = range(3)


@jit
def set_modes(q, w):
    """Fill the modes of an oscillator. Returns PLAIN, COUPLED where dampers couple them, or UNKNOWN where masses do."""
    n, K_size, C_size = len(q.M), 0.0, 0.0
    for i in range(n):
        if not 0.0 < q.M[i, i] < np.inf:
            return UNKNOWN
        for j in range(n):
            if i != j and q.M[i, j] != 0.0:
                return UNKNOWN
            scale = 1.0 / (math.sqrt(q.M[i, i]) * math.sqrt(q.M[j, j]))
            w.K[i, j], w.C[i, j] = q.K[i, j] * scale, q.C[i, j] * scale
            K_size, C_size = max(K_size, abs(w.K[i, j])), max(C_size, abs(w.C[i, j]))
    if not K_size < np.inf or not C_size < np.inf:
        return UNKNOWN
    K_size, C_size = K_size if K_size > 0.0 else 1.0, C_size if C_size > 0.0 else 1.0
    for i in range(n):
        for j in range(n):  # of modes with one frequency those that dampers part
            w.A[i, j] = (w.K[i, j] + w.K[j, i]) / K_size + 0.618 * (w.C[i, j] + w.C[j, i]) / C_size
    if not diagonalise(w.A, w.V):
        return UNKNOWN
    for i in range(n):
        for j in range(n):
            w.shape[i, j] = w.V[i, j] / math.sqrt(q.M[i, i])
    springs = are_parted(w.K, K_size, w, w.square, w.square_error)
    return PLAIN if are_parted(w.C, C_size, w, w.damping, w.damping_error) and springs else COUPLED


@jit
def are_parted(matrix, size, w, part, error):
    """The parts V_j^T matrix V_j, zero where that is rounding, and their errors. Returns whether V_i^T matrix V_j is
    rounding where j is not i."""
    n, V, row = len(matrix), w.V, w.row
    parted = True
    for j in range(n):
        left, terms = 0.0, 0.0
        for i in range(n):
            row[i], sizes = 0.0, 0.0
            for k in range(n):
                row[i] += matrix[i, k] * V[k, j]
                sizes += abs(matrix[i, k] * V[k, j])
            left += row[i] * row[i]
            terms += abs(V[i, j]) * sizes
        rounding = ROUNDING * n * (terms + ROUNDING * size)
        for k in range(n):
            total = 0.0
            for i in range(n):
                total += V[i, k] * row[i]
            if k == j:
                part[j] = total if total > rounding else 0.0
            else:
                parted = parted and abs(total) <= CLASSICAL * n * size
        error[j] = rounding if part[j] > 0.0 else min(rounding, 4.0 * math.sqrt(left))
    return parted
