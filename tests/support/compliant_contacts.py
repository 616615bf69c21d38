"""How exact the contacts of random oscillators with compliant stops are, and whether they are the right ones.

The reference computes the same orbits in forty digits, and again with all numbers moved by one rounding, up or down at
random: the largest change that this makes is the unit of errors. A few such moves may by accident do next to nothing;
where errors are beyond LEAST units, each number is moved alone, and the unit is the sum of what these do, which is the
most that rounding all of them can do. Nothing is compared beyond chaos, where rounding has moved a time by more than
CHAOS, and after STEPS of the reference, which a strongly overdamped contact can take.
"""

import math
from types import SimpleNamespace

import numpy as np
from mpmath import mp, mpf
from reference.events import simulate
from reference.machine import machine_of

import vibro_sweep as vs
from support.searching import Report, new_report, size
from support.stiff_contacts import moved
from vibro_sweep.model.state import coordinates

COUNT = 20  # contacts compared
MOVES = 4
LEAST = 10.0  # errors allowed, in units of what rounding the data does
CHAOS = 1e-8  # of a time
STEPS = 20_000
FIELDS = ("t_touch", "t_release", "v_touch", "v_release", "max_penetration", "max_force")
PERIODS = 20


def stop_of(rng, mass):
    """k_stop, c_stop and preload of a stop; z, the damping ratio of the gap's mass on it: 0, or 0.01 to 3."""
    k, z = 10 ** rng.uniform(-1, 8), rng.choice([0, 10 ** rng.uniform(-2, 0.5)])
    preload = rng.choice([0, 10 ** rng.uniform(-2, 0.5)])
    return {"k_stop": k * mass, "c_stop": 2 * z * math.sqrt(k) * mass, "preload": preload}


def drawn(seed):
    """An oscillator of one to four masses with any laws of contact, and a start; one in five begins inside a stop."""
    rng = np.random.default_rng([seed, 20])
    N = int(rng.integers(1, 5))
    A, B = rng.normal(size=(2, N, N))
    M = np.eye(N) + 0.3 * A @ A.T if rng.random() < 0.5 else np.diag(rng.uniform(0.5, 3, N))
    K = B @ B.T + 0.2 * np.eye(N)
    normal = np.eye(N)[0] if rng.random() < 0.6 else rng.normal(size=N)
    mass = 1 / (normal @ np.linalg.solve(M, normal))
    stops = str(rng.choice(["both", "right"]))
    laws = stop_of(rng, mass) | {"release": str(rng.choice(["displacement", "force"]))}
    if stops == "both":
        kind = rng.integers(3)  # the same law as on the right, another one, or a rigid stop
        left = [{}, {f"{name}_left": x for name, x in stop_of(rng, mass).items()}, {"R_left": rng.uniform(0.2, 1)}]
        laws |= left[kind]
    numbers = dict(force=rng.normal(size=N), omega=rng.uniform(0.4, 2), b=rng.uniform(0.05, 0.5), tau=rng.uniform(0, 6))
    system = vs.Oscillator(M, K, rng.uniform(0, 0.2) * K, contact_normal=normal, stops=stops, **numbers, **laws)
    start = np.zeros(2 * N)
    start[1::2] = 0.5 * rng.normal(size=N)
    if rng.random() < 0.2:
        start[0::2] = normal / (normal @ normal) * system.b * (1 + 10 ** rng.uniform(-6, 0.3))
    return system, start


def study(seed) -> Report:
    """How many contacts of an oscillator were compared, and how large their errors are."""
    result = compared(seed)
    report, worst = new_report(drawn=1, contacts=result["compared"]), max(result["errors"].values())
    where = f"seed {seed}, {result['masses']} masses, status {result['status']}"
    if result["defect"]:
        report.wrong.append(f"{where}: {result['defect']}")
    if result["compared"]:
        report.counted.update(
            {"compared": 1, "each number moved alone": int("each" in result), size("errors", worst): 1}
        )
    if not worst <= LEAST:
        report.wrong.append(f"{where}: {result['errors']}")
    return report


def study_of_sections(seed) -> Report:
    """The sections of a sweep: how large their errors are, where anything can be compared."""
    report, error = new_report(drawn=1), error_of_sections(seed)
    if error is not None:
        report.counted.update({"compared": 1, size("errors", error): 1})
        if not error <= LEAST:
            report.wrong.append(f"seed {seed}: {error:.3g}")
    return report


def compared(seed):
    """Errors by field in units of what rounding the data does, and how many contacts were compared."""
    system, start = drawn(seed)
    orbit = vs.simulate(system, start, PERIODS)
    report = {"seed": seed, "masses": len(system.linear.normal), "release": system.linear.by_force, "compared": 0}
    report |= {"status": str(orbit.status), "errors": dict.fromkeys(FIELDS, 0.0), "defect": ""}
    found, end = orbit.contacts[~np.isnan(orbit.contacts["t_release"])][:COUNT], PERIODS * system.period
    if len(orbit.sticking):  # chatter before it has no end
        began = orbit.sticking["t_on"][0]
        last = max([0.0, *(t for t in orbit.impacts["t"] if t < began), *(t for t in found["t_release"] if t < began)])
        found, end = found[found["t_release"] <= last], last * (1 + 1e-12)
    elif orbit.status != "ok" and len(found) < COUNT:  # ever shorter contacts, more than are followed
        end = found["t_release"][-1] * (1 + 1e-12) if len(found) else 0.0
    if not len(found):
        exact = simulate(machine_of(system.linear), start, contacts=1, until=end, steps=STEPS).contacts
        return report | {"defect": "missed" if exact and exact[0].t_release < end * (1 - 1e-9) else ""}
    return report | judged(system, start, found, end)


