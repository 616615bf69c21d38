"""Where programs go wrong without a word: impacts that are missed or invented, and errors of exponents.

Flights of the paper's oscillator have one extremum of x1 that lies 10^-k b behind a stop (is the impact seen?) or
before it (is there one that does not exist?). They are built and certified in 40 digits (tests/reference/certified.py).

Exponents with their errors are compared with those of a record that is 100 times as long: the part of them that is off
by more than 2 and by more than 5 of the errors in the file. Twenty parts of a record and a normal distribution would
put 6.0 % beyond 2 (Student's t with 19 degrees of freedom).
"""

from importlib.util import find_spec

import numpy as np
import peers
import problem
from bench import main, table

import vibro_sweep as vs

SYSTEM = problem.paper(6.6)
DECADES = (2, 4, 6, 8, 10, 12, 14)
GROUPS = 100  # times of the extremum
METHODS = {  # name: (package, solver, flights of a kind)
    "RK4, 1000 steps a period, bisection": ("numba", peers.rk4, {}, 1000),
    "SciPy DOP853, tol 1e-12": ("scipy", peers.dop853, {}, 200),
    "heyoka, one orbit, tol 1e-16": ("heyoka", peers.heyoka, {"lanes": 1}, 1000),
}
OURS = "vibro_sweep"
RIGID = {"R": 0.8}, {"b": (4.2, 7.0), "mu_k": (2.0, 8.0), "omega": (0.58, 0.68), "R": (0.5, 0.95)}
COMPLIANT = (
    {"k_stop": 400, "c_stop": 2.8, "preload": 0.05},  # a damping ratio of 0.07: restitution 0.8
    {"b": (4.2, 7.0), "mu_k": (2.0, 8.0), "omega": (0.58, 0.68), "k_stop": (50, 2000)},
)
LONGER = 100
ROWS = {}  # nothing here is compared by versions.py


def flights(reference, decade: int, behind: bool, count: int, rng) -> tuple[np.ndarray, np.ndarray]:
    """States (count, 4) at t = 0, and the times just after the extremum up to which the flight is watched."""
    from reference import certified

    b, period = SYSTEM.b, SYSTEM.period
    force, depth = reference.acceleration.astype(float), 10.0**-decade
    states, ends, need = [], [], -(-count // GROUPS)
    for _ in range(GROUPS):
        u, taken = period * rng.uniform(0.05, 0.95), 0
        before, phase = reference.before(u), reference.phase(u)
        while taken < need:
            side = rng.choice([-1, 1], 4 * need)
            z = np.zeros((4 * need, 6), certified.REAL)
            z[:, 0] = side * b * (1 + (depth if behind else -depth))
            z[:, 2:4] = b * rng.normal(size=(4 * need, 2)) * (0.5, 0.3)
            z[:, 4:] = phase
            a = -side * (z @ force)
            watch = 1.5 * np.sqrt(2 * depth * b / np.abs(a)).astype(float)
            start = z @ before.T
            start = reference.forced(start[:, :4].astype(float))
            good = (a > 0.1) & (np.abs(start[:, 0]) < b) & (u - watch > 0) & (u + watch < period)
            start, watch = start[good], watch[good]
            free = np.full(len(start), u - watch if behind else u + watch, certified.REAL)
            verdict = reference.inside(start, b, free, np.zeros(len(start)))
            chosen = np.flatnonzero(verdict == certified.POSITIVE)[: need - taken]
            states.append(start[chosen, :4].astype(float))
            ends.append(u + watch[chosen])
            taken += len(chosen)
    return np.concatenate(states)[:count], np.concatenate(ends)[:count]


def ours(state, end) -> bool:
    impacts = vs.simulate(SYSTEM, state, periods=1).impacts
    return len(impacts) > 0 and impacts["t"][0] <= end


def seen_by(make, options: dict):
    solver = make(SYSTEM, np.zeros((8, 4)), **options)

    def seen(state, end) -> bool:
        times = solver.fly(state, SYSTEM.period, 1)[0]  # a flight that ended at `end` would have a point there
        return len(times) > 0 and times[0] <= end

    return seen


def grazes(quick: bool) -> dict:
    """Missed and invented impacts of each method for each decade, and of how many flights."""
    from reference import certified

    reference, rng = certified.of_paper(SYSTEM.arguments), np.random.default_rng(1)
    count = 200 if quick else 1000
    sets = [[flights(reference, k, behind, count, rng) for behind in (True, False)] for k in DECADES]
    methods, found = {OURS: (ours, count)}, {}
    for name, (package, make, options, most) in METHODS.items():
        if find_spec(package):
            methods[name] = seen_by(make, options), min(count, most // 10 if quick else most)
    for name, (seen, number) in methods.items():
        cells = []
        for behind, before in sets:
            struck, free = (sum(map(seen, states[:number], ends[:number])) for states, ends in (behind, before))
            cells.append([number - int(struck), int(free)])
        found[name] = {"flights": number, "cells": cells}
    return found


def exponents(law: dict, key: str, ends: tuple, values: int, record: int):
    system = vs.System(**problem.PAPER | {"b": 6.0} | law)
    axes = {key: {"start": ends[0], "stop": ends[1], "num": values}}
    return vs.sweep(system, axes, transient=1300, record=record, observe=["lyapunov", "multipliers"])


def calibration(law: dict, key: str, ends: tuple, values: int, longer: int) -> dict:
    """How often the exponents of a sweep lie beyond 2 and 5 errors of those of a longer record."""
    short, long = (exponents(law, key, ends, values, 200 * more) for more in (1, longer))
    # an orbit that is found not settled in the long run was on another motion in the short one
    ok = ((short.status == 0) & (long.status == 0) & np.isfinite(short.lyapunov).all("exponent")).values
    far = np.abs(short.lyapunov - long.lyapunov).values / short.lyapunov_error.values
    periodic = short.period.values > 0
    parts = [float(np.mean(far[which] > limit)) for which in (ok, ok & ~periodic) for limit in (2, 5)]
    name = f"{key}, {'compliant' if 'k_stop' in law else 'rigid'}"
    return {"sweep": name, "points": int(ok.sum()), "periodic": int((ok & periodic).sum()), "parts": parts}


def measure(quick: bool) -> dict:
    rows = []
    for law, sweeps in (RIGID, COMPLIANT):
        for key, ends in list(sweeps.items())[: 1 if quick else None]:
            values = 101 if quick else 1001 if law is RIGID[0] else 401
            rows.append(calibration(law, key, ends, values, 10 if quick else LONGER))
    return {"grazes": grazes(quick), "calibration": rows}


def text(data: dict) -> str:
    lines = []
    for name, row in data["grazes"].items():
        cells = [f"{missed} + {invented}" if invented else str(missed) for missed, invented in row["cells"]]
        lines.append((name, row["flights"], *cells))
    header = ("impacts missed (+ invented), k =", "flights of each kind", *DECADES)
    rows = [
        (row["sweep"], row["points"], row["periodic"], *(f"{100 * part:.2f} %" for part in row["parts"]))
        for row in data["calibration"]
    ]
    names = [f"beyond {limit}, {which}" for which in ("all", "no period") for limit in (2, 5)]
    return table(header, lines) + "\n" + table(("exponents of a sweep", "points", "periodic", *names), rows)


if __name__ == "__main__":
    main(ROWS, measure, text)
