"""Branches of attractors of random systems, held against simulation on their stable pieces and at the ends of these.

Oscillators have one mass or three, unequal stops and any damping.
"""

import itertools
import math
from functools import partial

import numpy as np

import vibro_sweep as vs
from support.drawn_oscillators import positive
from support.searching import Report, new_report
from vibro_sweep.oscillator.linear import amplitudes, static_state

MOST_PERIODS = 20_000  # of one simulation
INSIDE = (2e-3, 2e-2, 0.1, 0.5, 1.0)  # from the end of a piece to the point before it


def random_system(rng) -> vs.System:
    system = vs.System(
        mu_m=10 ** rng.uniform(-0.5, 1), mu_k=10 ** rng.uniform(-0.5, 1), zeta=10 ** rng.uniform(-2, -0.5),
        f2=float(rng.choice([0, rng.uniform(0, 1)])), omega=rng.uniform(0.3, 2), R=rng.uniform(0.3, 1.0), b=1,
        stops=str(rng.choice(["both", "right", "left"])),
    )  # fmt: skip
    return system.replace(b=vs.grazing(system).b * rng.uniform(0.1, 1.05))


def random_oscillator(rng, masses=None) -> vs.Oscillator:
    """One or three masses between unequal stops; the matrices are full and the damping is not proportional."""
    n = masses or int(rng.choice([1, 3]))
    numbers = {
        "M": positive(rng, n, 1.0), "K": positive(rng, n, 0.3), "C": 0.1 * positive(rng, n, 0.1),
        "contact_normal": rng.normal(size=n), "force": rng.normal(size=n), "force_cos": rng.normal(size=n),
        "constant": 0.2 * rng.normal(size=n), "omega": rng.uniform(0.3, 1.5), "tau": 0.3,
        "R": rng.uniform(0.3, 0.9), "R_left": rng.uniform(0.3, 0.9),
        "stops": str(rng.choice(["both", "right", "left"])),
    }  # fmt: skip
    q = vs.Oscillator(**numbers, b=1.0).linear
    size, middle = abs(q.contact.normal @ amplitudes(q)), q.contact.normal @ static_state(q)
    return vs.Oscillator(**numbers, b=size * rng.uniform(0.1, 1.05), offset=middle + 0.1 * size * rng.normal())


def attractors(system, rng, most=3, tries=12):
    """(state, period) of different periodic attractors."""
    found, q = [], system.linear
    low = system.offset - (1 if system.stops != "right" else 2) * system.b
    high = system.offset + (1 if system.stops != "left" else 2) * system.b
    for _ in range(tries):
        gap = rng.uniform(low, high)
        state = rng.normal(size=2 * q.masses) * system.b * np.tile([1.0, system.omega], q.masses)
        state[::2] += q.contact.normal * (gap - q.contact.normal @ state[::2]) / (q.contact.normal @ q.contact.normal)
        section = vs.simulate(system, state, 2000).section
        periods = [n for n in range(1, 25) if np.abs(section[-1] - section[-1 - n]).max() < 1e-10 * system.b]
        if not periods:
            continue
        n, last = periods[0], section[-25:]
        if not any(n == m and np.abs(last - other).max(axis=1).min() < 1e-6 * system.b for other, m in found):
            found.append((section[-1], n))
        if len(found) == most:
            break
    return found


def within(system, state):
    """A state with the gap between the stops: moved along the gap if need be."""
    q, state = system.linear, np.array(state, float)
    gap = q.contact.normal @ state[::2]
    state[::2] += (
        q.contact.normal * (np.clip(gap, q.contact.low, q.contact.high) - gap) / (q.contact.normal @ q.contact.normal)
    )
    if q.masses == 1:  # to the last digit
        state[0] = np.clip(
            state[0], *sorted((q.contact.low / q.contact.normal[0], q.contact.high / q.contact.normal[0]))
        )
    return state


def bounds_of(system, name):
    value = getattr(system, name)
    if name == "b":
        graze = max(vs.grazing(system).b_right, vs.grazing(system).b_left)
        return min(0.1 * graze, 0.9 * value), max(1.1 * graze, 1.1 * value)
    if name == "offset":
        return value - 0.3 * system.b, value + 0.3 * system.b
    return 0.7 * value, min(1.3 * value, 1) if name.startswith("R") else 1.3 * value


def settle(orbit, largest):
    """The section after so many periods that a small disturbance is gone, and the impacts of the last `period`.

    The disturbance is smaller than the distance of the orbit from a graze: beyond that the motion may go elsewhere.
    """
    system, state, periods = orbit.system, orbit.state, orbit.period
    share = min(1e-7, 0.01 * orbit.stop_distance / system.b)
    rate = -math.log(min(max(largest, 1e-3), 1 - 1e-9)) / periods
    count = periods * math.ceil(min(25 / rate, MOST_PERIODS) / periods)
    N = len(state) // 2
    moved = np.array(state) + share * system.b * np.tile([1, system.omega], N) * (-1.0) ** np.arange(2 * N)
    before = vs.simulate(system, within(system, moved), count)
    return before.section[-1], vs.simulate(system, before.section[-1], periods)


