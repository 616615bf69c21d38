"""Exponents of periodic orbits with compliant stops, as sweeps find them, against sixty digits.

Of a random oscillator a sweep over the clearance finds attractors; the first periodic one with contacts counts. The
reference (reference/events.py) makes it periodic to many digits by Newton's method, and differences of its orbits
give the monodromy matrix. Where stops relax at the section their places are numbers of the state, too: as many of
the multipliers as there are states are compared, the largest ones; of a complex pair one may be the last of them.
"""

import math
from typing import NamedTuple

import numpy as np
from mpmath import mp, mpf
from reference.events import simulate
from reference.machine import machine_of

import vibro_sweep as vs
from support.searching import Report, new_report, size

DIGITS = 80  # and two for each of the smallest multiplier
STEP = -30  # power of ten, and one for each of these
CLOSED = 10  # digits of the periodic orbit beyond the step
MOST_STEPS = 8
MOST_CONTACTS = 30  # a period
MOST_DIGITS = 120  # of the smallest multiplier
WITHIN = 5  # times the stated error
PRECISE = 1e-9  # such errors say that an orbit has found its period
CLEARANCES = np.linspace(0.3, 0.9, 8)  # in parts of the grazing clearance


class Compared(NamedTuple):
    """Of an oscillator; `period` 0: no periodic attractor with contacts was found."""

    seed: int
    system: vs.Oscillator
    period: int = 0
    relaxing: int = 0  # stops that relax at the section
    share: float = 0.0  # of the time in contact
    errors: np.ndarray = np.empty(0)  # of the exponents, in units of omega
    stated: np.ndarray = np.empty(0)
    multiplier_errors: np.ndarray = np.empty(0)
    multipliers_stated: np.ndarray = np.empty(0)


def drawn(seed):
    """An oscillator of one to three masses, k_stop 1 to 10^8 times the stiffness, damping none to overdamped.

    Overdamped stops that the mass leaves by `displacement` are at most a thousand times as stiff: stiffer ones hold it
    for long.
    """
    rng = np.random.default_rng([seed, 21])
    N = 1 + seed % 3
    M = np.diag(rng.uniform(0.5, 3, N))
    B = rng.normal(size=(N, N))
    K = B @ B.T + 0.3 * np.eye(N)
    normal = np.eye(N)[0] if rng.random() < 0.5 else rng.normal(size=N)
    release = str(rng.choice(["displacement", "force"]))
    laws = {"release": release} | stop_of(rng, M, K, normal, release)
    stops = str(rng.choice(["both", "right"]))
    if stops == "both":
        kind = rng.integers(3)  # the same law as on the right, another one, or a rigid stop
        other = {f"{name}_left": value for name, value in stop_of(rng, M, K, normal, release).items()}
        laws |= ({}, other, {"R_left": rng.uniform(0.3, 0.95)})[kind]
    numbers = dict(force=rng.normal(size=N), omega=rng.uniform(0.5, 1.6), b=1.0, tau=rng.uniform(0, 6))
    damping = rng.uniform(0.05, 0.25) * K + rng.uniform(0, 0.1) * M
    return vs.Oscillator(M, K, damping, contact_normal=normal, stops=stops, **numbers, **laws)


def stop_of(rng, M, K, normal, release):
    """k_stop, c_stop and preload of a stop."""
    mass = 1 / (normal @ np.linalg.solve(M, normal))
    kind, power = rng.choice(["elastic", "damped", "damped", "overdamped"]), rng.uniform(0, 8)
    z = {"elastic": 0.0, "damped": 10 ** rng.uniform(-2, 0), "overdamped": 10 ** rng.uniform(0, 0.7)}[kind]
    if kind == "overdamped" and release == "displacement":
        power *= 3 / 8
    k = 10**power / (normal @ np.linalg.solve(K, normal))
    return {
        "k_stop": k,
        "c_stop": 2 * z * math.sqrt(k * mass),
        "preload": rng.choice([0, 10 ** rng.uniform(-2.5, 0)]),
    }


def compared(seed):
    """What is compared of oscillator `seed`."""
    system = drawn(seed)
    axis = few_contacts(system, CLEARANCES * vs.grazing(system).b)
    return compared_at(axis, system, seed) if len(axis) else Compared(seed, system)


def compared_at(axis, system, seed=0):
    """What is compared of the first periodic orbit with contacts at these clearances."""
    data = vs.sweep(
        system, {"b": axis}, transient=800, record=64, observe=["section", "lyapunov", "multipliers", "contacts"]
    )
    touched = data.contacts_right + data.contacts_left
    usual = np.isfinite(data.lyapunov).all("exponent")  # a rest on a preloaded stop loses dimensions
    counted = np.flatnonzero((data.status == 0) & (data.period > 0) & (touched > 0) & usual)
    if not len(counted):
        return Compared(seed, system)
    at = data.isel(b=counted[0])
    system, period = system.replace(b=float(axis[counted[0]])), int(at.period)
    state = [float(at[f"{letter}{mass}"][-1]) for mass in range(1, system.masses + 1) for letter in "xv"]
    small = -float(at.lyapunov.min()) * period * system.period / math.log(10)
    if small > MOST_DIGITS:
        return Compared(seed, system)
    exact, relaxing = multipliers(system.linear, state, period, math.ceil(small))
    logs = np.array([float(mp.log(abs(one))) for one in exact])
    found = at.multiplier_re.values + 1j * at.multiplier_im.values
    return Compared(
        seed, system, period, relaxing, float(at.contact_time),
        np.abs(at.lyapunov.values - logs / (period * system.period)) / system.linear.omega,
        at.lyapunov_error.values / system.linear.omega,
        np.array([float(min(min(abs(one - other), abs(one - other.conjugate())) for other in exact)) for one in found]),
        at.multiplier_error.values,
    )  # fmt: skip


