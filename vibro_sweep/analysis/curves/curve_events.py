"""Points of codimension two between two points of a bifurcation curve: their names, and where they are."""

import math

import numpy as np

from vibro_sweep.analysis.continuation.events import Event, LocatedEvent
from vibro_sweep.analysis.continuation.first_point import first_place
from vibro_sweep.analysis.continuation.secant import error_of, root
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.continuation.starting_orbit import CONDITIONS, StartingOrbit
from vibro_sweep.analysis.curves.crossed import aside, crossed, is_lost, is_on_other
from vibro_sweep.analysis.periodic.contact_numbers import has_corner, is_smooth
from vibro_sweep.engine.continuation.curve_tests import TOUCHING
from vibro_sweep.engine.continuation.problem import FOLD, GRAZE, TORUS
from vibro_sweep.engine.continuation.workspace import CURVE_TESTS, NAMES, TEST, THETA, Place
from vibro_sweep.tables.bifurcations import CODIMENSION_TWO

# (kind of curve, what changes its sign) -> types, by the sigma of their orbits; angles of a pair
ENDS_OF_CONTACTS = {"split": TEST.hold, "unrelaxed": TEST.relaxed}  # where a curve ends
VANISHES, TOUCHES = "vanishes", "touches"


def _types() -> dict[tuple, dict[int, str]]:
    found: dict[tuple, dict[int, str]] = {}
    for one in CODIMENSION_TWO:
        for condition, test in one.tests:
            at = test if test in (VANISHES, TOUCHES) else NAMES.index(test)
            found.setdefault((CONDITIONS[condition], at), {})[one.sigma] = one.name
    return found


TYPES = _types()
ANGLES = {one.name: 2 * math.pi * one.turn for one in CODIMENSION_TWO if one.turn}
ROUNDING = 1e-10  # of the bounds: points nearer to each other are one
PIECE = 0.02  # of the distance between two events
VANISHED = 1e-12  # of a test: more than rounding leaves of it at a zero
SLOW = 1e-6  # in units of the curve: an impulse next to which rounding of the multipliers is too large
SHORT = 1e-6  # length, in phase, of a contact next to which rounding of a critical orbit is too large
BEYOND = 0.5  # of a step: so far beyond its ends, on the straight line, it may reach where it turns
SETTLED = 1e-10  # Newton's last change
REACH = (0.25, 0.5, 1.0, 2.0, 4.0)
SAME = 1e-3  # of a step: a stop_distance that vanishes with an impact does so like the square of its speed


def events_between(curve: SolutionCurve, a: Place, b: Place) -> list[Event]:
    """The events whose tests change sign from a to b."""
    kind, events = curve.problem.kind, []
    for i in CURVE_TESTS:
        if np.sign(a.tests[i]) * np.sign(b.tests[i]) < 0:
            size = max(abs(a.tests[i]), abs(b.tests[i]))
            events.append(Event(type_at(curve, i), lambda place, i=i, size=size: place.tests[i] / size, i))
    for i in range(curve.K):
        changes = a.jumps[i] * b.jumps[i] < 0 and max(abs(a.jumps[i]), abs(b.jumps[i])) > VANISHED  # else it never was
        if changes and not (kind >= GRAZE and i == curve.problem.index):
            stop = curve.orbit.family.linear, int(curve.problem.sides[i])
            smooth = is_smooth(*stop) and not has_corner(*stop)  # multipliers are those without it
            name = type_at(curve, TOUCHES if smooth else VANISHES)
            events.append(Event(name, lambda place, i=i: place.jumps[i], impact=i))
    least, most = sorted(place.tests[TEST.stop_distance] for place in (a, b))
    if least < -TOUCHING and most > TOUCHING:
        name = type_at(curve, TOUCHES)
        events.append(Event(name, lambda place: min(place.tests[TEST.stop_distance], 1.0), touches=True))
    for name, i in ENDS_OF_CONTACTS.items():
        if min(a.tests[i], b.tests[i]) <= 0 < max(a.tests[i], b.tests[i]):
            events.append(Event(name, lambda place, i=i: min(place.tests[i], 1.0), touches=True))
    if kind == TORUS:
        for name, angle in ANGLES.items():
            if (a.p[THETA] - angle) * (b.p[THETA] - angle) < 0:
                events.append(Event(name, lambda place, angle=angle: place.p[THETA] - angle))
    return [event for event in events if event.type]


