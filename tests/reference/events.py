"""The simulator of a machine in many digits: flights between events, each event a proven root.

It works in the coordinates of the masses and shares no formula with the package. What happens at an event is in
instants.py.
"""

import math
from itertools import pairwise
from typing import NamedTuple

from flint import arb, arb_mat, arb_poly
from mpmath import mp, mpf

from reference.balls import falling_root, from_ball, precision, to_ball
from reference.flow import FREE, PRESSED, Phases
from reference.instants import Instant, order_and_sign

FADED = mpf(10) ** -45  # part of where it began, at which a stop without preload has relaxed
NARROW = arb((1, -90))
PIECES = 8  # of a step, in each of which a depth turns back once at most


class Event(NamedTuple):
    """kind: impact, touch, release, rest, leave (of a stop); stick, slip (of friction).

    side: of the stop; of a slip its direction; of a stick 0. v: delta' just before an impact or a touch and at a
    release; else 0. y: the state of the masses before the event.
    """

    kind: str
    element: int
    side: int
    t: mpf
    v: mpf
    y: list


class Rest(NamedTuple):
    """A rest on a stop; `t_off` is the end of the orbit where it still goes on then."""

    t_on: mpf
    t_off: mpf
    side: int
    element: int


class EndedContact(NamedTuple):
    """A contact with a compliant stop that has ended."""

    t_touch: mpf
    t_release: mpf
    side: int
    v_touch: mpf
    v_release: mpf
    max_penetration: mpf
    max_force: mpf
    element: int


class Orbit(NamedTuple):
    events: list[Event]
    rests: list[Rest]
    contacts: list[EndedContact]
    section: list[list]  # states of the masses at t = 0 mod T
    places: list[tuple]  # at the sections: s of each compliant stop that relaxes, in the order of the elements
    end: list  # the state of the masses at the end
    taken: mpf  # the energy that stops have taken from the masses
    given_up: bool  # the steps that were allowed did not reach the end

    @property
    def impacts(self) -> list[Event]:
        return [event for event in self.events if event.kind == "impact"]


def simulate(
    machine, state, periods=None, events=None, *, impacts=None, contacts=None, until=None, start_time=0, digits=30,
    resolution=None, places=(), steps=math.inf,
) -> Orbit:  # fmt: skip
    """The orbit from `state` (x1, v1, ..) on, until the first of what is said: over so many periods, until a time, or
    until so many events, impacts, or contacts that have ended; for so many steps at most.

    resolution: what is told apart, as a part: times, speeds and loads that differ by less are the same; 10^-digits
    if it is left out; numbers that are rounded to doubles may need 2^-50. places: those of `Orbit.places`, from
    where stops relax at the start.
    """
    if all(stop is None for stop in (periods, events, impacts, contacts, until)):
        raise ValueError("say when to stop: periods, events, impacts, contacts or until")
    with mp.workdps(digits + 20), precision():
        small = to_ball(mpf(10) ** -digits if resolution is None else mpf(resolution))
        motion = Motion(machine, state, start_time, small, places)
        period = (2 * arb.pi() / to_ball(machine.omega)).mid()
        ends = [arb.pos_inf()] if until is None else [to_ball(until)]
        if periods is not None:
            ends.append((motion.t + to_ball(periods) * period).mid())
        limits = {"events": events, "contacts": contacts, "impacts": impacts}
        return motion.go(min(ends), period, {name: n for name, n in limits.items() if n is not None}, steps)


