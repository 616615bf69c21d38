"""The discontinuity mapping in mpmath, order by order, and the exact map that it approximates.

A point X of the map is where the orbit would be at the phase of the right graze if the impact there had not been: the
map's points may lie beyond the stops. So the exact map is: a quarter of a period of free flight back, to between the
stops; one period of the oscillator as `naive.py` simulates it; a quarter of a period of free flight on.
"""

from mpmath import mp, mpf

from reference import naive
from reference.gmp import expm


class NaiveMap:
    """P of the system `params` (tau plays no part), with its b = b* - shift; call it with a 4x1 matrix."""

    def __init__(self, params, order, shift=None):
        values = {name: mpf(params[name]) for name in naive.NAMES if name != "tau"}
        mu_m, mu_k, zeta, omega = (values[name] for name in ("mu_m", "mu_k", "zeta", "omega"))
        x1, x2 = naive.response({**values, "tau": 0})
        M1 = [-1, -2 * zeta, 1, 2 * zeta]
        M2 = [1 / mu_m, 2 * zeta / mu_m, -(1 + mu_k) / mu_m, -2 * zeta * (1 + mu_k) / mu_m]
        self.A = mp.matrix([[0, 1, 0, 0], M1, [0, 0, 0, 1], M2])
        self.order, self.R, self.omega = order, values["R"], omega
        self.T = 2 * mp.pi / omega
        self.L = expm(self.A * self.T / 2)
        self.response, self.tau = (x1, x2), mp.atan2(x1.real, x1.imag)
        self.graze = self.steady(0)
        self.b = self.graze[0] - shift if shift is not None else values["b"]
        self.params = {**values, "b": self.b}

    def steady(self, t):
        """The non-impacting motion."""
        turn = mp.expj(self.omega * t + self.tau)
        x1, x2 = (x * turn for x in self.response)
        return mp.matrix([x1.imag, self.omega * x1.real, x2.imag, self.omega * x2.real])

    def strike(self, X):
        """(psi, speed squared at the right stop, acceleration); there is an impact where the square is positive."""
        psi, a = X[0] - self.b, -(self.omega**2) * self.graze[0]
        if self.order == 1:
            return psi, -2 * a * psi, a
        a += (self.A * (X - self.graze))[1]
        return psi, X[1] ** 2 - 2 * a * psi, a

    def C1(self, X):
        _, square, a = self.strike(X)
        if square <= 0:
            return X
        w, impulse = mp.sqrt(square), mp.matrix([0, 1, 0, 0])
        if self.order == 2:
            impulse = expm(-self.A * (w - X[1]) / a) * impulse
        return X - (1 + self.R) * w * impulse

    def middle(self, X):
        """Half a period on, before the left stop, and mirrored: the left stop is the right one then."""
        return self.graze - self.L * (self.C1(X) - self.graze)

    def __call__(self, X):
        return self.middle(self.middle(X))

    def case(self, X):
        """Which of the two stops are hit: the four cases of (48)."""
        return self.strike(X)[1] > 0, self.strike(self.middle(X))[1] > 0

    def exact(self, X, digits=40):
        """(the next point by the oscillator itself, which stops were hit)."""
        quarter = self.T / 4
        back, on = expm(-self.A * quarter), expm(self.A * quarter)
        start = self.steady(-quarter) + back * (X - self.graze)
        orbit = naive.simulate({**self.params, "tau": self.tau - mp.pi / 2}, list(start), periods=1, digits=digits)
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
