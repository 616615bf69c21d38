"""A slow and obvious simulator of any linear oscillator with one contact, as naive.py is of the paper's.

It works in the coordinates of the masses: free flight is y' = A y for y = (x1, v1, ..., xN, vN, sin(omega t + tau),
cos(omega t + tau), 1), an impulse acts along M^-1 n, and while a stop holds the gap n.x its force keeps n.x'' = 0.
"""

from typing import NamedTuple

import gmpy2
from mpmath import mp, mpf

from reference.gmp import context, dot, from_gmp, to_gmp
from reference.naive import LinearFlow
from reference.roots import ZERO, evaluate, falling_root


class Impact(NamedTuple):
    t: mpf
    side: int
    v: mpf  # of the gap, before the impact
    y: list  # the state of the masses before it


class Oscillator:
    """The two flows, the stops, and what happens on them. q: a `Linear` of floats, which count as exact."""

    def __init__(self, q, digits):
        n, number = len(q.normal), lambda a: to_gmp(mpf(a))
        self.N, self.omega = n, number(q.omega)
        self.low, self.high = (None if abs(x) == float("inf") else number(x) for x in (q.low, q.high))
        self.R = {-1: number(q.R_low), 1: number(q.R_high)}
        self.sides = [side for side, wall in ((1, self.high), (-1, self.low)) if wall is not None]
        self.brief = to_gmp(mpf(10) ** (-digits / mpf(2)))
        self.rounding = to_gmp(mpf(10) ** -digits)
        M = mp.matrix([[mpf(a) for a in row] for row in q.M])
        inverse = mp.inverse(M)
        solve = lambda a: inverse * mp.matrix([[mpf(x) for x in row] for row in a])  # noqa: E731
        K, C = solve(q.K), solve(q.C)
        f = solve([[s, c, one] for s, c, one in zip(q.sine, q.cosine, q.constant, strict=True)])
        along = mp.matrix([mpf(a) for a in q.normal])
        push = inverse * along
        push = push / (along.T * push)[0]
        self.normal, self.push = [to_gmp(a) for a in along], [to_gmp(a) for a in push]
        size = 2 * n + 3
        free = [[ZERO] * size for _ in range(size)]
        for i in range(n):
            free[2 * i][2 * i + 1] = ZERO + 1
            for j in range(n):
                free[2 * i + 1][2 * j], free[2 * i + 1][2 * j + 1] = -to_gmp(K[i, j]), -to_gmp(C[i, j])
            for j in range(3):
                free[2 * i + 1][2 * n + j] = to_gmp(f[i, j])
        free[2 * n][2 * n + 1], free[2 * n + 1][2 * n] = self.omega, -self.omega
        self.acceleration = [dot(self.normal, [free[2 * i + 1][j] for i in range(n)]) for j in range(size)]
        constrained = [list(row) for row in free]
        for i in range(n):
            constrained[2 * i + 1] = [
                a - self.push[i] * g for a, g in zip(free[2 * i + 1], self.acceleration, strict=True)
            ]
        self.free, self.constrained = LinearFlow(free), LinearFlow(constrained)

    def position(self, y):
        return dot(self.normal, y[0 : 2 * self.N : 2])

    def speed(self, y):
        return dot(self.normal, y[1 : 2 * self.N : 2])

    def wall(self, side):
        return self.high if side > 0 else self.low

    def gap(self, terms, side):
        """Taylor coefficients of the distance from a stop."""
        c = [-side * self.position(term) for term in terms]
        c[0] += side * self.wall(side)
        return c

    def kick(self, y, change):
        """Change the velocity of the gap, by an impulse along n."""
        y = list(y)
        for i in range(self.N):
            y[2 * i + 1] += self.push[i] * change
        return y

    def strike(self, y, side):
        """As in naive.py: (state, order of the gap's zero, None or the time after which the mass rests)."""
        v = self.speed(y)
        if side * v > 0:
            y = self.kick(y, -(1 + self.R[side]) * v)
        if abs(self.speed(y)) <= self.rounding * max(map(abs, y)):
            y = self.kick(y, -self.speed(y))
        gap = self.gap(self.free.taylor(y), side)
        gap[0] = ZERO
        if abs(gap[1]) <= self.rounding * max(map(abs, y)):
            gap[1] = ZERO
        leading = next(n for n, c in enumerate(gap) if c)
        speed, pull = gap[1], -2 * gap[2]
        if gap[leading] < 0:
            return y, leading, ZERO
        if pull > 0 and 2 * speed < self.brief * pull * (1 - self.R[side]):
            return self.kick(y, -self.speed(y)), 2, 2 * speed / (pull * (1 - self.R[side]))
        return y, leading, None

    def fly(self, y, touching, leading):
        flow, terms, contacts = self.free, self.free.taylor(y), []
        for side in self.sides:
            root = falling_root(self.gap(terms, side)[leading if side == touching else 0 :], ZERO, flow.h)
            if root is not None:
                contacts.append((root, side))
        if not contacts:
            return flow.h, flow.step(y), 0, terms
        u, side = min(contacts)
        return u, evaluate(terms, u), side, terms

    def rest(self, y, side, leading):
        terms = self.constrained.taylor(y)
        pull = [side * dot(self.acceleration, term) for term in terms]
        u = falling_root(pull[leading:], ZERO, self.constrained.h)
        if u is None:
            return self.constrained.h, self.constrained.step(y), False, terms
        return u, evaluate(terms, u), True, terms


def simulate(q, state, periods=None, impacts=None, digits=30):
    """Impacts, rests (t_on, t_off, side) and section states from t = 0, over `periods` or until so many impacts."""
    with mp.workdps(digits + 10), context():
        o = Oscillator(q, digits)
        t, period, tau = ZERO, 2 * gmpy2.const_pi() / o.omega, to_gmp(mpf(q.tau))
        end = gmpy2.inf() if periods is None else periods * period
        y = [to_gmp(mpf(x)) for x in state] + [gmpy2.sin(tau), gmpy2.cos(tau), ZERO + 1]
        struck = next((side for side in o.sides if o.position(y) == o.wall(side)), 0)
        hits, section, sticking, following = [], [], [], 0
        resting = touching = leading = 0
        while t <= end:
            if struck:
                if struck * o.speed(y) > 0:
                    hits.append(Impact(from_gmp(t), struck, from_gmp(o.speed(y)), [from_gmp(a) for a in y[: 2 * o.N]]))
                if len(hits) == impacts:
                    break
                y, leading, delay = o.strike(y, struck)
                touching = struck
                if delay is not None:
                    resting, t_on, leading = struck, t + delay, leading - 2
            if resting:
                u, ahead, released, terms = o.rest(y, resting, leading)
                struck = 0
            else:
                u, ahead, struck, terms = o.fly(y, touching, leading)
                released = False
            while following * period <= min(t + u, end):
                at = evaluate(terms, following * period - t)
                section.append([from_gmp(a) for a in at[: 2 * o.N]])
                following += 1
            t, y, touching, leading = t + u, ahead, 0, 0
            if released:
                sticking.append((from_gmp(t_on), from_gmp(t), resting))
                resting, touching, leading = 0, resting, 3
        if resting:
            sticking.append((from_gmp(t_on), from_gmp(end), resting))
        return hits, sticking, section
