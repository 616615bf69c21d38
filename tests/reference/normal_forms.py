"""Coefficients of normal forms in many digits, by differences of the map and of the equations of an orbit.

Kuznetsov, Elements of Applied Bifurcation Theory, 3rd edition: (5.45) for a pair of multipliers, (9.10) for -1, and the
quadratic coefficient of a fold. No power series, no impulses.
"""

from itertools import product

from mpmath import eye, mp, mpf, pi, zeros

from reference.shooting import Shooting

STEP = mpf(10) ** -10  # of differences, relative to states of size 1: for 50 digits


class SectionMap:
    """The map over P, with the mirror for sigma = -1, of states (x1, x2, v1, v2) at a time between two impacts."""

    def __init__(self, shooting: Shooting, A, n, u):
        self.s, self.A, self.n = shooting, A, n
        K, self.P = len(shooting.sides), pi / n["omega"] * shooting.half_periods
        t, self.t = u[:K], list(u[:K])
        z = list(u[K:])
        flights = [(t[k + 1] if k + 1 < K else t[0] + self.P) - t[k] for k in range(K)]
        longest = max(range(K), key=lambda k: flights[k])
        for k in range(longest + 1):  # to the middle of the longest flight
            z[2] = -n["R"] * z[2]
            z = shooting.fly(A, n, t[k], z, flights[k] if k < longest else flights[k] / 2)
        self.begin, self.centre = t[longest] + flights[longest] / 2, z
        later = list(range(longest + 1, K))
        self.impacts = [(t[k], shooting.sides[k]) for k in later]
        self.impacts += [(t[k] + self.P, shooting.sigma * shooting.sides[k]) for k in range(longest + 1)]

    def __call__(self, change):
        """The change of the image."""
        s, A, n = self.s, self.A, self.n
        z, t = [a + b for a, b in zip(self.centre, change, strict=True)], self.begin
        for guess, side in self.impacts:
            for _ in range(30):
                there = s.fly(A, n, t, z, guess - t)
                step = (there[0] - side * n["b"]) / there[2]
                guess -= step
                if abs(step) < mpf(10) ** (-mp.dps + 6):
                    break
            z, t = s.fly(A, n, t, z, guess - t), guess
            z[2] = -n["R"] * z[2]
        z = s.fly(A, n, t, z, self.begin + self.P - t)
        return mp.matrix([s.sigma * a - b for a, b in zip(z, self.centre, strict=True)])


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


def jacobian(residual, u):
    n, h = len(u), STEP
    J = zeros(n)
    for j in range(n):
        ends = [mp.matrix(residual([a + sign * h * (i == j) for i, a in enumerate(u)])) for sign in (1, -1)]
        J[:, j] = (ends[0] - ends[1]) / (2 * h)
    return J


def linearised(shooting: Shooting, A, n, u, mu):
    """(K + 4, K + 4): singular where the orbit has the multiplier mu, also where an impact has no speed.

    It is the Jacobian of the residual for changes that grow by mu from one period to the next, the first time too.
    """
    K = len(shooting.sides)
    J = jacobian(lambda x: shooting.residual(A, n, x), u)
    rate = shooting.rate(A, n, u[0], u[K:])
    for i in range(4):
        J[K + i, 0] += (mu - 1) * shooting.sigma * rate[i]
        J[K + i, K + i] -= (mu - 1) * shooting.sigma
    return J


def fold(residual, u):
    """(determinant, quadratic coefficient) of the equations residual(u) = 0: both vanish at a cusp."""
    h, f0, J = STEP, mp.matrix(residual(u)), jacobian(residual, u)
    v, w = null_vector(J), null_vector(J.T)
    ends = [mp.matrix(residual([a + sign * h * b for a, b in zip(u, v, strict=True)])) for sign in (1, -1)]
    second = (ends[0] + ends[1] - 2 * f0) / h**2
    return mp.det(J), sum(a * b for a, b in zip(w, second, strict=True))
