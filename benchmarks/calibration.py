"""How far the errors that a file gives for its Lyapunov exponents can be trusted: a Markdown table.

    python benchmarks/calibration.py [--values 1001] [--longer 100] [--compliant]

Four sweeps of the paper's oscillator, with rigid stops or with compliant ones, each once with a usual record and once
with one that is so many times longer. Of the exponents whose points have the status `ok` in both, the table gives the
part that differs from the long run by more than 2 and by more than 5 of the errors stored beside them. Twenty parts of
a record and a normal distribution would put 6.0 % beyond 2 (Student's t with 19 degrees of freedom).
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np

import vibro_sweep as vs
from vibro_sweep.scene import parse_scene

SYSTEM = {"mu_m": 10, "mu_k": 5, "zeta": 0.05, "f2": 0, "omega": 0.63, "b": 6.0}
RIGID = {"R": 0.8}, {"b": (4.2, 7.0), "mu_k": (2.0, 8.0), "omega": (0.58, 0.68), "R": (0.5, 0.95)}
COMPLIANT = (
    {"k_stop": 400, "c_stop": 2.8, "preload": 0.05},  # a damping ratio of 0.07: restitution 0.8
    {"b": (4.2, 7.0), "mu_k": (2.0, 8.0), "omega": (0.58, 0.68), "k_stop": (50, 2000)},
)


def exponents(folder: Path, stops: tuple[dict, dict], key: str, values: int, record: int):
    """The file of a sweep, with exponents after 1300 periods."""
    law, sweeps = stops
    low, high = sweeps[key]
    system = ", ".join(f"{name}: {value}" for name, value in (SYSTEM | law).items())
    text = (
        f"system: {{{system}}}\nsweep: {{{key}: {{start: {low}, stop: {high}, num: {values}}}}}\n"
        f"orbit: {{transient: 1300, record: {record}}}\nobserve: [lyapunov, multipliers]\n"
    )
    path = folder / f"{key}-{record}.h5"
    vs.run(parse_scene(text), path)
    return vs.open(path).load()


def row(folder: Path, stops: tuple[dict, dict], key: str, values: int, longer: int) -> dict:
    """How often the exponents of a sweep lie beyond 2 and 5 errors of those of a longer record."""
    short, long = (exponents(folder, stops, key, values, 200 * more) for more in (1, longer))
    # an orbit that is found not settled in the long run was on another motion in the short one
    ok = ((short.status == 0) & (long.status == 0) & np.isfinite(short.lyapunov).all("exponent")).values
    far = np.abs(short.lyapunov - long.lyapunov).values / short.lyapunov_error.values
    periodic = short.period.values > 0
    kinds = {"all": ok, "without a period": ok & ~periodic}
    parts = {name: (np.mean(far[which] > 2), np.mean(far[which] > 5)) for name, which in kinds.items()}
    return {"points": ok.sum(), "periodic": (ok & periodic).sum(), **parts}


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--values", type=int, default=1001)
    options.add_argument("--longer", type=int, default=100)
    options.add_argument("--compliant", action="store_true")
    given = options.parse_args()
    stops = COMPLIANT if given.compliant else RIGID
    print("| sweep | points | periodic | beyond 2, all | beyond 5, all | beyond 2, no period | beyond 5, no period |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as folder:
        for key in stops[1]:
            found = row(Path(folder), stops, key, given.values, given.longer)
            cells = [found[kind][i] for kind in ("all", "without a period") for i in (0, 1)]
            counts = f"| {key} | {found['points']} | {found['periodic']} | "
            print(counts + " | ".join(f"{100 * x:.2f} %" for x in cells) + " |")


if __name__ == "__main__":
    main()
