"""First contacts held against the certified reference: none beyond the stated rounding is missed, none invented.

Flights are built about an extremum whose distance from the stop is prescribed, 10^-1 .. 10^-15 of the amplitude
before or behind it. The reference then judges the flight as it is in floats, so that nothing rests on the building.
"""

import itertools

import numpy as np
import pytest
from numpy.random import default_rng
from reference import certified
from reference.certified import NEGATIVE, POSITIVE, REAL

import vibro_sweep as vs
from vibro_sweep.engine import one_system
from vibro_sweep.engine.motion import contact, ensemble, impacts, orbits, scan
from vibro_sweep.engine.motion.strike import TAIL, strike, strikes_of
from vibro_sweep.engine.simd.jit import entry
from vibro_sweep.engine.simd.lanes import LANES, lanes_of
from vibro_sweep.engine.tables.flight import ORDER
from vibro_sweep.model import status

DECADES = np.arange(1, 16)
EPS = 2.0**-52
CHAIN = 8 * EPS  # of the largest term of x1 along the flight: rounding allowed from the section to the contact


# --- polynomials: contact.first_contact alone -----------------------------------------------------------------------


@entry
def searched(g, c, gap, side, third, rest, out):
    for i in range(len(gap)):
        contact.set_gap(g, c[i], gap[i], side[i], 0 if gap[i] > 0.0 else 1)
        out[i] = contact.first_contact(g, third[i], rest[i])


def first_contacts(c, gap, side, third, rest, out):
    searched(np.empty(ORDER), c, gap, side, third, rest, out)
    return 0


@entry
def strikes(t, c, gap, side, third, rest, out):
    """The same, eight at once where that suffices; returns how often. c is the flight for z = (0, c_1, 0, 0, 0, 1)."""
    count = 0
    for first in range(0, len(gap) - LANES + 1, LANES):
        for i in range(LANES):
            n, t.tail[5, i] = first + i, 0.0
            for m in range(ORDER):
                t.series[5 * ORDER + m, i] = c[n, m]
                weight = m * (m - 1) * (m - 2) * rest[n] ** (m - 3) if m > 2 else 0.0
                if m < TAIL:
                    t.third[m, i] = weight
                else:
                    t.tail[5, i] += weight * abs(c[n, m])
            t.z[i, 1], t.z[i, 5], t.width[i] = c[n, 1], 1.0, rest[n]
            t.right[i] = gap[n] if side[n] > 0 else np.inf
            t.left[i] = -gap[n] if side[n] < 0 else -np.inf
        free, struck = strike(t, lanes_of(255))
        for i in range(LANES):
            n = first + i
            if gap[n] > 0 and (free | struck) >> i & 1:
                out[n] = np.inf if free >> i & 1 else t.offset[i]
                count += 1
    return count


def first_contacts_by_eights(c, gap, side, third, rest, out):
    """As an orbit finds them: by the long way what is not clear at once. Returns how many are."""
    first_contacts(c, gap, side, third, rest, out)
    t = np.zeros(1, strikes_of(2))
    t["R"] = 1e3  # it leaves fast enough not to come back within the cell: the first contact alone is judged here
    return strikes(t[0], c, gap, side, third, rest, out)


def product(*factors):
    """Product of polynomials (n, N), cut to ORDER coefficients."""
    result = factors[0]
    for factor in factors[1:]:
        longer = np.zeros((min(len(result) + len(factor) - 1, ORDER), result.shape[1]), REAL)
        for i, a in enumerate(factor):
            reach = longer[i : i + len(result)]
            reach += a * result[: len(reach)]
        result = longer
    return result


def linear(root):
    return np.stack([-root, np.ones_like(root)])


def gaps(kind, decade, missing, count, rng):
    """Coefficients (n, N) of the gap to the stop over [0, h]; near tangencies at random places. Amplitude about 1."""
    h = rng.uniform(0.1, 0.5, count).astype(REAL)
    scale = rng.normal(size=(6, count)) / np.cumprod(np.maximum(np.arange(6), 1))[:, None]
    scale[0] = rng.uniform(0.5, 2, count)
    q = scale.astype(REAL)
    depth = (np.where(missing, 1, -1) * 10.0**-decade * rng.uniform(0.3, 1, count)).astype(REAL)
    u, w = h * rng.uniform(0.02, 0.98, (2, count))
    one = np.ones((1, count), REAL)
    if kind == "graze":
        g = product(q, linear(u), linear(u))
    elif kind == "double":
        g = product(q, linear(u), linear(u), linear(w), linear(w)) * 10
    elif kind == "inflection":
        g = -product(q, linear(u), linear(u), linear(u))
        g[:2] += 10.0 ** -rng.uniform(1, 15, count) * rng.choice([-1, 0, 1], count) * linear(u)
    elif kind == "cubic":  # an extremum and an inflection in one cell
        g = product(q, linear(u), linear(u), linear(w)) * np.where(w < u, 1, -1)
    elif kind == "leaving":  # gap 0 at the start, with a speed that may be tiny; a graze of the stop just left
        g = product(q, linear(u), linear(u))
        g[0] += depth
        g[1:] = g[:-1].copy()
        g[0] = 0
        small = rng.random(count) < 0.5
        g[1] = np.where(small, 10.0 ** -rng.uniform(1, 15, count), np.abs(g[1]))
        depth = 0 * one[0]
    g[0] += depth
    return g, h


