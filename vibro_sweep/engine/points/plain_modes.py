"""The modes of a plain oscillator (plain_points.py), and what rounding leaves of their numbers."""

import math

import numpy as np

from vibro_sweep.engine.points.frame import CLASSICAL
from vibro_sweep.engine.points.metric import ROUNDING
from vibro_sweep.engine.points.symmetric import diagonalise, factorise
from vibro_sweep.engine.simd.jit import jit

UNKNOWN, COUPLED, PLAIN = range(3)


@jit
def set_modes(q, w):
    """Fill the modes of an oscillator, and its masses as L D L^T.

    Returns PLAIN, COUPLED where dampers couple the modes, or UNKNOWN where numbers are beyond the range of the floats.
    """
    n = len(q.M)
    for i in range(n):
        for j in range(n):
            w.mass[i, j] = q.M[i, j]
    if not factorise(w.mass, n):
        return UNKNOWN
    K_size, C_size = (
        set_in_the_metric(w.mass, q.K, w.K, w.K_terms),
        set_in_the_metric(w.mass, q.C, w.C, w.C_terms),
    )
    if not K_size < np.inf or not C_size < np.inf:
        return UNKNOWN
    K_size, C_size = K_size if K_size > 0.0 else 1.0, C_size if C_size > 0.0 else 1.0
    for i in range(n):
        for j in range(n):  # of modes with one frequency those that dampers part
            w.A[i, j] = (w.K[i, j] + w.K[j, i]) / K_size + 0.618 * (w.C[i, j] + w.C[j, i]) / C_size
    if not diagonalise(w.A, w.V):
        return UNKNOWN
    for j in range(n):  # psi_j = L^-T D^-1/2 V_j
        for i in range(n - 1, -1, -1):
            w.shape[i, j] = w.V[i, j] / math.sqrt(w.mass[i, i])
            for k in range(i + 1, n):
                w.shape[i, j] -= w.mass[k, i] * w.shape[k, j]
    springs = are_parted(w.K, w.K_terms, K_size, w, w.square, w.square_error)
    return PLAIN if are_parted(w.C, w.C_terms, C_size, w, w.damping, w.damping_error) and springs else COUPLED


@jit
def set_in_the_metric(mass, matrix, out, terms):
    """out = G matrix G^T with G = D^-1/2 L^-1, of masses L D L^T; terms: of each number the moduli of what it is the
    sum of. Returns the largest modulus, infinite beyond the range of the floats."""
    n, size = len(matrix), 0.0
    for i in range(n):
        for j in range(n):
            out[i, j], terms[i, j] = matrix[i, j], abs(matrix[i, j])
            for k in range(i):
                out[i, j] -= mass[i, k] * out[k, j]
                terms[i, j] += abs(mass[i, k]) * terms[k, j]
    for i in range(n):
        for j in range(n):
            for k in range(j):
                out[i, j] -= mass[j, k] * out[i, k]
                terms[i, j] += abs(mass[j, k]) * terms[i, k]
    for i in range(n):
        for j in range(n):
            scale = 1.0 / (math.sqrt(mass[i, i]) * math.sqrt(mass[j, j]))
            out[i, j], terms[i, j] = out[i, j] * scale, terms[i, j] * scale
            if not terms[i, j] < np.inf:
                return np.inf
            size = max(size, abs(out[i, j]))
    return size


@jit
def are_parted(matrix, terms, size, w, part, error):
    """The parts V_j^T matrix V_j, zero where that is rounding, and their errors. Returns whether V_i^T matrix V_j is
    rounding where j is not i."""
    n, V, row = len(matrix), w.V, w.row
    parted = True
    for j in range(n):
        left, sum_of_terms = 0.0, 0.0
        for i in range(n):
            row[i], sizes = 0.0, 0.0
            for k in range(n):
                row[i] += matrix[i, k] * V[k, j]
                sizes += terms[i, k] * abs(V[k, j])
            left += row[i] * row[i]
            sum_of_terms += abs(V[i, j]) * sizes
        rounding = ROUNDING * n * (sum_of_terms + ROUNDING * size)
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
