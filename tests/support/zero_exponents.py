"""Oscillators some of whose exponents are 0, drawn at random; roots of free motion in many digits.

Free motion is compared with its roots in 100 digits, regular motion with the exponents 0 that integrable systems have,
and chaos with the exponents of a record 100 times as long.
"""

import math

import numpy as np
from mpmath import mp

import vibro_sweep as vs
from support.searching import Report, new_report, size

WITHIN = 5  # times the stated error
CERTAIN = 2.0  # standard errors by which an exponent must differ from zero to be above or below it
DIGITS, NOTHING = 100, 1e-25  # a root of multiplicity m keeps DIGITS/m of them


def chain_matrix(springs):
    """(n, n) of n masses in a row between walls, (n + 1,) springs or dampers."""
    inner = springs[1:-1]
    return np.diag(springs[:-1] + springs[1:]) - np.diag(inner, 1) - np.diag(inner, -1)


def free(seed, most=4):
    """An oscillator of up to `most` masses that strikes nothing; springs, dampers or modes are missing at random."""
    rng = np.random.default_rng([seed, 28])
    n, kind = int(rng.integers(1, most + 1)), seed % 4
    k = rng.choice([0, 1], n + 1, p=[0.4, 0.6]) * 10 ** rng.uniform(-3, 4, n + 1)
    c = rng.choice([0, 1], n + 1) * 10 ** rng.uniform(-4, 2, n + 1)
    if kind == 1:  # classical damping
        c = k * 10 ** rng.uniform(-4, 0)
    K, C = chain_matrix(k), chain_matrix(c if kind != 2 else 0 * c)
    if kind == 3:  # full matrices, whose modes 0 are so but for rounding
        Q = np.linalg.qr(rng.normal(size=(n, n)))[0]
        K, C = (Q * (rng.choice([0, 1], n) * 10 ** rng.uniform(-2, most, n)) @ Q.T for most in (4, 2))
        K, C = (K + K.T) / 2, (C + C.T) / 2
    along = np.eye(n)[0] if rng.random() < 0.5 else rng.normal(size=n)
    if n > 1 and rng.random() < 0.5:
        along = np.eye(n)[0] - np.eye(n)[1]
    numbers = {"force": rng.normal(size=n), "omega": 10 ** rng.uniform(-1, 1), "R": 0.6, "b": 1e12, "tau": 0.0}
    return vs.Oscillator(M=np.diag(10 ** rng.uniform(-2, 2, n)), K=K, C=C, contact_normal=along, **numbers)


def real_parts(system):
    """Of the roots r of det(r^2 M + r C + K) = 0, descending: the exponents of free motion."""
    q = system.linear
    n = len(q.M)
    with mp.workdps(DIGITS):
        M, K, C = (mp.matrix(matrix.tolist()) for matrix in (q.M, q.K, q.C))
        A = mp.zeros(2 * n)
        A[:n, n:], A[n:, :n], A[n:, n:] = mp.eye(n), -(M**-1) * K, -(M**-1) * C
        roots = mp.eig(A, left=False, right=False)
        return np.sort([float(mp.re(r)) if abs(mp.re(r)) > NOTHING else 0.0 for r in roots])[::-1]


def regular(seed):
    """A mass between stops without losses and without forcing, and a start: its energy is kept, so it is regular."""
    rng = np.random.default_rng([seed, 29])
    omega, b = 10 ** rng.uniform(-0.5, 0.5), 10 ** rng.uniform(-1, 0.3)
    numbers = {"k": 1.0, "zeta": 0.0, "F": 0.0, "omega": omega, "R": 1.0, "tau": 0.0, "b": b}
    if rng.random() < 0.4:
        numbers["stops"] = "right"
    return vs.Oscillator.named("one_mass", **numbers), b * np.array([rng.uniform(-1, 1), rng.uniform(0.5, 5)])


def of_two_masses(seed, zeta=0.0, R=1.0, F=0.0):
    """A ball in the cavity of a host, and a start; by default nothing takes energy or brings it."""
    rng = np.random.default_rng([seed, 30])
    b = 10 ** rng.uniform(-1, 0.3)
    numbers = {"mass_ratio": 10 ** rng.uniform(-2, 0), "zeta": zeta, "F": F, "omega": 10 ** rng.uniform(-0.5, 0.5)}
    start = np.array([rng.uniform(-1, 1), rng.uniform(-1, 1), 0.0, rng.uniform(-1, 1)]) * b
    start[2] = start[0] + 0.5 * b * rng.uniform(-1, 1)
    return vs.Oscillator.named("ball_in_cavity", **numbers, b=b, R=R, tau=0.0), start


