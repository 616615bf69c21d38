"""First impacts of oscillators of one to eight masses, against a reference in the coordinates of these masses."""

import math
from types import SimpleNamespace

import numpy as np
from mpmath import mp, mpf
from reference.events import simulate
from reference.machine import machine_of

import vibro_sweep as vs
from support.any_oscillators import drawn
from support.searching import Report, new_report, size

MASSES = (1, 2, 3, 5, 8)
PERIODS = 60
LEAST = 20  # impacts before a slow one: an orbit with fewer is not compared
LARGEST = 10  # error, in units of what rounding the inputs does
COUNT = 30  # impacts compared


def moved(q, state, rng):
    """All inputs moved by one part in 2^53, up or down; of a state by as much of the clearance."""
    part = mp.ldexp(1, -53)

    def one(value):
        value = np.atleast_1d(value)
        signs = rng.choice([-1, 1], value.shape)
        if value.ndim == 2:
            signs = np.triu(signs) + np.triu(signs, 1).T
        return np.vectorize(lambda x, sign: mpf(float(x)) * (1 + int(sign) * part), otypes=[object])(value, signs)

    numbers = {name: one(value) if np.ndim(value) else one(value)[0] for name, value in q._asdict().items()}
    clearance = mpf(float(q.high - q.low)) * part
    return SimpleNamespace(**numbers), [
        mpf(float(x)) + int(s) * clearance for x, s in zip(state, rng.choice([-1, 1], len(state)), strict=True)
    ]


def fast_impacts(orbit):
    """How many impacts there are before the first slow one.

    Rounding of the gap acts on slow impacts like 1/v, and moved inputs do not.
    """
    speeds = np.abs(orbit.impacts["v1"][:COUNT])
    slow = np.flatnonzero(speeds < 0.2 * speeds.max(initial=0.0))
    return int(slow[0]) if len(slow) else len(speeds)


def errors_of_impacts(system, state, orbit, seed, moves=3):
    """Largest errors of times, speeds and states of the first impacts, in units of what rounding the inputs does.

    That is the sum of what each of some forty inputs does alone. Moved all at once, up or down at random, they do less,
    also where three such moves are added up: three times the mean of so many moves. Returns these errors and the number
    of impacts.
    """
    count, rng = fast_impacts(orbit), np.random.default_rng(seed)
    impacts = simulate(machine_of(system.linear), state, impacts=count).impacts
    others = [moved(system.linear, state, rng) for _ in range(moves)]
    others = [simulate(machine_of(q), x, impacts=count).impacts for q, x in others]
    largest = {"t": 0.0, "v1": 0.0, "x": 0.0}
    for i, (hit, found) in enumerate(zip(impacts, orbit.impacts[:count], strict=True)):
        assert hit.side == found["side"]
        moved_by = {"t": [other[i].t - hit.t for other in others], "v1": [other[i].v - hit.v for other in others]}
        for name, exact in (("t", hit.t), ("v1", hit.side * hit.v)):
            effect = 3 * sum(map(abs, moved_by[name])) / moves + math.ulp(float(exact))
            largest[name] = max(largest[name], float(abs(mpf(float(found[name])) - exact) / effect))
        size = max(abs(float(a)) for a in hit.y)
        apart = ([abs(a - b) for a, b in zip(other[i].y, hit.y, strict=True)] for other in others)
        effect = 3 * sum(map(max, apart)) / moves + math.ulp(size)
        both = zip((*found["x"], *found["xdot"]), hit.y[0::2] + hit.y[1::2], strict=True)
        largest["x"] = max(largest["x"], *(float(abs(mpf(float(a)) - b) / effect) for a, b in both))
    return largest, count


def study(seed) -> Report:
    """Of one number of masses after the other an orbit, if it has enough impacts before a slow one."""
    masses, number = MASSES[seed % len(MASSES)], 1 + seed // len(MASSES)
    report, (system, state) = new_report(drawn=1), drawn(number, masses)
    orbit = vs.simulate(system, state, PERIODS)
    if orbit.status != "ok":
        report.wrong.append(f"seed {seed}, {masses} masses: {orbit.status}")
    elif fast_impacts(orbit) > LEAST:
        errors, count = errors_of_impacts(system, state, orbit, number)
        if max(errors.values()) > LARGEST:  # three moves may by accident do next to nothing to one of the numbers
            errors, _ = errors_of_impacts(system, state, orbit, number, moves=12)
        report.counted.update({"orbits": 1, "impacts": count, size("errors", max(errors.values())): 1})
        if not max(errors.values()) < LARGEST:
            report.wrong.append(f"seed {seed}, {masses} masses: errors {errors}")
    return report
