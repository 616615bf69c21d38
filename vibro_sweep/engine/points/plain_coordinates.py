"""Contact coordinates of an oscillator whose masses are factorised, and its equations in them (contact.py)."""

import numpy as np

from vibro_sweep.engine.points.symmetric import factorise, solve
from vibro_sweep.engine.simd.jit import jit


@jit
def set_coordinates(q, p, w):
    """P and its inverse: the gap, and the masses but the one that is held least; n M^-1 n, and the push of an impulse.

    Returns whether coordinates are those of the masses, of which the gap is the first and moves alone in an impulse.
    """
    n, spare, least = len(q.M), 0, np.inf
    for i in range(n):
        w.mobility[i] = q.normal[i]
        if q.normal[i] != 0.0:
            held = (abs(q.K[i, i]) + q.omega * abs(q.C[i, i]) + q.omega * q.omega * abs(q.M[i, i])) / q.normal[i]
            held = held / q.normal[i]
            if held < least:
                spare, least = i, held
    solve(w.mass, n, w.mobility)
    w.along[0] = 0.0
    for i in range(n):
        w.along[0] += q.normal[i] * w.mobility[i]
        for j in range(n):
            p.P[i, j] = p.back[i, j] = 0.0
    row = 1
    for j in range(n):
        p.P[0, j] = q.normal[j]
        if j != spare:
            p.P[row, j] = p.back[j, row] = 1.0
            p.back[spare, row] = 0.0 - q.normal[j] / q.normal[spare]
            p.push[row] = w.mobility[j] / w.along[0]
            row += 1
    p.back[spare, 0], p.push[0] = 1.0 / q.normal[spare], 1.0
    p.turned, own = False, True
    for i in range(n):
        p.origin[i] = 0.0
        for j in range(n):
            p.turned = p.turned or p.P[i, j] != (1.0 if i == j else 0.0)
            own = own and (i == j or q.M[i, j] == 0.0)
    return own and not p.turned


@jit
def set_equations(q, p, w):
    """q'' + damping q' + stiffness q = force (sin, cos, 1): P M^-1 of the forces."""
    n, row = len(q.M), w.row
    p.divergence = 0.0
    for j in range(2 * n + 3):
        for k in range(n):
            row[k] = free_force(q, p, k, j)
        solve(w.mass, n, row)
        for i in range(n):
            total = 0.0
            for k in range(n):
                total += p.P[i, k] * row[k]
            if j < n:
                p.stiffness[i, j] = 0.0 - total
            elif j < 2 * n:
                p.damping[i, j - n] = 0.0 - total
                p.divergence += total if i == j - n else 0.0
            else:
                p.force[i, j - 2 * n] = total


@jit
def set_constrained(q, p, w):
    """q'' as a function of (q, q', sin, cos, 1) while a stop holds the gap. Returns whether it could be found."""
    n, A, row = len(q.M), w.A, w.row
    for i in range(1, n):
        for j in range(1, n):
            A[i - 1, j - 1] = in_contact(p, q.M, i, j)
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
def in_contact(p, matrix, i, j):
    """Entry i, j of back^T matrix back."""
    total, n = 0.0, len(matrix)
    for k in range(n):
        for m in range(n):
            total += p.back[k, i] * matrix[k, m] * p.back[m, j]
    return total


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
