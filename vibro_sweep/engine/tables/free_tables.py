"""Free flight from node 0 to each node, from the modes (eq. 6)."""

import math

from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import lanes_of, select
from vibro_sweep.engine.simd.memory import put, row
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


@inline
def pair(first, second, begin):
    """Eight numbers, all zero but two: number `begin`, which is 0 or 1, and the next but one."""
    both = select(lanes_of(0b0011 << begin), first, second)
    return select(lanes_of(0b0101 << begin), both, 0.0)


@inline
def add_block(E, m, on_x, on_v, square, s, xi, rate):
    """Add to the rows of x and v of mass m what a mode makes of them.

    on_x, on_v: its weights in the positions of both masses, and in their speeds. xi and rate: c + eta s, c - eta s of
    (6): e^{-eta u} ((c + eta s, s), (-omega_j^2 s, c - eta s)).
    """
    put(E, 2 * m, row(E, 2 * m) + on_x * xi - on_v * square * s)
    put(E, 2 * m + 1, row(E, 2 * m + 1) + on_x * s + on_v * rate)


@jit
def fill_flight(q, nodes, psi, omega_squared, mu_m):
    """E = exp(A t_k) in physical coordinates, from the 2x2 block of each mode."""
    for k in range(q.cells + 1):
        clear(nodes[k].E)
    for j in range(2):
        square = omega_squared[j]
        eta = q.zeta * square
        # psi_ij psi_mj M_m: the weight of mass m in the motion of mass i
        own, across = psi[0, j] * psi[0, j], psi[1, j] * psi[0, j]
        back, other = psi[0, j] * psi[1, j] * mu_m, psi[1, j] * psi[1, j] * mu_m
        first_x, first_v = pair(own, across, 0), pair(own, across, 1)
        second_x, second_v = pair(back, other, 0), pair(back, other, 1)
        for k in range(q.cells + 1):
            E, frame = nodes[k].E, nodes[k].frame
            cos, s, xi, rate = decaying(eta, square, k * q.width)
            frame[2 * j], frame[2 * j + 1] = cos, s
            add_block(E, 0, first_x, first_v, square, s, xi, rate)
            add_block(E, 1, second_x, second_v, square, s, xi, rate)
