"""Makes the sweeps whose windows are part of the record."""

import gzip
import tempfile
from pathlib import Path

import numpy as np
from golden import records, windows
from golden.motions import system_record
from support.models import oscillator

import vibro_sweep as vs
from tools.golden.named import PAPER

START = {"random": 2, "seed": 1}


def rigid() -> list[tuple]:
    """Name, oscillator, parameter, values."""
    return [
        ("paper in b", PAPER, "b", np.linspace(4.2, 6.9, 55)),
        ("paper in omega", PAPER.replace(b=0.4, stops="right"), "omega", np.linspace(0.4, 1.2, 25)),
        ("one mass in omega", oscillator("one_mass"), "omega", np.linspace(0.5, 1.6, 34)),
        ("chain in b", oscillator("chain", b=0.3), "b", np.linspace(0.1, 0.6, 26)),
        ("cavity in F", oscillator("ball_in_cavity"), "F", np.linspace(0.1, 0.6, 26)),
    ]


def compliant() -> list[tuple]:
    one = vs.Oscillator.named("one_mass", zeta=0.05, F=0.5, omega=0.9, b=0.6, k_stop=29.0, c_stop=0.5, tau=0.0)
    two = PAPER.replace(R=None, k_stop=100.0)
    return [
        ("compliant one mass in b", one.replace(stops="right"), "b", np.linspace(0.4, 2.6, 23)),
        ("compliant one mass left by force in omega", one.replace(preload=0.05, release="force"), "omega",
         np.linspace(0.4, 1.4, 21)),
        ("compliant paper in b", two, "b", np.linspace(2.0, 6.8, 25)),
    ]  # fmt: skip


def all_windows(told) -> list[dict]:
    return _windows_of(rigid(), told)


def all_compliant_windows(told) -> list[dict]:
    return _windows_of(compliant(), told)


def _windows_of(sweeps: list[tuple], told) -> list[dict]:
    result = []
    for name, system, parameter, values in sweeps:
        file = f"{name.replace(' ', '_')}.h5.gz"
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "sweep.h5"
            vs.sweep(
                system, {parameter: values}, start=START, transient=1000, record=60, observe=["section"], output=path,
                workers=1,
            )  # fmt: skip
            (records.FOLDER / file).write_bytes(gzip.compress(path.read_bytes(), 9, mtime=0))
        found = windows.result_of(windows.windows_in(records.FOLDER / file))
        record = {"name": name, "system": system_record(system), "file": file, "parameter": parameter}
        result.append(record | {"bounds": [float(values[0]), float(values[-1])], "result": found})
        told(f"{name}: {len(found['windows'])} windows")
    return result
