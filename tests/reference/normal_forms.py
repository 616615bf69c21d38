"""Coefficients of normal forms in many digits, by differences of the map of an orbit.

Kuznetsov, Elements of Applied Bifurcation Theory, 3rd edition: (5.45) for a pair of multipliers, (9.10) for -1. No
power series, no impulses.
"""

from itertools import product

from mpmath import eye, mp, mpf, zeros

STEP = mpf(10) ** -10  # of differences, relative to states of size 1: for 50 digits


def third_order(f, mu, h=STEP):
    """Re of the cubic coefficient at the multiplier mu: zero at a degenerate flip (mu = -1) or Neimark-Sacker point."""
    N = len(f.centre)
    known = {}

    def at(x):
        key = tuple(map(mp.nstr, x))
        if key not in known:
            known[key] = f([h * value for value in x])
        return known[key]

    def second(x, y):
        """B(x, y), for complex x and y."""
        total = mp.matrix([0] * N)
        for (i, a), (j, b) in product(enumerate((mp.re, mp.im)), repeat=2):
            p, q = [a(v) for v in x], [b(v) for v in y]
            if any(p) and any(q):
                plus, minus = [u + v for u, v in zip(p, q, strict=True)], [u - v for u, v in zip(p, q, strict=True)]
                value = at(plus) + at([-v for v in plus]) - at(minus) - at([-v for v in minus])
                total += mpf(1) / (4 * h**2) * value * (mp.mpc(0, 1) ** (i + j))
        return total

    def third(x):
        """C(x, x, x) for a real x."""
        twice = [2 * v for v in x]
        odd = at(twice) - at([-v for v in twice]) - 2 * (at(x) - at([-v for v in x]))
        return odd / (2 * h**3)

    A = zeros(N)
    for j in range(N):
        e = [mpf(i == j) for i in range(N)]
        twice, less = [2 * v for v in e], [-v for v in e]
        A[:, j] = (8 * (at(e) - at(less)) - at(twice) + at([2 * v for v in less])) / (12 * h)
    q, p = null_vector(A - mu * eye(N)), null_vector(A.T - mu * eye(N))
    p = p / sum(a * b for a, b in zip(p, q, strict=True))
    u, v = [mp.re(x) for x in q], [mp.im(x) for x in q]
    cubic = third(u)
    if any(v):
        plus, minus = (
            third([a + b for a, b in zip(u, v, strict=True)]),
            third([a - b for a, b in zip(u, v, strict=True)]),
        )
        cu, cv = third(u), third(v)
        uuv, uvv = (plus - minus) / 6 - cv / 3, (plus + minus) / 6 - cu / 3
        cubic = cu + uvv + mp.mpc(0, 1) * (uuv + cv)
    conjugate = mp.matrix([mp.conj(x) for x in q])
    mean = mp.lu_solve(eye(N) - A, second(q, conjugate))
    double = mp.lu_solve(mu**2 * eye(N) - A, second(q, q))
    total = cubic + 2 * second(q, mean) + second(conjugate, double)
    return mp.re(sum(a * b for a, b in zip(p, total, strict=True)) / mu) / 2


def null_vector(M):
    """Of length 1 and with a fixed phase: by a bordered system."""
    n = M.rows
    B = zeros(n + 1)
    for i in range(n):
        for j in range(n):
            B[i, j] = M[i, j]
        B[i, n], B[n, i] = mpf(1) / (i + 2), mpf(1) / (2 * i + 3)
    x = mp.lu_solve(B, mp.matrix([0] * n + [1]))[:n]
    return mp.matrix(x) / mp.norm(mp.matrix(x))
