"""Periodic orbits and their bifurcations in many digits, by another formulation than the package's.

Unknowns are the state before the first impact and the times of the impacts; flights are exponentials of the matrix of
(x1, x2, v1, v2, sin, cos); multipliers come from the monodromy matrix. No Green function, no modes, no impulses.
"""

from mpmath import cos, det, eye, mp, mpf, pi, sin, zeros

from reference.gmp import expm


class Shooting:
    """Orbits of the paper's oscillator with z(t + half_periods T/2) = sigma z(t) and impacts on `sides`."""

    def __init__(self, numbers: dict, sigma: int, half_periods: int, sides):
        self.numbers, self.sigma, self.half_periods, self.sides = numbers, sigma, half_periods, tuple(sides)

    def system(self, name=None, value=None):
        """Matrix A of z' = A z with z = (x1, x2, v1, v2, sin, cos), and the numbers, with one of them replaced."""
        n = {
            key: mpf(number) if key != "tau" or number != "grazing" else number for key, number in self.numbers.items()
        }
        if name:
            n[name] = value
        K = [[1, -1], [-1, 1 + n["mu_k"]]]
        M, force = [mpf(1), n["mu_m"]], [1 - n["f2"], n["f2"]]
        A = zeros(6)
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
            response = mp.lu_solve(stiffness, mp.matrix(force))[0]
            n["tau"] = pi / 2 - mp.arg(response)
        return A, n

    def fly(self, A, n, t, z, length):
        """State (4,) after `length` from z at the time t."""
        phase = n["omega"] * t + n["tau"]
        full = expm(A * length) * mp.matrix([*z, sin(phase), cos(phase)])
        return list(full[:4])

    def rate(self, A, n, t, z):
        phase = n["omega"] * t + n["tau"]
        return list((A * mp.matrix([*z, sin(phase), cos(phase)]))[:4])

    def unknowns(self, orbit_times, state):
        """From double precision: (t_1 .. t_K, state before the first impact as x1, v1, x2, v2)."""
        x1, v1, x2, v2 = map(mpf, map(float, state))
        return [*(mpf(float(t)) for t in orbit_times), x1, x2, v1, v2]

    def residual(self, A, n, u):
        K = len(self.sides)
        t, z = u[:K], list(u[K : K + 4])
        start = list(z)
        P = pi / n["omega"] * self.half_periods
        result = []
        for k, side in enumerate(self.sides):
            result.append(z[0] - side * n["b"])
            z[2] = -n["R"] * z[2]
            following = t[k + 1] if k + 1 < K else t[0] + P
            z = self.fly(A, n, t[k], z, following - t[k])
        return result + [a - self.sigma * b for a, b in zip(z, start, strict=True)]

    def monodromy(self, A, n, u):
        """4 x 4, sigma times the derivative of the map over P."""
        K = len(self.sides)
        t, z = u[:K], list(u[K : K + 4])
        P = pi / n["omega"] * self.half_periods
        product = eye(4)
        for k in range(K):
            before = self.rate(A, n, t[k], z)
            after_state = [z[0], z[1], -n["R"] * z[2], z[3]]
            after = self.rate(A, n, t[k], after_state)
            S = mp.diag([1, 1, -n["R"], 1])
            jump = [after[i] - S[i, i] * before[i] for i in range(4)]
            for i in range(4):
                S[i, 0] += jump[i] / z[2]
            following = t[k + 1] if k + 1 < K else t[0] + P
            E = expm(A * (following - t[k]))[:4, :4]
            product = E * S * product
            z = self.fly(A, n, t[k], after_state, following - t[k])
        return self.sigma * product

    def turning(self, A, n, u, time, side):
        """Gap from the stop and velocity at `time`, later than the first impact."""
        K = len(self.sides)
        t, z = u[:K], list(u[K : K + 4])
        for k in range(K):
            z[2] = -n["R"] * z[2]
            if k + 1 == K or time < t[k + 1]:
                z = self.fly(A, n, t[k], z, time - t[k])
                return [z[0] - side * n["b"], z[2]]
            z = self.fly(A, n, t[k], z, t[k + 1] - t[k])
        raise AssertionError

    def solve(self, u, name=None, value=None, test=None, extra=()):
        """Newton's method with differences; with `test`(A, n, u, extra) -> list also for the parameter and `extra`."""
        K = len(self.sides) + 4
        x = [*u, *([mpf(value)] if name else []), *map(mpf, extra)]

        def F(x):
            A, n = self.system(name, x[K]) if name else self.system()
            result = self.residual(A, n, x[:K])
            return result + (test(A, n, x[:K], x[K + 1 :]) if test else [])

        h = mpf(10) ** (-mp.dps // 2)
        for _ in range(4):
            f = F(x)
            J = zeros(len(x))
            for j in range(len(x)):
                moved = list(x)
                moved[j] += h
                for i, (a, b) in enumerate(zip(F(moved), f, strict=True)):
                    J[i, j] = (a - b) / h
            step = mp.lu_solve(J, mp.matrix(f))
            x = [a - b for a, b in zip(x, step, strict=True)]
            if max(abs(s) for s in step) < mpf(10) ** (-mp.dps + 8):
                break
        return x

    def where_multiplier(self, mu, u, name, value):
        """The parameter at which the orbit has the multiplier +1 or -1 (of the half map, if sigma = -1)."""
        x = self.solve(u, name, value, lambda A, n, u, _: [det(self.monodromy(A, n, u) - mu * eye(4))])
        return x[len(self.sides) + 4]

    def where_torus(self, u, name, value):
        """The parameter at which a complex pair of multipliers has modulus 1."""

        def test(A, n, u, _):
            mu = mp.eig(self.monodromy(A, n, u), left=False, right=False)
            pair = min((m for m in mu if m.imag > 0), key=lambda m: abs(abs(m) - 1))
            return [abs(pair) ** 2 - 1]

        return self.solve(u, name, value, test)[len(self.sides) + 4]

    def where_touching(self, time, side, u, name, value):
        """The parameter at which the orbit touches a stop near `time`."""
        test = lambda A, n, u, extra: self.turning(A, n, u, extra[0], side)  # noqa: E731
        return self.solve(u, name, value, test, [time])[len(self.sides) + 4]

    def where_vanishing(self, index, u, name, value):
        """The parameter at which impact `index` has no speed."""

        def test(A, n, u, _):
            K = len(self.sides)
            t, z = u[:K], list(u[K : K + 4])
            for k in range(index):
                z[2] = -n["R"] * z[2]
                z = self.fly(A, n, t[k], z, t[k + 1] - t[k])
            return [z[2]]

        return self.solve(u, name, value, test)[len(self.sides) + 4]
