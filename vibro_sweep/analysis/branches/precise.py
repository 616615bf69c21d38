"""The equations of a periodic orbit in extended precision, for impacts that follow each other closely."""

import math

import numpy as np

from vibro_sweep.analysis.periodic.impulse_equations import Equations
from vibro_sweep.engine.impulses.extended import cosine_and_sine, extended, identity, zeros
from vibro_sweep.engine.impulses.green import cells_needed, space
from vibro_sweep.engine.impulses.tables import ORDER, exponential, nodes, power, solve_refined, taylor_rows
from vibro_sweep.model.linear import Linear, forcing_period


def extended_table(q: Linear, sigma: int, halves: int) -> np.ndarray:
    """The Taylor coefficients of gamma_sigma, as green.py builds them, in extended precision."""
    s, cells = space(q), cells_needed(q) * halves
    E = exponential(extended(s.A), extended(forcing_period(q) / 2 * halves) / cells)
    matrix = identity(len(s.e_g)) - extended(sigma) * power(E, cells)
    start = solve_refined(matrix, extended(s.e_v))
    return nodes(E, start, cells) @ taylor_rows(extended(s.A), extended(s.e_g)).T


def precise(e: Equations, sides, u) -> tuple[np.ndarray, float]:
    """The residual (2K,) of the equations, and g'' before the last impact, summed in extended precision.

    In double precision the times at the end of a sequence, where speeds are small, would be known to rounding over
    speed only, and the onset to 1e-11.
    """
    K = len(sides)
    t, D = extended(u[:K]), extended(u[K : 2 * K])
    table = extended_table(e.q, e.sigma, e.halves)
    width = extended(e.P) / len(table)
    delay = t[:, None] - t
    before = np.arange(K)[:, None] < np.arange(K)
    s = delay + np.where(before, width * len(table), extended(0.0))
    cell = np.clip((s / width).astype(int), 0, len(table) - 1)
    at, c = s - cell * width, table[cell]
    sums = []
    for order in range(3):
        value = zeros(at.shape)
        for n in range(ORDER, order - 1, -1):
            value = value * at + math.perm(n, order) * c[..., n]
        value = value - np.diag(np.full(K, e.train.jumps[order]))
        sums.append((value * np.where(before, float(e.sigma), 1.0)) @ D)
    q, angle = e.steady, e.steady.omega * t
    cos, sin = cosine_and_sine(angle)
    sums[0] += q.mean + q.real * cos - q.imag * sin
    sums[1] -= q.omega * (q.real * sin + q.imag * cos)
    sums[2] -= extended(q.omega) ** 2 * (q.real * cos - q.imag * sin)
    contacts = e.contacts(sides)
    F = np.concatenate([sums[0] - contacts[:, 0], D + contacts[:, 1] * sums[1]])
    return F.astype(float), float(sums[2][-1])
