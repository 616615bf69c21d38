"""A periodic orbit as a JSON file: the system's numbers, and the impacts as they were computed, to the last bit."""

import json
import math
import zlib
from pathlib import Path

import numpy as np

from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.checks.arguments import check_type, checked_count
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.file_names import ExistingFileError, FileError, checked_path, file_to_write, read_bytes
from vibro_sweep.checks.real import array_of, number_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.engine.impulses.free_modes import ResonanceError, TooStiffError, without_orbit
from vibro_sweep.oscillator.family import family_of
from vibro_sweep.oscillator.models import DEFAULT
from vibro_sweep.oscillator.oscillator import Oscillator

FORMAT = "vibro_sweep periodic orbit 2"
WITHOUT_CHECKSUM = "vibro_sweep periodic orbit 1"
MOST_BYTES = 2**28


def save_orbit(orbit: PeriodicOrbit, path) -> Path:
    """Write `orbit`. ExistingFileError where there is a file, FileError where none can be written, ValueError for an
    orbit without a motion or of a Family."""
    path, s = file_to_write("path", path), orbit._solution
    if s is None:
        raise ArgumentError(f"this orbit has no motion to save: its status is {orbit.status!r}")
    system = orbit.system
    if not isinstance(system, Oscillator):
        raise ArgumentError("an orbit of a Family cannot be saved: its function is not a text")
    record = {
        "format": FORMAT,
        "system": {"type": system.model.name, **system.arguments},
        "sigma": s.sigma,
        "halves": s.half_periods,
        "sides": [int(side) for side in s.sides],
        "rests": list(s.rests),
        "unknowns": [float(value) for value in s.u],
        "residual": float(s.change),
    }
    record["checksum"] = checksum_of(record)
    try:
        with path.open("x", encoding="utf-8") as file:
            json.dump(record, file, indent=1)
            file.write("\n")
    except FileExistsError:
        raise ExistingFileError(path) from None
    except OSError as error:
        reason = error.strerror if path.parent.is_dir() else f"there is no folder {path.parent}"
        raise FileError(path, f"cannot be written: {reason}") from None
    return path


def load_orbit(path: str | Path) -> PeriodicOrbit:
    """Read what `PeriodicOrbit.save` wrote; its status is checked anew.

    Raises ValueError where the file is something else, MissingFileError where there is none, FileError where it cannot
    be read.
    """
    path = checked_path("path", path)
    text = read_bytes(path, MOST_BYTES)
    try:
        record = json.loads(text.decode())
    except (ValueError, RecursionError):  # no UTF-8, no JSON, thousands of digits; nested thousands of times
        record = None
    if not isinstance(record, dict) or record.get("format") not in (FORMAT, WITHOUT_CHECKSUM):
        raise FileError(path, f"not a file of the format {FORMAT!r}")
    try:
        check_type("system", record["system"], dict, "an object of numbers")
        numbers = dict(record["system"])
        system = Oscillator.named(numbers.pop("type", DEFAULT), **numbers)
        sigma, half_periods = (
            checked_count("sigma", record["sigma"], -1, 1),
            checked_count("halves", record["halves"], 1),
        )
        sides, rests = _whole("sides", record["sides"]), _whole("rests", record.get("rests", []))
        u, change = array_of(record["unknowns"], 1), number_of(record["residual"])
        if u is None or change is None:
            raise ValueError("its unknowns and its residual are not numbers")
        family = family_of(system)
        odd = sigma == -1 and half_periods % 2 == 1 and family.linear.symmetric
        even = sigma == 1 and half_periods % 2 == 0
        if not (odd or even) or half_periods < 1 or set(sides) - {1, -1}:
            raise ValueError("its symmetry, period or sides do not fit together")
        if list(rests) != sorted(set(rests)) or not all(0 <= k < len(sides) for k in rests):
            raise ValueError("its rests do not belong to impacts")
        if u.shape != (2 * len(sides) + len(rests),) or not np.all(np.isfinite(u)) or not math.isfinite(change):
            raise ValueError("its impacts are not complete")
        if np.any(np.diff(u[: len(sides)]) <= 0):
            raise ValueError("its impacts are not in order")
        if (record["format"] == FORMAT or "checksum" in record) and record["checksum"] != checksum_of(record):
            raise ValueError("its checksum is wrong")
    except KeyError as missing:
        raise FileError(path, f"damaged: {missing} is missing") from None
    except (TypeError, ValueError) as problem:
        raise FileError(path, f"damaged: {problem}") from None
    try:
        return orbit_of(system, Solution(family, sigma, half_periods, sides, u, change, rests))
    except ResonanceError:
        return PeriodicOrbit(system, without_orbit(family.linear))
    except TooStiffError:
        return PeriodicOrbit(system, "too_stiff")


def checksum_of(record: dict) -> str:
    """The checksum of all other entries of a record."""
    rest = {key: value for key, value in record.items() if key != "checksum"}
    return f"{zlib.crc32(json.dumps(rest, sort_keys=True).encode()):08x}"


def _whole(name: str, values: object) -> tuple[int, ...]:
    if not isinstance(values, list):
        raise ArgumentError(not_allowed(name, values, "a list of whole numbers"))
    return tuple(checked_count(f"{name}[{i}]", value, -1) for i, value in enumerate(values))
