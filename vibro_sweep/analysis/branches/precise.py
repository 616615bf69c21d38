"""The equations of a periodic orbit in extended precision, for impacts that follow each other closely."""

import math

import numpy as np

from vibro_sweep.analysis.periodic.impulse_equations import Equations
from vibro_sweep.engine.impulses.green import cells_needed, space
from vibro_sweep.engine.impulses.tables import ORDER, REAL, exponential, nodes, power, solve_refined, taylor_rows
from vibro_sweep.model.linear import Linear, forcing_period


def extended_table(q: Linear, sigma: int, halves: int) -> np.ndarray:
    """The Taylor coefficients of gamma_sigma, as green.py builds them, in extended precision."""
    s, cells = space(q), cells_needed(q) * halves
    E = exponential(s.A.astype(REAL), REAL(forcing_period(q) / 2 * halves) / cells)
    matrix = np.eye(len(s.e_g), dtype=REAL) - REAL(sigma) * power(E, cells)
    start = solve_refined(matrix, s.e_v.astype(REAL))
    return nodes(E, start, cells) @ taylor_rows(s.A.astype(REAL), s.e_g.astype(REAL)).T


def precise(e: Equations, sides, u) -> tuple[np.ndarray, float]:
    """The residual (2K,) of the equations, and g'' before the last impact, summed in extended precision.

    In double precision the times at the end of a sequence, where speeds are small, would be known to rounding over
    speed only, and the onset to 1e-11.
    """
    K = len(sides)
    t, D = u[:K].astype(REAL), u[K : 2 * K].astype(REAL)
    table = extended_table(e.q, e.sigma, e.halves)
    width = REAL(e.P) / len(table)
    delay = t[:, None] - t
    before = np.arange(K)[:, None] < np.arange(K)
    s = delay + np.where(before, width * len(table), REAL(0))
    cell = np.clip((s / width).astype(int), 0, len(table) - 1)
    at, c = s - cell * width, table[cell]
    sums = []
    for order in range(3):
        value = np.zeros_like(at)
        for n in range(ORDER, order - 1, -1):
            value = value * at + math.perm(n, order) * c[..., n]
        value = value - np.diag(np.full(K, REAL(e.train.jumps[order])))
        sums.append((value * np.where(before, REAL(e.sigma), REAL(1))) @ D)
    q, angle = e.steady, REAL(e.steady.omega) * t
    cos, sin = np.cos(angle), np.sin(angle)
    sums[0] += q.mean + q.real * cos - q.imag * sin
    sums[1] -= q.omega * (q.real * sin + q.imag * cos)
    sums[2] -= REAL(q.omega) ** 2 * (q.real * cos - q.imag * sin)
    contacts = e.contacts(sides)
    F = np.concatenate([sums[0] - contacts[:, 0], D + contacts[:, 1] * sums[1]])
    return F.astype(float), float(sums[2][-1])
