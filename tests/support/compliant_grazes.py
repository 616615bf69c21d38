"""Flights that come near a compliant stop, and whether the engine finds that they touch it: those of near_grazes.py.

Each is followed alone, with its contacts logged, and again side by side with seven others, as sweeps have it.
"""

import numpy as np
from reference.certified import POSITIVE, REAL, of_masses

from support.decades import DECADES, EPS
from support.drawn_oscillators import drawn
from support.near_grazes import CHAIN, flights
from support.searching import Report, new_report
from vibro_sweep.engine.compliant.law import LOGGED
from vibro_sweep.engine.motion.orbits import new_records
from vibro_sweep.engine.one_system import Engine
from vibro_sweep.engine.orbit_block import MOTION
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.tables import outcomes as status

MASSES = (1, 2, 3)
BATCH = {1: 4000, 2: 400, 3: 400}  # flights drawn for an oscillator
PATHS = ("alone", "side by side")
FOLLOWED = (status.OK, status.EVENT_LIMIT)  # bounces on a preload may be more than are followed


def study(seed, batch=None) -> Report:
    """Flights of one number of masses after the other; `batch` of them are drawn for an oscillator."""
    masses, number = MASSES[seed % len(MASSES)], 1 + seed // len(MASSES)
    rows = judge(masses, number, batch or BATCH[masses], np.random.default_rng([masses, number]))
    report = new_report(**{"decades without flights": int((rows[0, ..., 0] == 0).sum())})
    judged = len(DECADES) - (masses > 1)  # at 10^-15 of the clearance the terms of the gap of several are rounded away
    for path, of_path in zip(PATHS, rows, strict=True):
        total, missed, invented, contacts = of_path[:judged].sum((0, 1)).tolist()
        report.counted.update({f"flights {path}": total, f"contacts {path}": contacts})
        if missed or invented:
            report.wrong.append(f"seed {seed}, {masses} masses, {path}: {missed} missed, {invented} invented")
    return report


def law(rng):
    """Numbers of both stops: from soft to hard, elastic or damped, with a preload or without one."""
    k, z = 10 ** rng.uniform(0, 6), rng.choice([0, rng.uniform(0.01, 0.5)])
    preload, release = rng.choice([0, 10 ** rng.uniform(-2, 0)]), str(rng.choice(["displacement", "force"]))
    return dict(R=None, R_left=None, k_stop=k, c_stop=2 * z * np.sqrt(k), preload=preload, release=release)


def first_touches(engine, states, alone):
    """Time and side of the first contact of each flight within a period, infinite and 0 where there is none; side by
    side NaN, as no single contacts are kept."""
    e, masses = engine.ensemble, engine.kind.masses
    records, log = new_records(LANES, masses=masses), np.empty((LANES, int(alone), LOGGED))
    times, sides = np.full(len(states), np.inf), np.zeros(len(states))
    begins = engine.to_contact(states)
    for first in range(0, len(states), LANES):
        here = begins[first : first + LANES]
        e.orbits["status"] = status.NOT_COMPUTED
        e.law.orbits["contacts"] = 0
        for lane, state in enumerate(here):
            engine.put(state, lane=lane)
        e.orbits["periods"] = 1
        engine._run(MOTION, 1, records=records, law=e.law._replace(log=log))
        assert np.isin(e.orbits["status"][: len(here)], FOLLOWED).all()
        for lane, counts in enumerate(e.law.orbits["contacts"][: len(here)]):
            if counts.any():
                times[first + lane] = np.nan
                if alone:
                    period, cell, offset = log[lane, 0, :3]
                    times[first + lane] = period * engine.period + cell * engine.width + offset
                    sides[first + lane] = log[lane, 0, 6]
    return times, sides


def judge(masses, seed, count, rng, moved=0.0):
    """Rows (path, decade, missing, 4) of flights, missed, invented, contacts; of one oscillator with stops at -b and b.

    moved: part by which the stops of the engine stand further out.
    """
    own = {"contact_normal": [1.0]} if masses == 1 else {}
    system, _ = drawn(seed, masses, constant=False, offset=0.0, **own, **law(np.random.default_rng([seed, masses])))
    system = system.replace(b=system.b * rng.uniform(1, 4))
    reference, engine = of_masses(system.linear), Engine(system.replace(b=system.b * (1 + moved)))
    batches = [flights(reference, system, count // 4, rng) for _ in range(4)]
    states, decade, missing = (np.concatenate(parts) for parts in zip(*batches, strict=True))
    z = reference.forced(states)
    tolerance = CHAIN * np.abs(reference.shift[:, 0]).max(0) @ np.abs(z.T)  # every term of the gap at any time
    whole = np.full(len(states), engine.period * (1 - 2 * EPS), REAL)
    rows = np.zeros((len(PATHS), len(DECADES), 2, 4), int)
    for path in range(len(PATHS)):
        times, sides = first_touches(engine, states, alone=path == 0)
        hit, known = ~np.isinf(times), np.isfinite(times)
        until = np.where(known, times * (1 - 2 * EPS), whole).astype(REAL)
        missed = (known | ~hit) & (reference.inside(z, system.b, until, tolerance) != POSITIVE)
        gap, error = reference.gap(z, np.where(known, times, 0).astype(REAL))
        invented = known & (sides * gap < system.b - tolerance - error)
        unknown = np.flatnonzero(hit & ~known)
        within = reference.inside(z[unknown], system.b, whole[unknown], -tolerance[unknown])
        invented[unknown] = within == POSITIVE
        for column, chosen in enumerate((np.ones(len(hit), bool), missed, invented, hit)):
            np.add.at(rows[path, ..., column], (decade[chosen] - 1, missing[chosen].astype(int)), 1)
    return rows
