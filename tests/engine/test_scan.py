"""First contacts of flights, from the section through the scan to the contact: none missed, none invented.

Flights are built about an extremum whose distance from the stop is prescribed, 10^-1 .. 10^-15 of the amplitude
before or behind it. The certified reference then judges the flight as it is in floats, so that nothing rests on the
building.
"""

import numpy as np
import pytest
from numpy.random import default_rng
from reference import certified
from reference.certified import NEGATIVE, POSITIVE, REAL
from support.decades import DECADES, EPS

import vibro_sweep as vs
from vibro_sweep.engine import one_system
from vibro_sweep.engine.motion import crossing, ensemble, orbits, scan, together
from vibro_sweep.engine.simd.jit import exported
from vibro_sweep.engine.tables import exclusion
from vibro_sweep.tables import outcomes as status

CHAIN = 8 * EPS  # of the largest term of x1 along the flight: rounding allowed from the section to the contact


@exported  # like the kernels, without reference counts: a view of an array passes from one to the other
def first_impacts(e, stops, states, record, candidates, nothing):
    o, t = e.orbits[0], e.tangent[0]
    f, records = together.flight_of(e, o), together.records_of(e, o)
    for i in range(len(states)):
        x = states[i]
        orbits.set_state(o, f.nodes, stops, 0, 0.0, x)
        orbits.load_constants(o, f.oscillator[0])
        o.candidate = scan.first_candidate(f, o)
        candidates[i] = scan.candidate_state(o, f.nodes)[0]
        # the first cell alone, with one event allowed: R = 1 makes a mass that creeps off the stop knock for ever
        orbits.set_state(o, f.nodes, stops, 0, 0.0, x)
        o.events = crossing.MOST_EVENTS - 1
        outcome = crossing.cross_cell(None, f, stops, o, records, t, 0, 0.0)
        if o.impacts_logged == 0:
            orbits.set_state(o, f.nodes, stops, 0, 0.0, x)
            o.periods = 1
            ensemble.carry(e, None, together.Readings(nothing, False, nothing, 0))
            outcome = o.status
        record[i, 0] = records.impacts[0, 1] if o.impacts_logged else np.inf
        record[i, 1] = records.impacts[0, 2]
        record[i, 2] = records.impacts[0, 3]
        record[i, 3] = outcome


def random_system(rng):
    """Moderately damped, so that a flight can be followed backwards over a period."""
    while True:
        system = vs.System(
            mu_m=10 ** rng.uniform(-0.5, 1),
            mu_k=10 ** rng.uniform(-0.5, 1),
            zeta=rng.choice([0.0, 10 ** rng.uniform(-4, -1.5)]),
            f2=rng.choice([0.0, 1.0, rng.random()]),
            omega=10 ** rng.uniform(-0.3, 0.5),
            R=1.0,  # no chatter is summed up: every contact counts
            b=10 ** rng.uniform(-1, 1),
            tau=rng.uniform(-np.pi, np.pi),
        )
        if system.eta.max() * system.period < 5:
            return system


def flights(reference, b, count, rng):
    """States at the section of flights with an extremum of prescribed distance from a stop, and these distances.

    Returns states (N, 4), decades (N,), whether the extremum lies before the stop (N,).
    """
    u = float(reference.period) * rng.uniform(0.02, 0.98)
    decade = rng.choice(DECADES, count)
    missing = rng.random(count) < 0.5
    side = rng.choice([-1, 1], count)
    z = np.zeros((count, 6), REAL)
    z[:, 0] = side * b * (1 + np.where(missing, -1, 1) * 10.0**-decade * rng.uniform(0.3, 1, count))
    z[:, 2] = b * rng.normal(size=count)
    z[:, 3] = b * rng.normal(size=count)
    z[:, 4:] = reference.phase(u)
    force = reference.acceleration
    z[:, 2] = np.where(side * (z @ force) < 0, z[:, 2], -z[:, 2])
    curved = rng.random(count) < 0.85
    z[~curved, 2] -= (z @ force / force[2])[~curved]  # an inflection: no acceleration at the stop, or nearly none
    z[~curved, 1] = (side * b * 10.0 ** -rng.uniform(2, 14, count) * rng.choice([-1, 0, 1], count))[~curved]
    start = z @ reference.before(u).T
    free = np.abs(start[:, 0]) <= b
    return start[free, :4].astype(float), decade[free], missing[free]


