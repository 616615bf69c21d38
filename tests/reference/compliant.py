"""A simulator of any linear oscillator with compliant stops in many digits, as any_naive.py is of rigid ones.

It works in the coordinates of the masses and shares no formula with the package: y = (x1, v1, .., xN, vN, sin, cos, 1,
s+, s-), with s the places of stops that relax, obeys y' = A y between events, with one A for each stop that is pressed
or relaxes. An event is a proven root of a linear function of y.
"""

import math
from itertools import pairwise
from typing import NamedTuple

from flint import arb, arb_mat, arb_poly, ctx
from mpmath import mp, mpf

from reference.balls import falling_root, from_ball, to_ball, to_balls

REACH = 8  # |A| times the length of a step
FADED = mpf(10) ** -45  # part of where it began, at which a stop without preload has relaxed


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
    places: list[tuple]  # at the sections: s of the right stop and of the left one
    taken: mpf  # the energy that stops have taken from the masses
    given_up: bool  # the steps that were allowed did not reach the end


class Flow:
    """y' = A y in steps of h; a series of `order` terms is exact over a step."""

    def __init__(self, A, N, rate):
        self.A, size = A, A.nrows()
        scale = [rate if i % 2 and i < 2 * N else 1.0 for i in range(size)]  # velocities in those of the fastest motion
        norm = max(sum(abs(float(A[i, j])) * scale[j] / scale[i] for j in range(size)) for i in range(size))
        self.h, self.order = arb(REACH / norm), 1
        while mpf(REACH) ** self.order / mp.factorial(self.order) > mp.eps / (1 + rate):
            self.order += 1
        self.tables, self.step = {}, (A * self.h).exp().mid()

    def along(self, row, y):
        """Coefficients of row . y(h u) by powers of u."""
        if row not in self.tables:
            power, lines = arb_mat([list(row)]), []
            for n in range(self.order):
                lines.append(power.entries())
                power = (power * self.A * (self.h / (n + 1))).mid()
            self.tables[row] = arb_mat(lines)
        return [a.mid() for a in (self.tables[row] * y).entries()]

    def at(self, y, u):
        """y after the time u <= h."""
        if u == self.h:
            return (self.step * y).mid()
        term = total = y
        for n in range(1, self.order):
            term = (self.A * term * (u / n)).mid()
            total = total + term
        return total.mid()


class Oscillator:
    """The flows and stops of an oscillator. q: a `Linear` whose numbers count as exact."""

    def __init__(self, q):
        self.N, self.omega, self.by_force = len(q.normal), to_ball(q.omega), q.by_force
        self.size = 2 * self.N + 5
        inverse, along = to_balls(q.M).inv(), to_balls([[a] for a in q.normal])
        rows = [inverse * to_balls(part) for part in (q.K, q.C, list(zip(q.sine, q.cosine, q.constant, strict=True)))]
        self.K, self.C, self.f = (part.mid() for part in rows)
        push = (inverse * along).mid()
        self.normal, self.push = along.entries(), push.entries()
        self.mass = (1 / (along.transpose() * push)[0, 0]).mid()
        self.walls, self.R, self.k, self.c, self.p, self.flows = {}, {}, {}, {}, {}, {}
        for side, wall, R, k, c, p in (
            (1, q.high, q.R_high, q.k_high, q.c_high, q.p_high),
            (-1, q.low, q.R_low, q.k_low, q.c_low, q.p_low),
        ):
            if abs(wall) != float("inf"):
                self.walls[side], self.k[side], self.c[side], self.p[side] = map(to_ball, (wall, k, c, p))
                self.R[side] = None if k > 0 else to_ball(R)

    def place_of_s(self, side):
        return 2 * self.N + (3 if side > 0 else 4)

    def row(self, side, at=0, speed=0, constant=0, s=0):
        """A function of y: at delta + speed delta' + constant + s s."""
        row = [arb(0)] * self.size
        for i in range(self.N):
            row[2 * i], row[2 * i + 1] = side * at * self.normal[i], side * speed * self.normal[i]
        row[2 * self.N + 2] = constant - side * at * self.walls[side]
        row[self.place_of_s(side)] = arb(s)
        return tuple(a.mid() for a in row)

    def depth(self, side):
        return self.row(side, at=1)

    def speed(self, side):
        return self.row(side, speed=1)

    def force(self, side):
        return self.row(side, self.k[side], self.c[side], self.p[side])

    def matrix(self, pressed, relaxing):
        """A of y' = A y. pressed: a side or 0; relaxing: sides."""
        N, A = self.N, [[arb(0)] * self.size for _ in range(self.size)]
        force = self.force(pressed) if pressed else [arb(0)] * self.size
        for i in range(N):
            A[2 * i][2 * i + 1] = arb(1)
            for j in range(N):
                A[2 * i + 1][2 * j], A[2 * i + 1][2 * j + 1] = -self.K[i, j], -self.C[i, j]
            A[2 * i + 1][2 * N : 2 * N + 3] = [self.f[i, j] for j in range(3)]
            A[2 * i + 1] = [a - pressed * self.push[i] * b for a, b in zip(A[2 * i + 1], force, strict=True)]
        A[2 * N][2 * N + 1], A[2 * N + 1][2 * N] = self.omega, -self.omega
        for side in relaxing:
            n = self.place_of_s(side)
            A[n][n], A[n][2 * N + 2] = -self.k[side] / self.c[side], -self.p[side] / self.c[side]
        return arb_mat(A).mid()

    def flow(self, pressed, relaxing):
        key = pressed, tuple(sorted(relaxing))
        if key not in self.flows:
            rate = max(1.0, float(self.k[pressed] / self.mass) ** 0.5) if pressed else 1.0
            self.flows[key] = Flow(self.matrix(*key), self.N, rate)
        return self.flows[key]

    def kick(self, y, change):
        """Change the velocity of the gap, by an impulse along n."""
        y = y.entries()
        for i in range(self.N):
            y[2 * i + 1] = (y[2 * i + 1] + self.push[i] * self.mass * change).mid()
        return arb_mat(self.size, 1, y)


