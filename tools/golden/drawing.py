"""Cases drawn at random: oscillators of all models, orbits that attract or not. Needed to make the record only."""

import numpy as np
from golden.motions import start_of, system_record
from support.drawn_branches import MODELS, Case, beyond, drawn_case

import vibro_sweep as vs

OF_STOPS = ("k_stop", "preload", "c_stop")  # compliant ones
DEEP = 3  # branches from branch to branch
SEED = 30
SECOND = (  # of a curve's plane
    "omega", "R", "zeta", "b", "offset", "F", "mu_k", "mass_ratio", "k", "f2", "mu_m", *OF_STOPS,
)  # fmt: skip
BOX = (0.1, 0.06)  # of both parameters, relative, each way
INNER = 0.5  # of the box
CURVES = ("fold", "flip", "pitchfork", "neimark_sacker", "graze", "sticking")
LARGEST = 1e4  # of the bounds


def _record(name: str, case: Case) -> dict:
    system = case.orbit.system
    return {
        "name": name, "system": system_record(system), "start": start_of(case.orbit), "parameter": case.name,
        "bounds": [float(bound) for bound in case.bounds],
    }  # fmt: skip


def cases(seed: int):
    """Of a drawn oscillator a branch, and branches beyond its special points, each once."""
    model, rng = MODELS[seed % len(MODELS)], np.random.default_rng([SEED, seed])
    yield from one_after_the_other(f"drawn {seed}", model, drawn_case(model, rng), rng)


def one_after_the_other(name: str, model: str, case: Case | None, rng):
    """A branch, and branches beyond its special points, each once."""
    seen = []
    for depth in range(DEEP):
        if case is None:
            return
        branch = vs.continue_orbit(case.orbit, case.name, case.bounds)
        points = [(one.type, f"{one.parameters[case.name]:.9g}") for one in branch.special]
        if points in seen:
            return
        seen.append(points)
        yield _record(f"{name}.{depth}, {model}", case)
        case = beyond(branch, case, rng) if branch.ok else None


def one_curve(record: dict, special: dict, rng, name: str, box=BOX) -> dict | None:
    """A curve from a special point of a branch: another parameter, and a box around the point."""
    numbers, first = record["system"], record["parameter"]
    others = [one for one in SECOND if one != first and isinstance(numbers.get(one), float) and numbers[one]]
    if not others:
        return None
    second = others[int(rng.integers(min(2, len(others))))] if rng.random() < 0.7 else str(rng.choice(others))
    at = special["parameters"][first], numbers[second]
    boxes = [
        [_around(one, key, share * part) for one, key, share in zip(at, (first, second), box, strict=True)]
        for part in (1.0, INNER)
    ]
    start = {key: record[key] for key in ("system", "start", "parameter", "bounds")}
    kept = {"type": special["type"], "parameters": special["parameters"]}
    return {
        "name": name,
        **start,
        "special": kept,
        "then": [],
        "names": [first, second],
        "box": boxes[0],
        "inner": boxes[1],
    }


def _around(value: float, name: str, share: float) -> list[float]:
    reach = share * (abs(value) or 1.0)
    return [value - reach, min(value + reach, 1.0) if name.startswith("R") else value + reach]