def compare(report, where, orbit, tolerance=1e-9):
    """An orbit that is said to be stable against simulation from near it."""
    system = orbit.system
    if not (orbit.ok and orbit.stable):
        report.wrong.append(f"{where}: {orbit.status}, stable {orbit.stable}")
        return
    largest = float(np.abs(orbit.multipliers[0]))
    reached, last = settle(orbit, largest)
    slow = largest ** (MOST_PERIODS / orbit.period) > 1e-4
    off = np.abs(reached - orbit.state).max() / max(system.b, np.abs(orbit.state).max())
    speed = np.abs(orbit.impacts["v1"]).min(initial=np.inf) / (system.omega * system.b)
    allowed = (1e-5 if slow else tolerance) / min(1.0, speed)
    report.counted["compared"] += 1
    if not off < allowed:
        report.wrong.append(f"{where}: simulation ends {off:.1e} away, multiplier {largest:.6f}")
    near_section = np.any(np.abs(np.sin(np.pi * orbit.impacts["t"] / system.period)) < 1e-6)
    if len(last.impacts) != len(orbit.impacts) and not near_section:
        report.wrong.append(f"{where}: {len(last.impacts)} impacts instead of {len(orbit.impacts)}")


def orbit_at(system, name, points, i, j, share, period):
    """The orbit between the points i and j of a branch: by Newton's method from their impacts."""
    here, there = points.isel(point=i), points.isel(point=j)
    names = name, "impact_t", "impact_v"
    p, t, v = ((1 - share) * here[key] + share * there[key] for key in names)
    system = system.replace(**{name: float(p)})
    guess = list(zip(t.values, here.impact_side.values, v.values, strict=True))
    return vs.periodic_orbit(system, guess=guess, periods=period) if guess else vs.periodic_orbit(system, itinerary="")


DRAWN = {
    "systems": (random_system, ("b", "omega", "zeta", "R")),
    "oscillators": (random_oscillator, ("b", "omega", "offset", "R", "R_left")),
}


def study(seed: int, kind: str) -> Report:
    rng, report = np.random.default_rng(seed), new_report(drawn=1)
    draw, names = DRAWN[kind]
    system = draw(rng)
    found = attractors(system, rng)
    names = rng.permutation(names)[: 3 if found else 0]  # three branches of each system, of different attractors if any
    for k, name in enumerate(names.tolist()):
        state, n = found[k % len(found)]
        orbit = vs.periodic_orbit(system, state=state, periods=n)
        if orbit.status == "sticking":
            report.counted["sticking"] += 1
            continue
        where = f"seed {seed}, period {n}, {name}"
        if not (orbit.ok and n % orbit.period == 0 and orbit.stable):  # just beyond a flip the doubled one dies slowly
            report.wrong.append(f"{where}: attractor is {orbit.status}, period {orbit.period}, stable {orbit.stable}")
            continue
        n = orbit.period
        branch = vs.continue_orbit(orbit, name, bounds_of(system, name))
        report.counted["branches"] += 1
        for special in branch.special:
            unknown = special.type == "failed" or not (special.error < 1e-10 or special.type == "closed")
            if unknown or not (special.orbit.ok or special.type == "sticking"):
                report.wrong.append(f"{where}: {special.type} at {special.parameters}, error {special.error}")
        points = branch.points
        inside = np.abs(points.multiplier_re + 1j * points.multiplier_im).values.max(axis=1)
        for first, last in pieces(points, inside, branch.special, name):
            report.counted["pieces"] += 1
            for i in np.unique(np.linspace(first + 1, last - 1, 10).astype(int)):
                if first < i < last and inside[i] < 1:
                    compare(report, f"{where}, point {i}", orbit_at(system, name, points, i, i, 0.0, n))
            for end, inner in ((first, first + 1), (last, last - 1)):
                hold_end(report, where, system, name, branch, points, end, inner, n, (n, orbit.symmetric))
    return report


study_of_systems, study_of_oscillators = partial(study, kind="systems"), partial(study, kind="oscillators")


def pieces(points, largest, special, name):
    """(first, last) indices of maximal stable runs, ends included."""
    p = points[name].values
    cuts = {0, len(p) - 1} | {int(np.argmin(np.abs(p - s.parameters[name]))) for s in special}
    cuts = sorted(cuts)
    for first, last in itertools.pairwise(cuts):
        if last - first >= 2 and np.all(largest[first + 1 : last] < 1):
            yield first, last


def hold_end(report, where, system, name, branch, points, end, inner, n, kind):
    """Just inside an end the orbit attracts; just outside there is no such orbit, or it repels."""
    p = points[name].values
    special = min(branch.special, key=lambda s: abs(s.parameters[name] - p[end]))
    if special.type in ("boundary", "closed", "failed"):
        return
    for share in INSIDE:  # near a birth Newton's method may find the parent
        orbit = orbit_at(system, name, points, end, inner, share, n)
        if orbit.ok and (orbit.period, orbit.symmetric) == kind:
            break
    report.counted["ends"] += 1
    compare(report, f"{where}, inside {special.type} at {p[end]:.9g}", orbit)
    outside = system.replace(**{name: float(2 * p[end] - getattr(orbit.system, name))})
    reached = vs.simulate(outside, within(outside, orbit.state), MOST_PERIODS).section[-1]
    other = vs.periodic_orbit(outside, state=reached, periods=n)
    same = (other.itinerary, other.period, other.symmetric) == (orbit.itinerary, orbit.period, orbit.symmetric)
    if other.ok and other.stable and same and np.abs(other.state - orbit.state).max() < 0.02 * system.b:
        report.wrong.append(f"{where}, outside {special.type} at {p[end]:.9g}: the orbit still attracts")
