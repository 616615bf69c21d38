"""All kinds of files that this program writes: one table, from which tests of formats, damage and kills draw.

Each kind has a scene, or the sweep that it is made of; they are small, and have at least one of everything.
"""

from pathlib import Path
from typing import NamedTuple

import pytest

from vibro_sweep.cli import main

SYSTEM = "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6}\n"
LINEAR = """
system: {type: linear, M: [[1, 0], [0, 2]], K: [[3, -1], [-1, 2]], C: [[0.1, 0], [0, 0.1]], along: [1, 0],
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
BRANCHES = "continue: {from: {sweep: sweep.h5}, along: {b: {start: 5.85, stop: 6.2}}, depth: 0}\n"
CURVES = (
    "continue: {from: {branches: branches.h5, special: 1}, "
    "along: {b: {start: 5.85, stop: 6.2}, omega: {start: 0.6295, stop: 0.6305}}}\n"
)


class Kind(NamedTuple):
    """`scene`: what `run` makes it of; without one it is the windows of the sweep. `source`: a file that it needs."""

    scene: str | None
    source: str = ""

    def command(self, name: str) -> list[str]:
        """The words of the command line that make NAME.h5, in the folder of all kinds."""
        first = ["windows", f"{self.source}.h5"] if self.scene is None else ["run", f"{name}.yaml"]
        return [*first, "-o", f"{name}.h5", "--workers", "1", "--quiet"]


KINDS = {
    "sweep": Kind(SYSTEM + SWEEP),
    "follow": Kind(SYSTEM + FOLLOW + SHORT),
    "plane": Kind(SYSTEM + PLANE + SHORT),
    "orbit": Kind(SYSTEM + ORBIT + SHORT),
    "linear": Kind(LINEAR),
    "windows": Kind(None, "sweep"),
    "branches": Kind(SYSTEM + BRANCHES, "sweep"),
    "curves": Kind(SYSTEM + CURVES, "branches"),
}
FLAT = ("windows", "branches", "curves")


def write_scenes(folder: Path) -> None:
    for name, kind in KINDS.items():
        if kind.scene is not None:
            (folder / f"{name}.yaml").write_text(kind.scene)


@pytest.fixture(scope="session")
def kinds(tmp_path_factory) -> Path:
    """A folder with a file NAME.h5 of each kind, and NAME.yaml; nobody may change it."""
    folder = tmp_path_factory.mktemp("kinds")
    write_scenes(folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for name, kind in KINDS.items():
            assert main(kind.command(name)) == 0, name
    return folder
