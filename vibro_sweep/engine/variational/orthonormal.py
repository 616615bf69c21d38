"""Tangent vectors kept apart: orthonormalised where they come to lie too close together, and what they grew by then.

t: a record of tangent.py; `who`: the mask of the orbits to which something happens.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.simd.lanes import LANES, bits, lanes_of, select
from vibro_sweep.engine.simd.matrices import column, product, put_column, scaled, subtract
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.variational.growth import LONGEST, SHORTEST, close_volume, if_compliant, take_logs

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


@noinline
def orthonormalise(t, who):
    """Gram-Schmidt: Z = Q R, Z becomes Q and the diagonal of R is added to the growth."""
    orthogonalise(t, who)
    count_growth(t, who)


@jit
def orthonormalise_closely(t, i):
    """Twice: where rounding alone was left of a vector of orbit i, it is not at right angles to the others yet."""
    for _ in range(2):
        orthonormalise(t, lanes_of(1 << i))


@inline
def count_growth(t, who):
    """Count the growth of vectors that have become those of Q of Q R; of R there are `square_length` and `normal`."""
    combine_places(t, who)
    if t.collected:
        collect(t, bits(who))
    close_volume(if_compliant(t), t, who)
    extreme = normalise(t, who)
    if bits(extreme) != 0:
        take_logs(if_compliant(t), t, bits(extreme))
    put(t.volume, 0, select(who, 1.0, row(t.volume, 0)))


@inline
def combine_places(t, who):
    """Combine what the vectors do to the places of stops as the vectors themselves."""
    size = len(t.growth)
    for m in range(0, len(t.places) - size + 1, size):
        n = 0
        for i in range(size):
            place, square = row(t.places, m + i), row(t.square_length, i)
            for j in range(i + 1, size):
                other = row(t.places, m + j)
                put(t.places, m + j, select(who, other - row(t.normal, n) * place, other))
                n += 1
            put(t.places, m + i, select(who, select(square > 0.0, place / math.sqrt(square), 0.0), place))


@inline
def columns_of(t):
    """How many vectors there are at most: as many as states, and with compliant stops one more."""
    return len(t.growth) + len(t.alone) // 2


@inline
def place_of(size, i, j):
    """The index of entry (i, j) of a strict upper triangle, row by row."""
    return i * (2 * size - i - 1) // 2 + j - i - 1


@inline
def orthogonalise(t, who):
    """The columns of Z become orthogonal; what stands beside the diagonal of R is kept.

    Lengths are left to `normalise`: the next vector need not wait for a square root, and LLVM unrolls these loops for
    one and two masses, whose Z then stays in registers. A longer body would not be unrolled.
    """
    Z, size, place = t.Z, len(t.growth), 0
    for i in range(size):
        z = column(Z, i)
        square = select(row(t.lost, 0) >= float(size - i), 0.0, product(z, z))
        put(t.square_length, i, square)
        inverse = select(square > 0.0, 1.0 / square, 0.0)
        for j in range(i + 1, size):
            w = column(Z, j)
            along = inverse * product(z, w)
            put(t.normal, place, along)
            put_column(Z, j, subtract(who, w, along, z))
            place += 1


@inline
def normalise(t, who):
    """The columns of Z become unit vectors, and the growth is multiplied by their lengths.

    Returns the mask of the orbits in which a growth has left the range SHORTEST .. LONGEST.
    """
    extreme = who & ~who
    for i in range(len(t.growth)):
        square = row(t.square_length, i)
        length = math.sqrt(square)
        put_column(t.Z, i, scaled(who, column(t.Z, i), select(square > 0.0, 1.0 / length, 0.0)))
        growth = select(who, row(t.growth, i) * length, row(t.growth, i))
        put(t.growth, i, growth)
        extreme = extreme | (who & ~((growth > SHORTEST) & (growth < LONGEST)))
    return extreme


@noinline
def collect(t, who):
    """The product of all R so far: D U, with D the growths and U, which has ones on its diagonal, the shear.

    The next factor is R = D' (1 + along), and D^-1 (1 + along) D U the next U. Its terms have the factors D_k/D_i with
    k > i, not much above 1, and every row keeps its digits however much vectors differ in growth.
    """
    for lane in range(LANES):
        if not who >> lane & 1:
            continue
        n, size, columns = 0, len(t.growth), columns_of(t)
        for i in range(size - 1):
            for j in range(i + 1, columns):
                # rows k > i have not changed yet
                total = t.shear[n, lane]
                for k in range(i + 1, min(j + 1, size)):
                    d_i, d_k = t.growth[i, lane], t.growth[k, lane]
                    if d_i > 0.0 and t.logs[i, lane] > -np.inf:  # a lost direction has no row
                        ratio = d_k / d_i * math.exp(t.logs[k, lane] - t.logs[i, lane])
                        later = t.shear[place_of(columns, k, j), lane] if k < j else 1.0
                        total += t.normal[place_of(size, i, k), lane] * ratio * later
                t.shear[n, lane] = total
                n += 1
