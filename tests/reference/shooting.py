"""Periodic orbits and their bifurcations in many digits, by another formulation than the package's: shooting.

z = (x, x', sin(omega t + tau), cos(omega t + tau), 1) of the masses flies by exp(A t). Unknowns are the times of the
impacts and the state before the first one; multipliers come from the monodromy matrix. No Green function, no modes, no
contact coordinates, no impulses.
"""

from mpmath import cos, det, eye, mp, mpf, pi, sin, zeros

from reference.gmp import expm


class AnyShooting:
    """Orbits of an `Oscillator` (tau a number) with z(t + half_periods T/2) = sigma z(t) and impacts on `sides`."""

    def __init__(self, oscillator, sigma: int, half_periods: int, sides):
        self.q, self.sigma, self.half_periods, self.sides = oscillator.linear, sigma, half_periods, tuple(sides)
        self.numbers = {name: mpf(getattr(oscillator, name)) for name in ("omega", "b", "offset", "R")}
        self.numbers["R_left"] = self.numbers["R"] if oscillator.R_left is None else mpf(oscillator.R_left)
        self.numbers["tau"] = mpf(self.q.tau)
        self.follows = oscillator.R_left is None
        self.normal = [mpf(a) for a in self.q.normal.tolist()]
        self.N = len(self.normal)

    def system(self, name=None, value=None):
        """A of z' = A z, and the numbers, with one of them replaced."""
        n, N, q = dict(self.numbers), self.N, self.q
        if name:
            n[name] = value
        if self.follows:
            n["R_left"] = n["R"]
        inverse = mp.inverse(mp.matrix(q.M.tolist()))
        A = zeros(2 * N + 3)
        blocks = [(0, q.K, -1), (N, q.C, -1)]
        for column, matrix, sign in blocks:
            product = inverse * mp.matrix(matrix.tolist())
            for i in range(N):
                for j in range(N):
                    A[N + i, column + j] = sign * product[i, j]
        for column, force in ((2 * N, q.sine), (2 * N + 1, q.cosine), (2 * N + 2, q.constant)):
            product = inverse * mp.matrix(force.tolist())
            for i in range(N):
                A[N + i, column] = product[i]
        for i in range(N):
            A[i, N + i] = 1
        A[2 * N, 2 * N + 1], A[2 * N + 1, 2 * N] = n["omega"], -n["omega"]
        push = inverse * mp.matrix(q.normal.tolist())
        n["push"] = [value / sum(a * p for a, p in zip(self.normal, push, strict=True)) for value in push]
        return A, n

    def stop(self, n, side):
        return n["offset"] + side * n["b"]

    def full(self, n, t, z):
        phase = n["omega"] * t + n["tau"]
        return mp.matrix([*z, sin(phase), cos(phase), 1])

    def fly(self, A, n, t, z, length):
        return list((expm(A * length) * self.full(n, t, z))[: 2 * self.N])

    def rate(self, A, n, t, z):
        return list((A * self.full(n, t, z))[: 2 * self.N])

    def gap(self, z):
        return sum(a * x for a, x in zip(self.normal, z[: self.N], strict=True))

    def speed(self, z):
        return self.gap(z[self.N :])

    def struck(self, n, z, side):
        """After the impact: x' - (1 + R) (n.x') M^-1 n/(n M^-1 n)."""
        jump = -(1 + n["R" if side > 0 else "R_left"]) * self.speed(z)
        return [*z[: self.N], *(v + jump * p for v, p in zip(z[self.N :], n["push"], strict=True))]

    def passed(self, A, n, u):
        """(time, state before) of each impact, and the state at the end of the period."""
        K, t = len(self.sides), u[: len(self.sides)]
        z, before = list(u[K:]), []
        for k, side in enumerate(self.sides):
            before.append((t[k], z))
            following = t[k + 1] if k + 1 < K else t[0] + pi / n["omega"] * self.half_periods
            z = self.fly(A, n, t[k], self.struck(n, z, side), following - t[k])
        return before, z

    def residual(self, A, n, u):
        before, end = self.passed(A, n, u)
        gaps = [self.gap(z) - self.stop(n, side) for (_, z), side in zip(before, self.sides, strict=True)]
        return gaps + [a - self.sigma * b for a, b in zip(end, before[0][1], strict=True)]

    def monodromy(self, A, n, u):
        """(2N, 2N): sigma times the derivative of the map over P."""
        N, K = self.N, len(self.sides)
        before, _ = self.passed(A, n, u)
        product = eye(2 * N)
        for k, side in enumerate(self.sides):
            t, z = before[k]
            S = eye(2 * N)
            one_plus_R = 1 + n["R" if side > 0 else "R_left"]
            for i in range(N):
                for j in range(N):
                    S[N + i, N + j] -= one_plus_R * n["push"][i] * self.normal[j]
            ahead, behind = self.rate(A, n, t, z), self.rate(A, n, t, self.struck(n, z, side))
            kept = S * mp.matrix(ahead)
            for i in range(2 * N):
                for j in range(N):
                    S[i, j] += (behind[i] - kept[i]) * self.normal[j] / self.speed(z)
            following = u[k + 1] if k + 1 < K else u[0] + pi / n["omega"] * self.half_periods
            product = expm(A * (following - t))[: 2 * N, : 2 * N] * S * product
        return self.sigma * product

    def unknowns(self, times, state):
        """From double precision; state (2N,): x, then x'."""
        return [mpf(float(value)) for value in [*times, *state]]

    def solve(self, u, name=None, value=None, test=None, extra=()):
        """Newton's method with differences; with `test`(A, n, u, extra) -> list also for the parameter and `extra`."""
        size = len(u)
        x = [*u, *([mpf(value)] if name else []), *map(mpf, extra)]

        def F(x):
            A, n = self.system(name, x[size]) if name else self.system()
            return self.residual(A, n, x[:size]) + (test(A, n, x[:size], x[size + 1 :]) if test else [])

        h = mpf(10) ** (-mp.dps // 2)
        for _ in range(4):
            f, J = F(x), zeros(len(x))
            for j in range(len(x)):
                moved = F([value + h if i == j else value for i, value in enumerate(x)])
                for i, (a, b) in enumerate(zip(moved, f, strict=True)):
                    J[i, j] = (a - b) / h
            step = mp.lu_solve(J, mp.matrix(f))
            x = [a - b for a, b in zip(x, step, strict=True)]
            if max(abs(s) for s in step) < mpf(10) ** (-mp.dps + 8):
                break
        return x

    def multipliers(self, u):
        A, n = self.system()
        return mp.eig(self.monodromy(A, n, self.solve(u)), left=False, right=False)

    def where_multiplier(self, mu, u, name, value):
        """The parameter at which the orbit has the multiplier +1 or -1 (of the half map, if sigma = -1)."""
        test = lambda A, n, u, _: [det(self.monodromy(A, n, u) - mu * eye(2 * self.N))]  # noqa: E731
        return self.solve(u, name, value, test)[len(u)]

    def where_torus(self, u, name, value):
        """The parameter at which a complex pair of multipliers has modulus 1."""

        def test(A, n, u, _):
            mu = mp.eig(self.monodromy(A, n, u), left=False, right=False)
            return [abs(min((m for m in mu if m.imag > 0), key=lambda m: abs(abs(m) - 1))) ** 2 - 1]

        return self.solve(u, name, value, test)[len(u)]

    def where_touching(self, time, side, u, name, value):
        """The parameter at which the orbit touches a stop near `time`, later than the first impact."""
        test = lambda A, n, u, extra: self.turning(A, n, u, extra[0], side)  # noqa: E731
        return self.solve(u, name, value, test, [time])[len(u)]

    def turning(self, A, n, u, time, side):
        """Gap from the stop and its velocity at `time`, later than the first impact."""
        before, _ = self.passed(A, n, u)
        k = max(k for k, (t, _) in enumerate(before) if t <= time)
        t, z = before[k]
        z = self.fly(A, n, t, self.struck(n, z, self.sides[k]), time - t)
        return [self.gap(z) - self.stop(n, side), self.speed(z)]

    def where_vanishing(self, index, u, name, value):
        """The parameter at which impact `index` has no speed."""
        test = lambda A, n, u, _: [self.speed(self.passed(A, n, u)[0][index][1])]  # noqa: E731
        return self.solve(u, name, value, test)[len(u)]


class Shooting(AnyShooting):
    """Orbits of the paper's oscillator, with any of its numbers; tau: a number or "grazing"."""

    def __init__(self, numbers: dict, sigma: int, half_periods: int, sides):
        self.numbers, self.sigma, self.half_periods, self.sides = numbers, sigma, half_periods, tuple(sides)
        self.normal, self.N = [mpf(1), mpf(0)], 2

    def system(self, name=None, value=None):
        """A of z' = A z, and the numbers, with one of them replaced."""
        n = {key: number if number == "grazing" else mpf(number) for key, number in self.numbers.items()}
        n |= {} if name is None else {name: value}
        n |= {"R_left": n["R"], "offset": mpf(0), "push": [mpf(1), mpf(0)]}
        K = [[1, -1], [-1, 1 + n["mu_k"]]]
        M, force = [mpf(1), n["mu_m"]], [1 - n["f2"], n["f2"]]
        A = zeros(7)
        for i in range(2):
            A[i, 2 + i] = 1
            for j in range(2):
                A[2 + i, j] = -K[i][j] / M[i]
                A[2 + i, 2 + j] = -2 * n["zeta"] * K[i][j] / M[i]
            A[2 + i, 4] = force[i] / M[i]
        A[4, 5], A[5, 4] = n["omega"], -n["omega"]
        if n["tau"] == "grazing":
            w, z = n["omega"], 2 * n["zeta"]
            stiffness = mp.matrix(
                [[K[i][j] * (1 + 1j * w * z) - (w**2 * M[i] if i == j else 0) for j in range(2)] for i in range(2)]
            )
            n["tau"] = pi / 2 - mp.arg(mp.lu_solve(stiffness, mp.matrix(force))[0])
        return A, n

    def unknowns(self, times, state):
        """From double precision; state: x1, v1, x2, v2."""
        x1, v1, x2, v2 = state
        return super().unknowns(times, (x1, x2, v1, v2))
