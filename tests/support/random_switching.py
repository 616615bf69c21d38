"""Branches of attractors of random oscillators of all models, from branch to branch: what `switch` gives at their
special points is held against simulation, and no branch may come twice."""

from itertools import combinations

import numpy as np

import vibro_sweep as vs
from support.branch_rows import middle
from support.drawn_oscillators import positive
from support.random_branches import random_oscillator, random_system, within
from support.searching import Report, new_report

CLOSE = 1e-9  # of the state after a period of simulation, relative, times the largest multiplier
TELLS = 1e7  # largest multiplier with which a simulation over one period says something
APART = 1e-6  # of the size of the gap: states of one orbit that differ by less are the same
MOST_BRANCHES = 12


def one_mass(rng) -> vs.Oscillator:
    """On a spring; or free: a ball on a table, or between two walls, with a damper or without."""
    free = rng.random() < 0.4
    numbers = dict(k=0.0 if free else 1.0, zeta=float(rng.choice([0, 10 ** rng.uniform(-2, -0.5)])), tau=0.3)
    numbers |= dict(F=rng.uniform(0.5, 2), omega=rng.uniform(0.3, 2), R=rng.uniform(0.3, 0.95))
    if free and rng.random() < 0.5:
        return vs.Oscillator.named("one_mass", **numbers, constant=-rng.uniform(0.1, 0.6), b=0.0, stops="left")
    stops = "both" if free else str(rng.choice(["both", "right", "left"]))
    if not free and numbers["zeta"] == 0:
        numbers["zeta"] = 0.02
    return vs.Oscillator.named("one_mass", **numbers, b=rng.uniform(0.1, 1.5), stops=stops)


def ball_in_cavity(rng) -> vs.Oscillator:
    numbers = dict(mass_ratio=10 ** rng.uniform(-2, 0), zeta=10 ** rng.uniform(-2, -0.5), F=rng.uniform(0.2, 1.5))
    return vs.Oscillator.named(
        "ball_in_cavity", **numbers, omega=rng.uniform(0.4, 1.6), R=rng.uniform(0.4, 0.95), b=rng.uniform(0.1, 1.5),
        tau=0.3,
    )  # fmt: skip


def chain(rng) -> vs.Oscillator:
    n = int(rng.choice([2, 3]))
    numbers = dict(
        m=rng.uniform(0.5, 2, n), k=rng.uniform(0.3, 2, n + 1), c=rng.uniform(0.02, 0.2, n + 1),
        force=rng.uniform(-1, 1, n), stop_at=int(rng.integers(1, n + 1)), omega=rng.uniform(0.3, 1.5), tau=0.3,
        R=rng.uniform(0.3, 0.95), stops=str(rng.choice(["both", "right"])),
    )  # fmt: skip
    star = vs.grazing(vs.Oscillator.named("chain", **numbers, b=1.0)).b
    return vs.Oscillator.named("chain", **numbers, b=star * rng.uniform(0.1, 1.0))


def resting(rng) -> vs.System:
    """R = 0: the mass may rest after one impact."""
    return random_system(rng).replace(R=0.0)


def symmetric(rng) -> vs.Oscillator:
    """Two masses with full matrices between equal stops, without a constant force."""
    numbers = dict(
        M=positive(rng, 2, 1.0), K=positive(rng, 2, 0.3), C=0.1 * positive(rng, 2, 0.1),
        contact_normal=rng.normal(size=2), force=rng.normal(size=2), omega=rng.uniform(0.3, 1.5), tau=0.3,
        R=rng.uniform(0.3, 0.95),
    )  # fmt: skip
    star = vs.grazing(vs.Oscillator(**numbers, b=1.0)).b
    return vs.Oscillator(**numbers, b=star * rng.uniform(0.1, 1.0))