def found_between(curve: SolutionCurve, a: Place, b: Place) -> list[LocatedEvent]:
    """All events from a to b, located.

    Of several in one step two may hide each other: a test has a pole where an impact vanishes, or passes zero twice. So
    the pieces of the step beside each event are looked at as well.
    """
    found = without_echoes(curve, _located(curve, a, b))
    gone = [one.event.impact for one in found if one.event.impact is not None]
    if (len(found) < 2 and not gone) or any(is_divided(curve, i) for i in gone):  # tests have no poles there
        return found
    known = {0.0: a, 1.0: b} | {one.share: one.place for one in found}
    shares = np.unique(list(known))
    apart = PIECE * np.diff(shares).min()
    beside_each = [(share, sign * apart) for share in shares[1:-1].tolist() for sign in (-1, 1)]
    cuts = [0.0, *(share + apart for share, apart in beside_each), 1.0]
    places = [a, *(aside(curve, a, b, known[share], apart, gone) for share, apart in beside_each), b]
    if any(place is None for place in places):
        return found
    result = []
    for i in range(len(cuts) - 1):
        for one in _located(curve, places[i], places[i + 1]):
            result.append(one._replace(share=cuts[i] + one.share * (cuts[i + 1] - cuts[i])))
    # an impulse has no pole: where a piece is too short to locate its zero, that of the whole step holds
    seen = [one.event.impact for one in result]
    return result + [one for one in found if one.event.impact is not None and one.event.impact not in seen]


def found_to_edge(curve: SolutionCurve, a: Place, b: Place) -> list[LocatedEvent]:
    """All events from a, which is real, to the one after which the orbit is not a motion any more, which is the last
    one.

    Where an impact vanishes, other tests have poles and the motion behind passes the stop: so what lies before it is
    looked at by itself. Empty where the end cannot be located.
    """
    events = events_between(curve, a, b)
    edges = [one for one in events if one.impact is not None] or [one for one in events if one.touches]
    ends = [found for event in edges if (found := locate(curve, event, a, b)) is not None]
    if not ends:
        return []
    end = min(ends, key=lambda one: one.share)
    share = (1 - PIECE) * end.share
    gone = [] if end.event.impact is None else [end.event.impact]
    if any(is_divided(curve, i) for i in gone):
        guess = curve.between(a, end.place, 1 - PIECE)
        before = curve.correct(guess, curve.unit_row(curve.difference(a, end.place)))
    else:
        before = aside(curve, a, b, end.place, share - end.share, gone)
    if before is None:
        return [end]
    return [*(one._replace(share=one.share * share) for one in found_between(curve, a, before)), end]


def _located(curve: SolutionCurve, a: Place, b: Place) -> list[LocatedEvent]:
    found: list[LocatedEvent] = []
    for event in sorted(events_between(curve, a, b), key=lambda event: event.touches):
        flight = event.touches and event.type not in ENDS_OF_CONTACTS
        if not (flight and any(_passes_behind(curve, one) for one in found)):
            found += [one for one in [locate(curve, event, a, b)] if one is not None]
    return found


def _passes_behind(curve: SolutionCurve, one: LocatedEvent) -> bool:
    """Whether this is a contact that vanishes, behind which the motion passes the stop, and no other flight does."""
    impact = one.event.impact
    return impact is not None and is_divided(curve, impact) and one.place.tests[TEST.stop_distance] > 0


def without_echoes(curve: SolutionCurve, found: list[LocatedEvent]) -> list[LocatedEvent]:
    """The events in order, each place once.

    Where an impact vanishes, the motion behind passes the stop, which looks like another graze there; and with one mass
    M(mu) is singular for all mu at a resonant graze.
    """
    gone = [one for one in found if one.event.impact is not None]
    kept: list[LocatedEvent] = []
    for one in sorted(found, key=lambda one: (one.event.impact is None, one.share)):
        echo = one.event.impact is None and any(echoes(curve, one, other) for other in gone)
        if not echo and not any(one.event.type == other.event.type and same(curve, one, other) for other in kept):
            kept.append(one)
    return sorted(kept, key=lambda one: one.share)


def echoes(curve: SolutionCurve, one: LocatedEvent, other: LocatedEvent) -> bool:
    return same(curve, one, other) or (one.event.index is None and abs(one.share - other.share) < SAME)


def same(curve: SolutionCurve, one: LocatedEvent, other: LocatedEvent) -> bool:
    """Whether two points are one, to rounding."""
    return lies_at(curve, one, other.place, other.error)


def lies_at(curve: SolutionCurve, one: LocatedEvent, place: Place, error: float = 0.0) -> bool:
    """Whether a point is this place, to rounding."""
    apart = np.abs(one.place.p - place.p)[:2] - one.error - error
    return bool(np.all(apart <= ROUNDING * np.ptp(curve.bounds, axis=1)))


def beside(curve: SolutionCurve, a: Place, b: Place, one: LocatedEvent, found: list[LocatedEvent]) -> list[Place]:
    """A point on either side of one of those found from a to b, with no other place between at which the orbit may
    begin or cease to be real."""
    edges = [other.share for other in found if other.event.index is None and abs(other.share - one.share) > SAME]
    near = max((share for share in edges if share < one.share), default=None)
    far = min((share for share in edges if share > one.share), default=None)
    row, places = curve.unit_row(curve.difference(a, b)), []
    for end, share in ((a, near), (b, far)):
        middle = None if share is None else curve.between(a, b, (share + one.share) / 2)
        places.append((middle and curve.correct(middle, row)) or end)
    return places


def type_at(curve: SolutionCurve, test: int | str) -> str:
    """The type at which this changes its sign along the curve; "" where there is none for its orbits."""
    types = TYPES[curve.problem.kind, test]
    return types.get(0) or types.get(int(curve.problem.sigma), "")