def judge_flights(count, rng):
    """Rows (decade, missing, 5) of flights, missed, invented, contacts, wrongly excluded."""
    system = random_system(rng)
    reference = certified.of_paper(system.parameters())
    batches = [flights(reference, system.b, count // 8, rng) for _ in range(8)]
    states, decade, missing = (np.concatenate(parts) for parts in zip(*batches, strict=True))
    leaving = rng.random(len(states)) < 0.1  # flights that begin on a stop
    states[leaving, 0] = np.copysign(system.b, states[leaving, 0])
    states[leaving, 1] = -np.sign(states[leaving, 0]) * 10.0 ** -rng.uniform(0, 15, leaving.sum())
    engine = one_system.Engine(system)
    record, candidates = np.empty((len(states), 4)), np.empty(len(states), np.int64)
    eight = engine.ensemble._replace(records=orbits.new_records(1, impacts=1))
    first_impacts(eight, engine.stops, states, record, candidates, np.empty((1, 0, 4)))
    assert np.isin(record[:, 3], [status.OK, status.EVENT_LIMIT]).all()  # none is unresolved
    z = reference.forced(states)
    # every term of x1 at any time
    tolerance = CHAIN * np.abs(reference.shift[:, 0]).max(0) @ np.abs(z.T)
    hit = np.isfinite(record[:, 0])
    time = np.where(hit, record[:, 0] * engine.width + record[:, 1], engine.period)
    verdict = reference.inside(z, system.b, (time * (1 - 2 * EPS)).astype(REAL), tolerance)
    missed = verdict != POSITIVE
    x1, error = reference.gap(z, time.astype(REAL))
    invented = hit & (record[:, 2] * x1 < system.b - tolerance - error)
    excluded = np.minimum(candidates * engine.width, engine.period)
    wrong, later = missed & (excluded >= time), excluded > time  # up to `time` it is judged already
    wrong[later] = reference.inside(z[later], system.b, excluded[later].astype(REAL), tolerance[later]) == NEGATIVE
    rows = np.zeros((len(DECADES), 2, 5), int)
    for column, chosen in enumerate((np.ones(len(hit), bool), missed, invented, hit, wrong)):
        np.add.at(rows[..., column], (decade[chosen] - 1, missing[chosen].astype(int)), 1)
    return rows


@pytest.mark.slow
def test_the_reference_sees_what_was_built():
    rng = default_rng(7)
    free = 0
    for _ in range(4):
        system = random_system(rng)
        reference = certified.of_paper(system.parameters())
        batches = [flights(reference, system.b, 200, rng) for _ in range(4)]
        states, decade, missing = (np.concatenate(parts) for parts in zip(*batches, strict=True))
        end, none = np.full(len(states), reference.period, REAL), np.zeros(len(states), REAL)
        verdict = reference.inside(reference.forced(states), system.b, end, none)
        assert (verdict[~missing & (decade < 13)] == NEGATIVE).all()
        free += np.count_nonzero(verdict[missing] == POSITIVE)
    assert free > 50


@pytest.mark.slow
def test_flights():
    rng = default_rng(11)
    rows = sum(judge_flights(1200, rng) for _ in range(2))
    assert rows[..., 0].sum() > 1000
    assert rows[..., 3].sum() > 500
    for column, what in ((1, "missed"), (2, "invented"), (4, "excluded by the scan, with a contact")):
        assert rows[..., column].sum() == 0, what


def test_single_precision():
    """Control points computed in it, without fused multiply-adds, are as near to the true ones as their bounds say."""
    rng, worst = default_rng(5), 0.0
    for _ in range(20):
        engine = one_system.Engine(random_system(rng))
        q, scan = engine.flight.oscillator.view(np.recarray)[0], engine.flight.scan
        nodes, states = engine.flight.nodes, len(q.remainder) - 1
        rows = np.concatenate([nodes["E"][:, :states, :2], nodes["z"][:, None, :2]], 1).astype(REAL)
        third, last = REAL(q.width) / 3, 2 * engine.cells
        exact = np.empty((states + 1, last + 1), REAL)
        exact[:, ::2] = (rows[..., 0] + third * rows[..., 1]).T
        exact[:, 1::2] = (rows[..., 0] - third * rows[..., 1]).T[:, 1:]
        largest = np.abs(exact).max(1).astype(float)
        bounds = np.array([exclusion.rounding.__wrapped__(q, i, largest[i]) for i in range(states + 1)])
        assert (q.remainder >= bounds).all()
        for _ in range(50):
            y = rng.normal(size=states) * 10.0 ** rng.uniform(-3, 3, states)
            points = scan[states]
            for j in range(states):
                points = points + scan[j] * np.float32(y[j])
            error = np.abs(points[: last + 1] - (exact[states] + y @ exact[:states])).max()
            worst = max(worst, error / (bounds[states] + np.abs(y) @ bounds[:states]))
    assert 0.1 < worst < 1.0


@pytest.mark.slow
def test_many_flights():
    """Of two oscillators."""
    rng = default_rng(2025)
    rows = sum(judge_flights(16000, rng) for _ in range(2))
    assert rows[..., 3].sum() > 500 and rows[..., (1, 2, 4)].sum() == 0
