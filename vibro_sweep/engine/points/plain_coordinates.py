"""Contact coordinates of a plain oscillator (plain_points.py), and its equations in them (contact.py)."""

import numpy as np

from vibro_sweep.engine.points.symmetric import factorise, solve
from vibro_sweep.engine.simd.jit import jit


@jit
def set_coordinates(q, p):
    """P and its inverse: the gap, and the masses but the one that is held least (contact.py)."""
    n, spare, least = len(q.M), 0, np.inf
    for i in range(n):
        if q.normal[i] != 0.0:
            held = (abs(q.K[i, i]) + q.omega * abs(q.C[i, i]) + q.omega * q.omega * abs(q.M[i, i])) / q.normal[i]
            held = held / q.normal[i]
            if held < least:
                spare, least = i, held
    along = 0.0
    for i in range(n):
        along += q.normal[i] * (q.normal[i] / q.M[i, i])
        for j in range(n):
            p.P[i, j] = p.back[i, j] = 0.0
    row = 1
    for j in range(n):
        p.P[0, j] = q.normal[j]
        if j != spare:
            p.P[row, j] = p.back[j, row] = 1.0
            p.back[spare, row] = 0.0 - q.normal[j] / q.normal[spare]
            p.push[row] = q.normal[j] / q.M[j, j] / along
            row += 1
    p.back[spare, 0], p.push[0] = 1.0 / q.normal[spare], 1.0
    p.turned = False
    for i in range(n):
        p.origin[i] = 0.0
        for j in range(n):
            p.turned = p.turned or p.P[i, j] != (1.0 if i == j else 0.0)


@jit
def set_equations(q, p, w):
    """q'' + damping q' + stiffness q = force (sin, cos, 1)."""
    n = len(q.M)
    p.divergence = 0.0
    into_contact(q, p, q.K, w.A, p.stiffness)
    into_contact(q, p, q.C, w.A, p.damping)
    for i in range(n):
        p.divergence -= p.damping[i, i]
        sin = cos = one = 0.0
        for k in range(n):
            if p.P[i, k] != 0.0:
                share = p.P[i, k] / q.M[k, k]
                sin += share * q.sine[k]
                cos += share * q.cosine[k]
                one += share * q.constant[k]
        p.force[i, 0], p.force[i, 1], p.force[i, 2] = sin, cos, one


@jit
def into_contact(q, p, matrix, scratch, out):
    """P M^-1 matrix P^-1."""
    n = len(matrix)
    for i in range(n):
        for j in range(n):
            scratch[i, j] = 0.0
            for k in range(n):
                scratch[i, j] += matrix[i, k] * p.back[k, j]
            scratch[i, j] /= q.M[i, i]
    for i in range(n):
        for j in range(n):
            out[i, j] = 0.0
            for k in range(n):
                out[i, j] += p.P[i, k] * scratch[k, j]


@jit
def set_constrained(q, p, w):
    """q'' as a function of (q, q', sin, cos, 1) while a stop holds the gap. Returns whether it could be found."""
    n, A, row = len(q.M), w.A, w.row
    for i in range(1, n):
        for j in range(1, n):
            A[i - 1, j - 1] = 0.0
            for k in range(n):
                A[i - 1, j - 1] += p.back[k, i] * q.M[k, k] * p.back[k, j]
    if not factorise(A, n - 1):
        return False
    for j in range(2 * n + 3):
        p.constrained[0, j] = 0.0
        for i in range(1, n):
            row[i - 1] = 0.0
            for k in range(n):
                row[i - 1] += p.back[k, i] * free_force(q, p, k, j)
        solve(A, n - 1, row)
        for i in range(1, n):
            p.constrained[i, j] = row[i - 1]
    return True


@jit
def free_force(q, p, k, j):
    """The force on mass k for a unit of number j of (q, q', sin, cos, 1)."""
    n, total = len(q.M), 0.0
    if j < n:
        for i in range(n):
            total -= q.K[k, i] * p.back[i, j]
    elif j < 2 * n:
        for i in range(n):
            total -= q.C[k, i] * p.back[i, j - n]
    elif j == 2 * n:
        total = q.sine[k]
    else:
        total = q.cosine[k] if j == 2 * n + 1 else q.constant[k]
    return total
