"""Searches of first events: orbits of random oscillators against the reference, in units of rounding.

Of the paper's oscillator over its whole range each event is followed from the one before, so that chaos plays no part;
orbit number n is always the same one. Those of other oscillators are compared from the start on, until chaos.
"""

from itertools import pairwise

import numpy as np
from mpmath import mp, mpf
from reference import event_check
from reference.events import simulate as simulated
from reference.exponentials import TooManySwingsError
from reference.follow import DIGITS, Follower
from reference.machine import machine_of

import vibro_sweep as vs
from support.drawn_oscillators import PAPER_KINDS, drawn, drawn_compliant, drawn_paper, fastest_rate
from support.event_rows import end_of, errors
from support.searching import Report, new_report, size

EVENTS = 30
SAMPLES = 300
PERIODS = (1, 8, 64)  # simulated one after the other until there are enough events
COUNTED = ("checked", "grazes", "unchecked")
SIZES = (1, 10, 100, 1000)
CLASSES = ("sticks", "R < 0.1", "stiff", "both stops at once")
# Error allowed, in units of the effect of rounding (follow.py). Within a cell a stiff flight takes up to 10^4 small
# steps, each of which is rounded: the largest that was found is 2700.
LARGEST = 5000


def simulate(system, state, start_time):
    """The orbit until it has enough events, and whether it has."""
    for periods in PERIODS:
        orbit = vs.simulate(system, state, periods, start_time)
        events = len(orbit.impacts) + 2 * len(orbit.sticking)
        if events >= EVENTS or orbit.status != "ok":
            break
    return orbit, events


def beyond_a_stop(orbit, follower, until):
    """How far x1 lies beyond a stop at most, in units of the effect of rounding, and when."""
    moments = np.linspace(orbit.start_time, until, SAMPLES)
    hits = orbit.impacts["t"][orbit.impacts["t"] <= until]
    moments = np.unique(np.concatenate([moments, hits, (hits[1:] + hits[:-1]) / 2]))
    x1 = orbit.sample(moments)[:, 0]
    beyond = np.maximum(*(side * x1 - orbit.system.b if side in follower.sides else x1 * 0 for side in (1, -1)))
    worst, at = 0.0, None
    for i in np.argsort(-beyond)[:3]:
        if beyond[i] > 0:
            # at an impact what is known of x1 is what the flight that ends there tells
            legs = [leg for leg in follower.legs if leg[0] <= moments[i]][-2:]
            effects = [follower.effect(t, state, mpf(moments[i]) - t, 1)[0] for t, state in legs]
            noise = max(effects) + mpf(2) ** -53 * follower.b
            worst, at = max((worst, at), (float(beyond[i] / noise), float(moments[i])), key=lambda pair: pair[0])
    return worst, at


def checked(n):
    """Everything about orbit n."""
    numbers, state, start_time = drawn_paper(n)
    report = {"n": n, "kind": PAPER_KINDS[n % len(PAPER_KINDS)]}
    try:
        system = vs.System(**numbers)
        return report | judged(system, numbers, state, start_time)
    except vs.ParameterError as error:
        return report | {"accepted": False, "why": error.key}


def judged(system, numbers, state, start_time):
    """Everything about the first events of an orbit, each followed from the one before."""
    orbit, events = simulate(system, state, start_time)
    report = {"status": str(orbit.status), "events": events, "accepted": orbit.status == "ok" or events >= EVENTS}
    if not report["accepted"]:
        return report | {"why": str(orbit.status)}
    end = None if orbit.status != "ok" else float(orbit.section_times[-1])
    impacts = [tuple(x.item() for x in hit) for hit in orbit.impacts[: EVENTS + 1]]
    rests = [
        (float(r["t_on"]), None if end is not None and r["t_off"] >= end else float(r["t_off"]), int(r["side"]))
        for r in orbit.sticking[:EVENTS]
    ]
    times = sorted([hit[0] for hit in impacts] + [t for r in rests for t in r[:2] if t is not None])[:EVENTS]
    _, rate = fastest_rate(*(numbers[name] for name in ("mu_m", "mu_k", "zeta")))
    at_once = 0.25 / max(rate, 4 * system.omega)
    pairs = pairwise(impacts[:EVENTS])
    report |= {
        "sticks": any(r[0] <= times[-1] for r in rests) if times else bool(rests),
        "R < 0.1": system.R < 0.1,
        "stiff": rate * system.period > 8000,
        "both stops at once": any(a[1] != b[1] and b[0] - a[0] < at_once for a, b in pairs),
    }
    with mp.workdps(DIGITS):
        follower = Follower({**system.parameters(), "stops": system.stops}, mpf(system.period) * mpf(2) ** -53)
        found = follower.found
        try:
            follower.follow(start_time, state, impacts, rests, end, EVENTS)
            if orbit.status == "ok" and follower.legs:
                until = times[-1] if len(times) >= EVENTS else end
                worst, at = beyond_a_stop(orbit, follower, min(until, end))
                report["beyond"] = worst
                if worst > LARGEST:
                    found.defect("x1 beyond a stop", 0, noises=worst, t=at)
        except TooManySwingsError as error:
            found.unchecked += 1
            report["too long"] = str(error)
    return report | {name: getattr(found, name) for name in (*COUNTED, "errors", "defects")}


