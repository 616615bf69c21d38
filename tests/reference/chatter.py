"""Orbits at the onset of sticking in many digits: backwards from the end of the chatter, impact by impact.

At the end T the gap is at its stop, its velocity and acceleration are 0, its jerk is j. Very near to it, an impact at
T - s leaves with the velocity j s^2 f (3 - f)/6, (1 - f)^2 (3 - f) = R (3 - 2f): the acceleration is j (t - T). From
there all impacts follow backwards, each from a Taylor series of the flight; errors of the start die out. No power
series in s, no contact coordinates, no impulses.
"""

import gmpy2
from mpmath import exp, findroot, log, mp, mpf, pi, zeros

from reference.flow import matrix_of
from reference.gmp import context, dot, from_gmp, to_gmp

NEAREST = mpf(10) ** -9  # s of the last impact: the parameter's error is its square
EXTRA = 80  # bits: the gap moves by s^3 only


class Chatter:
    """A machine whose motion is repeated after half periods, mirrored if sigma is -1.

    machine_at: the machine, of one harmonic and one contact, at a value of the parameter.
    sides: of the impacts written out, in order, the last ones of the chatter; unknowns: state (x, x') at T, T, log s.
    """

    def __init__(self, machine_at, sigma: int, half_periods: int, sides):
        self.machine_at, self.sigma, self.half_periods, self.sides = machine_at, sigma, half_periods, tuple(sides)

    def system(self, value):
        """A of z' = A z for z = (x, x', sin, cos, 1), and the numbers beside it, at a value of the parameter."""
        machine = self.machine_at(value)
        (contact,) = machine.contacts
        self.N, size = machine.masses, 2 * machine.masses + 3
        order = [*range(0, 2 * self.N, 2), *range(1, 2 * self.N, 2), *range(2 * self.N, size)]
        A = matrix_of(machine._replace(contacts=()))
        self.normal = [mpf(a) for a in contact.normal]
        push = mp.inverse(mp.matrix(machine.M)) * mp.matrix(self.normal)
        n = {"omega": mpf(machine.omega), "tau": mpf(machine.tau)}
        n["push"] = [each / mp.fdot(self.normal, push) for each in push]
        n["stops"] = {stop.side: mpf(stop.place) for stop in contact.stops}
        n["R"] = {stop.side: mpf(stop.R) for stop in contact.stops}
        return mp.matrix([[A[i, j] for j in order] for i in order]), n

    def speed(self, z):
        return self.gap(z[self.N :])

    def taylor(self, A, n, t, z):
        """Taylor coefficients of the flight through z at t, as long as they count over 3/omega; A, z in gmpy2."""
        phase = n["omega"] * from_gmp(t) + n["tau"]
        term = [*z, to_gmp(mp.sin(phase)), to_gmp(mp.cos(phase)), gmpy2.mpfr(1)]
        result, reach = [term], to_gmp(3 / n["omega"])
        least, power = gmpy2.mpfr(10) ** (-mp.dps - 25), gmpy2.mpfr(1)
        while len(result) < 4 or max(map(abs, term)) * power > least:
            term = [dot(row, term) / len(result) for row in A]
            result.append(term)
            power *= reach
        return result

    def at(self, series, u):
        """The state after a time u."""
        total = series[-1][: 2 * self.N]
        for term in series[-2::-1]:
            total = [a * u + b for a, b in zip(total, term[: 2 * self.N], strict=True)]
        return total

    def gap(self, z):
        return sum(a * x for a, x in zip(map(float, self.normal), z[: self.N], strict=True))

    def back(self, A, n, t, z, side, aim):
        """(time, state after) of the impact on `side` before the flight that ends in z at t; aim: its time, roughly."""
        series = self.taylor(A, n, t, z)
        gaps = [self.gap(term) for term in series]
        gaps[0] -= to_gmp(n["stops"][side])
        u = aim - t
        for _ in range(60):
            value = slope = gmpy2.mpfr(0)
            for c in reversed(gaps):
                value, slope = value * u + c, slope * u + value
            step = value / slope
            u -= step
            if abs(step) < abs(u) * gmpy2.mpfr(10) ** (-mp.dps):
                break
        return t + u, self.at(series, u)

    def before(self, n, z, side):
        """The state before an impact, from that after it."""
        R = to_gmp(n["R"][side])
        jump = (1 + R) * -self.speed(z) / R
        return [*z[: self.N], *(v + jump * to_gmp(p) for v, p in zip(z[self.N :], n["push"], strict=True))]

    def tail(self, A, n, z, T, s, count):
        """(time, state before) of the impact `count` impacts before the one at T - s."""
        side, R = self.sides[-1], n["R"][self.sides[-1]]
        series, f = self.taylor(A, n, T, z), to_gmp(part_lost(R))
        # the impact at T - s: all but the gap and its velocity are as on the motion through T
        state = self.at(series, -s)
        jerk = 6 * self.gap(series[3])
        aims = to_gmp(n["stops"][side]) - self.gap(state), jerk * s**2 * f * (3 - f) / 6 - self.speed(state)
        for i, p in enumerate(map(to_gmp, n["push"])):
            state[i] += aims[0] * p
            state[self.N + i] += aims[1] * p
        t = T - s
        for _ in range(count):
            t, state = self.back(A, n, t, self.before(n, state, side), side, T - (T - t) / (1 - f))
        return t, self.before(n, state, side)

    def residual(self, A, n, x, times, count):
        """(2N + 3,); times: of the impacts written out, roughly; count: of impacts after the last of them."""
        z, T, s = x[: 2 * self.N], x[2 * self.N], exp(x[2 * self.N + 1])
        ended, end = self.ended(A, n, z, T)
        with context(EXTRA):
            *z, T, s, end = map(to_gmp, [*z, T, s, end])
            ended, A = list(map(to_gmp, ended)), [list(map(to_gmp, row)) for row in A.tolist()]
            t, state = self.tail(A, n, ended, end, s, count)
            for side, aim in zip(self.sides[-2::-1], times[-2::-1], strict=True):
                t, state = self.back(A, n, t, state, side, to_gmp(aim))
                state = self.before(n, state, side)
            period = to_gmp(pi / n["omega"] * self.half_periods)
            state = self.at(self.taylor(A, n, t, state), end - period - t)
            second = self.taylor(A, n, T, z)[2]
            rows = [self.gap(z) - to_gmp(n["stops"][self.sides[-1]]), self.speed(z), 2 * self.gap(second)]
            return [from_gmp(v) for v in rows + [a - self.sigma * b for a, b in zip(state, ended, strict=True)]]

    def first_s(self, A, n, z, T, last):
        """(count, log s) with which the last impact written out is at the time `last`."""
        shrunk = log(1 - part_lost(n["R"][self.sides[-1]]))
        count = int(log(NEAREST / (T - last)) / shrunk)
        s = log(T - last) + count * shrunk
        for _ in range(4):
            with context(EXTRA):
                rows = [list(map(to_gmp, row)) for row in A.tolist()]
                t = from_gmp(self.tail(rows, n, [*map(to_gmp, z)], to_gmp(T), to_gmp(exp(s)), count)[0])
            s += log(T - last) - log(T - t)
        return count, s

    def ended(self, A, n, z, T):
        """z and T with gap, velocity and acceleration as at the end: the impacts near to it are sensitive to these."""
        z, side = list(z), self.sides[-1]
        for _ in range(4):
            with context(EXTRA):
                rows = [list(map(to_gmp, row)) for row in A.tolist()]
                series = self.taylor(rows, n, to_gmp(T), [*map(to_gmp, z)])
                later = -self.gap(series[2]) / self.gap(series[3]) / 3
                z = [from_gmp(value) for value in self.at(series, later)]
                T += from_gmp(later)
            gap, speed = (mp.fdot(self.normal, half) for half in (z[: self.N], z[self.N :]))
            for i, p in enumerate(n["push"]):
                z[i] += (n["stops"][side] - gap) * p
                z[self.N + i] -= speed * p
        return z, T

    def where_sticking(self, state, T, times, value):
        """The parameter at which the chatter ends so; state (2N,): x, then x', at T; times: before T."""
        z, T, *times = [[mpf(float(v)) for v in state], mpf(float(T)), *(mpf(float(t)) for t in times)]
        A, n = self.system(mpf(value))
        z, T = self.ended(A, n, z, T)  # `first_s` takes them as they are
        count, s = self.first_s(A, n, z, T, times[-1])
        x = [*z, T, s, mpf(value)]

        def F(x):
            A, n = self.system(x[-1])
            return mp.matrix(self.residual(A, n, x[:-1], times, count))

        h, f, J = mpf(10) ** (-mp.dps // 2), F(x), zeros(len(x))
        for j in range(len(x)):
            J[:, j] = (F([v + h if i == j else v for i, v in enumerate(x)]) - f) / h
        for _ in range(6):
            step = mp.lu_solve(J, f)
            x = [a - b for a, b in zip(x, step, strict=True)]
            if max(map(abs, step)) < mpf(10) ** -18:
                return x[-1]
            f = F(x)
        raise AssertionError("no convergence")


def part_lost(R):
    """f: by which part flights become shorter."""
    return findroot(lambda f: (1 - f) ** 2 * (3 - f) - R * (3 - 2 * f), (1 - R) / 2)
