"""A machine as the references see it: masses, springs, dampers, forces, lists of contacts and of dry friction.

    M x'' + C x' + K x = constant + sum over harmonics h of (sine_h sin(h phi) + cosine_h cos(h phi))
                         + impulses and forces of the contacts + friction forces,      phi = omega t + tau

All numbers count as exact. `machine_of` makes this record of the package's `system.linear`, and is the only place in
the references that knows the names there.
"""

import math
from collections.abc import Sequence
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from mpmath import mpf


class Stop(NamedTuple):
    """A stop, which the gap g = normal . x does not pass: side (g - place) <= 0.

    Rigid: with a coefficient of restitution R. Compliant (R is None): at the depth delta = side (g - place) the force
    k delta + c delta' + p acts on the gap, away from the stop, until delta = 0, or (by_force) until it is zero.
    """

    side: int
    place: float
    R: float | None = None
    k: float = 0.0
    c: float = 0.0
    p: float = 0.0
    by_force: bool = False

    @property
    def relaxes(self) -> bool:
        """Whether the stop comes back slowly after a contact."""
        return self.R is None and self.by_force and self.c > 0


class Contact(NamedTuple):
    normal: Sequence[float]
    stops: tuple[Stop, ...]  # the right one (side +1) before the left one


class Friction(NamedTuple):
    """Dry friction between the masses and a belt: w = direction . x' - belt_speed is the velocity of the slip."""

    direction: Sequence[float]
    friction_force: float
    static_force: float
    belt_speed: float = 0.0


class Harmonic(NamedTuple):
    order: int
    sine: Sequence[float]
    cosine: Sequence[float]


class Machine(NamedTuple):
    M: Sequence[Sequence[float]]
    K: Sequence[Sequence[float]]
    C: Sequence[Sequence[float]]
    constant: Sequence[float]
    harmonics: tuple[Harmonic, ...] = ()
    omega: float = 1.0  # without harmonics: a clock
    tau: float = 0.0
    contacts: tuple[Contact, ...] = ()
    friction: tuple[Friction, ...] = ()

    @property
    def masses(self) -> int:
        return len(self.M)


class Element(NamedTuple):
    """What acts on the masses by itself: a stop of a contact, or a friction element; `number` counts from 1."""

    number: int
    row: list  # of delta' = row . x' of a stop, of w = row . x' - belt_speed of friction; the force acts along -row
    law: Stop | Friction

    @property
    def rigid(self) -> bool:
        return isinstance(self.law, Stop) and self.law.R is not None

    @property
    def compliant(self) -> bool:
        return isinstance(self.law, Stop) and self.law.R is None

    @property
    def rubs(self) -> bool:
        return isinstance(self.law, Friction)


def elements_of(machine: Machine) -> list[Element]:
    """In the order in which they have their turn at one instant: contacts by number, then friction."""
    stops = [
        Element(i, [stop.side * a for a in contact.normal], stop)
        for i, contact in enumerate(machine.contacts, 1)
        for stop in contact.stops
    ]
    return stops + [Element(i, list(friction.direction), friction) for i, friction in enumerate(machine.friction, 1)]


def machine_of(linear) -> Machine:
    """The machine of a `vs.types.Linear`, or of anything with the same names."""
    rows = {name: [list(row) for row in getattr(linear, name)] for name in "MKC"}
    return Machine(
        **rows,
        constant=list(linear.constant),
        harmonics=(Harmonic(1, list(linear.sine), list(linear.cosine)),),
        omega=linear.omega,
        tau=linear.tau,
        contacts=tuple(Contact(list(one.normal), stops_of(one)) for one in linear.contacts),
    )


def stops_of(contact) -> tuple[Stop, ...]:
    """The stops of a `vs.types.LinearContact`, or of anything with the same names."""
    stops = []
    for side, end in ((1, "high"), (-1, "low")):
        place, R, k, c, p = (getattr(contact, f"{name}{end}", 0.0) for name in ("", "R_", "k_", "c_", "p_"))
        if not math.isinf(place):
            law = {"k": k, "c": c, "p": p, "by_force": bool(contact.by_force)} if k > 0 else {"R": R}
            stops.append(Stop(side, place, **law))
    return tuple(stops)


def mapped(function, *linears):
    """A `vs.types.Linear` with other numbers: `function(name, ...)` of those of these, those of its contacts too."""

    def of(*records):
        names = [name for name in records[0]._fields if name != "contacts"]
        return SimpleNamespace(**{name: function(name, *(getattr(one, name) for one in records)) for name in names})

    result = of(*linears)
    return with_contacts(result, [of(*each) for each in zip(*(one.contacts for one in linears), strict=True)])


def with_contacts(numbers, contacts):
    """Numbers of an oscillator with these contacts, by the names of a `vs.types.Linear`."""
    numbers.contacts, numbers.contact, numbers.masses = contacts, contacts[0], len(numbers.M)
    return numbers


def moved(linear, slopes, changes):
    """A `vs.types.Linear`, moved by these changes along its derivatives: exact to their squares."""

    def of(name, value, *slopes_of_it):
        terms = [(mpf(d), slope) for d, slope in zip(changes, slopes_of_it, strict=True)]
        if name == "by_force":
            return bool(value)
        if isinstance(value, np.ndarray) and value.ndim:
            return value.astype(object) + sum(d * slope.astype(object) for d, slope in terms)
        return mpf(float(value)) + sum((d * mpf(float(slope)) for d, slope in terms if slope), mpf(0))

    return mapped(of, linear, *slopes)
