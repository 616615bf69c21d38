"""The phases of a machine: in each of them y' = A y, with one A, for

    y = (x1, v1, .., xN, vN, sin, cos of each harmonic, 1, s of each stop that relaxes)

A phase has one mode for each element (stop or friction): FREE, RELAXING (a free stop on its way back), PRESSED, HELD
(a rest on a stop, a stick: the force is what keeps the coordinate still), SLIP (+1 or -1).
"""

import math
from functools import cached_property

import numpy as np
from flint import arb, arb_mat
from mpmath import mp, mpf

from reference.balls import from_ball, precision, to_ball, to_balls
from reference.machine import elements_of

FREE, RELAXING, PRESSED, HELD = "free", "relaxing", "pressed", "held"
SLIP = {1: "slip+", -1: "slip-"}
REACH = 4  # |A| times the length of a step
PARTS = 8  # of a step, in each of which bounds are formed
DEPENDENT = arb((1, -80))  # a row with no more than this part beside others depends on them


def matrix_of(machine, modes=None):
    """A of y' = A y in a phase, in mpmath; of free flight, if no modes are given."""
    with precision():
        phases = Phases(machine)
        A = phases.phase(modes or (FREE,) * len(phases.elements)).A
        return mp.matrix([[from_ball(a) for a in row] for row in A.tolist()])


class Phases:
    """All phases of a machine, each made when it is first met."""

    def __init__(self, machine):
        self.machine, self.elements, N = machine, elements_of(machine), machine.masses
        self.N, self.one = N, 2 * N + 2 * len(machine.harmonics)
        relaxing = [e for e, element in enumerate(self.elements) if element.compliant and element.law.relaxes]
        self.place_of_s = {e: self.one + 1 + i for i, e in enumerate(relaxing)}
        self.size = self.one + 1 + len(relaxing)
        inverse = to_balls(machine.M).inv()
        self.rows = [to_balls([element.row]) for element in self.elements]
        self.push = [(inverse * row.transpose()).mid() for row in self.rows]  # x'' by a force 1 along the row
        self.free = self.accelerations(inverse)
        self.made = {}

    def accelerations(self, inverse):
        """x'' as rows of y, (N, size): M^-1 (constant + harmonics - K x - C x')."""
        machine, N = self.machine, self.N
        rows = [[arb(0)] * self.size for _ in range(N)]
        K, C = to_balls(machine.K), to_balls(machine.C)
        for i in range(N):
            rows[i][0 : 2 * N : 2] = [-K[i, j] for j in range(N)]
            rows[i][1 : 2 * N : 2] = [-C[i, j] for j in range(N)]
            for h, harmonic in enumerate(machine.harmonics):
                at = 2 * N + 2 * h
                rows[i][at : at + 2] = to_ball(harmonic.sine[i]), to_ball(harmonic.cosine[i])
            rows[i][self.one] = to_ball(machine.constant[i])
        return (inverse * arb_mat(rows)).mid()

    def function(self, e, at=0, speed=0, constant=0, s=0):
        """The function at . delta + speed . delta' + constant + s . s of y, for a stop; speed . w of friction."""
        row, element = [arb(0)] * self.size, self.elements[e]
        for i in range(self.N):
            row[2 * i], row[2 * i + 1] = at * self.rows[e][0, i], speed * self.rows[e][0, i]
        row[self.one] = arb(constant)
        if element.rubs:
            row[self.one] -= speed * to_ball(element.law.belt_speed)
        else:
            row[self.one] -= at * element.law.side * to_ball(element.law.place)
        if s:
            row[self.place_of_s[e]] = arb(s)
        return arb_mat([row]).mid()

    def depth(self, e):
        return self.function(e, at=1)

    def speed(self, e):
        return self.function(e, speed=1)

    def force(self, e):
        law = self.elements[e].law
        return self.function(e, to_ball(law.k), to_ball(law.c), to_ball(law.p))

    def phase(self, modes):
        if modes not in self.made:
            self.made[modes] = Phase(self, modes)
        return self.made[modes]


