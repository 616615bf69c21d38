"""Tangent vectors kept apart: orthonormalised where they come to lie too close together, and what they grew by then.

t: a record of tangent.py; `who`: the mask of the orbits to which something happens.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import aside, inline, jit
from vibro_sweep.engine.simd.lanes import LANES, bits, put, row, select

PLACE = (-1, 1, 2)  # entry (i, j) of a strict upper triangle, row by row, stands at PLACE[i] + j

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
    """Gram-Schmidt: Z = Q R, Z becomes Q and the diagonal of R is added to the growth."""
    if t.collected:
        reduce(t, who, True)
        collect(t, bits(who))
        for i in range(4):
            grow(t, who, i, row(t.length, i))
    else:
        reduce(t, who, False)
    put(t.volume, 0, select(who, 1.0, row(t.volume, 0)))


@inline
def reduce(t, who, kept):
    """Z becomes Q. What stands beside the diagonal of R, and the diagonal, is kept; or the growth has it at once.

    The lengths are taken out last: the next vector need not wait for a square root.
    """
    Z, n = t.Z, 0
    for i in range(4):
        z0, z1, z2, z3 = row(Z, i), row(Z, 4 + i), row(Z, 8 + i), row(Z, 12 + i)
        square = (z0 * z0 + z1 * z1) + (z2 * z2 + z3 * z3)
        square = select(row(t.lost, 0) >= 4.0 - i, 0.0, square)
        inverse = select(square > 0.0, 1.0 / square, 0.0)
        for j in range(i + 1, 4):
            w0, w1, w2, w3 = row(Z, j), row(Z, 4 + j), row(Z, 8 + j), row(Z, 12 + j)
            along = inverse * ((z0 * w0 + z1 * w1) + (z2 * w2 + z3 * w3))
            if kept:
                put(t.along, n, along)
                n += 1
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
        if kept:
            put(t.length, i, length)
        else:
            grow(t, who, i, length)


@inline
def grow(t, who, i, length):
    """The growth of vector i times a length."""
    growth = row(t.growth, i)
    put(t.growth, i, select(who, growth * length, growth))
    growth = row(t.growth, i)
    extreme = bits(who & ~((growth > 1e-100) & (growth < 1e100)))
    if extreme != 0:
        take_logs(t, i, extreme)


@aside
def collect(t, who):
    """The product of all R so far: D U, with D the growths and U, which has ones on its diagonal, the shear.

    The next factor is R = D' (1 + along), and D^-1 (1 + along) D U the next U. Its terms have the factors D_k/D_i with
    k > i, not much above 1, and every row keeps its digits however much vectors differ in growth.
    """
    for lane in range(LANES):
        if not who >> lane & 1:
            continue
        n = 0
        for i in range(3):
            for j in range(i + 1, 4):
                # rows k > i have not changed yet
                total = t.shear[n, lane]
                for k in range(i + 1, j + 1):
                    d_i, d_k = t.growth[i, lane], t.growth[k, lane]
                    if d_i > 0.0 and t.logs[i, lane] > -np.inf:  # a lost direction has no row
                        ratio = d_k / d_i * math.exp(t.logs[k, lane] - t.logs[i, lane])
                        total += t.along[PLACE[i] + k, lane] * ratio * (t.shear[PLACE[k] + j, lane] if k < j else 1.0)
                t.shear[n, lane] = total
                n += 1


@aside
def take_logs(t, j, extreme):
    """Begin products anew before they leave the range of the floats."""
    for i in range(LANES):
        if extreme >> i & 1:
            t.logs[j, i] += np.log(t.growth[j, i])
            t.growth[j, i] = 1.0
