"""The discontinuity mapping of any symmetric oscillator, as naive_map.py has the paper's: in the working precision.

X holds x1, v1, ..., xN, vN. Nothing is tabulated: each flight is a matrix exponential.
"""

from mpmath import mp, mpf

from reference.gmp import expm


class AnyNaiveMap:
    """P = Phi_{T/2} o C2 o Phi_{T/2} o C1 of a `Linear` whose numbers may be those of mpmath; call it with a column."""

    def __init__(self, q, order, expand_at=None):
        n = len(q.normal)
        column = lambda values: mp.matrix([mpf(x) for x in values])  # noqa: E731
        square = lambda rows: mp.matrix([[mpf(x) for x in row] for row in rows])  # noqa: E731
        M, K, C = (square(matrix) for matrix in (q.M, q.K, q.C))
        self.omega, self.order, self.q = mpf(q.omega), order, q
        self.A = mp.zeros(2 * n)
        inverse = mp.inverse(M)
        for i in range(n):
            self.A[2 * i, 2 * i + 1] = 1
            for j in range(n):
                self.A[2 * i + 1, 2 * j], self.A[2 * i + 1, 2 * j + 1] = -(inverse * K)[i, j], -(inverse * C)[i, j]
        push = inverse * column(q.normal)
        push /= (column(q.normal).T * push)[0]
        self.push, self.normal = mp.zeros(2 * n, 1), mp.zeros(1, 2 * n)
        for i in range(n):
            self.push[2 * i + 1], self.normal[2 * i] = push[i], mpf(q.normal[i])
        x = mp.lu_solve(K - self.omega**2 * M + 1j * self.omega * C, column(q.cosine) - 1j * column(q.sine))
        response = sum(mpf(a) * b for a, b in zip(q.normal, x, strict=True))
        x = x * mp.expj(-mp.arg(response))
        self.graze = mp.zeros(2 * n, 1)
        for i in range(n):
            self.graze[2 * i], self.graze[2 * i + 1] = mp.re(x[i]), -self.omega * mp.im(x[i])
        if expand_at is not None:
            more = mpf(expand_at) - (self.normal * self.graze)[0]
            for i in range(n):
                self.graze[2 * i] += more * push[i]
        self.half = expm(self.A * mp.pi / self.omega)

    def impact(self, X, R, b):
        """C1; eqs. (38), (39), and the next order."""
        D, speed = X - self.graze, (self.normal * self.A * X)[0]
        psi, a = (self.normal * X)[0] - b, -(self.omega**2) * (self.normal * self.graze)[0]
        if self.order == 2:
            a += (self.normal * self.A * self.A * D)[0]
        square = -2 * a * psi + (speed**2 if self.order == 2 else 0)
        if square <= 0 or a >= 0:
            return X
        w = mp.sqrt(square)
        late = (w - speed) / a if self.order == 2 else 0
        return X - (1 + R) * w * (expm(-self.A * late) * self.push)

    def __call__(self, X):
        """Over half a period and, mirrored, over the other half; for stops that are mirror images."""
        R, b = mpf(self.q.R_high), mpf(self.q.high)
        for _ in range(2):
            X = -(self.half * (self.impact(X, R, b) - self.graze) - self.graze)
        return X