class Phase:
    """A of y' = A y, and the functions of y that stay positive in this phase (`guards`, by (what, element))."""

    def __init__(self, phases, modes):
        self.phases, self.modes = phases, modes
        x2 = phases.free
        for e, element in enumerate(phases.elements):
            if modes[e] == PRESSED:
                x2 = x2 - phases.push[e] * phases.force(e)
            elif modes[e] in SLIP.values():
                sign = 1 if modes[e] == SLIP[1] else -1
                x2 = x2 - phases.push[e] * phases.function(e, constant=sign * to_ball(element.law.friction_force))
        self.reactions = self.forces_that_hold(x2)
        for e, reaction in self.reactions.items():
            x2 = x2 - phases.push[e] * reaction
        self.A, self.guards = self.matrix(x2), self.functions()

    @cached_property
    def flow(self):
        return Flow(self.A, self.phases.N, self.guards)

    def forces_that_hold(self, x2):
        """The force of each held element, as a function of y: row . (x'' - M^-1 sum of row force) = 0 for all of them.

        An element whose row depends on those of others before it carries nothing, and is left out.
        """
        phases, carrying, rows = self.phases, [], None
        for e, mode in enumerate(self.modes):
            if mode == HELD:
                more = phases.rows[e] if rows is None else arb_mat([*rows.tolist(), *phases.rows[e].tolist()])
                if self.left_over(more, [*carrying, e]) > DEPENDENT:
                    carrying, rows = [*carrying, e], more
        if not carrying:
            return {}
        forces = self.gram(rows, carrying).solve(rows * x2).mid().tolist()
        return {e: arb_mat([force]) for e, force in zip(carrying, forces, strict=True)}

    def gram(self, rows, carrying):
        """rows M^-1 rows^T"""
        columns = [rows * self.phases.push[e] for e in carrying]
        return arb_mat([[column[i, 0] for column in columns] for i in range(rows.nrows())]).mid()

    def left_over(self, rows, carrying):
        """What part of the last row is independent of the rows before it, in the metric of M^-1."""
        G, n = self.gram(rows, carrying), len(carrying) - 1
        if n == 0:
            return arb(1)
        before = arb_mat([[G[i, j] for j in range(n)] for i in range(n)])
        across = arb_mat([[G[i, n]] for i in range(n)])
        return (1 - (across.transpose() * before.solve(across))[0, 0] / G[n, n]).mid()

    def matrix(self, x2):
        phases, A = self.phases, [[arb(0)] * self.phases.size for _ in range(self.phases.size)]
        for i in range(phases.N):
            A[2 * i][2 * i + 1] = arb(1)
            A[2 * i + 1] = list(x2.tolist()[i])
        for h, harmonic in enumerate(phases.machine.harmonics):
            at, rate = 2 * phases.N + 2 * h, harmonic.order * to_ball(phases.machine.omega)
            A[at][at + 1], A[at + 1][at] = rate, -rate
        for e, n in phases.place_of_s.items():
            if self.modes[e] == RELAXING:  # k s + c s' + p = 0
                k, c, p = (to_ball(a) for a in phases.elements[e].law[3:6])
                A[n][n], A[n][phases.one] = -k / c, -p / c
        return arb_mat(A).mid()

    def functions(self):
        phases, guards = self.phases, {}
        for e, (element, mode) in enumerate(zip(phases.elements, self.modes, strict=True)):
            law = element.law
            if mode == FREE:
                guards["reach", e] = -phases.depth(e)
            elif mode == RELAXING:
                guards["reach", e] = phases.function(e, at=-1, s=1)
                if law.p > 0:
                    guards["relaxed", e] = phases.function(e, s=1)
            elif mode == PRESSED:
                if law.relaxes:
                    guards["force", e] = phases.force(e)
                if not law.relaxes or law.p > 0:  # without preload the force is zero first
                    guards["open", e] = phases.depth(e)
            elif mode in SLIP.values():
                guards["slip", e] = phases.speed(e) * (1 if mode == SLIP[1] else -1)
            elif e in self.reactions and element.rubs:
                limit = phases.function(e, constant=to_ball(law.static_force))
                guards["up", e], guards["down", e] = limit - self.reactions[e], limit + self.reactions[e]
            elif e in self.reactions:
                guards["pull", e] = self.reactions[e]
                if element.compliant:
                    guards["press", e] = phases.function(e, constant=to_ball(law.p)) - self.reactions[e]
        return guards


