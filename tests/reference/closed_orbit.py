"""Periodic orbits and their multipliers in many digits: flights over phases, and saltation at each event.

The unknowns are the state at the section and the times of all events. At an event a function row . y of the state is
zero, y becomes D y, and another phase begins; changes of the state at a fixed time pass it by the saltation matrix
D + (F+ - D F-) row/(row F-), with F the rates y' before and behind it. All derivatives are exact.
"""

from typing import NamedTuple

from flint import arb, arb_mat
from mpmath import mp, mpf

from reference.balls import from_ball, precision, to_ball
from reference.flow import FREE, HELD, PRESSED, RELAXING, SLIP, Phases
from reference.machine import elements_of

DIGITS = 45
CLOSED = mpf(10) ** -32  # the last change of Newton's method
# kind of an event -> (guard that vanishes there, mode of the element behind it; None: as before)
KINDS = {
    "impact": ("reach", None),
    "rest": ("reach", HELD),  # an impact that takes all speed, with a rest behind it
    "leave": ("pull", FREE),
    "touch": ("reach", PRESSED),
    "release": ("open", FREE),
    "force": ("force", FREE),  # the force is zero, and the stop is back before it is met again
    "relax": ("force", RELAXING),
    "relaxed": ("relaxed", FREE),
    "stick": ("slip", HELD),
    "turn+": ("slip", SLIP[1]),
    "turn-": ("slip", SLIP[-1]),
    "slip+": ("up", SLIP[1]),
    "slip-": ("down", SLIP[-1]),
}


class Leg(NamedTuple):
    """A flight to an event, and the event."""

    phase: object
    row: arb_mat
    jump: arb_mat  # D


def impacts_of(machine, sides):
    """The events of impacts on the stops of the first contact."""
    return [("impact", element_of(machine, side)) for side in sides]


def contacts_of(machine, sides, pulled=False):
    """The events of contacts with compliant stops of the first contact.

    pulled: whether contacts with a preload end by their force where the stop's do, before the mass is back at the stop.
    """
    events = []
    for e in (element_of(machine, side) for side in sides):
        law = elements_of(machine)[e].law
        events += ("touch", e), ("force" if law.relaxes and (law.p == 0 or pulled) else "release", e)
    return events


def element_of(machine, side, contact=1) -> int:
    """The place of a stop in the list of elements."""
    stops = [(i, stop.side) for i, each in enumerate(machine.contacts, 1) for stop in each.stops]
    return stops.index((contact, side))


