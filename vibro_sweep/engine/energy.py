"""What the designer of a damper looks at: the energy that stops take, root mean squares and peaks of all coordinates.

A room of its own, which nothing enters that does not ask for it. The orbits are carried over their record once more, a
period at a time: first for the times of their impacts, rests and contacts, then for samples between these. The motion
is analytic between two of these times and within a cell, or a step of a contact, so that eight samples at the nodes of
Gauss and Legendre give its mean square to rounding, and the polynomial through them its extremes.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.compliant.law import LOGGED, Law, clear_contacts
from vibro_sweep.engine.compliant.relaxing import bring_stops
from vibro_sweep.engine.energy_times import cut_contacts, cuts_of, set_times, sort
from vibro_sweep.engine.motion.ensemble import carry
from vibro_sweep.engine.motion.orbits import Records, Stops, set_state
from vibro_sweep.engine.motion.together import Ensemble, Readings
from vibro_sweep.engine.points import prepare
from vibro_sweep.engine.quadrature import NODES, PLACES, WEIGHTS
from vibro_sweep.engine.simd.jit import exported, inline, jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.trajectory import hold
from vibro_sweep.tables import outcomes as status

STEPS = 16  # of 0 .. 1, and one beyond on each side, at whose ends the polynomial is looked at for an extreme
TO_POWERS = np.ascontiguousarray(np.linalg.inv(np.vander(PLACES, NODES)))  # from values there, highest power first


class Workspace(NamedTuple):
    """Arrays that one orbit needs."""

    hits: np.ndarray  # (1, room, 3 + 2 N)
    rests: np.ndarray  # (1, room, 4)
    contacts: np.ndarray  # (1, room, LOGGED)
    cuts: np.ndarray
    times: np.ndarray
    samples: np.ndarray
    values: np.ndarray  # (2, NODES)
    begin: np.ndarray  # (2 N,)
    relaxed: np.ndarray  # (2,): where compliant stops are that relax


def new_workspace(parts: int, room: int, masses: int) -> Workspace:
    """Arrays for periods of at most so many parts, impacts, rests and contacts."""
    longest, states = parts + 1 + 4 * room, 2 * masses
    return Workspace(
        np.empty((1, room, 3 + states)),
        np.empty((1, room, 4)),
        np.empty((1, room, LOGGED)),
        np.empty(longest),
        np.empty((NODES * longest, 2)),
        np.empty((NODES * longest, states)),
        np.empty((2, NODES)),
        np.empty(states),
        np.empty(2),
    )


@jit
def add_up(cuts, samples, back, origin, squares, peaks, values):
    """Add integrals of squares, in cells, and raise the peaks. values: scratch (2, NODES)."""
    masses, count = len(back), 0
    for i in range(len(cuts) - 1):
        length = cuts[i + 1] - cuts[i]
        if not length > 1e-12:
            continue
        for j in range(2 * masses):
            for n in range(NODES):
                values[0, n] = origin[j // 2] if j % 2 == 0 else 0.0
                for m in range(masses):
                    values[0, n] += back[j // 2, m] * samples[count + n, 2 * m + j % 2]
                squares[j] += length * WEIGHTS[n] * values[0, n] ** 2
            peaks[j] = max(peaks[j], peak_of(values[0], values[1]))
        count += NODES


@jit
def peak_of(values, c):
    """The largest size on 0 .. 1 of the polynomial through these values at `PLACES`. c: scratch (NODES,).

    An extreme is where the parabola through three neighbours has it.
    """
    for i in range(NODES):
        c[i] = 0.0
        for n in range(NODES):
            c[i] += TO_POWERS[i, n] * values[n]
    largest, before, here = 0.0, 0.0, 0.0
    for i in range(-1, STEPS + 2):
        after = polynomial(c, i / STEPS)
        if i > 0:
            largest = max(largest, abs(here))
            if (here - before) * (after - here) < 0.0:
                at = (i - 1 + 0.5 * (before - after) / (before - 2.0 * here + after)) / STEPS
                if 0.0 <= at <= 1.0:
                    largest = max(largest, abs(polynomial(c, at)))
        before, here = here, after
    return largest


@jit
def polynomial(c, u):
    total = c[0]
    for n in range(1, NODES):
        total = total * u + c[n]
    return total


@jit
def loss_of(hits, stops, mass):
    """Energy that these impacts take."""
    total = 0.0
    for n in range(len(hits)):
        R = stops.R_right if hits[n, 3] > 0.0 else stops.R_left
        total += 0.5 * mass * (1.0 - R) * (1.0 + R) * hits[n, 4] ** 2
    return total


@inline
def with_log(law, log):
    """The compliant stops, with room for their contacts."""
    if law is not None:
        return Law(law.orbits, log, law.passage, law.halt)
    return None


@inline
def begin_contacts(law):
    """The log of contacts is empty."""
    if law is not None:
        clear_contacts(law.orbits[0], True)
        law.orbits[0].logged, law.orbits[0].row = 0, -1


@inline
def contacts_logged(law):
    if law is not None:
        return law.orbits[0].logged
    return 0


@inline
def work_on(law):
    """The work of the masses on compliant stops."""
    if law is not None:
        return law.orbits[0].mass * law.orbits[0].work
    return 0.0


@inline
def keep_places(law, o, width, places):
    """Keep where stops are that relax, at the section that the orbit has reached."""
    if law is not None:
        contact = law.orbits[0]
        bring_stops(contact, o, 0, 0.0, width)
        places[0], places[1] = contact.relaxed[0], contact.relaxed[1]


@jit
def carry_one(e, w, begin, rest, relaxed, part, log):
    """The first orbit over one period, from a state in contact coordinates."""
    o = e.orbits[0]
    f = e.flights.nodes[o.table]
    set_state(o, f, Stops(o.stops[0], o.stops[1], o.stops[2], o.stops[3]), 0, 0.0, begin)
    o.resting, o.periods, o.log_side = rest, 1, 0.0
    begin_contacts(e.law)
    hold(e.law, o, relaxed)
    carry(
        Ensemble(e.flights, e.orbits, e.strike, e.tangent, part, e.halt, with_log(e.law, log)),
        None,
        Readings(w.section, False, w.growth, 0),
    )


@exported
def run_energy(
    points, begins, resting, relaxed, masses, back, origin, periods, w, plan, workspace, loss, squares, peaks, outcome
):
    """Carry each orbit over its record. n = orbits.

    points: (n,). begins: (n, 2 N) in contact coordinates, `resting` (n,) the stops that they rest on, and `relaxed`
    (n, 2) where stops are that relax. masses: (n,) of the contact. back: (n, N, N) and origin (n, N), from contact
    coordinates. loss: (n,); squares: (n, 2 N), integrals over time; peaks: (n, 2 N). outcome: (n,), NOT_COMPUTED where
    an orbit is wanted; then its status; NOT_COMPUTED again where there was too little room.
    """
    e, hits, rests, begin = w.ensemble, workspace.hits, workspace.rests, workspace.begin
    contacts, places = workspace.contacts, workspace.relaxed
    o, room, states = e.orbits[0], workspace.hits.shape[1], len(workspace.begin)
    e.tangent[0].wanted = e.strike[0].measured = False
    for i in range(1, LANES):
        e.orbits[i].status = status.NOT_COMPUTED
    for n in range(len(points)):
        if outcome[n] != status.NOT_COMPUTED:
            continue
        stops = prepare(points[n], 0, w, plan)
        set_state(o, e.flights.nodes[o.table], stops, 0, 0.0, begins[n])
        q = e.flights.oscillator[o.table, 0]
        rest, loss[n], outcome[n] = resting[n], 0.0, status.OK
        for j in range(2):
            places[j] = relaxed[n, j]
        for j in range(states):
            squares[n, j] = peaks[n, j] = 0.0
        for _ in range(periods):
            for j in range(states):
                begin[j] = o.X[j]
            carry_one(
                e, w, begin, rest, places, Records(hits, rests, workspace.times[:0], workspace.samples[:0]), contacts
            )
            touched = contacts_logged(e.law)
            if o.status != status.OK or o.impacts_logged > room or o.rests_logged > room or touched > room:
                outcome[n] = o.status if o.status != status.OK else status.NOT_COMPUTED
                break
            struck = hits[0, : o.impacts_logged]
            loss[n] += loss_of(struck, stops, masses[n]) + work_on(e.law)
            cuts = cuts_of(struck, rests[0, : o.rests_logged], q, workspace.cuts)
            cuts = cut_contacts(with_log(e.law, contacts), touched, q, workspace.cuts, cuts)
            if cuts > len(workspace.cuts):
                outcome[n] = status.NOT_COMPUTED
                break
            sort(workspace.cuts[:cuts])
            count = set_times(workspace.cuts[:cuts], q, workspace.times)
            sampled = Records(hits, rests, workspace.times[:count], workspace.samples[:count])
            carry_one(e, w, begin, rest, places, sampled, contacts)
            add_up(workspace.cuts[:cuts], workspace.samples, back[n], origin[n], squares[n], peaks[n], workspace.values)
            rest = o.resting
            keep_places(e.law, o, q.width, places)
        for j in range(states):
            squares[n, j] *= q.width
