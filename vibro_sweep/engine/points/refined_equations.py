"""Equations of an oscillator whose rates lie apart, in twice the digits, for pages (page_kernel.py).

As exact.py, which has fractions, but in a kernel and by refinement: with the accelerations A = P M^-1 F P^-1 as they
were rounded, what is left of them is P M^-1 R, with the residual R = F P^-1 - M P^-1 A in twice the digits.
"""

from vibro_sweep.engine.points.symmetric import solve
from vibro_sweep.engine.simd.jit import exactly
from vibro_sweep.engine.tables.twofold import add, multiply


@exactly
def refine_equations(q, p, w):
    """Set `low` of a point: what the rounding of its equations has left."""
    n = len(q.M)
    set_low_of_back(q, p, w)
    for j in range(2 * n + 3):
        for k in range(n):
            high, low = force_of(q, p, w, k, j)
            for m in range(n):
                for i in range(n):
                    inertia, inertia_low = multiply(p.back[m, i], w.back_low[m, i], acceleration(p, i, j), 0.0)
                    inertia, inertia_low = multiply(-q.M[k, m], 0.0, inertia, inertia_low)
                    high, low = add(high, low, inertia, inertia_low)
            w.row[k] = high + low
        solve(w.mass, n, w.row)
        for i in range(n):
            p.low[i, j] = 0.0
            for k in range(n):
                p.low[i, j] += p.P[i, k] * w.row[k]


@exactly
def set_low_of_back(q, p, w):
    """What the rounding of P^-1 has left: in the row of the one mass that is no coordinate."""
    n, spare = len(q.M), 0
    for m in range(n):
        spare = m if p.back[m, 0] != 0.0 else spare
        for i in range(n):
            w.back_low[m, i] = 0.0
    for i in range(n):
        high, low = 1.0 if i == 0 else 0.0, 0.0
        for m in range(n):
            gap, gap_low = multiply(-q.normal[m], 0.0, p.back[m, i], 0.0)
            high, low = add(high, low, gap, gap_low)
        w.back_low[spare, i] = (high + low) / q.normal[spare]


@exactly
def force_of(q, p, w, k, j):
    """`free_force` in twice the digits."""
    n, high, low = len(q.M), 0.0, 0.0
    if j >= 2 * n:
        return (q.sine[k] if j == 2 * n else q.cosine[k] if j == 2 * n + 1 else q.constant[k]), 0.0
    matrix, column = (q.K, j) if j < n else (q.C, j - n)
    for m in range(n):
        term, term_low = multiply(-matrix[k, m], 0.0, p.back[m, column], w.back_low[m, column])
        high, low = add(high, low, term, term_low)
    return high, low


@exactly
def acceleration(p, i, j):
    """Entry i, j of A."""
    n = len(p.push)
    if j < n:
        return -p.stiffness[i, j]
    return -p.damping[i, j - n] if j < 2 * n else p.force[i, j - 2 * n]