class ClosedOrbit:
    """An orbit of a machine with y(t + periods T) = sigma y(t) for the state y of the masses.

    events: (kind, element from 0 on) within this time, from the section on, which is at the time `begin`; where others
    change their modes at the same instant, (kind, element, {element: mode}).
    modes: of the elements at the section; all are free, if they are left out.
    """

    def __init__(self, machine, events, periods, sigma=1, begin=0, modes=None, digits=DIGITS):
        self.machine, self.digits, self.sigma, self.N = machine, digits, sigma, machine.masses
        with mp.workdps(digits), precision():
            self.phases = phases = Phases(machine)
            modes = tuple(modes or (FREE,) * len(phases.elements))
            self.begin, omega = to_ball(begin), to_ball(machine.omega)
            self.length = (to_ball(periods) * 2 * arb.pi() / omega).mid()
            angle, self.inputs = omega * self.begin + to_ball(machine.tau), []
            for harmonic in machine.harmonics:
                self.inputs += (harmonic.order * angle).sin().mid(), (harmonic.order * angle).cos().mid()
            # the unknown part of y: the state of the masses, and s of stops that relax at the section
            self.at = [*range(2 * self.N), *(n for e, n in phases.place_of_s.items() if modes[e] == RELAXING)]
            self.legs = []
            for kind, e, *others in events:
                guard, mode = KINDS[kind]
                phase = phases.phase(modes)
                row = phase.guards[guard, e]
                self.legs.append(Leg(phase, row, self.jump(kind, e, modes[e])))
                changes = {e: mode or modes[e]} | (others[0] if others else {})
                modes = tuple(changes.get(i, old) for i, old in enumerate(modes))
            self.last = phases.phase(modes)

    def jump(self, kind, e, before):
        phases, D = (
            self.phases,
            arb_mat([[int(i == j) for j in range(self.phases.size)] for i in range(self.phases.size)]),
        )
        if kind in ("impact", "rest"):
            law, speed = phases.elements[e].law, phases.speed(e)
            push = phases.push[e] * (1 / (phases.rows[e] * phases.push[e])[0, 0])
            change = arb(1) if kind == "rest" else 1 + to_ball(law.R)
            for i in range(self.N):
                for j in range(phases.size):
                    D[2 * i + 1, j] -= change * push[i, 0] * speed[0, j]
        elif kind == "relax":
            depth = phases.depth(e)
            for j in range(phases.size):
                D[phases.place_of_s[e], j] = depth[0, j]
        elif before == RELAXING:
            D[phases.place_of_s[e], phases.place_of_s[e]] = arb(0)
        return D.mid()

    def start(self, u):
        y = [arb(0)] * self.phases.size
        y[2 * self.N : self.phases.one + 1] = *self.inputs, arb(1)
        for n, place in enumerate(self.at):
            y[place] = to_ball(u[n])
        return arb_mat(len(y), 1, y)

    def residual_and_jacobian(self, u):
        """(F, J): of each event its row . y, then sigma y - y(begin); u: the state, then times, in mpmath."""
        n, count = len(self.at), len(u)
        with mp.workdps(self.digits), precision():
            y, change = self.start(u), arb_mat(self.phases.size, count)  # and dy/du
            for column, place in enumerate(self.at):
                change[place, column] = arb(1)
            now, last, F, J = self.begin, None, [], []
            for k, leg in enumerate([*self.legs, None]):
                phase = self.last if leg is None else leg.phase
                t = self.begin + self.length if leg is None else to_ball(u[n + k])
                E = (phase.A * (t - now)).exp().mid()
                y, change = (E * y).mid(), (E * change).mid()
                rate = phase.A * y
                for i in range(self.phases.size):
                    if leg is not None:
                        change[i, n + k] += rate[i, 0]
                    if last is not None:
                        change[i, last] -= rate[i, 0]
                if leg is not None:
                    F.append((leg.row * y)[0, 0])
                    J.append((leg.row * change).entries())
                    y, change = (leg.jump * y).mid(), (leg.jump * change).mid()
                    now, last = t, n + k
            for column, place in enumerate(self.at):
                F.append(self.sigma * y[place, 0] - to_ball(u[column]))
                J.append([self.sigma * change[place, j] - int(j == column) for j in range(count)])
            return mp.matrix([from_ball(a) for a in F]), mp.matrix([[from_ball(a) for a in row] for row in J])

    def linearised(self, J, mu):
        """The Jacobian for changes that grow by mu in the period: singular where the orbit has this multiplier, also
        where an impact has no speed, and the closure a pole."""
        M, events = J.copy(), len(self.legs)
        for i in range(len(self.at)):
            M[events + i, i] += 1 - mu
        return M

    def speed(self, u, k):
        """The rate at which the row of event k goes to zero."""
        n = len(self.at)
        with mp.workdps(self.digits), precision():
            y, now = self.start(u), self.begin
            for i, leg in enumerate(self.legs):
                t = to_ball(u[n + i])
                y, now = ((leg.phase.A * (t - now)).exp() * y).mid(), t
                if i == k:
                    return from_ball((leg.row * leg.phase.A * y)[0, 0])
                y = (leg.jump * y).mid()

    def solve(self, state, times, steps=12):
        """(state, times) by Newton's method, from a guess: x1 v1 .. (and s) at the section, times of the events."""
        with mp.workdps(self.digits):
            u, n = mp.matrix([mpf(a) for a in [*state, *times]]), len(self.at)
            for _ in range(steps):
                change = mp.lu_solve(*self.residual_and_jacobian(u)[::-1])
                u -= change
                if mp.norm(change) < CLOSED:
                    return list(u[:n]), list(u[n:])
        raise ArithmeticError("no periodic orbit near the guess")

    def closure(self, state, times):
        """The matrix whose eigenvalues are the multipliers: of changes of the state at the section, (n, n)."""
        with mp.workdps(self.digits), precision():
            y, now = self.start(state), self.begin
            through = arb_mat([[int(i == j) for j in range(self.phases.size)] for i in range(self.phases.size)])
            following = [*(leg.phase for leg in self.legs), self.last][1:]
            for leg, t, behind in zip(self.legs, map(to_ball, times), following, strict=True):
                E = (leg.phase.A * (t - now)).exp()
                y, now = (E * y).mid(), t
                before, after = leg.phase.A * y, behind.A * (leg.jump * y)
                slope = 1 / (leg.row * before)[0, 0]
                S = leg.jump + (after - leg.jump * before) * leg.row * slope
                y, through = (leg.jump * y).mid(), (S * E * through).mid()
            through = (self.last.A * (self.begin + self.length - now)).exp() * through
            return mp.matrix([[self.sigma * from_ball(through[i, j]) for j in self.at] for i in self.at])

    def depth_and_speed(self, state, times, e, t):
        """delta and delta' of a stop at a time of a flight."""
        with mp.workdps(self.digits), precision():
            y, now = self.start(state), self.begin
            phase, t = self.last, to_ball(t)
            for leg, event in zip(self.legs, map(to_ball, times), strict=True):
                if t <= event:
                    phase = leg.phase
                    break
                y, now = (leg.jump * (leg.phase.A * (event - now)).exp() * y).mid(), event
            y = (phase.A * (t - now)).exp() * y
            return [from_ball((row * y)[0, 0]) for row in (self.phases.depth(e), self.phases.speed(e))]

    def multipliers(self, state, times):
        """By falling size."""
        with mp.workdps(self.digits):
            values = mp.eig(self.closure(state, times), left=False, right=False)
        return sorted(values, key=lambda value: (-abs(value), -value.imag))

    def image(self, state, times):
        """The state after the period, from one near a closed orbit's; times: of the events, nearly."""
        with mp.workdps(self.digits), precision():
            y, now = self.start(state), self.begin
            for leg, t in zip(self.legs, map(to_ball, times), strict=True):
                for _ in range(30):  # Newton's method for the time
                    there = (leg.phase.A * (t - now)).exp() * y
                    step = ((leg.row * there)[0, 0] / (leg.row * (leg.phase.A * there))[0, 0]).mid()
                    t = (t - step).mid()
                    if abs(step) < arb(10) ** (6 - self.digits):
                        break
                y, now = (leg.jump * (leg.phase.A * (t - now)).exp() * y).mid(), t
            y = (self.last.A * (self.begin + self.length - now)).exp() * y
            return [self.sigma * from_ball(y[place, 0]) for place in self.at]