SEARCHES = (first_contacts, first_contacts_by_eights)
KINDS = ("graze", "double", "inflection", "cubic", "leaving")


def judge_polynomials(search, kind, decade, missing, count, rng):
    """(flights, missed, invented, contacts found, unresolved, found at once)."""
    g, h = gaps(kind, decade, missing, count, rng)
    size = 10.0 ** rng.uniform(-3, 3, count)
    c = np.zeros((count, ORDER))
    side = rng.choice([-1.0, 1.0], count)
    c[:, : len(g)] = (-side * g * size).T
    gap = np.where(g[0] > 0, (g[0] * size).astype(float), 0.0)
    good = (g[0] > 0) | (kind == "leaving")
    c[:, 0] = 0.0  # first_contact never looks at it
    c, side, gap, h = c[good], side[good], gap[good], h[good].astype(float)
    n = np.arange(ORDER)
    terms = np.abs(c)
    if kind == "leaving":  # the gap divided by u
        terms = np.concatenate([terms[:, 1:], np.zeros((len(terms), 1))], axis=1)
    third = (n * (n - 1) * (n - 2) * terms * h[:, None] ** np.maximum(n - 3, 0)).sum(1) * (1 + 1e-14)
    found = np.empty(len(gap))
    at_once = search(c, gap, side, third, h, found)
    exact = (-side[:, None] * c).T.astype(REAL)
    exact[0] = gap
    m = contact.ROUNDING * np.abs(exact)
    told, hit = ~np.isnan(found), np.isfinite(found)
    last = np.where(hit, found * (1 - 2 * EPS), h).astype(REAL)
    above = exact + m
    low = np.zeros_like(last)
    if kind == "leaving":  # the zero at u = 0 is divided out
        above = above[1:]
    missed = told & (certified.sign(above, low, last) != POSITIVE)
    g_found, error = certified.value(exact - m, np.where(hit, found, 0).astype(REAL))
    slope = (n[1:, None] * np.abs(exact[1:])).sum(0) * EPS * np.where(hit, found, 0)
    invented = hit & (g_found > error + slope)
    return np.array([len(gap), missed.sum(), invented.sum(), hit.sum(), np.count_nonzero(~told), at_once])


def polynomial_table(search, kind, count, rng):
    rows = np.zeros((len(DECADES), 2, 6), int)
    for i, decade in enumerate(DECADES):
        for missing in (0, 1):
            rows[i, missing] = judge_polynomials(search, kind, decade, np.full(count, missing, bool), count, rng)
    return rows


def show(title, rows):
    print(
        f"\n{title}\n 10^-k | flights behind, contacts, missed, invented | flights before, contacts, missed, invented"
    )
    for decade, (behind, before) in zip(DECADES, rows, strict=True):
        cells = [f"{r[0]:8d} {r[3]:8d} {r[1]:4d} {r[2]:4d}" for r in (behind, before)]
        print(f"   {decade:3d} | " + " | ".join(cells))


@pytest.mark.parametrize("search", SEARCHES)
@pytest.mark.parametrize("kind", KINDS)
def test_polynomials(kind, search):
    rows = polynomial_table(search, kind, 300, default_rng(KINDS.index(kind)))
    assert rows[..., 1].sum() == 0, "missed"
    assert rows[..., 2].sum() == 0, "invented"
    assert rows[..., 3].sum() > 100
    if search is first_contacts_by_eights and kind != "leaving":  # that begins on a stop
        assert rows[..., 5].sum() > 100
    # two near grazes so close together that they are a fourfold root may stay open, and say so
    assert rows[..., 4].sum() <= (0.003 * rows[..., 0].sum() if kind == "double" else 0), "unresolved"


# --- flights of oscillators: from the section through the scan to the contact ---------------------------------------


