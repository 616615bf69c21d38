"""Cases of orbits born at grazing, and of onsets of sticking."""

import numpy as np
from golden import births, onsets
from golden.motions import start_of, system_record
from support.drawn_branches import drawn_oscillator

import vibro_sweep as vs
from tools.golden.making import tried
from tools.golden.named import PAPER

BIRTHS, ONSETS = 20, 10
WITHOUT = 3  # of the branches that are kept: those beyond whose grazes there is no onset
MODELS = ("two_mass", "one_mass", "chain", "linear")
SHORT_OF_CHATTER = 12  # impacts: onsets lie beyond orbits of more
ROOMS = (0.2, 0.15, 0.11, 0.08, 0.0666)


def born_cases():
    for omega in (0.63, 0.56, 0.53, 0.44):
        yield f"paper, omega = {omega}", PAPER.replace(omega=omega), 4
    for constant in (-2.0, -3.0):
        system = vs.Oscillator.named(
            "one_mass", k=1, zeta=0.1, F=1, omega=0.8, R=0.8, b=1, tau=0, constant=constant, stops="right"
        )
        yield f"one mass, constant = {constant}", system, 3
    seed = 0
    while True:
        model = MODELS[seed % len(MODELS)]
        yield f"drawn {seed}, {model}", drawn_oscillator(model, np.random.default_rng([40, seed])), 3 + seed % 3
        seed += 1


def all_births(report) -> list[dict]:
    result = []
    for name, system, periods in born_cases():
        record = {"name": name, "system": system_record(system), "periods": periods}
        made = tried(lambda case: case | {"result": births.result_of(case)}, record, report)
        if made and made["result"]:
            result.append(made)
            report(f"{name}: {len(made['result'])} orbits")
        if len(result) == BIRTHS:
            return result


def onset_cases():
    """Branches of orbits with chatter of the paper's oscillator, at other frequencies, R and damping."""
    seed = 0
    while True:
        rng = np.random.default_rng([41, seed])
        numbers = {"omega": rng.uniform(0.55, 0.72), "R": rng.uniform(0.6, 0.85), "zeta": rng.uniform(0.03, 0.08)}
        system = PAPER.replace(**numbers) if seed else PAPER
        for b in ROOMS:
            there = system.replace(b=b)
            section = vs.simulate(there, [0.0] * 4, 500).section
            orbit = vs.periodic_orbit(there, state=section[-1])
            if orbit.ok and len(orbit.impacts) > SHORT_OF_CHATTER:
                yield {
                    "name": f"chatter {seed}, b = {b}", "system": system_record(there), "start": start_of(orbit),
                    "parameter": "b", "bounds": [0.6 * b, 1.2 * b],
                }  # fmt: skip
        seed += 1


def all_onsets(report) -> list[dict]:
    result, without = [], 0
    for case in onset_cases():
        made = tried(lambda record: record | {"result": onsets.onsets_of(record)}, case, report)
        if made is None or not made["result"]:
            continue
        empty = not any(made["result"])
        if not empty or without < WITHOUT:
            without += empty
            result.append(made)
            report(f"{made['name']}: {[onset and onset['parameters'] for onset in made['result']]}")
        if len(result) - without == ONSETS:
            return result
