"""One orbit, from phase to phase: the series from here on, the first end of the phase, and what happens there.

This is the motion of `motion/crossing.py` with any number of elements. Eight orbits at once, nodes of a period and the
exclusion test belong to machines with one contact: here every phase is followed series by series.
"""

import math

import numpy as np

from vibro_sweep.engine.elements.element_machine import BY_FORCE, CELLS, RIGID, RUBS, Machine
from vibro_sweep.engine.elements.instants import happen
from vibro_sweep.engine.elements.laws_of_elements import FREE, PRESSED, RELAXING
from vibro_sweep.engine.elements.moving import (
    Log,
    carry,
    depth,
    first_end,
    keep_end,
    load_inputs,
    load_series,
    move,
    new_orbit,
    saltate,
    speed,
)
from vibro_sweep.engine.elements.phases import find_phase, new_phases
from vibro_sweep.engine.simd.jit import exported, jit
from vibro_sweep.tables import outcomes as status

MOST_EVENTS = 100_000  # in one period
EXPLAINED = 64.0 * 2.0**-52  # of the terms of delta: a start behind a stop that rounding can explain
MOST_STEPS = 1_000_000  # in one cell


class ElementOrbit:
    """An orbit of a machine with any number of elements.

    state : (2 N,) x1, v1, x2, .. at the time `start` >= 0; places : of stops that relax, in the order of the elements
    events : how many are logged
    """

    def __init__(self, m: Machine, state, start: float = 0.0, events: int = 0, places=()):
        self.machine, self.phases, self.orbit = m, new_phases(m), new_orbit(m)
        now, N = self.orbit.now[0], len(m.free)
        z = self.orbit.z
        z[:N], z[N : 2 * N] = m.P @ np.asarray(state, float)[0::2], m.P @ np.asarray(state, float)[1::2]
        z[2 * N : 2 * N + len(places)] = places
        self._events = np.empty((events, 6 + 2 * N))
        now["period"], now["cell"], now["offset"] = self.place_of(start)
        begin(m, self.phases, self.orbit, Log(self._events, np.empty((0, len(z)))))

    def place_of(self, t: float) -> tuple[int, int, float]:
        """Period, cell and offset of a time."""
        width = self.machine.width[0]
        period = math.floor(t / (CELLS * width))
        t -= period * CELLS * width
        cell = min(int(t / width), CELLS - 1)
        return period, cell, max(t - cell * width, 0.0)

    def follow(self, end: float, vectors: np.ndarray | None = None, periods: int = 0) -> int:
        """Follow it to the time `end`. vectors: (states, n) of tangent vectors, by (y, y', s). Returns its status."""
        V = np.empty((len(self.orbit.z), 0)) if vectors is None else vectors
        self.sections = np.empty((periods, len(self.orbit.z)))
        follow(self.machine, self.phases, self.orbit, Log(self._events, self.sections), V, *self.place_of(end))
        return int(self.orbit.now["status"][0])

    @property
    def state(self) -> np.ndarray:
        """(2 N,) x1, v1, x2, .."""
        N, z = len(self.machine.free), self.orbit.z + self.orbit.z_low
        return np.stack([self.machine.back @ z[:N], self.machine.back @ z[N : 2 * N]], -1).reshape(-1)

    @property
    def events(self) -> np.ndarray:
        """(events, 6 + 2 N) of those that were logged: `Log`."""
        return self._events[: self.orbit.now["logged"][0]]


@exported
def begin(m, p, o, log):
    """Modes at the start, and what happens there."""
    o.now[0].status = status.OK
    for e in range(len(o.modes)):
        s = o.z[2 * len(m.free) + m.relaxing[e]] if m.relaxing[e] >= 0 else 0.0
        o.modes[e] = RELAXING if s > 0.0 else FREE
        past = 0.0 if m.kind[e] == RUBS else depth(m, o, e) - s
        if past > EXPLAINED * (1.0 + abs(m.law[e, 0])):
            if m.kind[e] == RIGID:
                o.now[0].status = status.BEYOND_STOP
                return
            force = m.law[e, 1] * depth(m, o, e) + m.law[e, 2] * speed(m, o, e) + m.law[e, 3]
            o.modes[e] = PRESSED
            if m.kind[e] == BY_FORCE and force < 0.0:
                o.modes[e] = RELAXING
                o.z[2 * len(m.free) + m.relaxing[e]] = depth(m, o, e)
    o.now[0].phase = find_phase(m, p, o.modes, o.made)
    happen(m, p, o, log, -1)


@jit
def to_next_cell(m, o, log):
    now = o.now[0]
    now.cell, now.offset, now.offset_low = now.cell + 1, 0.0, 0.0
    if now.cell == CELLS:
        if now.period < len(log.sections):
            for j in range(len(o.z)):
                log.sections[now.period, j] = o.z[j] + o.z_low[j]
        now.period, now.cell, now.events = now.period + 1, 0, 0
    for j in range(len(o.z)):
        if not math.isfinite(o.z[j]):
            now.status = status.NOT_FINITE


@exported
def follow(m, p, o, log, V, period, cell, offset):
    """Follow an orbit, and its tangent vectors V (states, n), to this place."""
    now, tangent, steps = o.now[0], V.shape[1] > 0, 0
    while now.status == status.OK:
        final = now.period == period and now.cell == cell
        if (final and now.offset >= offset) or now.period > period:
            return
        f = now.phase
        remaining = ((offset if final else m.width[0]) - now.offset) - now.offset_low
        last = remaining <= 1.001 * p.step[f, 0]
        load_inputs(m, p, f, o)
        load_series(p, f, o)
        u, hit = first_end(m, p, f, o, remaining if last else p.step[f, 0])
        if u != u:
            now.status = status.UNRESOLVED
            return
        move(m, o, u)
        if tangent:
            carry(m, p, f, o, V, u)
        if hit < 0:
            steps += 1
            for e in range(len(o.at)):
                o.at[e] = 0
            if last and final:
                return
            if last:
                to_next_cell(m, o, log)
                steps = 0
            elif steps > MOST_STEPS:
                now.status = status.TOO_STIFF
            continue
        load_inputs(m, p, f, o)
        if tangent:
            keep_end(m, p, f, o, hit)
        happen(m, p, o, log, hit)
        if tangent:
            saltate(m, p, o, V)
        if now.events > MOST_EVENTS:
            now.status = status.EVENT_LIMIT
