"""Tables of the free flight y' = A (y, 1): Taylor coefficients and powers over a cell, and what they give of a flight.

Affine maps are (n, n + 1): the last column is the shift by the constant force. Slopes are by the free numbers. Rows are
kept as whole vectors, which hold zeros beyond.
"""

from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import eight, put_eight


def columns_of(n):
    """Numbers in a row of an affine map, in whole vectors."""
    return LANES * (n // LANES + 1)


@jit
def start_product(n, shift, out):
    """out: the shift of an affine map (n, n + 1) whose matrix is zero."""
    for r in range(n):
        for c in range(n):
            out[r, c] = 0.0
        out[r, n] = shift[r, n]


@jit
def add_product(n, a, b, out):
    """out += the matrix of a times b, for affine maps (n, n + 1): the last column is the shift."""
    columns = b.shape[1]
    for r in range(n):
        for c in range(0, columns, LANES):
            total = eight(out, r * columns + c)
            for k in range(n):
                total = total + a[r, k] * eight(b, k * columns + c)
            put_eight(out, r * columns + c, total)


@jit
def product(n, a, b, out):
    """out = a b."""
    start_product(n, a, out)
    add_product(n, a, b, out)


@jit
def product_slope(n, a, da, b, db, out):
    """out = d(a b)."""
    start_product(n, da, out)
    add_product(n, a, db, out)
    add_product(n, da, b, out)


@jit
def build_series(f):
    n = f.A.shape[0]
    for r in range(n):
        for c in range(n + 1):
            f.series[0, r, c] = 1.0 if r == c else 0.0
            for j in range(f.parameters):
                f.series_slopes[j, 0, r, c] = 0.0
    for k in range(1, ORDER + 1):
        for r in range(n):
            for c in range(n + 1):
                total = 0.0
                for l in range(n):  # noqa: E741
                    total += f.series[k - 1, r, l] * f.A[l, c]
                f.series[k, r, c] = total / k
        for j in range(f.parameters):
            if f.moves[j] > 0:
                for r in range(n):
                    for c in range(n + 1):
                        total = 0.0
                        for l in range(n):  # noqa: E741
                            total += f.series_slopes[j, k - 1, r, l] * f.A[l, c]
                            total += f.series[k - 1, r, l] * f.A_slopes[j, l, c]
                        f.series_slopes[j, k, r, c] = total / k


@jit
def polynomial(n, series, u, out):
    """out = sum_k series_k u^k, (n, n + 1)."""
    size = n * out.shape[1]
    for i in range(0, size, LANES):
        total = eight(series, ORDER * size + i)
        for k in range(ORDER - 1, -1, -1):
            total = total * u + eight(series, k * size + i)
        put_eight(out, i, total)


@jit
def build_powers(f):
    n = f.A.shape[0]
    polynomial(n, f.series, f.width, f.powers[0])
    for k in range(1, f.bits):
        product(n, f.powers[k - 1], f.powers[k - 1], f.powers[k])
    for j in range(f.parameters):
        if f.moves[j] > 0:
            polynomial(n, f.series_slopes[j], f.width, f.power_slopes[j, 0])
            for k in range(1, f.bits):
                before, slope = f.powers[k - 1], f.power_slopes[j, k - 1]
                product_slope(n, before, slope, before, slope, f.power_slopes[j, k])


@jit
def flight(f, length, out, other):
    """The affine map (n, n + 1) of a flight, and its derivatives where A moves: out (3, n, n + 1). other: as out."""
    n = f.A.shape[0]
    cells = int(length / f.width)
    u = length - cells * f.width
    polynomial(n, f.series, u, out[0])
    for j in range(f.parameters):
        if f.moves[j] > 0:
            polynomial(n, f.series_slopes[j], u, out[1 + j])
    bit = 0
    while cells > 0:
        if cells & 1:
            product(n, out[0], f.powers[bit], other[0])
            for j in range(f.parameters):
                if f.moves[j] > 0:
                    product_slope(n, out[0], out[1 + j], f.powers[bit], f.power_slopes[j, bit], other[1 + j])
            for i in range(1 + f.parameters):
                if i == 0 or f.moves[i - 1] > 0:
                    for place in range(0, n * out.shape[2], LANES):
                        put_eight(out[i], place, eight(other[i], place))
        cells >>= 1
        bit += 1