class Flow:
    """y' = A y in steps of h; a series of `order` terms is exact over a step."""

    def __init__(self, A, N, functions):
        self.A, size = A, A.nrows()
        entries = np.array([[abs(float(a)) for a in row] for row in A.tolist()])
        stiffness = max([entries[2 * i + 1, 0 : 2 * N : 2].sum() for i in range(N)])
        rate = max(1.0, math.sqrt(stiffness))  # velocities are measured in those of the fastest motion
        scale = np.array([rate if i % 2 and i < 2 * N else 1.0 for i in range(size)])
        self.h, self.order = arb(REACH / max((entries * scale / scale[:, None]).sum(1).max(), 1e-3)), 1
        while mpf(REACH) ** self.order / mp.factorial(self.order) > mp.eps / (1 + rate):
            self.order += 1
        self.step = (A * self.h).exp().mid()
        # speeds of the masses at PARTS times within a step, as rows of y
        steps = [(A * (self.h * (part + 1) / PARTS)).exp().tolist()[1 : 2 * N : 2] for part in range(PARTS)]
        self.speeds = np.array([[[float(a) for a in row] for row in rows] for rows in steps])
        self.names, self.tables, self.floats = list(functions), {}, {}
        for name, row in functions.items():
            self.add(name, row)
        self.guards = np.array([self.floats[name] for name in functions]).reshape(-1, self.order, size)

    def add(self, name, row):
        """Rows by which y gives the coefficients of row . y(h u) by powers of u."""
        lines = []
        for n in range(self.order):
            lines.append(row.entries())
            row = (row * self.A * (self.h / (n + 1))).mid()
        self.tables[name], self.floats[name] = arb_mat(lines), np.array([[float(a) for a in line] for line in lines])

    def series(self, name, y, row=None):
        """Coefficients of this function along the orbit by powers of u, time = h u, and the sizes of their terms."""
        if name not in self.tables:
            self.add(name, row)
        sizes = np.abs(self.floats[name]) @ np.abs(floats_of(y))
        return [a.mid() for a in (self.tables[name] * y).entries()], sizes

    def near(self, y):
        """The functions that bounds do not show to stay positive throughout a step."""
        y = floats_of(y)
        c, sizes = self.guards @ y, np.abs(self.guards) @ np.abs(y)
        parts = np.abs(d := c @ shifts(self.order))  # (PARTS, functions, order): powers of u - middle of each part
        least = (d[:, :, 0] - parts[:, :, 1:].sum(2)).min(0)
        return [name for name, a, size in zip(self.names, least, sizes, strict=True) if a <= 1e-12 * size.sum()]

    def fastest(self, y, part):
        """The largest speed of a mass, among samples, within this part of a step."""
        samples = np.abs(self.speeds[: int(PARTS * part)] @ floats_of(y))
        return samples.max() if samples.size else 0.0

    def at(self, y, u):
        """y after the time u <= h."""
        if u == self.h:
            return (self.step * y).mid()
        term = total = y
        for n in range(1, self.order):
            term = (self.A * term * (u / n)).mid()
            total = total + term
        return total.mid()


def floats_of(y):
    return np.array([float(a) for a in y.entries()])


SHIFTS = {}


def shifts(order):
    """(PARTS, order, order): from powers of u in [0, 1] to powers of (u - m)/r in each part of it, m - r to m + r."""
    if order not in SHIFTS:
        r = 0.5 / PARTS
        SHIFTS[order] = np.array(
            [
                [[math.comb(n, k) * ((2 * part + 1) * r) ** (n - k) * r**k if k <= n else 0.0 for k in range(order)]
                 for n in range(order)]
                for part in range(PARTS)
            ]
        )  # fmt: skip
    return SHIFTS[order]
