"""Whether orbits have arrived, told from a record, and judged by themselves going on for 30 times longer."""

import numpy as np

import vibro_sweep as vs
from support.searching import Report, new_report

LONGER = 31  # times the periods up to the end of the record
FAR = 1e-5  # of the sizes of coordinates: no orbit that is ok with a period may be farther from it
THERE = 1e-7  # of the sizes: the first points of a record that are nearer to the periodic orbit had arrived
MOST = 3_000_000  # periods of `settle`
MASSES = ("one", "two", "isolator", "free", "ball")


def drawn(rng: np.random.Generator) -> vs.Oscillator:
    """One or two masses, in or off resonance, Q from 5 to 100 000; isolators that creep, free masses, balls."""
    kind, Q, resonant = rng.choice(MASSES), 10 ** rng.uniform(np.log10(5), 5), rng.random() < 0.5
    if kind in ("one", "ball"):
        M, K, force, normal = np.eye(1), np.eye(1), np.array([rng.uniform(0.1, 1)]), [1.0]
        if kind == "ball" and rng.random() < 0.5:
            K = np.zeros((1, 1))
    else:
        k = 10 ** rng.uniform(-1, 0.5, 2) if kind == "two" else np.array([0.0, 1.0])
        K = np.array([[k[0] + k[1], -k[1]], [-k[1], k[1]]])
        K[1, 1] += 10 ** rng.uniform(-5, -1) if kind == "isolator" else 0.0
        M, force = np.diag([1, 10 ** rng.uniform(-1, 1)]), np.array([1.0, rng.choice([0, -0.5])])
        normal = [1, -1] if rng.random() < 0.6 else [1, 0]
    damper = rng.uniform(0.1, 2) if kind == "isolator" else 10 ** rng.uniform(-4, -1) if rng.random() < 0.25 else 0.0
    C = np.eye(1) / Q if len(M) == 1 else K / Q + damper * np.diag([0.0, 1.0])
    squares = np.linalg.eigvals(np.linalg.solve(M, K)).real
    modes = np.sqrt(squares[squares > 1e-9])
    resonant = resonant and len(modes) > 0
    omega = rng.choice(modes) * (1 + rng.normal() / max(Q, 20)) if resonant else rng.uniform(0.3, 3)
    if resonant and rng.random() < 0.5:
        force = force * max(1 / Q, 1e-4)
    soft = rng.random() < 0.4
    stop = {"k_stop": 10 ** rng.uniform(-0.5, 2.5), "c_stop": 10 ** rng.uniform(-2, 0)} if soft else {}
    stop = stop or {"R": rng.uniform(0.2, 0.95)}
    falls = {"constant": [rng.uniform(0.05, 0.5)]} if kind == "ball" else {}
    stops = "right" if kind == "ball" else rng.choice(["right", "both"])
    return vs.Oscillator(
        M=M, K=K, C=C, force=force, omega=float(omega), contact_normal=normal, b=rng.uniform(0.1, 1.5), stops=stops,
        tau=0.0, **stop, **falls,
    )  # fmt: skip


def recorded(system: vs.Oscillator, transient: int, record: int, *more: str, settle: int | None = None):
    """The Dataset of one column, and its section points (record, 2 N)."""
    how = {"transient": transient, "settle": settle, "record": record, "observe": ["section", *more]}
    data = vs.sweep(system, {"b": [system.b]}, **how)
    names = [name for k in range(1, system.masses + 1) for name in (f"x{k}", f"v{k}")]
    return data, np.stack([data[name].values[0] for name in names], axis=-1)


def study(seed: int) -> Report:
    """A column of one machine and the same column later."""
    rng = np.random.default_rng([seed, 77])
    system, transient, record = drawn(rng), int(10 ** rng.uniform(2, 3.5)), int(rng.integers(40, 201))
    data, points = recorded(system, transient, record)
    later, end = recorded(system, LONGER * (transient + record), 200, "lyapunov")
    status, period, P = data.status.item(), data.period.item(), later.period.item()
    sizes = np.abs(points).max(axis=0)
    units = np.tile([1.0, system.omega], system.masses)
    sizes = np.maximum(sizes, 1e-3 * (sizes / units).max() * units)
    apart = [np.abs((points - np.roll(end, k, axis=0)[-P:][np.arange(record) % P]) / sizes) for k in range(P)]
    had_arrived = P > 0 and 3 * P + 8 <= record and min(a[:P].max() for a in apart) < THERE
    comes = P > 0 or later.approached_period.item() > 0
    largest, error = later.lyapunov.values[0, 0], later.lyapunov_error.values[0, 0]
    chaotic = P == 0 and largest > 2 * error  # whatever is said of its points
    report = new_report(
        machines=1, with_a_period=int(period > 0), on_the_way=int(status == 6), had_arrived=int(had_arrived),
        and_said_so=int(had_arrived and period > 0),
        ok_and_periodic_later=int(status == 0 and period == 0 and comes),
        irregular_later=int(not comes),
        of_these_on_the_way_before=int(not comes and status == 6),
        chaotic_later=int(chaotic),
        of_these_on_the_way=int(chaotic and later.status.item() == 6),
    )  # fmt: skip
    if period > 0 and P > 0 and min(a[-1].max() for a in apart) > FAR:
        report.wrong.append(f"seed {seed}: period {period} at {min(a[-1].max() for a in apart):.1e} from the orbit")
    return report


def study_of_settle(seed: int) -> Report:
    """Does a machine that goes on until it has arrived take more than twice what it needs?"""
    rng = np.random.default_rng([seed, 77])
    system, transient, record = drawn(rng), int(10 ** rng.uniform(2, 3.5)), int(rng.integers(40, 201))
    data, _ = recorded(system, transient, record, settle=MOST)
    arrived, took = data.status.item() == 0 and data.period.item() > 0, data.transient_periods.item()
    went_on = arrived and took > transient
    too_long = False
    if went_on:
        half, _ = recorded(system, max((took + record) // 2 - record - 1, transient), record)
        too_long = half.status.item() == 0 and half.period.item() > 0
    steps = np.diff(data.x1.values.ravel())
    away = bool((steps > 0).all() or (steps < 0).all())  # of what no spring holds: it comes to no orbit
    return new_report(
        machines=1, arrived=int(arrived), went_on=int(went_on), took_more_than_twice=int(too_long),
        not_arrived=int(data.status.item() == 6 and not away), goes_away=int(data.status.item() == 6 and away),
        without_a_period=int(data.status.item() == 0 and data.period.item() == 0),
    )  # fmt: skip