def value_of(row, y):
    return (arb_mat([list(row)]) * y)[0, 0].mid()


def leading(c, tiny):
    """The order of the first coefficient that is not rounding."""
    sizes = [abs(a) for a in c]
    least = tiny * max(sizes)
    return next((n for n, a in enumerate(sizes) if a > least), len(c) - 1)


def largest_within(c, u):
    """The largest value of a polynomial in [0, u], u <= 1; in each of its parts it turns back once at most."""
    f, sizes = arb_poly(c), [n * abs(float(a)) for n, a in enumerate(c)]
    found = [c[0], f(u).mid()]
    if sizes[1] < 1.000001 * sum(sizes[2:]):
        slope, edges = f.derivative(), [(u * n / REACH).mid() for n in range(REACH + 1)]
        for low, high in pairwise(edges):
            if slope(low) > 0 and slope(high) < 0:
                part = slope(arb_poly([low, high - low])).coeffs()
                found.append(f(low + (high - low) * falling_root([a.mid() for a in part], 0, NARROW)).mid())
    return max(found)


NARROW = arb((1, -90))


def simulate(q, state, contacts=None, periods=None, digits=40, until=None, places=(0, 0), steps=math.inf):
    """The orbit from the state (x1, v1, ..) at t = 0 until so many contacts have ended, or over so many periods, or
    until a time; for so many steps at most. places: of the right stop and of the left one, from where they relax."""
    before = ctx.prec
    with mp.workdps(digits + 20):
        ctx.prec = mp.prec
        try:
            return Motion(Oscillator(q), q.tau, state, digits, places).go(contacts, periods, until, steps)
        finally:
            ctx.prec = before


