"""Free flight from node 0 to each node, from the modes (eq. 6)."""

import math

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.close_modes import difference
from vibro_sweep.engine.tables.flight import decaying
from vibro_sweep.engine.tables.series import clear


@jit
def gap_of(mu_m, mu_k):
    """omega_2^2 - omega_1^2, with all its digits where the modes lie close together."""
    return 2.0 * math.hypot(0.5 * (((mu_k - mu_m) + 1.0) / mu_m), 1.0 / math.sqrt(mu_m))


@jit
def fill_coupling(q, nodes, psi, omega_squared, mu_m, gap):
    """The blocks of E by which x1 and x2 move each other, where the modes lie close together."""
    for k in range(q.cells + 1):
        E = nodes[k].E
        s, xi, rate, bend = difference(q.zeta, omega_squared[0], gap, k * q.width)
        for i in range(2):
            m = 1 - i
            weight = psi[i, 1] * psi[m, 1] * (mu_m if m == 1 else 1.0)
            E[2 * m, 2 * i] = weight * xi
            E[2 * m + 1, 2 * i] = weight * s
            E[2 * m, 2 * i + 1] = -weight * bend
            E[2 * m + 1, 2 * i + 1] = weight * rate


@jit
def fill_flight(q, nodes, psi, omega_squared, mu_m):
    """E = exp(A t_k) in physical coordinates, from the 2x2 block of each mode."""
    for k in range(q.cells + 1):
        clear(nodes[k].E)
    for j in range(2):
        square = omega_squared[j]
        eta = q.zeta * square
        for k in range(q.cells + 1):
            E, frame = nodes[k].E, nodes[k].frame
            c, s, xi, rate = decaying(eta, square, k * q.width)
            frame[2 * j], frame[2 * j + 1] = c, s
            # (6): e^{-eta u} ((c + eta s, s), (-omega_j^2 s, c - eta s)) of xi_j and xi_j'
            for i in range(2):
                for m in range(2):
                    weight = psi[i, j] * psi[m, j] * (mu_m if m == 1 else 1.0)
                    E[2 * m, 2 * i] += weight * xi
                    E[2 * m + 1, 2 * i] += weight * s
                    E[2 * m, 2 * i + 1] -= weight * square * s
                    E[2 * m + 1, 2 * i + 1] += weight * rate
