"""All kinds of files that this program writes: one table, from which tests of formats, damage and kills draw.

Each kind has a scene, or the sweep that it is made of; they are small, and have at least one of everything.
"""

import contextlib
from pathlib import Path
from typing import NamedTuple

import pytest

import vibro_sweep as vs
from support.oscillators import PAPER, PAPER_NUMBERS
from support.programs import main

SYSTEM = f"system: {{{PAPER_NUMBERS}, b: 6}}\n"
LINEAR = """
system: {type: linear, M: [[1, 0], [0, 2]], K: [[3, -1], [-1, 2]], C: [[0.1, 0], [0, 0.1]], contact_normal: [1, 0],
  force: [1, 0], omega: 1.1, R: 0.8, b: 0.5}
sweep: {omega: {start: 1.3, stop: 1.9, num: 3}}
orbit: {transient: 5, record: 6}
observe: [section, lyapunov]
"""
SWEEP = (
    "sweep: {b: {start: 5.5, stop: 6.1, num: 4}}\norbit: {transient: 1000, record: 40}\nobserve: [section, impacts]\n"
)
PLANE = "sweep: {omega: {values: [0.62, 0.63, 0.65]}, b: {start: 6.5, stop: 6.7, num: 2}}\n"
FOLLOW = "sweep: {b: {start: 6.5, stop: 6.7, num: 3}}\nstart: {follow: both}\n"
ORBIT = "trajectory: {periods: 2, samples: 20}\n"
SHORT = "orbit: {transient: 5, record: 6}\nobserve: [section, lyapunov, impacts, energy]\n"
LONG = (("transient: 5, record: 6", "transient: 6000, record: 100"),)
BRANCHES = "continue: {from: {sweep: sweep.h5}, parameter: {b: [5.85, 6.2]}, depth: 0}\n"
CURVES = "continue: {from: {branches: branches.h5, special: 1}, parameter: {b: [5.85, 6.2], omega: [0.6295, 0.6305]}}\n"


class Kind(NamedTuple):
    """`scene`: what `run` makes it of; without one it is the windows of the sweep. `source`: a file that it needs.

    longer : words of the scene, and words in their place with which a run has many blocks or pieces
    """

    scene: str | None
    source: str = ""
    longer: tuple[tuple[str, str], ...] = ()

    def command(self, name: str) -> list[str]:
        """The words of the command line that make NAME.h5, in the folder of all kinds."""
        first = ["windows", f"{self.source}.h5"] if self.scene is None else ["run", f"{name}.yaml"]
        return [*first, "-o", f"{name}.h5", "--workers", "1", "--quiet"]


KINDS = {
    "sweep": Kind(
        SYSTEM + SWEEP,
        longer=(
            ("start: 5.5, stop: 6.1, num: 4", "start: 5.4, stop: 6.2, num: 41"),
            ("transient: 1000", "transient: 20000"),
        ),
    ),
    "follow": Kind(
        SYSTEM + FOLLOW + SHORT,
        longer=(("num: 3", "num: 800"), ("transient: 5, record: 6", "transient: 100, record: 100")),
    ),
    "plane": Kind(SYSTEM + PLANE + SHORT, longer=(("num: 2", "num: 150"), *LONG)),
    "orbit": Kind(SYSTEM + ORBIT + SHORT),
    "linear": Kind(LINEAR, longer=(("num: 3", "num: 400"), *LONG)),
    "windows": Kind(None, "sweep"),
    "branches": Kind(SYSTEM + BRANCHES, "sweep", (("depth: 0", "depth: 1"),)),
    "curves": Kind(
        SYSTEM + CURVES,
        "branches",
        (("branches: branches.h5, special: 1", "sweep: sweep.h5, largest: 4"), ("b: [5.85,", "b: [5.4,")),
    ),
}
# sweeps with compliant stops, which are killed as well; files of one format need not be damaged twice
COMPLIANT = {
    "compliant": Kind(
        "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, b: 4, k_stop: 400, c_stop: 2, preload: 0.1}\n"
        "sweep: {b: {start: 3, stop: 7, num: 3}}\nstart: {random: 2, seed: 5}\n"
        "orbit: {transient: 5, record: 6}\nobserve: [attractors, section, contacts, energy]\n",
        longer=(("num: 3", "num: 120"), ("transient: 5, record: 6", "transient: 3000, record: 100")),
    ),
    "compliant, follow": Kind(
        "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, k_stop: 2, c_stop: 20, preload: 0.01,"
        " release: force}\n"
        "sweep: {b: {start: 3, stop: 5, num: 3}, omega: {values: [0.6, 0.63, 0.66]}}\nstart: {follow: both}\n"
        "orbit: {transient: 5, record: 6}\nobserve: [section, lyapunov, contacts, energy]\n",
        longer=(
            ("num: 3", "num: 400"),
            ("omega: {values: [0.6, 0.63, 0.66]}", "omega: {start: 0.6, stop: 0.7, num: 40}"),
        ),
    ),
}
RAGGED = ("windows", "branches", "curves")
PERIODIC = "periodic"  # `PeriodicOrbit.save`
BOTH_SIDES = PAPER.replace(b=1)


def write_scenes(folder: Path, longer: bool = False) -> None:
    for name, kind in (KINDS | COMPLIANT).items():
        if kind.scene is None:
            continue
        text = kind.scene
        for old, new in kind.longer if longer else ():
            assert old in text
            text = text.replace(old, new)
        (folder / f"{name}.yaml").write_text(text)


class WrittenKinds:
    """Files of all kinds in a folder, each made when it is first asked for; nobody may change them."""

    def __init__(self, folder: Path):
        self.folder = folder
        write_scenes(folder)

    def __call__(self, name: str) -> Path:
        """NAME.h5, beside NAME.yaml and the file that it is made from; or the JSON file of a periodic orbit."""
        if name == PERIODIC:
            path = self.folder / f"{name}.json"
            return path if path.exists() else vs.periodic_orbit(BOTH_SIDES, itinerary="LLRR").save(path)
        path, kind = self.folder / f"{name}.h5", KINDS[name]
        if not path.exists():
            if kind.source:
                self(kind.source)
            with contextlib.chdir(self.folder):
                assert main(kind.command(name)) == 0, name
        return path


@pytest.fixture(scope="session")
def kinds(tmp_path_factory) -> WrittenKinds:
    return WrittenKinds(tmp_path_factory.mktemp("kinds"))