def judged(system, start, found, end):
    """The errors in what was found until `end`; `each` says whether each number was moved alone."""
    with mp.workdps(50):

        def contacts_of(numbers, state):
            return simulate(machine_of(numbers), state, contacts=len(found), until=2 * end).contacts

        rng, q = np.random.default_rng(1), system.linear
        numbers, state = moved_numbers(q, start, None)
        orbit = simulate(machine_of(numbers), state, contacts=len(found), until=2 * end, steps=STEPS)
        exact = orbit.contacts
        if orbit.given_up:
            found = found[: len(exact)]
        few = [contacts_of(*moved_numbers(q, start, rng)) for _ in range(MOVES)]
        report = errors_of(found, exact, few, max)
        if max(report["errors"].values()) <= LEAST:
            return report
        each = [contacts_of(*one) for one in moved_one_by_one(q, start)]
        return errors_of(found, exact, each, sum) | {"each": True}


def error_of_sections(seed, periods=6):
    """Largest error of the section states of a sweep, which computes eight orbits side by side, in units of what
    rounding the data does; None where chaos or a stop that is met ever more often leaves nothing to compare."""
    system, start = drawn(seed)
    names = [one.name for one in coordinates(system.masses)]
    begin = dict(zip(names, start, strict=True))
    data = vs.sweep(system, {"omega": [system.linear.omega]}, transient=0, record=periods, start=begin)
    if data.status.values[0] != 0 or len(vs.simulate(system, start, periods).sticking):
        return None
    with mp.workdps(50):
        rng, orbits = np.random.default_rng(1), []
        for i in range(1 + MOVES):
            numbers, state = moved_numbers(system.linear, start, rng if i else None)
            orbit = simulate(machine_of(numbers), state, periods=periods + 1e-9)
            orbits.append(np.array(orbit.section[1 : periods + 1]))
        found = np.stack([data[name].values[0] for name in names], -1)
        effect = np.max([np.abs(one - orbits[0]).max(1) for one in orbits[1:]], 0)
        error = np.abs(found - orbits[0]).max(1)
        counted = effect < CHAOS
        unit = effect + np.spacing(np.abs(found).max(1))
        return float((error / unit)[counted].max()) if counted.any() else None


def moved_numbers(q, start, rng):
    """As `moved`, for the numbers that are neither infinite nor words."""
    kept = {name: getattr(q, name) for name in q._fields if not _is_number(getattr(q, name))}
    numbers, state = moved(_Numbers({name: a for name, a in q._asdict().items() if name not in kept}), start, rng)
    vars(numbers).update(kept)
    return numbers, state


def moved_one_by_one(q, start):
    """As `moved_numbers`, one number that is not zero at a time."""
    exact, state = moved_numbers(q, start, None)
    part = 1 + mp.ldexp(1, -53)
    for name, value in vars(exact).items():
        if isinstance(value, mpf):
            yield SimpleNamespace(**vars(exact) | {name: value * part}), state
        elif np.asarray(value).dtype == object:
            for at in np.ndindex(value.shape):
                if value[at] and tuple(sorted(at)) == at:  # matrices stay symmetric
                    beside = value.copy()
                    beside[at] = beside[at[::-1]] = value[at] * part
                    yield SimpleNamespace(**vars(exact) | {name: beside}), state
    for i, x in enumerate(state):
        if x:
            yield exact, [*state[:i], x * part, *state[i + 1 :]]


class _Numbers(dict):
    def _asdict(self):
        return self


def _is_number(a):
    a = np.asarray(a)
    return a.dtype.kind == "f" and np.all(np.isfinite(a))


def errors_of(found, exact, others, together):
    """Up to the contact from which on rounding the data changes which contacts there are, or moves them far.

    others: contacts of moved numbers. together: of what these moves do, what is the unit.
    """
    errors = dict.fromkeys(FIELDS, 0.0)
    for i in range(len(found)):
        if any(len(one) <= i for one in [exact, *others]):
            same = len({len(one) for one in [exact, *others]}) == 1
            return {"errors": errors, "compared": i, "defect": "invented" if same else ""}
        effects = {
            name: together(abs(getattr(one[i], name) - getattr(exact[i], name)) for one in others) for name in FIELDS
        }
        if max(effects["t_touch"], effects["t_release"]) > CHAOS * exact[i].t_release:
            return {"errors": errors, "compared": i}
        if exact[i].side != found["side"][i]:
            return {"errors": errors, "compared": i, "defect": "another side"}
        for name in FIELDS:
            wanted = getattr(exact[i], name)
            unit = effects[name] + math.ulp(float(wanted))
            errors[name] = max(errors[name], float(abs(mpf(float(found[name][i])) - wanted) / unit))
    return {"errors": errors, "compared": len(found)}