def dissipative(seed):
    """An oscillator of one mass or two with losses under a force, and a start; many are chaotic."""
    rng = np.random.default_rng([seed, 31])
    zeta, R, omega, b = 10 ** rng.uniform(-3.5, -0.7), rng.uniform(0.5, 1), 10 ** rng.uniform(-0.5, 0.5), 0.0
    b = 10 ** rng.uniform(-1.3, 0.7)
    common = {"zeta": zeta, "R": R, "omega": omega, "b": b, "tau": 0.0}
    if rng.random() < 0.5:
        return vs.Oscillator.named("one_mass", k=1.0, F=1.0, **common), b * rng.uniform(-0.9, 0.9, 2)
    numbers = {"mu_m": 10 ** rng.uniform(-1, 1), "mu_k": 10 ** rng.uniform(-1, 1), "f2": rng.uniform(0, 1)}
    return vs.System(**numbers, **common), b * rng.uniform(-0.9, 0.9, 4)


def compare(report: Report, where: str, far, error) -> None:
    """Count numbers that are off by `far`, and how many times their error that is."""
    ratios = far / np.maximum(error, np.finfo(float).tiny)
    report.counted["exponents"] += len(ratios)
    report.counted.update(size("exponents", ratio, (1, 2, WITHIN)) for ratio in ratios)
    report.wrong.extend(f"{where}: off by {ratio:.3g} errors" for ratio in ratios if not ratio <= WITHIN)


def study_of_free_motion(seed, most=4) -> Report:
    """Of up to `most` masses; zeros must be exactly 0."""
    report, system = new_report(drawn=1), free(seed, most)
    exponents = vs.lyapunov(system, np.zeros(2 * len(system.linear.M)), 300, 100)
    if np.isnan(exponents).any():
        return report
    known, exact = np.isfinite(exponents), real_parts(system)
    compare(report, f"seed {seed}", np.abs(exponents - exact)[known], exponents.error[known])
    report.counted["zeros"] += int(np.count_nonzero(exact == 0))
    report.wrong.extend(f"seed {seed}: {number} for 0" for number in exponents[exact == 0] if number != 0)
    return report


def study_of_regular_motion(seed) -> Report:
    """One mass: both exponents are 0. Two masses: those of the flow and of the energy are, and all come in pairs."""
    report, (system, start) = new_report(drawn=1), regular(seed) if seed % 2 == 0 else of_two_masses(seed)
    exponents = vs.lyapunov(system, start, 1300, 200)
    zero = exponents if len(exponents) == 2 else np.array([exponents[1], exponents[2], exponents[0] + exponents[3]])
    compare(report, f"seed {seed}", np.abs(zero), exponents.error[: len(zero)])
    report.counted["chaotic"] += int(len(exponents) == 4 and exponents[0] > CERTAIN * exponents.error[0])
    return report


def scatter(running, T):
    """The standard error of exponents from `lyapunov_running` (periods, n), by parts and their correlation alone."""
    periods = len(running)
    growth = running * np.arange(1, periods + 1)[:, None] * T
    ends = np.arange(1, 21) * (periods // 20) - 1
    rates = np.diff(growth[ends], axis=0, prepend=0) / (periods // 20 * T) - running[-1]
    squares = (rates**2).sum(axis=0)
    c = np.clip((rates[1:] * rates[:-1]).sum(axis=0) / squares + 1 / 20, 0, 0.8)
    return np.sqrt(squares / (20 * 19) * (1 + c) / (1 - c))


def study_of_chaos(seed) -> Report:
    """Whether chaos is told from zero as well as by the scatter of parts of the record alone.

    Of an orbit whose lambda_1 > 0 is certain from a record 100 times as long.
    """
    report, (system, start) = new_report(drawn=1), dissipative(seed)
    how = {"observe": ["section", "lyapunov", "convergence"], "start": start, "transient": 1300}
    short = vs.sweep(system, {"b": [system.b]}, record=200, **how).isel(b=0)
    if not (short.period == 0 and short.status == 0 and np.isfinite(short.lyapunov).all()):
        return report
    long = vs.lyapunov(system, start, 1300, 20_000)
    if not long[0] > 5 * long.error[0]:
        return report
    m = int(np.argmax(short.lyapunov_running[-1].values))
    alone = float(scatter(short.lyapunov_running.values, system.period)[m])
    exponent, error = float(short.lyapunov[0]), float(short.lyapunov_error[0])
    shear = math.log(2) / (200 * system.period)
    report.counted["certain"] += 1
    report.counted.update(
        {"by the scatter": int(exponent > CERTAIN * alone), "as stated": int(exponent > CERTAIN * error)}
    )
    report.counted.update([size("errors over the scatter", error / alone, (1, 1.2, 2))])
    if not math.isclose(error, max(alone, shear), rel_tol=1e-6, abs_tol=1e-12):
        report.wrong.append(f"seed {seed}: error {error:.3g}, by the scatter {alone:.3g}, of the shear {shear:.3g}")
    return report
