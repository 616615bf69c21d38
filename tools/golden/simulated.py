"""Makes the records of simulated motions, of their exponents, and of discontinuity maps."""

import time

import numpy as np
from golden import exponents, kept_numbers, maps, simulations
from golden.motions import system_of

import vibro_sweep as vs
from tools.golden.allowing import result_of
from tools.golden.between_processors import WIDER
from tools.golden.named_simulations import NAMED, paper
from tools.golden.oscillators import GROUPS, PAPER, drawn

SEED = 44
PERIODS = (4, 8, 12)
LONGEST = 0.2  # seconds of a simulation
ROWS = {
    "impacts": 30, "states at impacts": 8, "contacts": 30, "rests": 10, "section": 7, "samples": 7,
    "exponents": 16, "residual": 1, "graze": 1, "states": 3, "jacobians": 48,
}  # fmt: skip
MOVES = {"simulations": 300, "exponents": 6, "maps": 300}  # of numbers of an oscillator; 300 are all of them
EXPONENTS = (60, 40), (8, 12), (2, 4), (0, 2)  # periods before and of the record; fewer where the orbit is chaotic


def all_simulations(told) -> list[dict]:
    return list(_made("simulations", _simulated_cases(), simulations.computed, told))


def all_exponents(simulated, told) -> list[dict]:
    """Of every second of these records."""
    return list(_made("exponents", map(_exponents_case, simulated[::2]), exponents.computed, told))


def all_maps(told) -> list[dict]:
    return list(_made("maps", _map_cases(), maps.computed, told))


def _made(kind: str, cases, computed, told):
    for case in cases:
        key = f"{kind}: {case['name']}"
        record = case | ({"wider": WIDER[key]} if key in WIDER else {})
        record["result"] = _result_of(kind, record, computed)
        told(f"{key}: {record['result']['words']}, {kept_numbers.count(record)} numbers")
        yield record


def _result_of(kind: str, record: dict, computed) -> dict:
    rng = np.random.default_rng([SEED, *record["name"].encode()])
    return result_of(record, computed, ROWS, MOVES[kind], rng)


def _exponents_case(simulated: dict) -> dict:
    """Over as many periods as all exponents mean something."""
    start = {name: simulated[name] for name in ("name", "group", "system", "state")}
    for transient, record in EXPONENTS:
        case = start | {"transient": transient, "record": record}
        if _result_of("exponents", case, exponents.computed)["tables"]["exponents"]["whole"]:
            break
    return case


def _simulated_cases():
    """The paper's oscillator, those with names, and those drawn until there are enough of each group."""
    for k, (system, state) in enumerate(paper()):
        yield _case("paper", k, system, state)
    for number, (name, group) in enumerate(GROUPS.items()):
        named = NAMED[name]() if name in NAMED else []
        for k in range(group.count):
            system, state = named[k] if k < len(named) else _accepted(group, [SEED, number, k], quiet=k % 10 == 9)
            yield _case(name, k, system, state)


def _case(group: str, k: int, system: dict, state: list[float]) -> dict:
    start_time = 0.0 if k % 4 else 2.5
    periods = PERIODS[k % len(PERIODS)]
    return {
        "name": f"{group}, {k}", "group": group, "system": system, "state": state, "periods": periods,
        "start_time": start_time,
    }  # fmt: skip


def _accepted(group, seed, quiet: bool) -> tuple[dict, list[float]]:
    """The first oscillator that is not refused, takes no time, and meets a stop unless it may be `quiet`."""
    rng = np.random.default_rng(seed)
    while True:
        system, state = drawn(group, rng)
        try:
            oscillator = system_of(system)
            vs.simulate(oscillator, state, 0)  # compiles
            begun = time.process_time()
            orbit = vs.simulate(oscillator, state, PERIODS[-1])
        except ValueError:
            continue
        meets = len(orbit.impacts) or len(orbit.contacts)
        if time.process_time() - begun < LONGEST and (meets or quiet):
            return system, state


def _map_cases():
    rng = np.random.default_rng([SEED, 2])
    changes = (
        {"b": 6.6}, {"b": 6.0}, {"b": 6.9}, {"b": 6.6, "stops": "right"}, {"b": 6.6, "stops": "left"},
        {"b": 6.5, "R": 0.0}, {"b": 6.5, "R": 1.0}, {"b": 1.0, "zeta": 0.9}, {"b": 2.0, "omega": 1.3, "zeta": 0.3},
        {"b": 6.7}, {"b": 6.7},
    )  # fmt: skip
    systems = [("paper", PAPER | change) for change in changes]
    for name in ("one mass, rigid", "two masses, rigid", "three masses, rigid"):
        systems += [(name, _symmetric(GROUPS[name]._replace(constant=False), rng)) for _ in range(3)]
    for k, (group, system) in enumerate(systems):
        order, expand_at = 1 + k % 2, 6.7107356 if system["b"] == 6.7 else None
        graze = vs.discontinuity_map(system_of(system), order, expand_at).graze
        states = [_rounded(graze + 0.2 * np.abs(graze).max() * rng.normal(size=len(graze))) for _ in range(3)]
        yield {
            "name": f"{group}, {k}", "group": group, "system": system, "order": order, "expand_at": expand_at,
            "states": states,
        }  # fmt: skip


def _symmetric(group, rng) -> dict:
    """One of which there is a map."""
    while True:
        system, _ = drawn(group, rng)
        system |= {"tau": "grazing"}
        for name in ("offset", "R_left"):
            system.pop(name, None)
        try:
            graze = vs.grazing(system_of(system))
        except ValueError:
            continue
        return system | {"b": float(f"{0.95 * graze.b:.4g}")}


def _rounded(values) -> list[float]:
    return [float(f"{value:.6g}") for value in values]
