"""Systems whose rates lie far apart.

Where a rate is so fast that series would need more than `tables.MOST_CELLS` cells to a period, the system is called
stiff: its cells are those of a coarser grid, a series takes a small step within its cell, and a mode that the cells
do not resolve is fast. The scan does not follow a fast mode but bounds it by its energy, which only falls; and since
a fast mode is never in resonance, r can be its steady response.
"""

import math

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import WIDTH, decaying


@jit
def rate_of(omega_squared, zeta):
    """The fastest rate of a mode: the larger |root| of s^2 + 2 eta s + omega_j^2."""
    eta = zeta * omega_squared
    return math.sqrt(omega_squared) if eta * eta <= omega_squared else eta + math.sqrt(eta * eta - omega_squared)


@jit
def is_fast(q, omega_squared):
    """Whether the cells do not resolve a mode."""
    return q.stiff and rate_of(omega_squared, q.zeta) * q.width > WIDTH


@jit
def slow_part(q, psi, omega_squared, mu_m, i, u):
    """x1 and v1 of the modes that are not fast, after a free flight from the unit state i."""
    x, v = 0.0, 0.0
    for j in range(2):
        if not is_fast(q, omega_squared[j]):
            _, s, xi, rate = decaying(q.zeta * omega_squared[j], omega_squared[j], u)
            weight = psi[0, j] * psi[i // 2, j] * (mu_m if i // 2 == 1 else 1.0)
            x += weight * (xi if i % 2 == 0 else s)
            v += weight * (-omega_squared[j] * s if i % 2 == 0 else rate)
    return x, v


@jit
def add_stiff_remainder(q, nodes, psi, omega_squared, mu_m, f2):
    """`remainder` of a stiff system, by the energies of the modes: |xi| <= e = |xi_0| + |xi_0'|/omega_j in free motion.

    Of a fast mode that is all. Of another, whose rate is rho, the equation of motion bounds each derivative by those
    before: the fourth by 17 rho^4 e. The motion r is a sine in a fast mode; in another the force adds to the bounds.
    """
    quartic = q.width**4 / 144.0
    for j in range(2):
        rho, fast = rate_of(omega_squared[j], q.zeta), is_fast(q, omega_squared[j])
        for i in range(4):
            e = abs(psi[0, j] * psi[i // 2, j]) * (mu_m if i // 2 == 1 else 1.0)
            if i % 2 == 1:
                e /= math.sqrt(omega_squared[j])
            q.remainder[i] += e * (1.0 if fast else 17.0 * rho**4 * quartic)
        force = abs(psi[0, j] * (1.0 - f2) + psi[1, j] * f2)
        if fast:
            largest, rho = force / abs(omega_squared[j] - q.omega * q.omega), q.omega
        else:
            largest, rho = 0.0, max(rho, q.omega)
            for k in range(q.cells + 1):
                g = nodes[k].forced[j]
                xi, rate = abs(g[0, 0]) + abs(g[0, 1]), abs(g[1, 0]) + abs(g[1, 1])
                largest = max(largest, 2.0 * force * (xi + rate / math.sqrt(omega_squared[j])))
        q.remainder[4] += abs(psi[0, j]) * (17.0 * rho**4 * largest + 8.0 * rho**2 * force) * quartic
