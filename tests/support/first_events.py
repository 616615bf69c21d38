"""Random oscillators of two masses over the whole allowed range: the first events of each orbit against exact flights.

Orbit number n is always the same one.
"""

import math

import numpy as np
from mpmath import mp, mpf
from reference.exponentials import TooManySwingsError
from reference.follow import DIGITS, Follower

import vibro_sweep as vs
from support.searching import Report, new_report, size
from vibro_sweep.engine.one_system import Engine
from vibro_sweep.engine.tables.cells import STIFF_CELLS
from vibro_sweep.model.grazing import steady_response

SEED = 11
EVENTS = 30
SAMPLES = 300
PERIODS = (1, 8, 64)  # simulated one after the other until there are enough events
COUNTED = ("checked", "grazes", "unchecked")
SIZES = (1, 10, 100, 1000)
CLASSES = ("sticks", "R < 0.1", "stiff", "both stops in a cell")
# Error allowed, in units of the effect of rounding (follow.py). Within a cell a stiff flight takes up to 10^4 small
# steps, each of which is rounded: the largest that was found is 2700.
LARGEST = 5000
ROUND = ("narrow", "any", "narrow", "stiff", "narrow", "sticking", "narrow", "little restitution")
KINDS = (*ROUND, *ROUND, "narrow", "stiff", "any")


def draw(n):
    """Orbit number n -> (numbers of the system, state, start time)."""
    rng = np.random.default_rng([SEED, n])
    kind = KINDS[n % len(KINDS)]

    def power(low, high):
        return 10.0 ** rng.uniform(low, high)

    def one_of(*choices):
        return choices[rng.integers(len(choices))]

    wide = rng.random() < 0.5
    mu_m, mu_k = (power(-6, 6), power(-6, 6)) if wide else (power(-1.5, 1.5), power(-1.5, 1.5))
    zeta = one_of(0.0, power(-6, 1), power(-6, 1), rng.uniform(0, 0.3))
    squares = vs.System(mu_m=mu_m, mu_k=mu_k, zeta=0, f2=0, omega=1.2345, R=1, b=1, tau=0).modes.omega_squared
    eta = zeta * squares[1]
    rate = max(eta + math.sqrt(max(eta**2 - squares[1], 0.0)), math.sqrt(squares[1]))  # the fastest
    omega = one_of(power(-3, 3), math.sqrt(one_of(*squares)) * power(-1, 1), power(-1, 0.5))
    R = one_of(0.0, 1.0, rng.uniform(0, 1), rng.uniform(0, 1), rng.uniform(0, 1), power(-20, -1), 1 - power(-12, -1))
    f2 = one_of(0.0, 1.0, rng.uniform(0, 1))
    clearance = one_of(power(-6, 0.0), power(-2, 0), rng.uniform(0, 1.1))
    if kind == "sticking":
        R, clearance, omega = rng.uniform(0, 0.6), power(-3, -0.2), math.sqrt(squares[0]) * power(-1.5, 0)
        zeta = one_of(0.0, power(-4, 0))
    elif kind == "little restitution":
        R = one_of(0.0, rng.uniform(0, 0.1), rng.uniform(0, 0.1), power(-12, -1), power(-300, -12))
    elif kind == "stiff":
        omega = rate * 2 * math.pi / power(3.95, 6.95)
    elif kind == "narrow":
        clearance, R = power(-6, -2), one_of(1.0, rng.uniform(0.2, 1), rng.uniform(0.2, 1), R)
    omega = min(max(omega, 1e-3), 1e3)

    d, e = (x.tolist() for x in steady_response(mu_m, mu_k, zeta, f2, omega))
    b_star, size = math.hypot(d[0], e[0]), math.hypot(d[1], e[1])
    stops = one_of("both", "both", "both", "right", "left") if kind != "narrow" else "both"
    tau = one_of(0.0, rng.uniform(-math.pi, math.pi), rng.uniform(-math.pi, math.pi))
    start_time = one_of(0.0, 0.0, 0.0, rng.uniform(-1, 3) * 2 * math.pi / omega)
    place = one_of("anywhere", "anywhere", "origin", "at rest on a stop", "moving on a stop", "graze")
    if kind == "narrow" and rng.random() < 0.8:
        place = one_of("anywhere", "moving on a stop")
    if place == "graze":
        clearance = 1 + one_of(1, -1, -1) * power(-16, -1)
    b = clearance * b_star
    side = {"both": one_of(1.0, -1.0), "right": 1.0, "left": -1.0}[stops]
    scale = one_of(b, size, b)
    v1, x2, v2 = rng.normal(size=3) * power(-2, 0.5) * scale * np.array([omega, 1, omega])
    if kind == "narrow":
        v1 = one_of(1, -1) * 4 * b * max(4 * omega, rate) * power(0.2, 2)  # across the clearance within a cell
    state = [rng.uniform(-b, b), v1, x2, v2]
    if place == "origin":
        state = [0.0] * 4
    elif place == "at rest on a stop":
        state[:2] = side * b, 0.0
    elif place == "moving on a stop":
        state[0] = side * b
    elif place == "graze":
        start_time = 0.0
        phase = one_of(side * math.pi / 2, rng.uniform(-math.pi, math.pi))  # pi/2: x1 at its largest
        tau = phase - math.atan2(e[0], d[0])
        sin, cos = math.sin(tau), math.cos(tau)
        state = [d[0] * sin + e[0] * cos, omega * (d[0] * cos - e[0] * sin)]
        state += [d[1] * sin + e[1] * cos, omega * (d[1] * cos - e[1] * sin)]
        state[0] = min(max(state[0], -b), b)
    numbers = dict(mu_m=mu_m, mu_k=mu_k, zeta=zeta, f2=f2, omega=omega, R=R, b=b, tau=tau, stops=stops)
    return numbers, tuple(map(float, state)), float(start_time)


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
            t, state = [leg for leg in follower.legs if leg[0] <= moments[i]][-1]
            noise = follower.effect(t, state, mpf(moments[i]) - t, 1)[0] + mpf(2) ** -53 * follower.b
            worst, at = max((worst, at), (float(beyond[i] / noise), float(moments[i])), key=lambda pair: pair[0])
    return worst, at


