"""Orbits with several contacts and friction: the one door to the engine's loop for them, which has no name."""

from typing import NamedTuple

import numpy as np
from reference import machine as reference

from vibro_sweep.engine.elements.element_machine import CELLS, Friction, Stop, machine_of, stops_of
from vibro_sweep.engine.elements.follow import ElementOrbit

KINDS = ("impact", "touch", "release", "rest", "leave", "stick", "slip")


class Event(NamedTuple):
    """As in `reference.events`: side of a slip its direction, of a stick 0; y (2 N,) before it."""

    kind: str
    element: int
    side: int
    t: float
    v: float
    y: np.ndarray


class Orbit(NamedTuple):
    status: int
    events: list[Event]
    end: np.ndarray  # (2 N,)
    z: np.ndarray  # (states,) y, y', s
    section: np.ndarray  # (periods, states)


def element_of(element: reference.Element):
    law, normal = element.law, [float(a) for a in element.row]
    if element.rubs:
        return Friction(element.number, normal, *map(float, law[1:]))
    R = np.nan if law.R is None else float(law.R)
    normal = [law.side * a for a in normal]
    return Stop(element.number, normal, law.side, float(law.place), R, *map(float, law[3:6]), law.by_force)


def engine_machine(machine: reference.Machine):
    """The machine of the references, as the engine has it."""
    harmonics = [(int(order), floats(sine), floats(cosine)) for order, sine, cosine in machine.harmonics]
    matrices = [np.array([floats(row) for row in matrix]) for matrix in (machine.M, machine.K, machine.C)]
    elements = [element_of(element) for element in reference.elements_of(machine)]
    numbers = floats(machine.constant), harmonics, float(machine.omega), float(machine.tau)
    return machine_of(*matrices, *numbers, elements), elements


def floats(row):
    return [float(a) for a in row]


def machine_of_system(system):
    """The machine of an oscillator of the package, with any number of contacts."""
    q = system._family.built
    tau, stops = system.phase if q.tau is None else q.tau, stops_of(q.contacts)
    return machine_of(q.M, q.K, q.C, q.constant, [(1, q.sine, q.cosine)], q.omega, tau, stops), stops


def orbit_of(made, state, until, *, start=0.0, events=1000, vectors=None, periods=0) -> Orbit:
    """The orbit of `engine_machine` from this state of the masses on. vectors: (states, n), by (y, y', s)."""
    machine, elements = made
    orbit = ElementOrbit(machine, floats(state), start, events)
    status, period = orbit.follow(until, vectors, periods), CELLS * machine.width[0]
    found = []
    for kind, e, side, n, t, v, *y in orbit.events:
        element = elements[int(e)]
        side = element.side if isinstance(element, Stop) else int(side)
        y = np.stack([machine.back @ np.array(half) for half in (y[: len(y) // 2], y[len(y) // 2 :])], -1).reshape(-1)
        found.append(Event(KINDS[int(kind)], element.number, side, n * period + t, v, y))
    return Orbit(status, found, orbit.state, orbit.orbit.z + orbit.orbit.z_low, orbit.sections)
