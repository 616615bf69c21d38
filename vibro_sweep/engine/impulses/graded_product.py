"""Multipliers of a periodic orbit with impacts: eigenvalues of the product of its saltation and flight factors.

They may span twenty decades, so that the product itself is never formed: of orbits with ten impacts its eigenvalues
were wrong by 7e-6 at a multiplier 2e-11, and altogether at 2e-17. Orthogonal iteration runs through the
factors; each pass gives triangular factors whose product of diagonal blocks has the multipliers, each as accurate as
its own condition allows. Moduli within a factor 2 stay together in a block.

The saltation matrix in contact coordinates, with v, a the gap velocity and acceleration before the impact:

    S = 1 - (1 + R) (e_v e_v^T + A e_v e_g^T) + (1 + R) (a/v) e_v e_g^T

Only the last term grows near a graze. For R > 0 it is split off, S = S_0 (1 - (1 + R) a/(R v) e_v e_g^T), and the
shear is written as rotation, stretch, rotation, so that its small singular value keeps its digits. What stretches less
is multiplied as it is, until directions have been stretched against each other by e^STRETCH.
"""

import math
from itertools import pairwise

import numpy as np

from vibro_sweep.engine.impulses.flights import flight_matrix
from vibro_sweep.engine.simd.jit import exported_quickly, jit

PASSES = 40
STRETCH = 4.0  # logarithm: so far directions may be stretched against each other before they are factorised
TINY = 1e-280  # squares that are smaller may have lost digits
EARLIEST = 12  # pass after which moduli closer than 0.01^(1/12) = 0.68 need not be distinguished


@jit
def factorise(Y, order, T, product, columns):
    """Replace Y (n, n) by Q of its QR factors, rows taken in `order` (large ones first); product <- T product."""
    n = len(order)
    for j in range(n):
        for i in range(n):
            columns[i, j] = Y[order[i], j]
    for i in range(n):
        for j in range(n):
            T[i, j] = 0.0
            Y[i, j] = 1.0 if i == j else 0.0  # becomes Q
    # Givens rotations from below: small rows are turned into large ones, never the other way
    for j in range(n):
        for i in range(n - 1, j, -1):
            a, b = columns[i - 1, j], columns[i, j]
            if b == 0.0:
                continue
            square = a * a + b * b
            inverse = 1.0 / (math.sqrt(square) if square > TINY else math.hypot(a, b))
            c, s = a * inverse, b * inverse
            for k in range(n):
                x, y = columns[i - 1, k], columns[i, k]
                columns[i - 1, k], columns[i, k] = c * x + s * y, c * y - s * x
                x, y = Y[k, i - 1], Y[k, i]
                Y[k, i - 1], Y[k, i] = c * x + s * y, c * y - s * x
            columns[i, j] = 0.0
    for i in range(n):
        for j in range(n):
            T[i, j] = Y[i, j]
    for i in range(n):
        for j in range(n):
            Y[order[i], j] = T[i, j]
    for i in range(n):  # an upper triangle, so that rows may be replaced from above
        for j in range(n):
            total = 0.0
            for k in range(i, n):
                total += columns[i, k] * product[k, j]
            product[i, j] = total


@jit
def turn(Y, i, j, c, s):
    """Rotate rows i and j."""
    for k in range(Y.shape[1]):
        x, y = Y[i, k], Y[j, k]
        Y[i, k], Y[j, k] = c * x + s * y, c * y - s * x


@jit
def shear_of(one_plus_R, v, a):
    """The shear that is split off the saltation matrix, and its larger singular value; 0 and 1 where R = 0."""
    beta = -one_plus_R * a / (v * (one_plus_R - 1.0)) if one_plus_R > 1.0 else 0.0
    return beta, 0.5 * (abs(beta) + math.hypot(beta, 2.0))


@jit
def salt(f, one_plus_R, v, a, split, Y, order, T, product, columns):
    """Y <- S Y for one impact; split: with the shear by itself, and factorised. one_plus_R: 1 + R."""
    n = len(order)
    N = n // 2
    shear = one_plus_R * a / v
    if split:
        beta, size = shear_of(one_plus_R, v, a)
        c, s = 1.0 / math.hypot(1.0, 1.0 / size), math.copysign(1.0 / math.hypot(1.0, size), beta)
        turn(Y, 0, N, c, s)  # V^T: the right singular vector of the large singular value first
        for k in range(n):
            Y[0, k] *= size
            Y[N, k] /= size
        for i in range(n - 1):
            order[i] = i if i < N else i + 1
        order[n - 1] = N
        factorise(Y, order, T, product, columns)
        for i in range(n):
            order[i] = i
        turn(Y, 0, N, abs(s), -math.copysign(c, beta))  # U
        shear = 0.0
    R = one_plus_R - 1.0  # as differences of g and (1 + R) g rows would lose the digits of a small R
    for k in range(n):
        g, speed = Y[0, k], Y[N, k]
        for i in range(1, n):
            if i != N:
                Y[i, k] -= one_plus_R * f.B[i, N] * g
        Y[0, k] = -R * g  # A e_v has the gap component 1
        Y[N, k] = (shear - one_plus_R * f.B[N, N]) * g - R * speed


