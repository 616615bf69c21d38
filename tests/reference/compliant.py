"""A slow and obvious simulator of any linear oscillator with compliant stops, as any_naive.py is of rigid ones.

It works in the coordinates of the masses, at any number of digits, and shares no formula with the package:
y = (x1, v1, .., xN, vN, sin, cos, 1, s+, s-), with s the places of stops that relax, obeys y' = A y between events,
with one A for each stop that is pressed or relaxes. An event is a proven root of a linear function of y.
"""

from typing import NamedTuple

import gmpy2
from mpmath import mp, mpf

from reference.gmp import context, dot, from_gmp, to_gmp
from reference.naive import LinearFlow
from reference.roots import ZERO, evaluate, falling_root


class Contact(NamedTuple):
    t_touch: mpf
    t_release: mpf
    side: int
    v_touch: mpf
    v_release: mpf
    max_penetration: mpf
    max_force: mpf


class Orbit(NamedTuple):
    contacts: list[Contact]
    impacts: list[tuple]  # (t, side, v)
    section: list[list]
    taken: mpf  # the energy that stops have taken from the masses


class Flow:
    """A flow whose velocities are measured in those of its fastest motion, so that its steps are as long as they may
    be."""

    def __init__(self, A, N, rate):
        self.scales = [ZERO + 1] * len(A)
        for i in range(N):
            self.scales[2 * i + 1] = rate
        rows = range(len(A))
        self.flow = LinearFlow([[A[i][j] * self.scales[j] / self.scales[i] for j in rows] for i in rows])
        self.h = self.flow.h

    def taylor(self, y):
        terms = self.flow.taylor([a / s for a, s in zip(y, self.scales, strict=True)])
        return [[a * s for a, s in zip(term, self.scales, strict=True)] for term in terms]


class Oscillator:
    """The flows of an oscillator. q: a `Linear` of floats, which count as exact."""

    def __init__(self, q, digits):
        number = lambda a: to_gmp(mpf(a))  # noqa: E731
        self.N, self.omega, self.by_force = len(q.normal), number(q.omega), q.by_force
        self.tiny = to_gmp(mpf(10) ** -digits)
        inverse = mp.inverse(mp.matrix([[mpf(a) for a in row] for row in q.M]))
        solve = lambda a: inverse * mp.matrix([[mpf(x) for x in row] for row in a])  # noqa: E731
        self.K, self.C = solve(q.K), solve(q.C)
        self.f = solve([[s, c, one] for s, c, one in zip(q.sine, q.cosine, q.constant, strict=True)])
        along = mp.matrix([mpf(a) for a in q.normal])
        push = inverse * along
        self.normal, self.push = [to_gmp(a) for a in along], [to_gmp(a) for a in push]
        self.mass = 1 / dot(self.normal, self.push)
        self.walls, self.R, self.k, self.c, self.p = {}, {}, {}, {}, {}
        for side, wall, R, k, c, p in (
            (1, q.high, q.R_high, q.k_high, q.c_high, q.p_high),
            (-1, q.low, q.R_low, q.k_low, q.c_low, q.p_low),
        ):
            if abs(wall) != float("inf"):
                self.walls[side] = number(wall)
                self.k[side], self.c[side], self.p[side] = number(k), number(c), number(p)
                self.R[side] = None if k > 0 else number(R)
        self.flows = {}

    def place_of_s(self, side):
        return 2 * self.N + (3 if side > 0 else 4)

    def matrix(self, pressed, relaxing, held=0):
        """A of y' = A y. pressed: a side or 0; relaxing: sides; held: the side of a stop on which the gap rests."""
        N, size = self.N, 2 * self.N + 5
        A = [[ZERO] * size for _ in range(size)]
        for i in range(N):
            A[2 * i][2 * i + 1] = ZERO + 1
            for j in range(N):
                A[2 * i + 1][2 * j], A[2 * i + 1][2 * j + 1] = -to_gmp(self.K[i, j]), -to_gmp(self.C[i, j])
            for j in range(3):
                A[2 * i + 1][2 * N + j] = to_gmp(self.f[i, j])
        A[2 * N][2 * N + 1], A[2 * N + 1][2 * N] = self.omega, -self.omega
        if pressed:
            force = self.force(pressed)
            for i in range(N):
                A[2 * i + 1] = [a - pressed * self.push[i] * b for a, b in zip(A[2 * i + 1], force, strict=True)]
        if held:
            a = [dot(self.normal, [A[2 * i + 1][j] for i in range(N)]) for j in range(size)]
            for i in range(N):
                share = self.push[i] * self.mass
                A[2 * i + 1] = [x - share * y for x, y in zip(A[2 * i + 1], a, strict=True)]
        for side in relaxing:
            n = self.place_of_s(side)
            A[n][n], A[n][2 * N + 2] = -self.k[side] / self.c[side], -self.p[side] / self.c[side]
        return A

    def flow(self, pressed, relaxing, held=0):
        key = pressed, tuple(sorted(relaxing)), held
        if key not in self.flows:
            rate = gmpy2.sqrt(self.k[pressed] / self.mass) if pressed else ZERO + 1
            self.flows[key] = Flow(self.matrix(pressed, relaxing, held), self.N, max(rate, ZERO + 1))
        return self.flows[key]

    def depth(self, side):
        """delta as a row that y is multiplied by."""
        row = [ZERO] * (2 * self.N + 5)
        for i in range(self.N):
            row[2 * i] = side * self.normal[i]
        row[2 * self.N + 2] = -side * self.walls[side]
        return row

    def speed(self, side):
        row = [ZERO] * (2 * self.N + 5)
        for i in range(self.N):
            row[2 * i + 1] = side * self.normal[i]
        return row

    def force(self, side):
        row = [self.k[side] * a + self.c[side] * b for a, b in zip(self.depth(side), self.speed(side), strict=True)]
        row[2 * self.N + 2] += self.p[side]
        return row

    def pull(self, side):
        """The free acceleration into a stop."""
        A = self.matrix(0, ())
        return [side * dot(self.normal, [A[2 * i + 1][j] for i in range(self.N)]) for j in range(len(A))]

    def kick(self, y, change):
        y = list(y)
        for i in range(self.N):
            y[2 * i + 1] += self.push[i] * self.mass * change
        return y

    def shift(self, y, change):
        """Move the gap alone, by what rounding leaves of it."""
        y, norm = list(y), dot(self.normal, self.normal)
        for i in range(self.N):
            y[2 * i] += self.normal[i] * change / norm
        return y


