"""A periodic orbit as a JSON file: the system's numbers, and the impacts as they were computed, to the last bit."""

import json
import math
from dataclasses import fields
from pathlib import Path

import numpy as np

from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.model.general import Oscillator
from vibro_sweep.model.linear import family_of
from vibro_sweep.model.oscillator import System

FORMAT = "vibro_sweep periodic orbit 1"


def save_orbit(orbit: PeriodicOrbit, path) -> Path:
    """Write `orbit`; FileExistsError where there is a file, ValueError for an orbit without a motion or of a Family."""
    s = orbit._solution
    if s is None:
        raise ValueError(f"this orbit has no motion to save: its status is {orbit.status!r}")
    system = orbit.system
    if isinstance(system, System):
        numbers = {field.name: getattr(system, field.name) for field in fields(system)}
    elif isinstance(system, Oscillator):
        numbers = {"type": system.model.name, **system.given}
    else:
        raise ValueError("an orbit of a Family cannot be saved: its function is no text")
    record = {
        "format": FORMAT,
        "system": numbers,
        "sigma": s.sigma,
        "halves": s.halves,
        "sides": [int(side) for side in s.sides],
        "rests": list(s.rests),
        "unknowns": [float(value) for value in s.u],
        "residual": float(s.change),
    }
    path = Path(path)
    with path.open("x", encoding="utf-8") as file:
        json.dump(record, file, indent=1)
        file.write("\n")
    return path


def load_orbit(path) -> PeriodicOrbit:
    """Read what `PeriodicOrbit.save` wrote; its status is checked anew. ValueError where the file is something else."""
    try:
        record = json.loads(Path(path).read_text(encoding="utf-8"))
    except (UnicodeDecodeError, json.JSONDecodeError):
        record = None
    if not isinstance(record, dict) or record.get("format") != FORMAT:
        raise ValueError(f"{path}: not a file of the format {FORMAT!r}")
    try:
        numbers = dict(record["system"])
        model = numbers.pop("type", None)
        system = System(**numbers) if model is None else Oscillator.named(model, **numbers)
        sigma, halves, sides = int(record["sigma"]), int(record["halves"]), tuple(map(int, record["sides"]))
        u, change = np.array(record["unknowns"], float), float(record["residual"])
        rests = tuple(map(int, record.get("rests", ())))
        family = family_of(system)
        odd = sigma == -1 and halves % 2 == 1 and family.linear.symmetric
        even = sigma == 1 and halves % 2 == 0
        if not (odd or even) or halves < 1 or set(sides) - {1, -1}:
            raise ValueError("its symmetry, period or sides do not fit together")
        if list(rests) != sorted(set(rests)) or not all(0 <= k < len(sides) for k in rests):
            raise ValueError("its rests do not belong to impacts")
        if u.shape != (2 * len(sides) + len(rests),) or not np.all(np.isfinite(u)) or not math.isfinite(change):
            raise ValueError("its impacts are not complete")
        if np.any(np.diff(u[: len(sides)]) <= 0):
            raise ValueError("its impacts are not in order")
    except (KeyError, TypeError, ValueError) as problem:
        raise ValueError(f"{path}: damaged: {problem}") from None
    return orbit_of(system, Solution(family, sigma, halves, sides, u, change, rests))