class Motion:
    """One orbit, and what is recorded of it."""

    def __init__(self, machine, state, start_time, small, places):
        self.phases, self.t, self.small = Phases(machine), to_ball(start_time), small
        angle, angles = to_ball(machine.omega) * self.t + to_ball(machine.tau), []
        for harmonic in machine.harmonics:
            angles += (harmonic.order * angle).sin().mid(), (harmonic.order * angle).cos().mid()
        later = [to_ball(s) for s in places or [0] * len(self.phases.place_of_s)]
        self.y = arb_mat(self.phases.size, 1, [*map(to_ball, state), *angles, arb(1), *later])
        self.began = {
            e: s for e, s in zip(self.phases.place_of_s, later, strict=True) if s > 0
        }  # from where stops relax
        self.touched, self.peaks, self.rest_since = {}, {}, {}
        self.events, self.rests, self.contacts, self.section, self.places = [], [], [], [], []
        self.taken, self.started = arb(0), False
        self.decided = set()  # elements of the last event, whose guards may begin with a zero
        self.fastest = arb(0)  # speed of a mass so far, by samples
        self.modes = None

    def value(self, row):
        return (row * self.y)[0, 0].mid()

    def masses(self, y=None):
        return [from_ball(a) for a in (self.y if y is None else y).entries()[: 2 * self.phases.N]]

    def log(self, kind, e, side, v=0, t=None):
        t = from_ball(self.t) if t is None else t
        number = self.phases.elements[e].number
        self.events.append(Event(kind, number, side, t, from_ball(arb(v)), self.masses()))

    def go(self, end, period, limits, steps):
        self.section_count = int((self.t / period - self.small).mid().ceil().unique_fmpz() or 0)
        Instant(self).start(limits)
        count = 0
        while self.t < end and not self.enough(limits) and count < steps:
            count += 1
            phase = self.faded()
            part, hit = self.next_event(phase)
            u = part * phase.flow.h
            last = (end - self.t).mid()
            if u > last:
                u, hit = last, None
            self.keep_sections(phase.flow, u, period)
            self.keep_contacts(phase, (u / phase.flow.h).mid())
            self.fastest = max(self.fastest, arb(phase.flow.fastest(self.y, float(u / phase.flow.h))))
            self.y, self.t = phase.flow.at(self.y, u), (self.t + u).mid()
            self.decided = set()
            if hit is not None:
                Instant(self).happen(hit, limits)
        for e, t in self.rest_since.items():
            self.end_rest(e, t)
        given_up = count >= steps
        records = self.events, self.rests, self.contacts, self.section, self.places
        return Orbit(*records, self.masses(), from_ball(self.taken), given_up)

    def enough(self, limits):
        impacts = sum(event.kind == "impact" for event in self.events) if "impacts" in limits else 0
        counts = {"events": len(self.events), "contacts": len(self.contacts), "impacts": impacts}
        return any(counts[name] >= n for name, n in limits.items())

    def faded(self):
        """The phase; a stop without preload has relaxed where next to nothing is left of s."""
        for e, began in list(self.began.items()):
            if self.phases.elements[e].law.p == 0 and self.y[self.phases.place_of_s[e], 0] < to_ball(FADED) * began:
                self.forget(e)
                self.modes = (*self.modes[:e], FREE, *self.modes[e + 1 :])
        return self.phases.phase(self.modes)

    def next_event(self, phase):
        """(part of a step, guard): what comes first, or the end of a step and None."""
        first, hit = arb(1), None
        near = set(phase.flow.near(self.y)) | {name for name in phase.flow.names if name[1] in self.decided}
        for name in sorted(near, key=lambda name: (name[1], name[0])):
            c, sizes = phase.flow.series(name, self.y)
            zeros = self.zeros(name, c, sizes) if name[1] in self.decided else 0
            order, _ = order_and_sign(c, sizes, self.small, zeros)
            if order is None:
                continue  # zero throughout: held by others
            root = falling_root(c, order if name[1] in self.decided else 0, NARROW)
            if root is not None and root < first:
                first, hit = root, name
        return first, hit

    def zeros(self, name, c, sizes):
        """How many coefficients are zero because of what has been decided, whatever rounding has left there."""
        return 1 if abs(float(c[0])) <= 16 * float(self.small) * max(1.0, abs(float(self.t))) * sizes.sum() else 0

    def keep_sections(self, flow, u, period):
        """Those from now to the time u after."""
        while (at := (self.section_count * period).mid()) <= (self.t + u).mid():
            there = flow.at(self.y, (at - self.t).mid())
            self.section.append(self.masses(there))
            self.places.append(tuple(from_ball(there[n, 0]) for n in self.phases.place_of_s.values()))
            self.section_count += 1

    def keep_contacts(self, phase, part):
        """Peaks of depth and force of the pressed stops within this part of a step, and the work that they do."""
        for e, mode in enumerate(self.modes):
            if mode == PRESSED:
                depth, force, speed = (
                    phase.flow.series((name, e), self.y, row(e))[0]
                    for name, row in (
                        ("depth", self.phases.depth), ("push", self.phases.force), ("speed", self.phases.speed)
                    )
                )  # fmt: skip
                peaks = [largest_within(c, part) for c in (depth, force)]
                self.peaks[e] = [max(pair) for pair in zip(self.peaks[e], peaks, strict=True)]
                self.taken += phase.flow.h * (arb_poly(force) * arb_poly(speed)).integral()(part).mid()

    def press(self, e):
        self.forget(e)
        v = self.value(self.phases.speed(e))
        self.log("touch", e, self.phases.elements[e].law.side, v)
        self.touched[e] = (self.t, v)
        self.peaks[e] = [self.value(row) for row in (self.phases.depth(e), self.phases.force(e))]

    def release(self, e):
        v, side, number = (
            self.value(self.phases.speed(e)),
            self.phases.elements[e].law.side,
            self.phases.elements[e].number,
        )
        self.log("release", e, side, v)
        t, v_touch = self.touched.pop(e)
        t_touch, t_release, v_touch, v_release, depth, force = map(
            from_ball, (t, self.t, v_touch, v, *self.peaks.pop(e))
        )
        self.contacts.append(EndedContact(t_touch, t_release, side, v_touch, v_release, depth, force, number))

    def relax(self, e):
        """The stop relaxes from where it is."""
        self.began[e] = self.value(self.phases.depth(e))
        self.set_s(e, self.began[e])

    def forget(self, e):
        """The stop is relaxed, or pressed again."""
        if self.began.pop(e, None) is not None:
            self.set_s(e, arb(0))

    def set_s(self, e, s):
        y = self.y.entries()
        y[self.phases.place_of_s[e]] = s
        self.y = arb_mat(self.phases.size, 1, y)

    def end_rest(self, e, t_on):
        element = self.phases.elements[e]
        self.rests.append(Rest(t_on, from_ball(self.t), element.law.side, element.number))


def largest_within(c, u):
    """The largest value of a polynomial in [0, u], u <= 1; in each of its pieces it turns back once at most."""
    f, sizes = arb_poly(c), [n * abs(float(a)) for n, a in enumerate(c)]
    values = [c[0], f(u).mid()]
    if sizes[1] < 1.000001 * sum(sizes[2:]):
        slope, edges = f.derivative(), [(u * n / PIECES).mid() for n in range(PIECES + 1)]
        for low, high in pairwise(edges):
            if slope(low) > 0 and slope(high) < 0:
                piece = slope(arb_poly([low, high - low])).coeffs()
                values.append(f(low + (high - low) * falling_root([a.mid() for a in piece], 0, NARROW)).mid())
    return max(values)