def column(terms, row):
    return [dot(row, term) for term in terms]


def work(force, speed, u):
    """The integral of the product of two polynomials over [0, u]."""
    total = ZERO
    for n in reversed(range(len(force))):
        total += force[n] * sum((b * u ** (n + m + 1) / (n + m + 1) for m, b in enumerate(speed)), ZERO)
    return total


def leading(c, h, tiny):
    """The order of the first coefficient that is not rounding, over a step h."""
    sizes = [abs(a) * h**n for n, a in enumerate(c)]
    return next((n for n, a in enumerate(sizes) if a > tiny * max(sizes)), len(c) - 1)


def simulate(q, state, contacts=None, periods=None, digits=40):
    """The orbit from the state (x1, v1, ..) at t = 0 until so many contacts have ended, or over so many periods."""
    with mp.workdps(digits + 20), context():
        o = Oscillator(q, digits)
        N, t, period = o.N, ZERO, 2 * gmpy2.const_pi() / o.omega
        tau = to_gmp(mpf(q.tau))
        y = [to_gmp(mpf(a)) for a in state] + [gmpy2.sin(tau), gmpy2.cos(tau), ZERO + 1, ZERO, ZERO]
        end = gmpy2.inf() if periods is None else periods * period
        done, impacts, section, pressed, relaxing, held, touched = [], [], [], 0, set(), 0, None
        deepest, strongest, leaving, next_section, taken = ZERO, ZERO, 0, 0, ZERO
        for side in o.walls:
            if o.R[side] is None and dot(o.depth(side), y) > 0:
                if o.by_force and dot(o.force(side), y) < 0:
                    y[o.place_of_s(side)] = dot(o.depth(side), y)
                    relaxing.add(side)
                else:
                    pressed, touched = side, (t, dot(o.speed(side), y))
                    deepest, strongest = dot(o.depth(side), y), dot(o.force(side), y)
        while t < end and (contacts is None or len(done) < contacts):
            flow = o.flow(pressed, relaxing, held)
            terms, found = flow.taylor(y), []
            watched = []
            if held:
                a = o.pull(held)
                watched = [("off", held, a), ("in", held, [x - y for x, y in zip(limit(o, held), a, strict=True)])]
            elif pressed:
                ends_by_force = o.by_force and o.c[pressed] > 0
                if not ends_by_force or o.p[pressed] > 0:
                    watched.append(("zero", pressed, o.depth(pressed)))
                if ends_by_force:
                    watched.append(("force", pressed, o.force(pressed)))
            for side in o.walls:
                if side != pressed and side != held:
                    row = [-a for a in o.depth(side)]
                    row[o.place_of_s(side)] += 1
                    watched.append(("touch", side, row))
            for what, side, row in watched:
                c = column(terms, row)
                n = 0
                if (what, side) == leaving or (what == "touch" and side == leaving) or leaving == ("begin", side):
                    n = leading(c, flow.h, o.tiny)
                root = falling_root(c[n:], ZERO, flow.h)
                if root is not None:
                    found.append((root, what, side))
            for side in relaxing:
                s = y[o.place_of_s(side)]
                if o.p[side] > 0:
                    root = falling_root(column(terms, unit(o, o.place_of_s(side))), ZERO, flow.h)
                    if root is not None:
                        found.append((root, "relaxed", side))
                elif s < o.tiny**2:
                    found.append((ZERO, "relaxed", side))
            u, what, side = min(found, key=lambda one: one[0]) if found else (flow.h, "", 0)
            while next_section * period <= min(t + u, end):
                section.append([from_gmp(a) for a in evaluate(terms, next_section * period - t)[: 2 * N]])
                next_section += 1
            if pressed:
                taken += work(column(terms, o.force(pressed)), column(terms, o.speed(pressed)), min(u, end - t))
                for row, largest in ((o.depth(pressed), "deep"), (o.force(pressed), "strong")):
                    c = column(terms, row)
                    slope = [n * a for n, a in enumerate(c)][1:]
                    top = falling_root(slope, ZERO, u) if slope[0] > 0 and u > 0 else None
                    value = max(evaluate([[a] for a in c], at)[0] for at in (ZERO, u, top) if at is not None)
                    if largest == "deep":
                        deepest = max(deepest, value)
                    else:
                        strongest = max(strongest, value)
            t, y, leaving = t + u, evaluate(terms, u), 0
            if what == "relaxed":
                relaxing.discard(side)
                y[o.place_of_s(side)] = ZERO
            elif what in ("zero", "force"):
                if what == "force":
                    y[o.place_of_s(side)] = dot(o.depth(side), y)
                    relaxing.add(side)
                done.append(Contact(*map(from_gmp, (touched[0], t)), side, *map(
                    from_gmp, (touched[1], dot(o.speed(side), y), deepest, strongest)
                )))  # fmt: skip
                pressed, leaving = 0, side
            elif what == "off":
                held, leaving = 0, side
            elif what == "in":
                held, pressed, touched, leaving = 0, side, (t, ZERO), ("begin", side)
                deepest = strongest = ZERO
            elif what == "touch" and o.R[side] is not None:
                speed = dot(o.speed(side), y)
                impacts.append((from_gmp(t), side, from_gmp(speed)))
                taken += o.mass * (1 - o.R[side]) * (1 + o.R[side]) * speed * speed / 2
                y, leaving = o.kick(y, -side * (1 + o.R[side]) * speed), side
            elif what == "touch":
                relaxing.discard(side)
                y[o.place_of_s(side)] = ZERO
                pressed, touched, leaving = side, (t, dot(o.speed(side), y)), ("begin", side)
                deepest, strongest = dot(o.depth(side), y), dot(o.force(side), y)
        return Orbit(done, impacts, section, from_gmp(taken))


def limit(o, side):
    row = [ZERO] * (2 * o.N + 5)
    row[2 * o.N + 2] = o.p[side] / o.mass
    return row


def unit(o, n):
    return [ZERO + (i == n) for i in range(2 * o.N + 5)]