class Motion:
    """One orbit, and what is recorded of it."""

    def __init__(self, o, tau, state, digits, places):
        self.o, self.t, self.tiny = o, arb(0), to_ball(mpf(10) ** -digits)
        phase = [to_ball(mp.sin(tau)), to_ball(mp.cos(tau)), arb(1), arb(0), arb(0)]
        self.y = arb_mat(o.size, 1, [to_ball(a) for a in state] + phase)
        self.pressed, self.relaxing = 0, {}  # of stops that relax: where they began
        self.left = 0  # the stop whose distance begins with a zero
        self.kept, self.taken = Orbit([], [], [], [], mpf(0), False), arb(0)
        for side, s in zip((1, -1), map(to_ball, places), strict=True):
            if s > 0:
                self.relaxing[side] = s
                self.set_s(side, s)
            if side in o.walls and o.R[side] is None and value_of(o.depth(side), self.y) > s:
                self.forget(side)
                if o.by_force and value_of(o.force(side), self.y) < 0:
                    self.relax(side)
                else:
                    self.press(side)

    def press(self, side):
        self.pressed, self.touched = side, (self.t, value_of(self.o.speed(side), self.y))
        self.peaks = [value_of(row, self.y) for row in (self.o.depth(side), self.o.force(side))]

    def relax(self, side):
        self.relaxing[side] = value_of(self.o.depth(side), self.y)
        self.set_s(side, self.relaxing[side])

    def set_s(self, side, s):
        y = self.y.entries()
        y[self.o.place_of_s(side)] = s
        self.y = arb_mat(self.o.size, 1, y)

    def watched(self):
        """(what may happen, side, function of y that falls through zero there)"""
        o, rows = self.o, []
        if self.pressed:
            by_force = o.by_force and o.c[self.pressed] > 0
            if not by_force or o.p[self.pressed] > 0:
                rows.append(("zero", self.pressed, o.depth(self.pressed)))
            if by_force:
                rows.append(("force", self.pressed, o.force(self.pressed)))
        rows += [("touch", side, o.row(side, at=-1, s=1)) for side in o.walls if side != self.pressed]
        return rows + [("relaxed", side, o.row(side, s=1)) for side in self.relaxing if o.p[side] > 0]

    def next_event(self, flow):
        """(part of a step, what, side): what comes first, or the end of a step."""
        for side, began in self.relaxing.items():
            if self.o.p[side] == 0 and value_of(self.o.row(side, s=1), self.y) < to_ball(FADED) * began:
                return arb(0), "relaxed", side
        first = arb(1), "", 0
        for what, side, row in self.watched():
            c = flow.along(row, self.y)
            at_zero = side == self.left and what in ("touch", "zero")
            root = falling_root(c, leading(c, self.tiny) if at_zero else 0, NARROW)
            if root is not None and root < first[0]:
                first = root, what, side
        return first

    def go(self, contacts, periods, until, steps):
        o, count = self.o, 0
        period = (2 * arb.pi() / o.omega).mid()
        end = arb.pos_inf() if periods is None else (periods * period).mid()
        end = end if until is None else to_ball(until)
        while self.t < end and (contacts is None or len(self.kept.contacts) < contacts):
            if count >= steps:
                return self.kept._replace(given_up=True)
            count += 1
            flow = o.flow(self.pressed, self.relaxing)
            part, what, side = self.next_event(flow)
            u = part * flow.h
            self.keep_sections(flow, u, period, end)
            if self.pressed:
                rows = o.depth(self.pressed), o.force(self.pressed)
                found = [largest_within(flow.along(row, self.y), part) for row in rows]
                self.taken += flow.h * self.work(flow, min(u, (end - self.t).mid()) / flow.h)
                self.peaks = [max(pair) for pair in zip(self.peaks, found, strict=True)]
            self.y, self.t, self.left = flow.at(self.y, u), (self.t + u).mid(), 0
            if what and self.t <= end:
                self.happen(what, side)
        return self.kept._replace(taken=from_ball(self.taken))

    def work(self, flow, part):
        """The integral of the force of the pressed stop times delta' over this part of a step, by parts of a step."""
        force, speed = (flow.along(row(self.pressed), self.y) for row in (self.o.force, self.o.speed))
        return (arb_poly(force) * arb_poly(speed)).integral()(part).mid()

    def keep_sections(self, flow, u, period, end):
        """Those from now to the time u after."""
        while (at := (len(self.kept.section) * period).mid()) <= min((self.t + u).mid(), end):
            there = flow.at(self.y, (at - self.t).mid()).entries()
            self.kept.section.append([from_ball(a) for a in there[: 2 * self.o.N]])
            self.kept.places.append(tuple(from_ball(there[self.o.place_of_s(side)]) for side in (1, -1)))

    def happen(self, what, side):
        o, speed = self.o, value_of(self.o.speed(side), self.y)
        if what == "relaxed":
            self.forget(side)
        elif what == "touch" and o.R[side] is not None:
            self.kept.impacts.append((from_ball(self.t), side, from_ball(speed)))
            self.taken += o.mass * (1 - o.R[side]) * (1 + o.R[side]) * speed * speed / 2
            self.y, self.left = o.kick(self.y, -side * (1 + o.R[side]) * speed), side
        elif what == "touch":
            self.forget(side)
            self.press(side)
            self.left = side
        else:
            if what == "force":
                self.relax(side)
            (t, v), numbers = self.touched, (self.t, speed, *self.peaks)
            released, v_release, *peaks = map(from_ball, numbers)
            self.kept.contacts.append(Contact(from_ball(t), released, side, from_ball(v), v_release, *peaks))
            self.pressed, self.left = 0, side

    def forget(self, side):
        """The stop is relaxed, or pressed again."""
        self.relaxing.pop(side, None)
        self.set_s(side, arb(0))