def checked(n):
    """Everything about orbit n."""
    numbers, state, start_time = draw(n)
    report = {"n": n, "kind": KINDS[n % len(KINDS)]}
    try:
        system = vs.System(**numbers)
        engine = Engine(system)
        orbit, events = simulate(system, state, start_time)
    except vs.ParameterError as error:
        return report | {"accepted": False, "why": error.key}
    report |= {"status": str(orbit.status), "events": events, "accepted": orbit.status == "ok" or events >= EVENTS}
    if not report["accepted"]:
        return report | {"why": str(orbit.status)}
    end = None if orbit.status != "ok" else float(orbit.section_times[-1])
    impacts = [tuple(x.item() for x in hit) for hit in orbit.impacts[: EVENTS + 1]]
    rests = [
        (float(r["t_on"]), None if end is not None and r["t_off"] >= end else float(r["t_off"]), int(r["side"]))
        for r in orbit.sticking[:EVENTS]
    ]
    times = sorted([hit[0] for hit in impacts] + [t for r in rests for t in r[:2] if t is not None])[:EVENTS]
    sides = {}
    for hit in impacts[:EVENTS]:
        sides.setdefault(math.floor(hit[0] / engine.width), set()).add(hit[1])
    report |= {
        "sticks": any(r[0] <= times[-1] for r in rests) if times else bool(rests),
        "R < 0.1": system.R < 0.1,
        "stiff": engine.cells == STIFF_CELLS,
        "both stops in a cell": any(len(s) > 1 for s in sides.values()),
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
