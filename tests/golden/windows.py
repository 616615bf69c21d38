"""Windows of sweeps as records, and what differs from a record. The file of the sweep is part of it: which orbits it
meets after a chaotic transient depends on the last digits."""

import gzip
import tempfile
from pathlib import Path

import h5py

import vibro_sweep as vs
from golden import records
from golden.special_points import changed, differences, special_record

LABELS = ("period", "itinerary", "symmetric", "points", "other_attractor", "held")


def windows_in(file: Path):
    """Of a sweep whose file is compressed."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "sweep.h5"
        path.write_bytes(gzip.decompress(file.read_bytes()))
        with h5py.File(path, "r+") as sweep:
            sweep.attrs["kind"] = "sweep"  # which files of its time did not say
        return vs.windows(path)


def result_of(windows) -> dict:
    return {
        "parameter": windows.parameter,
        "window": windows.window.tolist(),
        "reason": windows.reason.tolist(),
        "windows": [_window(one) for one in windows],
        "unvisited": [[one.window, one.lo, one.hi, one.values, one.at] for one in windows.unvisited],
    }


def _window(one) -> dict:
    ends = [special_record(one.lower), special_record(one.upper)]
    return {name: getattr(one, name) for name in LABELS} | {"ends": ends}


def compared(record: dict, result: dict, windows) -> list[str]:
    now = result_of(windows)
    lines = changed(result, now, ("parameter", "window", "reason"))
    if len(result["windows"]) != len(now["windows"]):
        return [*lines, f"{len(result['windows'])} windows, now {len(now['windows'])}"]
    size = {result["parameter"]: record["bounds"][1] - record["bounds"][0]}
    allowed = []
    for k, (stored, one) in enumerate(zip(result["windows"], now["windows"], strict=True)):
        own = changed(stored, one, LABELS) + differences(stored["ends"], one["ends"], size)
        lines += [f"window {k}: {line}" for line in own]
        errors = [end["error"] for two in (stored, one) for end in two["ends"]]
        allowed.append(sum(error for error in errors if error == error))
    unvisited = [(one, other) for one, other in zip(result["unvisited"], now["unvisited"], strict=False)]
    if len(result["unvisited"]) != len(now["unvisited"]) or not all(_same(*both, allowed) for both in unvisited):
        lines.append(f"unvisited: {result['unvisited']}, now {now['unvisited']}")
    return lines


def _same(stored, now, allowed) -> bool:
    """A stretch of a window begins and ends at values of the sweep, or at the window's ends."""
    return (
        stored[0] == now[0]
        and stored[3:] == now[3:]
        and all(abs(a - b) <= allowed[stored[0]] for a, b in zip(stored[1:3], now[1:3], strict=True))
    )


def differences_from(record: dict) -> list[str]:
    """Between a record and the windows that are found now in its sweep."""
    return compared(record, record["result"], windows_in(records.FOLDER / record["file"]))
