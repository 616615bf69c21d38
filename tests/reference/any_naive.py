"""A slow and obvious simulator of any linear oscillator with one contact, which the fast one is held against.

It shares no formula with the package, and works in the coordinates of the masses: free flight is y' = A y for y = (x1,
v1, ..., xN, vN, sin(omega t + tau), cos(omega t + tau), 1), which mpmath carries forward by exp(A h); an impulse acts
along M^-1 n, and while a stop holds the gap n.x its force keeps n.x'' = 0. A contact is a root of the Taylor polynomial
of the distance from the stop, isolated by halving the step until a bound on the polynomial decides. Inside, numbers are
those of gmpy2.
"""

from typing import NamedTuple

import gmpy2
from mpmath import mp, mpf

from reference.gmp import context, dot, expm, from_gmp, to_gmp
from reference.roots import ZERO, evaluate, falling_root


class Impact(NamedTuple):
    t: mpf
    side: int
    v: mpf  # of the gap, before the impact
    y: list  # the state of the masses before it


class LinearFlow:
    """y' = A y over steps of h, with |A| h = 1/2."""

    def __init__(self, A):
        self.A = A
        self.rows = [[(a, j) for j, a in enumerate(row) if a] for row in A]  # most entries are zero
        norm = max(sum(abs(a) for a in row) for row in A)
        self.h = 1 / (2 * norm)
        self.growth = gmpy2.exp(norm * self.h)  # |y(u)| <= growth |y(0)| within a step
        exact = expm(mp.matrix([[from_gmp(a * self.h) for a in row] for row in A]))
        self.E = [[to_gmp(a) for a in row] for row in exact.tolist()]
        self.order = 1
        while mp.ldexp(1, -self.order) / mp.factorial(self.order) > mp.eps / 16:
            self.order += 1

    def step(self, y):
        return [dot(row, y) for row in self.E]

    def taylor(self, y):
        """Coefficients y_n of y(u) = sum of y_n u^n, each a state."""
        terms = [list(y)]
        for n in range(1, self.order + 1):
            last = terms[-1]
            terms.append([sum((a * last[j] for a, j in row), ZERO) / n for row in self.rows])
        return terms


class Oscillator:
    """The two flows, the stops, and what happens on them. q: a `Linear` of floats, which count as exact, or of mpf."""

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
        # how far the gap can leave its chord within a step, h^2/8 max |n.x''|, for |y| = 1 at the step's start
        self.bulge = sum(map(abs, self.acceleration)) * self.free.growth * self.free.h**2 / 8

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
        """Restitution at the stop that the mass touches -> (state, leading, delay).

        leading: the order of the first coefficient of the gap afterwards that is not zero.
        delay: None if the mass leaves; else the time after which it rests, that of the chatter still to come.
        """
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
        """One step, or less up to a contact -> (duration, state, side struck or 0, Taylor terms or None)."""
        flow, contacts = self.free, []
        ahead, bulge = flow.step(y), self.bulge * max(map(abs, y))
        here, there = self.position(y), self.position(ahead)
        near = [s for s in self.sides if s == touching or max(s * here, s * there) + bulge >= s * self.wall(s)]
        if not near:
            return flow.h, ahead, 0, None
        terms = flow.taylor(y)
        for side in near:
            # the zero at u = 0, from which the mass just left, is divided out: it cannot be found again
            root = falling_root(self.gap(terms, side)[leading if side == touching else 0 :], ZERO, flow.h)
            if root is not None:
                contacts.append((root, side))
        if not contacts:
            return flow.h, ahead, 0, terms
        u, side = min(contacts)
        return u, evaluate(terms, u), side, terms

    def rest(self, y, side, leading):
        """One step at rest, or less up to the release -> (duration, state, released, Taylor terms)."""
        terms = self.constrained.taylor(y)
        pull = [side * dot(self.acceleration, term) for term in terms]
        u = falling_root(pull[leading:], ZERO, self.constrained.h)
        if u is None:
            return self.constrained.h, self.constrained.step(y), False, terms
        return u, evaluate(terms, u), True, terms


def simulate(q, state, periods=None, impacts=None, start_time=0, digits=30):
    """Impacts, rests (t_on, t_off, side) and section states, over `periods` or until so many impacts.

    Chatter is followed impact by impact until what remains of it lasts less than 10^(-digits / 2) and is summed up as a
    geometric series.
    """
    if periods is None and impacts is None:
        raise ValueError("say when to stop: periods or impacts")
    with mp.workdps(digits + 10), context():
        o = Oscillator(q, digits)
        t, period = to_gmp(mpf(start_time)), 2 * gmpy2.const_pi() / o.omega
        end = gmpy2.inf() if periods is None else t + to_gmp(mpf(periods)) * period
        phase = o.omega * t + to_gmp(mpf(q.tau))
        y = [to_gmp(mpf(x)) for x in state] + [gmpy2.sin(phase), gmpy2.cos(phase), ZERO + 1]
        if any(side * o.position(y) > side * o.wall(side) for side in o.sides):
            raise ValueError("the start lies behind a stop")
        struck = next((side for side in o.sides if o.position(y) == o.wall(side)), 0)
        hits, section, sticking, following = [], [], [], int(gmpy2.ceil(t / period))
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
                terms = terms or o.free.taylor(y)
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
