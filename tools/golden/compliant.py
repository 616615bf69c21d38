"""Cases with compliant stops: those that tests know by name, and random ones. Their records keep what fails, too."""

import collections

import numpy as np
from golden import branches, curves, searches
from golden.motions import system_of, system_record
from support.compliant_bifurcations import BRANCHES
from support.drawn_branches import Case, drawn_number, drawn_orbit, drawn_oscillator

import vibro_sweep as vs
from tools.golden import drawing
from tools.golden.making import MOST_REACHED, tried

COUNTS = {"branches": {1: 29, 2: 26, 3: 8}, "curves": {1: 18, 2: 18, 3: 4}, "searches": {1: 7, 2: 7, 3: 1}}  # by masses
SEEDS = {"branches": 0, "searches": 100_000}
MODELS = {1: ("one_mass", "one_mass", "linear"), 2: ("two_mass", "chain", "linear"), 3: ("chain", "linear")}
LAWS = ("alike", "unlike", "mixed")
MOST_EVENTS = 16  # contacts and impacts of an orbit: longer ones take long to follow
PER_ORBIT = 2  # branches of one drawn oscillator
NOT_NEGATIVE = ("c_stop", "preload", "c_stop_left", "preload_left", "zeta")
BOX = (0.5, 0.4)  # of both parameters of a curve, relative, each way: as far as ends and points of codimension two
CURVES = ("fold", "flip", "pitchfork", "neimark_sacker", "graze")


def drawn_stops(system, rng):
    """The oscillator with compliant stops: soft or stiff, some damped, some preloaded; two stops alike or not, or a
    rigid one and a compliant one."""

    def stop(suffix: str, reference: float | None = None) -> dict:
        k = 10 ** rng.uniform(0.5, 4) if reference is None else reference * 10 ** rng.uniform(-1, 1)
        z = float(rng.choice([0.0, rng.uniform(0.01, 0.4)]))
        preload = float(rng.choice([0.0, rng.uniform(0, 0.3)]))
        return {f"k_stop{suffix}": k, f"c_stop{suffix}": 2 * z * np.sqrt(k), f"preload{suffix}": preload}

    law = str(rng.choice(LAWS)) if getattr(system, "stops", "both") == "both" else "alike"
    rigid = dict.fromkeys(("R", "R_left")) if system.numbers.get("R_left") is not None else {"R": None}
    numbers = rigid | stop("") | {"release": str(rng.choice(["displacement", "force"]))}
    if law == "unlike":
        numbers |= stop("_left", numbers["k_stop"])
    if law == "mixed":
        numbers["R_left"] = float(rng.uniform(0.3, 0.95))
    return system.replace(**numbers)


def drawn_case(masses: int, rng) -> tuple[str, Case | None]:
    """A model, and an orbit of an oscillator of it that touches a stop, with the number in which it is followed."""
    model = str(rng.choice(MODELS[masses]))
    system = drawn_oscillator(model, rng)
    while system.masses != masses:
        system = drawn_oscillator(model, rng)
    system = drawn_stops(system, rng)
    orbit = drawn_orbit(system, rng)
    if orbit is None or not 0 < len(orbit.itinerary) <= MOST_EVENTS:
        return model, None
    name, (lo, hi) = drawn_number(system, rng)
    return model, Case(orbit, name, (max(lo, 0.0) if name in NOT_NEGATIVE else lo, hi))


def drawn_cases(masses: int, seed: int):
    rng = np.random.default_rng([drawing.SEED, masses, seed])
    model, case = drawn_case(masses, rng)
    for k, record in enumerate(drawing.one_after_the_other(f"compliant {masses}.{seed}", model, case, rng)):
        if k == PER_ORBIT:
            return
        yield record