@jit
def flight_length(u, P, K, k):
    """Time from impact k to the next."""
    return (u[k + 1] if k + 1 < K else u[0] + P) - u[k]


@jit
def flight_pieces(spread, length):
    """Pieces of a flight in each of which no direction shrinks by more than e^-STRETCH against another."""
    return 1 + int(length * spread / STRETCH)


@exported_quickly
def multiply(f, contacts, u, P, motion, product, columns, couplings, order, factors, work, room):
    """The product of all factors as `columns` times `product`, both (n, n), in the last basis of the iteration.

    `product` is an upper triangle, `columns` falls apart into diagonal blocks where `couplings` (n,) vanish. motion:
    (K, 3), gap velocity and acceleration before each impact. order: (n,) integers. factors: (pieces, n, n), room for
    the flights in `flight_pieces` pieces each. work: (3, n, n). room: of flights.
    """
    K = len(contacts)
    n = len(order)
    Y, T, start = work[0], work[1], work[2]
    for i in range(n):
        order[i] = i
        for j in range(n):
            Y[i, j] = 1.0 if i == j else 0.0
    count = 0
    for k in range(K):
        length = flight_length(u, P, K, k)
        pieces = flight_pieces(f.spread, length)
        flight_matrix(f, length / pieces, factors[count], room)
        for piece in range(1, pieces):
            for i in range(n):
                for j in range(n):
                    factors[count + piece, i, j] = factors[count, i, j]
        count += pieces
    for turn_number in range(PASSES):
        for i in range(n):
            for j in range(n):
                start[i, j], product[i, j] = Y[i, j], 1.0 if i == j else 0.0
        count, stretched = 0, 0.0  # the logarithm of how far Y may be stretched since it was factorised
        for k in range(K):
            one_plus_R, v, a = contacts[k, 1], motion[k, 0], motion[k, 1]
            sheared = 2.0 * math.log(shear_of(one_plus_R, v, a)[1])
            split = stretched + sheared > STRETCH
            if split and stretched > 0.0:
                factorise(Y, order, T, product, columns)
            salt(f, one_plus_R, v, a, split, Y, order, T, product, columns)
            stretched = (0.0 if split else stretched + sheared) - math.log(one_plus_R - 1.0)  # S_0 has 1 and R
            length = flight_length(u, P, K, k)
            pieces = flight_pieces(f.spread, length)
            for _ in range(pieces):
                for i in range(n):
                    for j in range(n):
                        total = 0.0
                        for m in range(n):
                            total += factors[count, i, m] * Y[m, j]
                        T[i, j] = total
                for i in range(n):
                    for j in range(n):
                        Y[i, j] = T[i, j]
                count += 1
                stretched += length * f.spread / pieces
                if stretched > STRETCH:
                    factorise(Y, order, T, product, columns)
                    stretched = 0.0
        factorise(Y, order, T, product, columns)
        settled = True
        for i in range(n):
            for j in range(n):
                total = 0.0
                for k in range(n):
                    total += start[k, i] * Y[k, j]
                columns[i, j] = total
        for split in range(1, n):
            couplings[split] = 0.0
            for i in range(split, n):
                for j in range(split):
                    couplings[split] = max(couplings[split], abs(columns[i, j]))
            settled = settled and (couplings[split] < 1e-14 or (turn_number >= EARLIEST and couplings[split] > 1e-2))
        if settled:
            break


def eigenvalues(product: np.ndarray, columns: np.ndarray, couplings: np.ndarray) -> np.ndarray:
    """The multipliers (n,) from what `multiply` gives: by falling modulus, of a pair +im first."""
    n = len(product)
    cuts = [0, *(i for i in range(1, n) if couplings[i] < 1e-13), n]
    values = np.empty(n, complex)
    for a, b in pairwise(cuts):
        block = columns[a:b, a:b] @ product[a:b, a:b]
        values[a:b] = block if b - a == 1 else np.linalg.eigvals(block)
    return values[np.lexsort((-values.imag, -np.abs(values)))]
