"""Branches without impacts: no resonance peak at which the motion passes a stop is stepped over."""

import numpy as np
from scipy.optimize import brentq

import vibro_sweep as vs
from support.searching import Report, new_report


def study(seed) -> Report:
    """Of an oscillator with two narrow resonances a branch along omega or a ratio: both ends, against samples that lie
    far closer than the peaks are wide."""
    rng = np.random.default_rng([12, seed])
    numbers = {
        "mu_m": 10 ** rng.uniform(-0.3, 1), "mu_k": 10 ** rng.uniform(-0.3, 1), "zeta": 10 ** rng.uniform(-2.7, -1),
        "f2": rng.uniform(0, 1), "omega": rng.uniform(0.3, 2.0),
    }  # fmt: skip
    name = str(rng.choice(["omega", "mu_k", "mu_m"]))
    start, bounds = numbers[name], (0.4 * numbers[name], 2.5 * numbers[name])
    b = gap_amplitude(numbers, name, start) * 10 ** rng.uniform(0.02, 1.2)
    expected = stretch(numbers, name, start, bounds, b)
    branch = vs.continue_orbit(vs.periodic_orbit(vs.System(**numbers, R=0.8, b=b), itinerary=""), name, bounds)
    ends = [branch.begins.parameters[name], branch.ends.parameters[name]]
    report = new_report(branches=1, peaks=sum(end not in bounds for end in expected))
    if not np.allclose(ends, expected, rtol=1e-9, atol=0):
        report.wrong.append(f"seed {seed}, {name} with b = {b}: {ends}, and by samples {expected}")
    return report


def gap_amplitude(numbers, name, value):
    """Of x1 without impacts, from eq. (3)."""
    p = numbers | {name: value}
    K = np.array([[1, -1], [-1, 1 + p["mu_k"]]])
    Z = K - p["omega"] ** 2 * np.diag([1, p["mu_m"]]) + 2j * p["zeta"] * p["omega"] * K
    return abs(np.linalg.solve(Z, [1 - p["f2"], p["f2"]])[0])


def stretch(numbers, name, start, bounds, b):
    """The values around `start` up to which the amplitude stays below b, by many samples."""
    ends = []
    for bound in bounds:
        values = start + (bound - start) * np.linspace(0, 1, 4001)
        size = np.array([gap_amplitude(numbers, name, value) for value in values]) - b
        k = int(np.argmax(size > 0))
        if size[k] > 0:
            ends.append(
                brentq(lambda value: gap_amplitude(numbers, name, value) - b, *values[k - 1 : k + 1], xtol=1e-15)
            )
        else:
            ends.append(bound)
    return ends
