"""Free flights of any oscillator that come near a stop, and whether the engine finds their first contact.

A flight is built about an extremum of its gap whose distance from the stop is prescribed, 10^-1 .. 10^-15 of the
clearance before or behind it, and is followed back to the section. The certified reference judges it as it is in
floats.
"""

import numpy as np
from reference.certified import POSITIVE, REAL, of_masses

from support.decades import DECADES, EPS
from support.drawn_oscillators import drawn
from support.searching import Report, new_report
from vibro_sweep.engine import orbit_block
from vibro_sweep.engine.motion.orbits import new_records
from vibro_sweep.engine.one_system import Engine
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.tables import outcomes as status

MASSES = (1, 2, 3, 4, 5, 8)
BATCH = 4000  # flights drawn for an oscillator: some end behind a stop where they should begin
MOST = 256  # impacts of a flight that there is room for
CHAIN = 8 * EPS  # of the largest terms of the gap along the flight: rounding allowed from the section to the contact


def study(seed) -> Report:
    """Flights of one number of masses after the other, whose extrema lie before a stop and behind it."""
    masses, number = MASSES[seed % len(MASSES)], 1 + seed // len(MASSES)
    rows = judge(masses, number, BATCH, np.random.default_rng([masses, number]))
    total, missed, invented, contacts = rows.sum((0, 1)).tolist()
    report = new_report(flights=total, contacts=contacts, **{"decades without flights": int((rows[..., 0] == 0).sum())})
    if missed or invented:
        report.wrong.append(f"seed {seed}, {masses} masses: {missed} missed, {invented} invented")
    return report


def flights(reference, system, count, rng):
    """States (n, 2 N) of the masses at the section, decades (n,), whether the extremum lies before the stop (n,)."""
    n, states, push = system.masses, reference.states, np.linalg.solve(system.linear.M, system.linear.contact.normal)
    along, push = system.linear.contact.normal, push / (system.linear.contact.normal @ push)
    u = float(reference.period) * rng.uniform(0.02, 0.98)
    decade, missing, side = rng.choice(DECADES, count), rng.random(count) < 0.5, rng.choice([-1, 1], count)
    z = np.zeros((count, reference.A.rows), REAL)
    z[:, :states] = system.b * rng.normal(size=(count, states))
    z[:, states:] = reference.phase(u)
    wanted = side * system.b * (1 + np.where(missing, -1, 1) * 10.0**-decade * rng.uniform(0.3, 1, count))
    z[:, 0:states:2] += np.outer(wanted - z[:, 0:states:2] @ along, push)
    z[:, 1:states:2] -= np.outer(z[:, 1:states:2] @ along, push)
    if n > 1:  # an inflection: no acceleration at the stop, or nearly none
        flat = rng.random(count) < 0.1
        across = np.eye(n)[1] - along[1] * push
        across = np.kron(across / (reference.acceleration[0:states:2] @ across), [1, 0])
        z[:, :states] -= np.outer(flat * (z @ reference.acceleration), across)
    start = z @ reference.before(u).T
    kept = (side * (z @ reference.acceleration) <= 1e-9) & (np.abs(start[:, 0:states:2] @ along) <= system.b)
    return start[kept, :states].astype(float), decade[kept], missing[kept]


def carry_eight(engine, states):
    """Carry orbits from up to eight states (n, 2 N) in contact coordinates over a period: records, impacts."""
    eight = engine.ensemble.orbits
    eight["status"] = status.NOT_COMPUTED
    for lane, state in enumerate(states):
        engine.put(state, lane=lane)
    eight["periods"] = 1
    records = new_records(LANES, impacts=MOST, masses=engine.kind.masses)
    engine._run(orbit_block.MOTION, 1, records=records)
    return eight[: len(states)], records


def first_impacts(engine, states):
    """Time and side of the first impact of each flight within a period; infinite and 0 where there is none."""
    times, sides = np.full(len(states), np.inf), np.zeros(len(states))
    begins = engine.to_contact(states)
    for first in range(0, len(states), LANES):
        orbits, records = carry_eight(engine, begins[first : first + LANES])
        assert (orbits["status"] == status.OK).all()
        for lane, logged in enumerate(orbits["impacts_logged"]):
            if logged:
                period, cell, offset, side = records.impacts[lane, 0, :4]
                times[first + lane], sides[first + lane] = period * engine.period + cell * engine.width + offset, side
    return times, sides


def judge(masses, seed, count, rng, moved=0.0):
    """Rows (decade, missing, 4) of flights, missed, invented, contacts; of one oscillator with its stops at -b and b.

    moved: part by which the stops of the engine stand further out.
    """
    system, _ = drawn(seed, masses, offset=0.0)
    system = system.replace(b=system.b * rng.uniform(1, 4))
    reference, engine = of_masses(system.linear), Engine(system.replace(b=system.b * (1 + moved)))
    batches = [flights(reference, system, count // 4, rng) for _ in range(4)]
    states, decade, missing = (np.concatenate(parts) for parts in zip(*batches, strict=True))
    times, sides = first_impacts(engine, states)
    z, hit = reference.forced(states), np.isfinite(times)
    tolerance = CHAIN * np.abs(reference.shift[:, 0]).max(0) @ np.abs(z.T)  # every term of the gap at any time
    until = np.where(hit, times, engine.period)
    missed = reference.inside(z, system.b, (until * (1 - 2 * EPS)).astype(REAL), tolerance) != POSITIVE
    gap, error = reference.gap(z, until.astype(REAL))
    invented = hit & (sides * gap < system.b - tolerance - error)
    rows = np.zeros((len(DECADES), 2, 4), int)
    for column, chosen in enumerate((np.ones(len(hit), bool), missed, invented, hit)):
        np.add.at(rows[..., column], (decade[chosen] - 1, missing[chosen].astype(int)), 1)
    return rows
