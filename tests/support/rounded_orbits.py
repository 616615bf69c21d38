"""Exponents and multipliers of periodic orbits, whose errors include the rounding of the orbit, against 30 digits."""

import numpy as np
from mpmath import log, mp, mpf
from reference.closed_orbit import ClosedOrbit, impacts_of
from reference.machine import machine_of

import vibro_sweep as vs
from support.searching import Report, new_report, size

MOST_IMPACTS = 20
WANTED = ["section", "lyapunov", "multipliers", "impacts"]
WITHIN = 5  # times the stated error


def study(seed) -> Report:
    """How many exponents and multipliers were compared, and how many times their error they are off."""
    report = new_report(drawn=1)
    with mp.workdps(30):
        for both in ratios(seed):
            for name, ratio in zip(("exponent", "multiplier"), both, strict=True):
                report.counted.update([f"{name}s", size(f"{name}s", ratio, (1, 2, WITHIN))])
                if not ratio <= WITHIN:
                    report.wrong.append(f"seed {seed}: {name} off by {ratio:.3g} errors")
    return report


def drawn(rng):
    """An oscillator of one mass or two, with losses."""
    if rng.random() < 0.5:
        M, K, C, along = np.eye(1), np.eye(1), np.array([[10 ** rng.uniform(-2.5, 0)]]), [1.0]
    else:
        M, K, C = (np.diag(10 ** rng.uniform(low, high, 2)) for low, high in ((-0.7, 0.7), (-1, 1), (-2, 0)))
        between = np.array([[1.0, -1.0], [-1.0, 1.0]])
        K, C = K + rng.choice([0, 1]) * between, C + 10 ** rng.uniform(-2, 0) * between
        along = [[1.0, 0.0], [1.0, -1.0]][rng.integers(2)]
    numbers = dict(omega=10 ** rng.uniform(-0.3, 0.5), R=rng.uniform(0.3, 0.95), b=10 ** rng.uniform(-2, 0), tau=0.3)
    return vs.Oscillator(M=M, K=K, C=C, contact_normal=along, force=rng.uniform(0.3, 1, len(M)), **numbers)


def exact(system, data):
    """The multipliers in 30 digits by falling modulus; None of an orbit that is not of few impacts alone."""
    masses = len(system.linear.M)
    state = [float(data[f"{name}{n + 1}"][-1]) for n in range(masses) for name in "xv"]
    orbit = vs.simulate(system, state, int(data.period))
    if not 0 < len(orbit.impacts) <= MOST_IMPACTS or len(orbit.sticking) or orbit.status.note:
        return None
    machine = machine_of(system.linear)
    closed = ClosedOrbit(machine, impacts_of(machine, orbit.impacts["side"]), int(data.period))
    return closed.multipliers(*closed.solve(state, orbit.impacts["t"]))


def ratios(seed):
    """Of the exponents and of the multipliers of up to two orbits: how many errors they are away. (n, 2)"""
    rng = np.random.default_rng([seed, 77])
    system = drawn(rng)
    b = system.b * 10 ** np.sort(rng.uniform(0, 0.6, 8))
    sweep = vs.sweep(system, {"b": b}, observe=WANTED, transient=3000, record=200)
    fits = (sweep.period > 0) & (sweep.status == 0) & (sweep.impacts_right + sweep.impacts_left > 0)
    size = sweep.lyapunov_error[:, 0] * sweep.period  # the hardest first
    rows = []
    for n in sorted(np.flatnonzero(fits), key=lambda n: -float(size[n]))[:2]:
        data, own = sweep.isel(b=n), system.replace(b=float(b[n]))
        multipliers = exact(own, data)
        if multipliers is None or not (data.lyapunov_error > 0).all():
            continue
        time = int(data.period) * system.period
        for i, multiplier in enumerate(multipliers):
            far = abs(log(abs(multiplier)) / time - mpf(float(data.lyapunov[i])))
            value = mp.mpc(float(data.multiplier_re[i]), float(data.multiplier_im[i]))
            apart = min(abs(value - other) for other in multipliers)
            rows.append((float(far / data.lyapunov_error[i]), float(apart / data.multiplier_error[i])))
    return rows
