"""The discontinuity mapping in mpmath, order by order, and the exact map that it approximates.

X holds x1, v1, ..., xN, vN. Nothing is tabulated: each flight is a matrix exponential. A point X of the map is where
the orbit would be at the phase of the right graze if the impact there had not been: the map's points may lie beyond the
stops. So the exact map is: a quarter of a period of free flight back, to between the stops; one period of the
oscillator as `naive.py` simulates it; a quarter of a period of free flight on.
"""

from mpmath import mp, mpf

from reference import naive
from reference.flow import matrix_of
from reference.gmp import expm
from reference.machine import machine_of


class AnyNaiveMap:
    """P = Phi_{T/2} o C2 o Phi_{T/2} o C1 of a `Linear` whose numbers may be those of mpmath; call it with a column."""

    def __init__(self, q, order, expand_at=None):
        n = q.masses
        column = lambda values: mp.matrix([mpf(x) for x in values])  # noqa: E731
        square = lambda rows: mp.matrix([[mpf(x) for x in row] for row in rows])  # noqa: E731
        M, K, C = (square(matrix) for matrix in (q.M, q.K, q.C))
        self.omega, self.order, self.q = mpf(q.omega), order, q
        self.A = matrix_of(machine_of(q))[: 2 * n, : 2 * n]
        push = mp.inverse(M) * column(q.contact.normal)
        push /= (column(q.contact.normal).T * push)[0]
        self.push, self.normal = mp.zeros(2 * n, 1), mp.zeros(1, 2 * n)
        for i in range(n):
            self.push[2 * i + 1], self.normal[2 * i] = push[i], mpf(q.contact.normal[i])
        x = mp.lu_solve(K - self.omega**2 * M + 1j * self.omega * C, column(q.cosine) - 1j * column(q.sine))
        response = sum(mpf(a) * b for a, b in zip(q.contact.normal, x, strict=True))
        self.amplitudes = x * mp.expj(-mp.arg(response))
        self.graze = self.steady(0)
        if expand_at is not None:
            more = mpf(expand_at) - (self.normal * self.graze)[0]
            for i in range(n):
                self.graze[2 * i] += more * push[i]
        self.L = expm(self.A * mp.pi / self.omega)

    def steady(self, t):
        """The non-impacting motion, which is furthest on the right at t = 0."""
        x = self.amplitudes * mp.expj(self.omega * t)
        return mp.matrix([part for one in x for part in (mp.re(one), -self.omega * mp.im(one))])

    def strike(self, X):
        """(psi, speed squared at the right stop, acceleration); there is an impact where the square is positive."""
        psi, a = (self.normal * X)[0] - mpf(self.q.contact.high), -(self.omega**2) * (self.normal * self.graze)[0]
        if self.order == 1:
            return psi, -2 * a * psi, a
        a += (self.normal * self.A * self.A * (X - self.graze))[0]
        return psi, (self.normal * self.A * X)[0] ** 2 - 2 * a * psi, a

    def C1(self, X):
        """The impact at the right stop; eqs. (38), (39), and the next order."""
        _, square, a = self.strike(X)
        if square <= 0 or a >= 0:
            return X
        w, impulse = mp.sqrt(square), self.push
        if self.order == 2:
            impulse = expm(-self.A * (w - (self.normal * self.A * X)[0]) / a) * impulse
        return X - (1 + mpf(self.q.contact.R_high)) * w * impulse

    def middle(self, X):
        """Half a period on, before the left stop, and mirrored: the left stop is the right one then."""
        return self.graze - self.L * (self.C1(X) - self.graze)

    def __call__(self, X):
        """Over a period, of stops that are mirror images."""
        return self.middle(self.middle(X))


class NaiveMap(AnyNaiveMap):
    """P of the paper's oscillator `params` (tau plays no part), with its b = b* - shift."""

    def __init__(self, params, order, shift=None):
        values = {name: mpf(params[name]) for name in naive.NAMES if name != "tau"}
        super().__init__(naive.linear_of({**values, "tau": 0}), order)
        self.b = self.q.contact.high = self.graze[0] - shift if shift is not None else values["b"]
        self.params = {**values, "b": self.b}

    def case(self, X):
        """Which of the two stops are hit: the four cases of (48)."""
        return self.strike(X)[1] > 0, self.strike(self.middle(X))[1] > 0

    def exact(self, X, digits=40):
        """(the next point by the oscillator itself, which stops were hit)."""
        quarter = mp.pi / (2 * self.omega)
        back, on = expm(-self.A * quarter), expm(self.A * quarter)
        start = self.steady(-quarter) + back * (X - self.graze)
        tau = naive.grazing(self.params, mp.dps)[1]
        orbit = naive.simulate({**self.params, "tau": tau - mp.pi / 2}, list(start), periods=1, digits=digits)
        end = mp.matrix(orbit.section[-1])
        sides = [hit.side for hit in orbit.impacts]
        return self.graze + on * (end - self.steady(-quarter)), (1 in sides, -1 in sides)


def linear_family(P, case, psi, direction):
    """X with all of X - X* proportional to psi, the penetration at the stop that is hit; b = b*.

    direction: 4 numbers of size one. Once the right stop is hit the left one is out of reach here (L_12 < 0).
    """
    right, left = case
    D = mp.matrix(direction)
    D[0] = 1 if right else -1
    if not right:  # x2 such that the left stop is passed, or missed, by psi
        D[2] = ((-1 if left else 1) - (P.L[0, 0] * D[0] + P.L[0, 1] * D[1] + P.L[0, 3] * D[3])) / P.L[0, 2]
    return P.graze + psi * D


def root_family(P, case, psi, direction):
    """X with v1, x2 and v2 proportional to sqrt(psi): how orbits come back after an impact; b = b*.

    x1 passes each stop that is hit by psi; at the left one by the map of order 2.
    """
    right, left = case
    second, root = NaiveMap(P.params, 2), mp.sqrt(psi)
    v1 = direction[1] if right else direction[1] / 4  # alone it must not carry the mass to a stop that it should miss
    X = P.graze + mp.matrix([psi if right else -psi, v1 * root, 0, direction[3] * root])
    wanted = psi if left else -root  # short of it by so much that maps of all orders agree
    for _ in range(100):
        miss = second.middle(X)[0] - second.b - wanted
        X[2] += miss / P.L[0, 2]
        if abs(miss) < psi * mp.mpf(10) ** -12:
            return X
    raise ArithmeticError("no such point")