def study(n) -> Report:
    """What became of orbit n, how many of its events were compared, and how large errors are, in units of rounding."""
    result = checked(n)
    if not result["accepted"]:
        return new_report(orbits=1, **{f"refused, {result['why']}": 1})
    report = new_report(orbits=1, accepted=1, **{name: int(result[name]) for name in (*CLASSES, *COUNTED)})
    report.wrong.extend(f"orbit {n}: {defect}" for defect in result["defects"])
    errors = {name: error[0] for name, error in result["errors"].items()} | {"beyond a stop": result.get("beyond", 0.0)}
    for name, error in errors.items():
        report.counted[size("errors", error, SIZES)] += 1
        if not error <= LARGEST:
            report.wrong.append(f"orbit {n}: error of {name} {error:.3g}")
    return report


MASSES = (1, 2, 3, 5, 8)
CHAOTIC = 1e-8  # part of a time by which rounding moves it, from which on nothing is compared


def study_of_any(seed) -> Report:
    """The first impacts of an orbit of one number of masses after the other."""
    masses, number = MASSES[seed % len(MASSES)], 1 + seed // len(MASSES)
    system, state = drawn(number, masses)
    orbit = vs.simulate(system, state, 60)
    if orbit.status != "ok":
        return Report(new_report(drawn=1).counted, [f"seed {seed}, {masses} masses: {orbit.status}"])
    return _report(f"seed {seed}, {masses} masses", orbit, state, end_of(orbit, EVENTS), "impact", most=EVENTS)


def study_of_compliant(seed, count=20) -> Report:
    """The first contacts with compliant stops, until a rest, before which chatter has no end."""
    system, state = drawn_compliant(seed)
    orbit = vs.simulate(system, state, 20)
    ended = np.sort(orbit.contacts["t_release"][~np.isnan(orbit.contacts["t_release"])])
    end = end_of(orbit, count)
    if len(orbit.sticking):
        before = [t for t in (*orbit.impacts["t"], *ended) if t < orbit.sticking["t_on"][0]]
        end = min(end, max(before, default=0.0) * (1 + 1e-8))
    elif orbit.status != "ok" and len(ended) < count:  # ever shorter contacts, more than are followed
        end = ended[-1] * (1 + 1e-8) if len(ended) else 0.0
    where = f"seed {seed}, {system.masses} masses, status {orbit.status}"
    return _report(where, orbit, state, end, "contact", most=count, steps=20_000)


def _report(where, orbit, state, end, kind, **more) -> Report:
    findings = errors(orbit, state, end, chaos=CHAOTIC, **more)
    worst, count = max(findings.errors.values(), default=0.0), findings.checked[kind]
    report = new_report(drawn=1, compared=int(count > 0), **{f"{kind}s": count, "grazes": findings.grazes})
    if count:
        report.counted[size("errors", worst)] += 1
    report.wrong.extend(f"{where}: {defect}" for defect in findings.defects)
    if not worst <= event_check.ALLOWED:
        report.wrong.append(f"{where}: {findings.errors}")
    return report


def study_of_sections(seed, periods=6) -> Report:
    """Section states of a sweep, which computes eight orbits side by side, where rounding leaves some digits."""
    system, start = drawn_compliant(seed)
    names = [f"{letter}{mass}" for mass in range(1, system.masses + 1) for letter in "xv"]
    begin = dict(zip(names, start, strict=True))
    data = vs.sweep(system, {"omega": [system.omega]}, transient=0, record=periods, start=begin)
    report = new_report(drawn=1)
    if data.status.values[0] != 0 or len(vs.simulate(system, start, periods).sticking):
        return report
    with mp.workdps(50):
        rng, machine = np.random.default_rng(1), machine_of(system.linear)
        moves = [(machine, start), *(event_check.moved(machine, start, rng) for _ in range(event_check.MOVES))]
        orbits = [simulated(each, list(state), periods + 1e-9).section[1 : periods + 1] for each, state in moves]
        exact, *others = (np.array(orbit) for orbit in orbits)
        found = np.stack([data[name].values[0] for name in names], -1)
        effect = np.max([np.abs(other - exact).max(1) for other in others], 0)
        error = np.abs(found - exact).max(1)
        counted = effect < CHAOTIC
        worst = float((error / (effect + np.spacing(np.abs(found).max(1))))[counted].max(initial=0.0))
    if counted.any():
        report.counted.update({"compared": 1, size("errors", worst): 1})
    if not worst <= event_check.ALLOWED:
        report.wrong.append(f"seed {seed}: {worst:.3g}")
    return report
