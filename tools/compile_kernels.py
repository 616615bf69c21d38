"""Compile, once each and two kinds at a time, the kernels that the tests need: python tools/compile_kernels.py

Two workers of pytest would compile the same kernel at the same moment. The list is that of the kinds of oscillators in
tests/ that several files use; the table "kernels compiled" at the end of a run of the tests says which are missing.
"""

import logging
import multiprocessing
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import vibro_sweep as vs

WORKERS = 2
PAPER = {"mu_m": 10, "mu_k": 5, "zeta": 0.05, "f2": 0, "omega": 0.63, "b": 2.0}
RIGID, COMPLIANT = {"R": 0.8}, {"k_stop": 100.0, "c_stop": 0.5}


def sweep(system, **more) -> None:
    """Sections, exponents, impacts and energies of an orbit."""
    observe = ["section", "lyapunov", "impacts", "energy"]
    vs.sweep(system, {"omega": [system.omega]}, transient=1, record=2, observe=observe, workers=1, **more)


def trajectory(system) -> None:
    sweep(system, trajectory={"periods": 1, "samples": 3})


def mapping(system) -> None:
    """The discontinuity mapping in place of the flow, and its Jacobian."""
    vs.discontinuity_map(system).jacobian([0.0] * 4)
    text = "{system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.0}, dynamics: map, "
    text += "orbit: {transient: 1, record: 2}, observe: [section, lyapunov]}"
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "map.yaml"
        scene.write_text(text)
        vs.run(vs.load_scene(scene), scene.with_suffix(".h5"), workers=1)


def branch(system) -> None:
    """A periodic orbit, of free motion where nothing else is sure to exist."""
    vs.periodic_orbit(system, itinerary="R")


def one_mass(**numbers):
    return vs.Oscillator.named("one_mass", zeta=0.05, F=1.0, omega=0.8, b=0.3, stops="right", **numbers)


def of_masses(n: int, **numbers):
    """A chain of n masses whose first strikes stops."""
    return vs.Oscillator(
        np.eye(n), 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1), rayleigh=[0.1, 0.0], force=[1.0] + [0.0] * (n - 1),
        contact_normal=[1.0] + [0.0] * (n - 1), omega=0.7, b=0.3, **numbers,
    )  # fmt: skip


# name: oscillator, and what is compiled of it; those first that take longest
KINDS: dict[str, tuple[Callable[[], Any], tuple[Callable[[Any], None], ...]]] = {
    "two masses, compliant": (lambda: of_masses(2, **COMPLIANT), (sweep, trajectory, branch)),
    "three masses": (lambda: of_masses(3, **RIGID), (sweep, branch)),
    "two masses": (lambda: vs.System(**PAPER, **RIGID), (sweep, trajectory, mapping, branch)),
    "one mass, compliant": (lambda: one_mass(**COMPLIANT), (sweep, trajectory, branch)),
    "three masses, compliant": (lambda: of_masses(3, **COMPLIANT), (sweep, branch)),
    "one mass": (lambda: one_mass(**RIGID), (sweep, branch)),
    "two masses, rests": (lambda: of_masses(2, R=0.0), (branch,)),
    "two masses, constant force": (lambda: of_masses(2, constant=[0.1, 0.0], **RIGID), (sweep,)),
    "one mass, constant force": (lambda: one_mass(constant=0.1, **RIGID), (sweep,)),
    "four masses": (lambda: of_masses(4, **RIGID), (sweep, branch)),
}


def compiled(name: str) -> tuple[str, float]:
    """Compile the kernels of a kind; the seconds that this took."""
    logging.getLogger("vibro_sweep").setLevel(logging.WARNING)
    begun = time.perf_counter()
    make, uses = KINDS[name]
    system = make()
    for use in uses:
        use(system)
    return name, time.perf_counter() - begun


if __name__ == "__main__":
    begun = time.perf_counter()
    with multiprocessing.get_context("spawn").Pool(WORKERS, maxtasksperchild=1) as pool:
        for name, seconds in pool.imap_unordered(compiled, KINDS):
            print(f"compiled kernels of {name} in {seconds:.0f} s", flush=True)
    print(f"compiled all kernels in {time.perf_counter() - begun:.0f} s")