def ends_of_contacts() -> dict:
    """Branches that end where the contact never ends, or where the stop has not relaxed at the next touch."""
    held = dict(k=1.0, zeta=0.05, omega=5.5, k_stop=29.0, c_stop=0.5, b=1.0, tau=0.0, constant=1.5, stops="right")
    slow = dict(k=1.0, zeta=0.05, F=0.5, omega=0.8, k_stop=29.0, c_stop=2.0, b=1.0, tau=0.0, stops="right")
    met_again = dict(
        k=1.0, zeta=0.21946461644074794, F=1.4480217615475175, omega=1.624381452744489, R=0.5119483099802649,
        k_stop_left=391.3381999367444, c_stop_left=50.0, preload_left=0.18166495017546266, b=0.7118563659162448,
        tau=1.3880336099211246,
    )  # fmt: skip
    cases = {
        "contact that never ends": (held | {"F": 0.3}, "R", "F", (0.01, 5)),
        "stop that has not relaxed": (slow | {"release": "force"}, "R", "c_stop", (1, 12)),
        "stop that is met before it is out": (met_again | {"release": "force"}, "LR", "c_stop_left", (45, 70)),
    }
    return {name: (vs.Oscillator.named("one_mass", **numbers), *case) for name, (numbers, *case) in cases.items()}


def named_cases():
    for name, (system, itinerary, parameter, bounds) in (BRANCHES | ends_of_contacts()).items():
        start = {"itinerary": itinerary, "periods": 1}
        yield {
            "name": f"compliant, {name}", "system": system_record(system), "start": start, "parameter": parameter,
            "bounds": [float(bound) for bound in bounds],
        }  # fmt: skip


def branch_record(record: dict) -> dict:
    branch = branches.followed(record)
    result = branches.result_of(branch, np.random.default_rng(0))
    return record | {"result": result, "switch": branches.switched(branch)}


def curve_record(record: dict) -> dict:
    return record | {"result": curves.result_of(curves.traced(record))}


def search_record(record: dict) -> dict:
    def progress(count, *_):
        if count > MOST_REACHED:
            raise LookupError("too many branches")

    reached = searches.searched(record, progress)
    return record | {"result": searches.result_of(reached, np.random.default_rng(0))}


def filled(kind: str, make, named, drawn, report) -> list[dict]:
    """Records of the named cases, then of those drawn, up to the number of each number of masses."""
    result, counted = [], collections.Counter()

    def add(case: dict, masses: int) -> None:
        if counted[masses] < COUNTS[kind][masses] and (made := tried(make, case, report)):
            result.append(made)
            counted[masses] += 1
            report(made["name"])

    for case in named:
        add(case, system_of(case["system"]).masses)
    for masses, count in COUNTS[kind].items():
        seed = SEEDS[kind]
        while counted[masses] < count:
            try:
                for case in drawn(masses, seed):
                    add(case, masses)
            except (ValueError, vs.RunError) as error:
                report(f"# {masses} masses, seed {seed}: {error!s:.150}")
            seed += 1
    return result


def all_branches(report) -> list[dict]:
    return filled("branches", branch_record, named_cases(), drawn_cases, report)


def all_searches(report) -> list[dict]:
    def cases(masses, seed):
        for case in drawn_cases(masses, seed):
            yield case | {"follow": ["split", "graze", "pitchfork", "flip"], "depth": 1 + seed % 2}
            return

    return filled("searches", search_record, (), cases, report)


def all_curves(known: list[dict], report) -> list[dict]:
    """From special points of the branches `known`, those types first that are met seldom."""
    rng, counted, types, result = np.random.default_rng(drawing.SEED), collections.Counter(), collections.Counter(), []
    points = [(record, *point) for record in known for point in enumerate(record["result"]["special"])]
    points = [points[i] for i in rng.permutation(len(points)) if points[i][2]["type"] in CURVES]
    while points:
        points.sort(key=lambda point: types[point[2]["type"]])
        branch, k, special = points.pop(0)
        masses = system_of(branch["system"]).masses
        case = drawing.one_curve(branch, special, rng, f"{branch['name']}, {special['type']} {k}", BOX)
        if case and counted[masses] < COUNTS["curves"][masses] and (made := tried(curve_record, case, report)):
            report(made["name"])
            result.append(made)
            counted[masses] += 1
            types[special["type"]] += 1
    return result
