"""The sum of the exponents of sweeps with compliant stops, and its exact value from what the files hold.

Of an orbit that begins no contact with a stop that still relaxes it is -tr(M^-1 C), less c_stop/m_e times the share of
the time in contact, and 2 nu ln R for each impact of a rigid stop, with nu of them per unit time.
"""

import math
from collections import Counter
from typing import NamedTuple

import numpy as np

import vibro_sweep as vs
from support.compliant_exponents import drawn_relaxing
from support.searching import Report, new_report

VALID = (0, 6)  # ok, and not_settled, which is a remark
MOST = 1e-12  # of a residual
LESS = 10  # times: the share of contact, a sum of many, is known to less
POINTS = 12  # along each axis of a plane
CLEARANCES = np.linspace(0.03, 0.8, 64)  # in parts of the grazing clearance
RECORD = 100
MODELS = ("two_mass", "one_mass", "chain", "matrices")


class Summed(NamedTuple):
    """Of a plane."""

    points: int
    counted: int  # with contacts, and with all exponents
    worst: float  # stored residual
    compared: int  # whose sum was formed anew
    apart: float  # from that sum, at most: of it, where it is larger than 1


def drawn(seed):
    """An oscillator with the same compliant stops on both sides, with one, or with one of them rigid; and two axes."""
    rng = np.random.default_rng([seed, 22])
    model, release = MODELS[seed % 4], str(rng.choice(["displacement", "force"]))
    z, k = rng.choice([0.0, 10 ** rng.uniform(-2, 1.5)]), 10 ** rng.uniform(0, 8)
    # the mass on the stop is 1 in the first two models and about 1 in the others
    law = {"k_stop": k, "c_stop": 2 * z * math.sqrt(k), "preload": rng.choice([0.0, 10 ** rng.uniform(-3, -0.5)])}
    stops = str(rng.choice(["both", "right", "mixed"]))
    law |= {"R_left": rng.uniform(0.3, 0.95)} if stops == "mixed" else {}
    common = {"b": 0.5, "omega": rng.uniform(0.5, 1.5), "stops": "right" if stops == "right" else "both"}
    common |= law | {"release": release}
    N = 3
    if model == "two_mass":
        named = dict(mu_m=rng.uniform(1, 10), mu_k=rng.uniform(1, 8), zeta=rng.uniform(0.01, 0.1), f2=rng.uniform(0, 1))
        system = vs.System(**named, **common)
    elif model == "one_mass":
        system = vs.Oscillator.named("one_mass", zeta=rng.uniform(0.01, 0.1), F=1, k=1, tau=0.3, **common)
    elif model == "chain":
        springs = dict(m=rng.uniform(0.5, 2, N), k=rng.uniform(0.3, 2, N + 1), c=rng.uniform(0.01, 0.1, N + 1))
        system = vs.Oscillator.named("chain", force=[1, 0, 0.4], tau=0.1, **springs, **common)
    else:
        A, B = rng.normal(size=(2, 2, 2))
        M, K = np.eye(2) + 0.2 * A @ A.T, B @ B.T + 0.3 * np.eye(2)
        system = vs.Oscillator(
            M, K, 0.1 * K, contact_normal=rng.normal(size=2), force=rng.normal(size=2), tau=0.2, **common
        )
    clearance = vs.grazing(system).b_right
    axes = {"omega": system.omega * np.linspace(0.9, 1.1, POINTS), "b": clearance * np.linspace(0.05, 0.95, POINTS)}
    return system, axes


def summed_relaxing(seed):
    """How many points of a sweep of an oscillator whose two stops relax count, and their largest residual over what it
    may be."""
    system = drawn_relaxing(seed, np.random.default_rng([seed, 24]))
    axis = CLEARANCES * vs.grazing(system).b_right
    data = vs.sweep(system, {"b": axis}, transient=800, record=64, observe=["section", "lyapunov", "multipliers"])
    counted, residual = np.isin(data.status.values, VALID), np.abs(data.lyapunov_residual.values)
    # an orbit that still comes nearer to its period has another sum by at most what its exponents are off
    away = np.where(data.period.values > 0, data.lyapunov_error.values[:, 0], 0.0)
    most = MOST + away
    return np.count_nonzero(counted & np.isfinite(residual)), np.nanmax((residual / most)[counted], initial=0.0)


def summed(seed):
    """The sums on the plane of oscillator `seed`."""
    system, axes = drawn(seed)
    q = system.linear
    rigid = math.isfinite(q.contact.low) and not q.contact.k_low > 0
    words = ["section", "lyapunov", "contacts", *(["impacts"] if rigid else [])]
    data = vs.sweep(system, axes, transient=60, record=RECORD, observe=words)
    touched = (data.contacts_right + data.contacts_left).values
    counted = np.isin(data.status.values, VALID) & (touched > 0) & np.isfinite(data.lyapunov.values).all(-1)
    exact = -np.trace(np.linalg.solve(q.M, q.C)) - q.contact.c_high / mass_of(q) * data.contact_time.values
    if rigid:
        rate = data.impacts_left.values * axes["omega"][:, None] / (2 * math.pi * RECORD)
        exact = exact + 2 * rate * math.log(q.contact.R_low)
    alike = counted & (data.period.values == 0)  # else the exponents are those of one period
    if q.contact.by_force and q.contact.c_high > 0:
        alike[:] = False
    apart = np.abs(data.lyapunov.values.sum(-1) - exact) / np.maximum(1, np.abs(exact))
    return Summed(
        counted.size, int(counted.sum()), float(np.abs(data.lyapunov_residual.values[counted]).max(initial=0.0)),
        int(alike.sum()), float(apart[alike].max(initial=0.0)),
    )  # fmt: skip


def mass_of(q):
    """m_e = 1/(n M^-1 n)."""
    return 1 / (q.contact.normal @ np.linalg.solve(q.M, q.contact.normal))


def study(seed) -> Report:
    """The sums of the exponents of a plane, as they are stored, and as contact times and impacts give them."""
    one = summed(seed)
    report = new_report(points=one.points, counted=one.counted, **{"sums formed anew": one.compared})
    if not (one.worst < MOST and one.apart < LESS * MOST):
        report.wrong.append(f"seed {seed}: residual {one.worst:.1e}, sums apart by {one.apart:.1e}")
    return report


def study_of_relaxing(seed) -> Report:
    """Motion has one multiplier more than states there; where it is one of a pair with the last one both count."""
    counted, worst = summed_relaxing(seed)
    return Report(Counter(points=int(counted)), [f"seed {seed}: {worst:.3g} times the residual"] * (not worst < 1))