DRAWN = {
    "systems": (random_system, ("b", "omega", "zeta", "R")),
    "oscillators": (random_oscillator, ("b", "omega", "offset", "R")),
    "one_mass": (one_mass, ("F", "omega", "R", "zeta")),
    "ball_in_cavity": (ball_in_cavity, ("b", "omega", "R", "mass_ratio")),
    "chain": (chain, ("b", "omega", "R")),
    "symmetric": (symmetric, ("b", "omega", "R")),
    "resting": (resting, ("b", "omega", "zeta")),
}


def study(seed: int) -> Report:
    """Of one kind of oscillators after the other; `simulated` counts orbits of which a simulation says something."""
    kind, number = list(DRAWN)[seed % len(DRAWN)], seed // len(DRAWN)
    rng, report = np.random.default_rng([number, *map(ord, kind)]), new_report(drawn=1)
    draw, names = DRAWN[kind]
    system = draw(rng)
    name = str(rng.choice(names))
    found = attractor(system, rng)
    orbit = vs.periodic_orbit(system, state=found[0], periods=found[1]) if found else None
    if orbit is None or not orbit.ok:
        return report
    value = system.parameters()[name]
    width = 0.3 * (abs(value) or 1.0)
    least = -np.inf if name == "offset" else 0.0
    bounds = (max(value - width, least), min(value + width, 1.0 if name == "R" else np.inf))
    where = f"seed {seed}, {kind}, {orbit.itinerary or 'free'} of period {orbit.period} in {name}"
    _hold(report, where, orbit, name, bounds)
    return report


def attractor(system, rng, tries=4):
    """(state, period) of a periodic attractor, or None."""
    q = system.linear
    low = q.contact.low if np.isfinite(q.contact.low) else q.contact.high - 2
    high = q.contact.high if np.isfinite(q.contact.high) else q.contact.low + 2
    for _ in range(tries):
        gap, state = rng.uniform(low, high), 0.5 * (high - low) * rng.normal(size=2 * q.masses)
        state[::2] += q.contact.normal * (gap - q.contact.normal @ state[::2]) / (q.contact.normal @ q.contact.normal)
        section = vs.simulate(system, within(system, state), 2000).section
        size = np.abs(section[-1]).max()
        periods = [n for n in range(1, 25) if np.abs(section[-1] - section[-1 - n]).max() < 1e-10 * size]
        if periods:
            return section[-1], periods[0]
    return None


def _hold(report: Report, where: str, orbit, name: str, bounds) -> None:
    try:
        found = vs.follow_branches(orbit, name, bounds, depth=1)
    except ValueError as error:
        report.wrong.append(f"{where}: follow_branches raises {error}")
        return
    report.counted["branches"] += len(found)
    report.wrong.extend(f"{where}: branch {i} failed" for i, item in enumerate(found) if not item.branch.ok)
    for i, item in enumerate(found[:MOST_BRANCHES]):
        for special in item.branch.special:
            if special.type in ("graze", "pitchfork", "flip"):
                report.counted["specials"] += 1
                there = f"{where}, branch {i}, {special.type} at {special.parameters[name]!r}"
                _switched(report, there, special, name, bounds)
    for i, j in combinations(range(len(found)), 2):
        if _kind(found[i].branch) == _kind(found[j].branch):
            report.counted["pairs"] += 1
            if _same(found[i].branch, found[j].branch, name):
                report.wrong.append(f"{where}: branches {i} and {j} are one")


def _switched(report: Report, where: str, special, name: str, bounds) -> None:
    try:
        orbits = vs.switch(special)
    except ValueError as error:
        report.wrong.append(f"{where}: switch raises {error}")
        return
    for orbit in orbits:
        report.counted["orbits"] += 1
        here = f"{where}: {orbit.itinerary} of period {orbit.period}"
        if not orbit.ok:
            report.wrong.append(f"{here}: {orbit.status}")
            continue
        _simulated(report, here, orbit)
        value = orbit.system.parameters()[name]
        if bounds[0] < value < bounds[1]:
            reach = bounds[1] - bounds[0]
            near = max(bounds[0], value - reach), min(bounds[1], value + reach)
            branch = vs.continue_orbit(orbit, name, near)
            report.counted["followed"] += 1
            if not branch.ok or branch.points.sizes["point"] < 2:
                report.wrong.append(f"{here}: it cannot be followed")