def compared_relaxing(seed):
    """What is compared of an oscillator whose two stops are touched while they relax, most of them."""
    rng = np.random.default_rng([seed, 23])
    system = drawn_relaxing(seed, rng)
    return compared_at([rng.uniform(0.03, 0.8) * vs.grazing(system).b_right], system, seed)


def drawn_relaxing(seed, rng):
    """An oscillator of one or two masses with two damped stops that are left by force."""
    numbers = dict(b=0.5, omega=rng.uniform(0.4, 1.3), zeta=rng.uniform(0.01, 0.1), stops="both", release="force")
    law = relaxing_stop(rng) | {"preload": rng.choice([0, 0, 10 ** rng.uniform(-3, -0.5)])}
    if rng.random() < 0.3:
        law |= {f"{name}_left": value for name, value in relaxing_stop(rng).items()}
    if seed % 2:
        return vs.System(mu_m=3, mu_k=2, f2=0.4, **numbers, **law)
    return vs.Oscillator.named("one_mass", k=1, F=1, tau=0.3, **numbers, **law)


def relaxing_stop(rng):
    """k_stop and c_stop of a damped or overdamped stop."""
    k = 10 ** rng.uniform(0.3, 2.5)
    return {"k_stop": k, "c_stop": 2 * 10 ** rng.uniform(-0.1, 0.8) * math.sqrt(k)}


def few_contacts(system, axis):
    """The clearances at which the mass touches its stops, and does not bounce on a preload ever faster."""
    data = vs.sweep(system, {"b": axis}, transient=40, record=20, observe=["contacts"])
    touched = (data.contacts_right + data.contacts_left).values
    return axis[(data.status.values == 0) & (touched > 0) & (touched <= MOST_CONTACTS * 20)]


def multipliers(q, state, period, small):
    """The multipliers, by falling modulus, of the periodic orbit near this state, and how many stops relax there.

    small : so many digits the smallest multiplier lies below 1
    """
    masses, digits, step = q.masses, DIGITS + 2 * small, mpf(10) ** (STEP - small)
    with mp.workdps(digits + 20):
        machine = machine_of(q)
        first = simulate(machine, state, periods=period, digits=digits)
        stops = len(first.places[period])
        relaxing = [n for n in range(stops) if first.places[period][n] > 0]
        u = mp.matrix([*first.section[period], *(first.places[period][n] for n in relaxing)])

        def mapped(u):
            places = [mpf(0)] * stops
            for n, s in zip(relaxing, u[2 * masses :], strict=True):
                places[n] = s
            end = simulate(machine, list(u[: 2 * masses]), periods=period, digits=digits, places=places)
            return mp.matrix([*end.section[period], *(end.places[period][n] for n in relaxing)])

        for _ in range(MOST_STEPS):
            away, J = mapped(u) - u, mp.matrix(len(u))
            for j in range(len(u)):
                beside = u.copy()
                beside[j] += step
                column = (mapped(beside) - u - away) / step
                for i in range(len(u)):
                    J[i, j] = column[i]
            if mp.norm(away) < step * mpf(10) ** -CLOSED:
                values = mp.eig(J, left=False, right=False)
                return sorted(values, key=lambda value: -abs(value))[: 2 * masses], len(relaxing)
            u += mp.lu_solve(mp.eye(len(u)) - J, away)
    raise ArithmeticError(f"no periodic orbit near {state}")


def study(seed) -> Report:
    return reported(compared(seed))


def study_of_relaxing(seed) -> Report:
    return reported(compared_relaxing(seed))


def reported(one: Compared) -> Report:
    """How many exponents were compared, and how many times their error they are off."""
    if not one.period:
        return new_report(tried=1)
    report = new_report(tried=1, orbits=1, relaxing=int(one.relaxing > 0), precise=int(one.stated.max() < PRECISE))
    for name, errors, stated in (
        ("exponents", one.errors, one.stated),
        ("multipliers", one.multiplier_errors, one.multipliers_stated),
    ):
        ratios = errors / np.maximum(stated, np.finfo(float).tiny)
        report.counted.update(size(name, ratio, (1, 2, WITHIN)) for ratio in ratios)
        report.wrong.extend(f"seed {one.seed}: {name} by {ratio:.3g} errors" for ratio in ratios if not ratio <= WITHIN)
    return report
