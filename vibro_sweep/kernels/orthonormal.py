"""Tangent vectors kept apart: orthonormalised where they come to lie too close together, and what they grew by then.

t: a record of tangent.py; `who`: the mask of the orbits to which something happens.
"""

import math

import numpy as np

from vibro_sweep.kernels.jit import aside, jit
from vibro_sweep.kernels.lanes import LANES, bits, put, row, select

CONDITION = 1e3  # bound on the condition number of Z past which it is orthonormalised


@jit
def watch(t, who, determinant):
    """Orthonormalise, after a step with this |determinant|, if the vectors come to lie too close together."""
    put(t.volume, 0, select(who, row(t.volume, 0) * determinant, row(t.volume, 0)))
    lost = row(t.lost, 0)
    put(t.lost, 0, select(who & (determinant <= 0.0) & (lost < 1.0), 1.0, lost))
    size = 0.0 * lost
    for m in range(16):
        size += row(t.Z, m) * row(t.Z, m)
    # the condition number is below 2/det (|Z|^2/4)^2
    close = who & ((row(t.lost, 0) > 0.0) | (size * size > 8.0 * CONDITION * row(t.volume, 0)))
    if bits(close) != 0:
        orthonormalise(t, close)


@aside
def orthonormalise(t, who):
    """Gram-Schmidt: Z = Q R, Z becomes Q and the diagonal of R is added to the growth.

    The lengths are taken out last: the next vector need not wait for a square root.
    """
    Z = t.Z
    for i in range(4):
        z0, z1, z2, z3 = row(Z, i), row(Z, 4 + i), row(Z, 8 + i), row(Z, 12 + i)
        square = (z0 * z0 + z1 * z1) + (z2 * z2 + z3 * z3)
        square = select(row(t.lost, 0) >= 4.0 - i, 0.0, square)
        inverse = select(square > 0.0, 1.0 / square, 0.0)
        for j in range(i + 1, 4):
            w0, w1, w2, w3 = row(Z, j), row(Z, 4 + j), row(Z, 8 + j), row(Z, 12 + j)
            along = inverse * ((z0 * w0 + z1 * w1) + (z2 * w2 + z3 * w3))
            put(Z, j, select(who, w0 - along * z0, w0))
            put(Z, 4 + j, select(who, w1 - along * z1, w1))
            put(Z, 8 + j, select(who, w2 - along * z2, w2))
            put(Z, 12 + j, select(who, w3 - along * z3, w3))
        length = math.sqrt(square)
        inverse = select(square > 0.0, 1.0 / length, 0.0)
        put(Z, i, select(who, inverse * z0, z0))
        put(Z, 4 + i, select(who, inverse * z1, z1))
        put(Z, 8 + i, select(who, inverse * z2, z2))
        put(Z, 12 + i, select(who, inverse * z3, z3))
        growth = row(t.growth, i)
        put(t.growth, i, select(who, growth * length, growth))
        growth = row(t.growth, i)
        extreme = bits(who & ~((growth > 1e-100) & (growth < 1e100)))
        if extreme != 0:
            take_logs(t, i, extreme)
    put(t.volume, 0, select(who, 1.0, row(t.volume, 0)))


@aside
def take_logs(t, j, extreme):
    """Begin products anew before they leave the range of the floats."""
    for i in range(LANES):
        if extreme >> i & 1:
            t.logs[j, i] += np.log(t.growth[j, i])
            t.growth[j, i] = 1.0
