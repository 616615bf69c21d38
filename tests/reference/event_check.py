"""Events of a recorded orbit against the same orbit in many digits, in units of rounding.

The reference computes the orbit, and again with all numbers moved by one part in 2^53, up or down at random: the
largest change that this makes is the unit of errors. A few such moves may by accident do next to nothing; where errors
are beyond what is allowed, each number is moved alone, and the unit is the sum of what these do, which is the most that
rounding all of them can do. Nothing is compared from where rounding changes which events there are, or has moved a
number by more than a part of CHAOS.
"""

import math
from itertools import count
from typing import NamedTuple

import numpy as np
from mpmath import mp, mpf

from reference.events import simulate
from reference.machine import Machine

DIGITS = 50
ALLOWED = 10.0  # units
MOVES = 4
CHAOS = 1e-11  # of an event's time and speeds
TAIL = 1e-4  # before a rest: chatter is summed up, and lists may end earlier or later
AT_END = 1e-9  # of the time: events so near to the end of the orbit may lie on either side of it
KINDS = {  # what is compared of each kind of event
    "impact": ("t", "v", "x", "xdot"),
    "rest": ("t_on", "t_off"),
    "contact": ("t_touch", "t_release", "v_touch", "v_release", "max_penetration", "max_force"),
    "section": ("t", "x", "xdot"),
}
AFTER = {"impact": -1, "rest": -1, "contact": -1, "section": 1}  # sections at the end count
ENDS = {"impact": "t", "rest": "t_on", "contact": "t_release", "section": "t"}  # when it counts


class Recorded(NamedTuple):
    """An orbit as it was found: rows of the numbers in KINDS, and the sides of all but the sections."""

    sides: dict[str, list[int]]
    rows: dict[str, list[tuple]]
    end: float


class Findings(NamedTuple):
    """By (kind, number) the largest errors, in units, and as parts of the largest such number (of touches and releases
    of the time); checked: of each kind, how many were compared."""

    errors: dict[tuple[str, str], float]
    parts: dict[tuple[str, str], float]
    defects: list[str]
    checked: dict[str, int]
    grazes: int  # lists that end where rounding decides what is next


def errors(
    machine: Machine, state, found: Recorded, *, chaos=CHAOS, most=None, steps=math.inf, until, start_time=0.0
) -> Findings:
    """What is wrong with an orbit from `state`, of which at most so many events of a kind are compared.

    chaos: by which part of its time rounding may move an event; steps: of the reference, after which it gives up.
    """
    with mp.workdps(DIGITS):
        rng = np.random.default_rng(1)

        def orbit(machine, state, **more):
            return simulate(machine, state, digits=DIGITS - 20, start_time=start_time, until=until, **more)

        first = orbit(machine, state, steps=steps)
        exact = _recorded(machine, first, found.end, start_time)
        if first.given_up:
            times = [row[KINDS[kind].index(ENDS[kind])][0] for kind, rows in exact.rows.items() for row in rows]
            found = recorded_until(found, float(max(times, default=0)) * (1 + 2 * AT_END))
            exact = _recorded(machine, first, found.end, start_time)
        moves = (moved(machine, state, rng) for _ in range(MOVES))
        others = [_recorded(each, orbit(each, start), found.end, start_time) for each, start in moves]
        findings = compared(machine, found, exact, others, max, chaos, most)
        if max(findings.errors.values(), default=0.0) > ALLOWED:
            moves = moved_one_by_one(machine, state)
            others = [_recorded(each, orbit(each, start), found.end, start_time) for each, start in moves]
            findings = compared(machine, found, exact, others, sum, chaos, most)
        return findings


def compared(
    machine: Machine, found: Recorded, exact: Recorded, others: list[Recorded], together, chaos, most
) -> Findings:
    """together: of what the moves do, what is the unit."""
    result = Findings({}, {}, [], {}, 0)
    for kind, names in KINDS.items():
        rows, sides = _until_rests(found, kind)
        true, true_sides = _until_rests(exact, kind)
        moves = [_until_rests(other, kind) for other in others]
        floors = [_floors(machine, kind, row) for row in true]
        many = 0
        for i in range(max(len(rows), len(true))):
            if many == most:
                break
            doubtful = any(len(move) <= i < len(true) or i >= len(true) < len(move) for move, _ in moves)
            if doubtful or (i < len(true) and _is_chaotic(true[i], [move[i] for move, _ in moves], chaos)):
                result = result._replace(grazes=result.grazes + 1)
                break
            if i >= len(true) or i >= len(rows) or sides[i] != true_sides[i]:
                word = "invented" if i >= len(true) else "missed" if i >= len(rows) else "another side"
                result.defects.append(f"{kind} {i}: {word}")
                break
            for n, name in enumerate(names):
                effect = [_distance(move[i][n], true[i][n]) for move, _ in moves]
                unit = together(effect) + math.ulp(_size(true[i][n])) + floors[i][n]
                apart = _distance(rows[i][n], true[i][n])
                scale = [true[i]] if name in ("t_touch", "t_release") else true
                part = apart / max(_size(row[n]) for row in scale) if apart else 0.0
                for largest, error in ((result.errors, apart / unit), (result.parts, part)):
                    largest[kind, name] = max(float(error), largest.get((kind, name), 0.0))
            many += 1
        result.checked[kind] = many
    return result


