"""Impacts and contacts of orbits and simulations in order, and orbits found anew from them."""

from typing import NamedTuple

import vibro_sweep as vs


class Event(NamedTuple):
    begin: float
    end: float  # of an impact as it begins
    side: int
    speed: float  # with which it begins
    kind: str  # impact, contact, or rest: after an impact with R = 0


def events_of(motion) -> list[Event]:
    """Impacts, rests and contacts of an orbit or a simulation, in order."""
    rests = {one["t_on"]: one["t_off"] for one in motion.sticking}
    impacts = [
        Event(t, rests.get(t, t), side, v, "rest" if t in rests else "impact")
        for t, side, v in motion.impacts[["t", "side", "v1"]].tolist()
    ]
    contacts = [Event(*one, "contact") for one in motion.contacts[["t_touch", "t_release", "side", "v_touch"]].tolist()]
    return sorted(impacts + contacts)


def found_from(events: list[Event], system, periods: int):
    """The orbit near these events, by Newton's method."""
    if not events:
        return vs.periodic_orbit(system, itinerary="")
    guess = [(event.begin, event.side, event.speed) for event in events]
    return vs.periodic_orbit(system, guess=guess, periods=periods)


def anew(orbit, system=None):
    """The orbit found again from its own events, or the one near them of another system."""
    return found_from(events_of(orbit), system or orbit.system, orbit.period)


def between(one: list[Event], other: list[Event], share: float) -> list[Event]:
    """Events at a share of the way from those of one orbit to those of another."""
    return [
        Event(
            *((1 - share) * a + share * b for a, b in zip(x[:2], y[:2], strict=True)),
            x.side,
            (1 - share) * x.speed + share * y.speed,
            x.kind,
        )
        for x, y in zip(one, other, strict=True)
    ]
