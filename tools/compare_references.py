"""Holds the simulator of tests/reference/events.py against the two that it replaces, on 200 random machines.

`PYTHONPATH=tests python tools/compare_references.py > tests/data/reference.log`: one line a machine, with the largest
difference of any number of the two orbits, as a part of it or of 1.
"""

import math
import time

import numpy as np
from mpmath import mp, mpf
from reference import any_naive, compliant
from reference.events import simulate
from reference.machine import machine_of

import vibro_sweep as vs

MACHINES = 200
DIGITS = 40  # so that 30 are left where an orbit is chaotic
PERIODS, IMPACTS, CONTACTS = 12, 80, 30


def stop_of(rng, mass):
    """A compliant stop; its damping ratio z is 0, or 0.01 to 2."""
    k, z = 10 ** rng.uniform(0, 5), rng.choice([0, 10 ** rng.uniform(-2, 0.3)])
    preload = rng.choice([0, 10 ** rng.uniform(-2, 0.5)])
    return {"k_stop": k * mass, "c_stop": 2 * z * math.sqrt(k) * mass, "preload": preload}


def drawn(seed):
    """(law, oscillator, start): rigid stops for even seeds, R from 0 to 1; else compliant ones, or both."""
    rng = np.random.default_rng([seed, 61])
    N = int(rng.integers(1, 5))
    A, B = rng.normal(size=(2, N, N))
    M = np.eye(N) + 0.3 * A @ A.T if rng.random() < 0.5 else np.diag(rng.uniform(0.5, 3, N))
    K = B @ B.T + 0.2 * np.eye(N)
    normal = np.eye(N)[0] if rng.random() < 0.6 else rng.normal(size=N)
    mass = 1 / (normal @ np.linalg.solve(M, normal))
    stops = str(rng.choice(["both", "right"]))
    numbers = dict(force=rng.normal(size=N), omega=rng.uniform(0.3, 2), b=rng.uniform(0.05, 0.5), tau=rng.uniform(0, 6))
    start = np.zeros(2 * N)
    start[1::2] = 0.5 * rng.normal(size=N)
    if seed % 2 == 0:
        laws, law = {"R": float(rng.choice([0.0, rng.uniform(0, 0.5), rng.uniform(0.5, 1), 1.0]))}, "rigid"
        numbers["constant"] = rng.choice([0, 1]) * rng.normal(size=N)
    else:
        law = str(rng.choice(["displacement", "force"]))
        laws = stop_of(rng, mass) | {"release": law}
        if stops == "both":
            left = {f"{name}_left": x for name, x in stop_of(rng, mass).items()}
            laws |= [{}, left, {"R_left": rng.uniform(0.2, 1)}][rng.integers(3)]
        law += "+rigid" * int("R_left" in laws) + "+preload" * int(laws["preload"] > 0)
        if rng.random() < 0.2:  # inside a stop
            start[0::2] = normal / (normal @ normal) * numbers["b"] * (1 + 10 ** rng.uniform(-6, 0.3))
    return (
        law,
        vs.Oscillator(M, K, rng.uniform(0, 0.2) * K, contact_normal=normal, stops=stops, **numbers, **laws),
        start,
    )


def of_rigid(old, new):
    """Rows of numbers of both orbits."""
    hits, rests, section = old
    rows = [(hit.t, hit.side, hit.side * hit.v, *hit.y) for hit in hits], [tuple(rest) for rest in rests], section
    others = [(hit.t, hit.side, hit.v, *hit.y) for hit in new.impacts], [rest[:3] for rest in new.rests], new.section
    return rows, others


def of_compliant(old, new):
    """The same, until the first rest: the old simulator follows chatter on a rigid stop for ever."""
    end = new.rests[0].t_on - mpf("1e-15") if new.rests else math.inf
    contacts = [[closed[:7] for closed in orbit.contacts if closed.t_release < end] for orbit in (old, new)]
    impacts = [hit for hit in old.impacts if hit[0] < end], [(e.t, e.side, e.v) for e in new.impacts if e.t < end]
    first, second = zip(contacts, impacts, strict=True)
    if new.rests:
        return first, second
    places = [[(sum(at),) for at in orbit.places] for orbit in (old, new)]
    return (*first, old.section, places[0], [(old.taken,)]), (*second, new.section, places[1], [(new.taken,)])


def compared(seed):
    """What has been drawn, how many impacts, contacts and rests, the largest difference, seconds of both."""
    law, system, start = drawn(seed)
    q, state, times = system.linear, start.tolist(), [time.process_time()]
    with mp.workdps(DIGITS):
        if law == "rigid":
            old = any_naive.simulate(q, state, periods=PERIODS, impacts=IMPACTS, digits=DIGITS)
            times.append(time.process_time())
            new = simulate(machine_of(q), state, periods=PERIODS, impacts=IMPACTS, digits=DIGITS)
            rows, others = of_rigid(old, new)
        else:
            numbers = {"contacts": CONTACTS, "periods": PERIODS, "digits": DIGITS}
            old = compliant.simulate(q, state, **numbers, steps=5000)
            times.append(time.process_time())
            new = simulate(machine_of(q), state, **numbers)
            rows, others = of_compliant(old, new)
        times.append(time.process_time())
        worst = math.inf
        if [len(row) for row in rows] == [len(row) for row in others]:
            numbers = [[a for row in some for numbers in row for a in numbers] for some in (rows, others)]
            worst = max(float(abs(a - b) / max(1, abs(a))) for a, b in zip(*numbers, strict=True))
    counts = len(new.impacts), len(new.contacts), len(new.rests)
    return (law, system.masses, *counts, f"{worst:.1e}"), np.diff(times)


def main():
    print("seed law masses impacts contacts rests difference")
    seconds = 0
    for seed in range(MACHINES):
        row, times = compared(seed)
        seconds = seconds + times
        print(seed, *row, flush=True)
    print(f"# seconds of processor time, old and new: {seconds[0]:.1f} {seconds[1]:.1f}")


if __name__ == "__main__":
    main()