def _recorded(machine, orbit, end, start_time) -> Recorded:
    """An orbit of events.py."""
    period = 2 * mp.pi / machine.omega
    first = mp.ceil(start_time / period)
    rows = {
        "impact": [((hit.t,), (hit.side * hit.v,), hit.y[0::2], hit.y[1::2]) for hit in orbit.impacts],
        "rest": [((rest.t_on,), (min(rest.t_off, end),)) for rest in orbit.rests],
        "contact": [tuple((getattr(one, name),) for name in KINDS["contact"]) for one in orbit.contacts],
        "section": [(((first + k) * period,), y[0::2], y[1::2]) for k, y in enumerate(orbit.section) if k],
    }
    sides = {"impact": [hit.side for hit in orbit.impacts], "rest": [rest.side for rest in orbit.rests]}
    sides |= {"contact": [one.side for one in orbit.contacts], "section": [0] * len(rows["section"])}
    return Recorded(sides, rows, end)


def recorded_until(found: Recorded, end: float) -> Recorded:
    """The same as recorded until an earlier end: rests that last longer are known until then, later ones not at all."""
    known = [i for i, ((on,), _) in enumerate(found.rows["rest"]) if on < end]
    rests = [((on,), (min(off, end),)) for (on,), (off,) in (found.rows["rest"][i] for i in known)]
    sides = found.sides | {"rest": [found.sides["rest"][i] for i in known]}
    return Recorded(sides, found.rows | {"rest": rests}, end)


def _until_rests(orbit: Recorded, kind):
    """(rows, sides) of a kind, without the impacts of the last moments before a rest and events about the end."""
    kept = []
    for i, (row, side) in enumerate(zip(orbit.rows[kind], orbit.sides[kind], strict=True)):
        if kind == "impact":
            onsets = [on for ((on,), _), s in zip(orbit.rows["rest"], orbit.sides["rest"], strict=True) if s == side]
            if any(0 < on - row[0][0] < TAIL for on in onsets):
                continue
        if row[KINDS[kind].index(ENDS[kind])][0] < orbit.end * (1 + AT_END * AFTER[kind]):
            kept.append(i)
    return [orbit.rows[kind][i] for i in kept], [orbit.sides[kind][i] for i in kept]


def _floors(machine, kind, row):
    """What one part in 2^53 of the clearance does to an impact: a gap of that size cannot be known better.

    Times of rests are known to as much of the period.
    """
    if kind != "impact":
        return [2.0**-53 * float(2 * mp.pi / machine.omega) * (kind == "rest")] * len(row)
    ((t,), (v,), x, xdot), (contact, *_) = row, machine.contacts
    places = [stop.place for stop in contact.stops]
    clearance = (max(places) - min(places)) / 2 if len(places) == 2 else abs(places[0])
    late = clearance * 2.0**-53 / abs(float(v))
    phase = machine.omega * float(t) + machine.tau
    pull = np.array(machine.constant) - np.dot(machine.K, _floats(x)) - np.dot(machine.C, _floats(xdot))
    for harmonic in machine.harmonics:
        pull = pull + np.sin(harmonic.order * phase) * np.array(harmonic.sine)
        pull = pull + np.cos(harmonic.order * phase) * np.array(harmonic.cosine)
    pull = np.linalg.solve(machine.M, pull)
    return [size * late for size in (1.0, abs(pull @ contact.normal), _size(xdot), _size(pull))]


def _floats(a):
    return [float(x) for x in a]


def _is_chaotic(true, moves, chaos) -> bool:
    return any(_distance(move[n], a) > chaos * max(1.0, _size(a)) for move in moves for n, a in enumerate(true))


def _distance(a, b):
    return max(abs((mpf(float(x)) if isinstance(x, float) else x) - y) for x, y in zip(a, b, strict=True))


def _size(a) -> float:
    return max(abs(float(x)) for x in a)


def moved(machine: Machine, state, rng):
    """All numbers moved by one part in 2^53, up or down; matrices stay symmetric."""
    part = mp.ldexp(1, -53)
    return _changed(machine, state, lambda a: mpf(a) * (1 + int(rng.choice([-1, 1])) * part))


def moved_one_by_one(machine: Machine, state):
    """As `moved`, one number that is not zero at a time."""
    numbers = []
    _changed(machine, state, lambda a: numbers.append(a) or a)
    for chosen in [place for place, a in enumerate(numbers) if a]:
        factors = (1 + mp.ldexp(int(place == chosen), -53) for place in count())
        yield _changed(machine, state, lambda a, factors=factors: mpf(a) * next(factors))


def _changed(machine, state, change):
    """The machine and the state, each of whose numbers is changed: matrices by their upper triangles."""

    def of(a):
        if a is None or isinstance(a, int):  # sides, orders, words
            return a
        if hasattr(a, "_fields"):
            return type(a)(*map(of, a))
        return type(a)(map(of, a)) if isinstance(a, list | tuple) else change(a)

    matrices = {}
    for name in "MKC":
        upper = {(i, j): change(a) for i, row in enumerate(getattr(machine, name)) for j, a in enumerate(row) if j >= i}
        N = machine.masses
        matrices[name] = [[upper[min(i, j), max(i, j)] for j in range(N)] for i in range(N)]
    rest = {name: of(a) for name, a in machine._asdict().items() if name not in matrices}
    other = Machine(**matrices, **rest)
    return other, _on_stops(machine, state, other, [change(x) for x in state])


def _on_stops(machine, state, other, moved):
    """A start on a stop is on the moved stop."""
    for contact, new in zip(machine.contacts, other.contacts, strict=True):
        for stop, place in zip(contact.stops, (stop.place for stop in new.stops), strict=True):
            if mp.fdot(map(mpf, contact.normal), map(mpf, state[0::2])) == stop.place:
                off = (place - mp.fdot(new.normal, moved[0::2])) / mp.fdot(new.normal, new.normal)
                for i, a in enumerate(new.normal):
                    moved[2 * i] += a * off
    return moved
