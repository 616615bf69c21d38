"""Flights over 1, 2, 4, ... cells in twice the digits of a float, rounded once: of oscillators whose rates lie apart.

A number is the sum of two floats, and a matrix (2, n, n) has the second ones in its second half. Sums and products are
those of Knuth and Dekker (T. J. Dekker, Numer. Math. 18, 1971), which no multiply-add may fuse. As in products.py a
flight E = 1 + D is kept as D; here its rows and columns are all inputs, sin and cos of the force among them.
"""

from vibro_sweep.engine.simd.jit import exactly, jit

TERMS = 14  # of the series: with rate * u <= SHORT what is left out is below 2^-106
SHORT = 2.0**-6
SPLIT = 2.0**27 + 1.0
TURN, TURN_LOW = 6.283185307179586, 2.4492935982947064e-16  # 2 pi


@exactly
def add(a, a_low, b, b_low):
    total = a + b
    other = total - a
    low = (a - (total - other)) + (b - other) + (a_low + b_low)
    high = total + low
    return high, low - (high - total)


@exactly
def multiply(a, a_low, b, b_low):
    c, d = SPLIT * a, SPLIT * b
    a_high, b_high = c - (c - a), d - (d - b)
    a_rest, b_rest = a - a_high, b - b_high
    product = a * b
    low = ((a_high * b_high - product) + a_high * b_rest + a_rest * b_high) + a_rest * b_rest
    low += a * b_low + a_low * b
    high = product + low
    return high, low - (high - product)


@exactly
def divide(a, a_low, b):
    quotient = a / b
    product, low = multiply(quotient, 0.0, b, 0.0)
    rest = ((a - product) - low + a_low) / b
    high = quotient + rest
    return high, rest - (high - quotient)


@exactly
def multiply_matrices(a, b, out):
    """out = a b."""
    n = a.shape[1]
    for i in range(n):
        for j in range(n):
            high, low = 0.0, 0.0
            for m in range(n):
                if a[0, i, m] != 0.0 and b[0, m, j] != 0.0:
                    more, more_low = multiply(a[0, i, m], a[1, i, m], b[0, m, j], b[1, m, j])
                    high, low = add(high, low, more, more_low)
            out[0, i, j], out[1, i, j] = high, low


@exactly
def fill_short(point, A, u, u_low, D, term, product):
    """D of a flight over the time u, by its series; A: scratch, the transposed matrix times u."""
    n, masses = A.shape[1], len(point.push)
    for i in range(n):
        for j in range(n):
            A[0, i, j] = A[1, i, j] = 0.0
    for i in range(masses):
        A[0, 2 * i + 1, 2 * i] = 1.0
        for j in range(masses):
            A[0, 2 * j, 2 * i + 1], A[1, 2 * j, 2 * i + 1] = -point.stiffness[i, j], point.low[i, j]
            A[0, 2 * j + 1, 2 * i + 1], A[1, 2 * j + 1, 2 * i + 1] = -point.damping[i, j], point.low[i, masses + j]
        for j in range(2 * masses, n):
            A[0, j, 2 * i + 1], A[1, j, 2 * i + 1] = point.force[i, j - 2 * masses], point.low[i, j]
    A[0, 2 * masses + 1, 2 * masses], A[0, 2 * masses, 2 * masses + 1] = point.omega, -point.omega
    for i in range(n):
        for j in range(n):
            A[0, i, j], A[1, i, j] = multiply(A[0, i, j], A[1, i, j], u, u_low)
            D[0, i, j], D[1, i, j] = A[0, i, j], A[1, i, j]
            term[0, i, j], term[1, i, j] = A[0, i, j], A[1, i, j]
    for k in range(2, TERMS + 1):
        multiply_matrices(term, A, product)
        for i in range(n):
            for j in range(n):
                high, low = divide(product[0, i, j], product[1, i, j], float(k))
                term[0, i, j], term[1, i, j] = high, low
                D[0, i, j], D[1, i, j] = add(D[0, i, j], D[1, i, j], high, low)


@exactly
def double(D, product):
    """D of a flight becomes that of one of twice the length."""
    n = D.shape[1]
    multiply_matrices(D, D, product)
    for i in range(n):
        for j in range(n):
            high, low = add(product[0, i, j], product[1, i, j], 2.0 * D[0, i, j], 2.0 * D[1, i, j])
            D[0, i, j], D[1, i, j] = high, low


@jit
def fill_doubled(q, nodes, point, room):
    """D at the nodes 1, 2, 4, ..., rounded. room (4, 2, inputs, inputs): scratch."""
    states, inputs = 2 * len(q.series), len(q.force)
    D, rate, halvings = room[0], max(point.omega, point.rate), 0
    u, u_low = divide(TURN, TURN_LOW, point.omega)
    u, u_low = divide(u, u_low, float(q.cells))
    while rate * u > SHORT:
        u, u_low, halvings = 0.5 * u, 0.5 * u_low, halvings + 1
    fill_short(point, room[1], u, u_low, D, room[2], room[3])
    for _ in range(halvings):
        double(D, room[3])
    k = 1
    while k <= q.cells:
        E = nodes[k].E
        for j in range(inputs):
            for i in range(E.shape[1]):
                E[j, i] = D[0, j, i] if i < states else 0.0
        double(D, room[3])
        k *= 2