def locate(curve: SolutionCurve, event: Event, a: Place, b: Place) -> LocatedEvent | None:
    """None where the test does not vanish between a and b, or at a place that is singular for Newton's method.

    A test may change its sign at a pole as well, where an impact vanishes.

    The error (`error_of`) is an estimate from several locations and from what rounding of the equations does.
    """
    if event.impact is not None and is_divided(curve, event.impact):
        on_both = curve.problem.kind == TORUS and crossed(curve, a, b, event.impact)
        return _along_grazes(curve, event, a, b) or (LocatedEvent(event, *on_both) if on_both else None)
    found = root(curve, a, b, event.test)
    settled = found is not None and found[1].tests[TEST.residual] <= SETTLED
    if event.impact is not None:
        settled = settled and not is_on_other(curve, a, b, found[1], event.impact)
        if not settled or is_lost(curve, a, b, found[1]):
            at_crossing = crossed(curve, a, b, event.impact)
            if at_crossing is not None:
                return LocatedEvent(event, *at_crossing)
    if not settled:
        return None
    share, place = found
    if event.index is not None:
        at, *ends = (abs(float(one.tests[event.index])) for one in (place, a, b))
        if at > max(0.5 * min(ends), VANISHED) or not is_sharp(curve, event, place):
            return None
    error = error_of(curve, a, b, event.test, share, place)
    if error is None or (event.index is not None and error > np.abs(b.p - a.p)[:2].max()):  # rounding, all along
        return None
    return LocatedEvent(event, share, place, error)


def is_divided(curve: SolutionCurve, impact: int) -> bool:
    """Whether the condition of a critical orbit is divided by the length of this contact: rounding is, too."""
    return FOLD <= curve.problem.kind <= TORUS and _is_smooth(curve, impact)


def _is_smooth(curve: SolutionCurve, impact: int) -> bool:
    return is_smooth(curve.orbit.family.linear, int(curve.problem.sides[impact]))


def _along_grazes(curve: SolutionCurve, event: Event, a: Place, b: Place) -> LocatedEvent | None:
    """The place between a and b at which a contact vanishes, on the curve of its grazes."""
    before, behind = a.jumps[event.impact], b.jumps[event.impact]
    aim, length = curve.between(a, b, before / (before - behind)), curve.distance(a, b)
    found = on_grazes(curve, event.impact, aim, (length,))
    if found is None or found.event.type != event.type:
        return None
    share = float(curve.unit_row(curve.difference(a, b)) @ curve.difference(a, found.place)) / length
    if abs(share - 0.5) > 0.5 + BEYOND:
        return None
    return LocatedEvent(event, min(max(share, 0.0), 1.0), found.place, found.error)


def on_grazes(curve: SolutionCurve, impact: int, aim: Place, lengths) -> LocatedEvent | None:
    """The event at which the curve of critical orbits meets that of the grazes of this contact, near a place; located
    along the latter, where nothing is divided by the contact's length."""
    aim = curve.copied(aim)
    aim.jumps[impact] = 0.0
    types = [kind for kind in (type_at(curve, TOUCHES), type_at(curve, VANISHES)) if kind]
    other = SolutionCurve(StartingOrbit("graze", curve.solution(aim), index=impact), curve.names, curve.bounds)
    first = first_place(other)
    for length in lengths if first is not None else ():
        found = event_near(other, first, length, types)
        if found is not None:
            units = other.state_units / curve.state_units
            aim.x[:], aim.p[:2] = found.place.x, found.place.p[:2]
            aim.x[:, : curve.n] *= units
            aim.jumps[~curve.problem.rests] *= units[-1]
            aim.tests[TEST.residual] = found.place.tests[TEST.residual]
            aim.tests[TEST.stop_distance] = found.place.tests[TEST.stop_distance] * units[0]
            return found._replace(place=aim)
    return None


def is_sharp(curve: SolutionCurve, event: Event, place: Place) -> bool:
    """Whether rounding leaves a test its sign: that of multipliers has a pole where another impact vanishes, all are
    divided by the length of a contact on curves of critical orbits, and have it as a factor on those of grazes."""
    least = np.abs(place.jumps)
    if curve.problem.kind == GRAZE:
        least[curve.problem.index] = np.inf
    shortest = SHORT if FOLD <= curve.problem.kind <= TORUS else VANISHED
    lost = any(_is_smooth(curve, int(i)) for i in np.flatnonzero(least < shortest))
    return not lost and (event.index != TEST.pair or not np.any(least < SLOW))


def event_near(curve: SolutionCurve, place: Place, length: float, types) -> LocatedEvent | None:
    """The first event of these types on the curve on either side of `place`, a few times `length` away at most."""
    for factor in REACH:
        ends = [curve.step(place, sign * factor * length) for sign in (-1, 1)]
        if ends[0] is None or ends[1] is None:
            continue
        for event in events_between(curve, ends[0], ends[1]):
            found = locate(curve, event, *ends) if event.type in types else None
            if found is not None:
                return found
    return None