@entry  # like the kernels, without reference counts: a view of an array passes from one to the other
def first_impacts(e, stops, states, record, suspects, nothing):
    o, t = e.orbits[0], e.tangent[0]
    f, records = ensemble.flight_of(e, o), ensemble.records_of(e, o)
    for i in range(len(states)):
        x = states[i]
        orbits.place(o, f.nodes, stops, 0, 0.0, x)
        o.suspect = scan.first_suspect(f, o)
        suspects[i] = scan.suspect_state(o, f.nodes)[0]
        # the first cell alone, with one event allowed: R = 1 makes a mass that creeps off the stop knock for ever
        orbits.place(o, f.nodes, stops, 0, 0.0, x)
        o.events = impacts.MOST_EVENTS - 1
        outcome = impacts.cross_cell(f, stops, o, records, t, 0, 0.0)
        if o.impacts_logged == 0:
            orbits.place(o, f.nodes, stops, 0, 0.0, x)
            o.periods = 1
            ensemble.carry(e, None, ensemble.Readings(nothing, False, nothing, 0))
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
    force = np.array([certified.longdouble(reference.A[1, j]) for j in range(6)])
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
    reference = certified.Reference(system.parameters())
    batches = [flights(reference, system.b, count // 8, rng) for _ in range(8)]
    states, decade, missing = (np.concatenate(parts) for parts in zip(*batches, strict=True))
    leaving = rng.random(len(states)) < 0.1  # flights that begin on a stop
    states[leaving, 0] = np.copysign(system.b, states[leaving, 0])
    states[leaving, 1] = -np.sign(states[leaving, 0]) * 10.0 ** -rng.uniform(0, 15, leaving.sum())
    engine = one_system.Engine(system)
    record, suspects = np.empty((len(states), 4)), np.empty(len(states), np.int64)
    eight = engine.ensemble._replace(records=orbits.new_records(1, impacts=1))
    first_impacts(eight, engine.stops, states, record, suspects, np.empty((1, 0, 4)))
    assert np.isin(record[:, 3], [status.OK, status.EVENT_LIMIT]).all()  # none is unresolved
    z = reference.forced(states)
    # every term of x1 at any time
    tolerance = CHAIN * np.abs(reference.shift[:, 0]).max(0) @ np.abs(z.T)
    hit = np.isfinite(record[:, 0])
    time = np.where(hit, record[:, 0] * engine.width + record[:, 1], engine.period)
    verdict = reference.inside(z, system.b, (time * (1 - 2 * EPS)).astype(REAL), tolerance)
    missed = verdict != POSITIVE
    x1, error = reference.x1(z, time.astype(REAL))
    invented = hit & (record[:, 2] * x1 < system.b - tolerance - error)
    excluded = np.minimum(suspects * engine.width, engine.period)
    wrong, later = missed & (excluded >= time), excluded > time  # up to `time` it is judged already
    wrong[later] = reference.inside(z[later], system.b, excluded[later].astype(REAL), tolerance[later]) == NEGATIVE
    rows = np.zeros((len(DECADES), 2, 5), int)
    for column, chosen in enumerate((np.ones(len(hit), bool), missed, invented, hit, wrong)):
        np.add.at(rows[..., column], (decade[chosen] - 1, missing[chosen].astype(int)), 1)
    return rows


def test_the_reference_sees_what_was_built():
    rng = default_rng(7)
    free = 0
    for _ in range(4):
        system = random_system(rng)
        reference = certified.Reference(system.parameters())
        batches = [flights(reference, system.b, 200, rng) for _ in range(4)]
        states, decade, missing = (np.concatenate(parts) for parts in zip(*batches, strict=True))
        end, none = np.full(len(states), reference.period, REAL), np.zeros(len(states), REAL)
        verdict = reference.inside(reference.forced(states), system.b, end, none)
        assert (verdict[~missing & (decade < 13)] == NEGATIVE).all()
        free += np.count_nonzero(verdict[missing] == POSITIVE)
    assert free > 50


def test_flights():
    rng = default_rng(11)
    rows = sum(judge_flights(2500, rng) for _ in range(2))
    assert rows[..., 0].sum() > 2000
    assert rows[..., 3].sum() > 1000
    for column, what in ((1, "missed"), (2, "invented"), (4, "excluded by the scan, with a contact")):
        assert rows[..., column].sum() == 0, what


@pytest.mark.slow
def test_a_million_flights(capsys):
    rng = default_rng(2024)
    with capsys.disabled():
        for kind, search in itertools.product(KINDS, SEARCHES):
            rows = polynomial_table(search, kind, 5000, rng)
            show(f"polynomials: {kind}, {search.__name__}; unresolved: {rows[..., 4].sum()}", rows)
            assert rows[..., 1:3].sum() == 0
        rows = sum(judge_flights(16000, rng) for _ in range(60))
        show("flights of oscillators", rows)
        print(f"excluded by the scan in spite of a contact: {rows[..., 4].sum()} of {rows[..., 0].sum()}")
    assert rows[..., (1, 2, 4)].sum() == 0
