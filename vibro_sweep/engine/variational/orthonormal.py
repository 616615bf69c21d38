"""Tangent vectors kept apart: orthonormalised where they come to lie too close together, and what they grew by then.

t: a record of tangent.py; `who`: the mask of the orbits to which something happens.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import aside, inline, jit
from vibro_sweep.engine.simd.lanes import LANES, bits, select
from vibro_sweep.engine.simd.memory import put, row

CONDITION = 1e3  # bound on the condition number of Z past which it is orthonormalised
SMALLEST = 1e-30  # of the squares of all vectors together: where all decay alike, none lies too close to another


@jit
def watch(t, who, determinant):
    """Orthonormalise, after a step with this |determinant|, if the vectors come to lie too close together."""
    put(t.volume, 0, select(who, row(t.volume, 0) * determinant, row(t.volume, 0)))
    lost = row(t.lost, 0)
    put(t.lost, 0, select(who & (determinant <= 0.0) & (lost < 1.0), 1.0, lost))
    size = 0.0 * lost
    n = len(t.growth)
    for m in range(n * n):
        size += row(t.Z, m) * row(t.Z, m)
    # the condition number is below 2/det (|Z|^2/n)^(n/2)
    power, scale = size, float(n)
    for _ in range(n // 2 - 1):
        power, scale = power * size, scale * n
    skewed = (power > 0.5 * scale * CONDITION * row(t.volume, 0)) | (size < SMALLEST)
    close = who & ((row(t.lost, 0) > 0.0) | skewed)
    if bits(close) != 0:
        orthonormalise(t, close)


@aside
def orthonormalise(t, who):
    """Gram-Schmidt: Z = Q R, Z becomes Q and the diagonal of R is added to the growth."""
    if t.collected:
        reduce(t, who, True)
        collect(t, bits(who))
        for i in range(len(t.growth)):
            grow(t, who, i, row(t.length, i))
    else:
        reduce(t, who, False)
    put(t.volume, 0, select(who, 1.0, row(t.volume, 0)))


@inline
def place_of(size, i, j):
    """Where entry (i, j) of a strict upper triangle stands, row by row."""
    return i * (2 * size - i - 1) // 2 + j - i - 1


@inline
def along(Z, size, i, j):
    """The product of vectors i and j."""
    total = row(Z, i) * row(Z, j) + row(Z, size + i) * row(Z, size + j)
    for m in range(2, size, 2):
        first, second = m * size, (m + 1) * size
        total = total + (row(Z, first + i) * row(Z, first + j) + row(Z, second + i) * row(Z, second + j))
    return total


@inline
def reduce(t, who, kept):
    """Z becomes Q. What stands beside the diagonal of R, and the diagonal, is kept; or the growth has it at once.

    The lengths are taken out last: the next vector need not wait for a square root.
    """
    Z, size, place = t.Z, len(t.growth), 0
    for i in range(size):
        square = along(Z, size, i, i)
        square = select(row(t.lost, 0) >= float(size - i), 0.0, square)
        inverse = select(square > 0.0, 1.0 / square, 0.0)
        for j in range(i + 1, size):
            part = inverse * along(Z, size, i, j)
            if kept:
                put(t.along, place, part)
                place += 1
            for m in range(size):
                w = row(Z, m * size + j)
                put(Z, m * size + j, select(who, w - part * row(Z, m * size + i), w))
        length = math.sqrt(square)
        inverse = select(square > 0.0, 1.0 / length, 0.0)
        for m in range(size):
            z = row(Z, m * size + i)
            put(Z, m * size + i, select(who, inverse * z, z))
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
        n, size = 0, len(t.growth)
        for i in range(size - 1):
            for j in range(i + 1, size):
                # rows k > i have not changed yet
                total = t.shear[n, lane]
                for k in range(i + 1, j + 1):
                    d_i, d_k = t.growth[i, lane], t.growth[k, lane]
                    if d_i > 0.0 and t.logs[i, lane] > -np.inf:  # a lost direction has no row
                        ratio = d_k / d_i * math.exp(t.logs[k, lane] - t.logs[i, lane])
                        later = t.shear[place_of(size, k, j), lane] if k < j else 1.0
                        total += t.along[place_of(size, i, k), lane] * ratio * later
                t.shear[n, lane] = total
                n += 1


@aside
def take_logs(t, j, extreme):
    """Begin products anew before they leave the range of the floats."""
    for i in range(LANES):
        if extreme >> i & 1:
            t.logs[j, i] += np.log(t.growth[j, i])
            t.growth[j, i] = 1.0