def _simulated(report: Report, where: str, orbit) -> None:
    """That the motion comes back after the period and not before, and is its own mirror image if it is said to be.

    Masses may swing far beyond the stops together: motions are distinguished by the size of the gap, not of the state.
    """
    system, n = orbit.system, orbit.period
    largest = max(1.0, float(np.abs(orbit.multipliers).max()))
    if not largest < TELLS:
        return
    run = vs.simulate(system, orbit.state, n)
    states, q = run.section, system.linear
    size = max(np.abs(states).max(), 1e-300)
    gap = max(
        np.abs(states[:, ::2] @ q.contact.normal).max(),
        *(abs(x) for x in (q.contact.low, q.contact.high) if np.isfinite(x)),
        1e-300,
    )
    report.counted["simulated"] += 1
    error = np.abs(states[-1] - orbit.state).max() / size
    if not error < CLOSE * largest:
        report.wrong.append(f"{where}: simulation ends {error:.1e} away, multiplier {largest:.1e}")
        return
    for d in range(1, n):
        apart = np.abs(states[d:] - states[:-d]).max() / gap
        if n % d == 0 and apart < APART:
            report.wrong.append(f"{where}: the period is {d}, to {apart:.1e}")
    if q.symmetric and n % 2 == 1:
        half = run.sample([n * system.period / 2])[0]
        apart = np.abs(half + orbit.state).max() / gap
        if (apart < APART) != orbit.symmetric and not APART / 100 < apart < 100 * APART:
            report.wrong.append(f"{where}: symmetric {orbit.symmetric}, mirror images differ by {apart:.1e}")


def _kind(branch) -> tuple:
    """Equal for branches of orbits that may be the same ones."""
    orbit = middle(branch)
    sides = np.array([1 if letter == "R" else -1 for letter in orbit.itinerary], int)
    rotations = [np.roll(sign * sides, k).tolist() for sign in (1, -1) for k in range(max(len(sides), 1))]
    return min(rotations), orbit.period


def _same(one, other, name: str) -> bool:
    """Whether a point inside of one branch, or its mirror image, lies on the other: by section states."""
    points, others = one.points, other.points
    names = [str(key) for key in points.data_vars if key[0] in "xv" and key[1:].isdigit()]
    p, q = points[name].values, others[name].values
    if len(p) < 3 or len(q) < 3:
        return False
    k = int(np.argmax(np.abs(p[2:] - p[:-2]))) + 1
    system = one.special[0].orbit.system.replace(**{name: float(p[k])})
    state = np.array([float(points[key][k]) for key in names])
    for i in np.flatnonzero((q[:-1] - p[k]) * (q[1:] - p[k]) <= 0):
        share = (p[k] - q[i]) / (q[i + 1] - q[i]) if q[i + 1] != q[i] else 0.0
        here, there = others.isel(point=i), others.isel(point=i + 1)
        t, v = ((1 - share) * here[key].values + share * there[key].values for key in ("impact_t", "impact_v"))
        guess = list(zip(t, here.impact_side.values, v, strict=True))
        if not guess:
            return True
        found = vs.periodic_orbit(system, guess=guess, periods=middle(other).period)
        if not found.ok:
            continue
        T, n = system.period, found.period
        times = T * np.arange(n)
        sections = [*found.sample(times), *(-found.sample(times + T / 2) if system.linear.symmetric else ())]
        if min(np.abs(state - section).max() for section in sections) < 1e-8 * max(np.abs(state).max(), 1e-300):
            return True
    return False
