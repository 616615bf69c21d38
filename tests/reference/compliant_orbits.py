"""Periodic orbits with contacts, and their multipliers, in thirty digits: slow and obvious, no formula of the package.

In the coordinates of the masses y = (x, v, sin, cos, 1), y' = A y with one A for free flight and one for each pressed
stop. The unknowns are the state at t = 0 and the times of all touches and releases; Newton's method keeps the Jacobian
of the guess, from differences. Multipliers are eigenvalues of flights and saltation matrices 1 + (F+ - F-) n/(n F-),
with F the rates of y before and behind an event, and n the row that vanishes at it: of the gap less the stop, or of the
force at the end of a contact that ends by it, after which the stop is taken to relax unseen.
"""

from mpmath import mp, mpf

DIGITS = 45


class ContactOrbit:
    """q: a `Linear` of floats, which count as exact, or of numbers of mpmath; sides: of the contacts, within so many
    periods of the force. sigma: the motion is repeated after them, or (-1) mirrored. pulled: whether contacts with a
    preload end by their force where the oscillator's do, before the mass is back at the stop."""

    def __init__(self, q, sides, periods, sigma=1, pulled=False):
        with mp.workdps(DIGITS):
            self._build(q, sides, periods, sigma, pulled)

    def _build(self, q, sides, periods, sigma, pulled):
        self.q, self.sides, self.N, self.sigma = q, list(sides), len(q.normal), sigma
        self.length = periods * 2 * mp.pi / mpf(q.omega)
        N, self.size = self.N, 2 * self.N + 3
        inverse = mp.inverse(mp.matrix(q.M.tolist()))
        self.free = self._matrix(inverse, q.K, q.C, q.constant)
        self.pressed = {}
        normal = mp.matrix([mpf(a) for a in q.normal])
        push = inverse * normal
        laws = {1: (q.k_high, q.c_high, q.p_high, q.high), -1: (q.k_low, q.c_low, q.p_low, q.low)}
        for side, (k, c, p, stop) in laws.items():
            if k > 0:
                A = self.free.copy()
                for i in range(N):
                    for j in range(N):
                        A[N + i, j] -= push[i] * mpf(k) * normal[j]
                        A[N + i, N + j] -= push[i] * mpf(c) * normal[j]
                    A[N + i, 2 * N + 2] += push[i] * (mpf(k) * mpf(stop) - side * mpf(p))
                touch, force = mp.matrix(1, self.size), mp.matrix(1, self.size)
                for i in range(N):
                    touch[i], force[i], force[N + i] = normal[i], mpf(k) * normal[i], mpf(c) * normal[i]
                touch[2 * N + 2], force[2 * N + 2] = -mpf(stop), side * mpf(p) - mpf(k) * mpf(stop)
                self.pressed[side] = A, touch, force if q.by_force and c > 0 and (p == 0 or pulled) else touch
        self.gap = mp.matrix(1, self.size)
        for i in range(N):
            self.gap[i] = normal[i]

    def _matrix(self, inverse, K, C, constant):
        q, N, A = self.q, self.N, mp.matrix(self.size)
        K, C = inverse * mp.matrix(K.tolist()), inverse * mp.matrix(C.tolist())
        f = [inverse * mp.matrix([mpf(a) for a in force]) for force in (q.sine, q.cosine, constant)]
        for i in range(N):
            A[i, N + i] = 1
            for j in range(N):
                A[N + i, j], A[N + i, N + j] = -K[i, j], -C[i, j]
            for j in range(3):
                A[N + i, 2 * N + j] = f[j][i]
        A[2 * N, 2 * N + 1], A[2 * N + 1, 2 * N] = mpf(q.omega), -mpf(q.omega)
        return A

    def _begin(self, u):
        tau = mpf(self.q.tau)
        return mp.matrix([*u[: 2 * self.N], mp.sin(tau), mp.cos(tau), 1])

    def _pieces(self, u):
        """(A, duration, row that vanishes at the event at the end or None, A behind it)."""
        times, before = u[2 * self.N :], mpf(0)
        for k, side in enumerate(self.sides):
            A, touch, release = self.pressed[side]
            yield self.free, times[2 * k] - before, touch, A
            yield A, times[2 * k + 1] - times[2 * k], release, self.free
            before = times[2 * k + 1]
        yield self.free, self.length - before, None, None

    def residual(self, u):
        y, rows = self._begin(u), []
        for A, length, row, _ in self._pieces(u):
            y = mp.expm(A * length) * y
            if row is not None:
                rows.append((row * y)[0])
        return mp.matrix([*(self.sigma * y[i] - u[i] for i in range(2 * self.N)), *rows])

    def solve(self, state, times, steps=12):
        """(state, times, multipliers) from a guess: x1 v1 .. at t = 0, and touch and release of each contact within the
        period that begins there."""
        with mp.workdps(DIGITS):
            u = mp.matrix([*map(mpf, state[::2]), *map(mpf, state[1::2]), *map(mpf, times)])
            F, h, J = self.residual(u), mpf(10) ** -20, mp.matrix(len(u))
            for j in range(len(u)):
                moved = u.copy()
                moved[j] += h
                column = (self.residual(moved) - F) / h
                for i in range(len(u)):
                    J[i, j] = column[i]
            for _ in range(steps):
                change = mp.lu_solve(J, self.residual(u))
                u -= change
                if mp.norm(change) < mpf(10) ** -30:
                    break
            x, v = list(u[: self.N]), list(u[self.N : 2 * self.N])
            return [a for pair in zip(x, v, strict=True) for a in pair], list(u[2 * self.N :]), self.multipliers(u)

    def multipliers(self, u):
        """By falling size, of the map over these periods."""
        values = mp.eig(self.closure(u), left=False, right=False)
        return sorted(values, key=lambda value: (-abs(value), -value.imag))

    def closure(self, u):
        """The matrix whose eigenvalues are the multipliers."""
        y, product = self._begin(u), mp.eye(self.size)
        for A, length, row, behind in self._pieces(u):
            E = mp.expm(A * length)
            y, product = E * y, E * product
            if row is not None:
                before, after = A * y, behind * y
                product += (after - before) * (row * product) / (row * before)[0]
        n = 2 * self.N
        return self.sigma * product[:n, :n]


class ContactMap:
    """The map over the period of a `ContactOrbit`, of states (x .., v ..) at its t = 0, by where its flights end."""

    def __init__(self, orbit: ContactOrbit, state, times):
        self.orbit, self.centre, self.times = orbit, list(state), list(times)

    def __call__(self, change):
        """The change of the image."""
        o, t = self.orbit, mpf(0)
        y = o._begin([a + b for a, b in zip(self.centre, change, strict=True)])
        for k, guess in enumerate(self.times):
            pressed, touch, release = o.pressed[o.sides[k // 2]]
            A, row, start = (pressed, release, y) if k % 2 else (o.free, touch, y)
            for _ in range(30):
                y = mp.expm(A * (guess - t)) * start
                step = (row * y)[0] / (row * A * y)[0]
                guess -= step
                if abs(step) < mpf(10) ** (-mp.dps + 6):
                    break
            y, t = mp.expm(A * (guess - t)) * start, guess
        y = mp.expm(o.free * (o.length - t)) * y
        return mp.matrix([o.sigma * y[i] - a for i, a in enumerate(self.centre)])
