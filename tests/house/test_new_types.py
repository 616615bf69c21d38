"""How many edits a new type of bifurcation takes: made in a copy of the package (docs/development/architecture.md)."""

import json
import os
import re
import shutil
import subprocess
import sys

import pytest
from support import ROOT

pytestmark = pytest.mark.slow
FOLLOW = """
import json
import vibro_sweep as vs
system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=3.0)
branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="LR"), "b", (0.3, 6.8))
special = [(one.type, one.parameters["b"], float(one.orbit.impacts["v1"][0])) for one in branch.special]
print(json.dumps([special, vs.__file__]))
"""
TABLE, TESTS = "tables/bifurcations.py", "engine/continuation/branch_tests.py"


def special_points(folder, edits):
    """(type, b, speed of the first impact) of the paper's symmetric orbit, of the package with these edits."""
    shutil.copytree(ROOT / "vibro_sweep", folder / "vibro_sweep", ignore=shutil.ignore_patterns("__pycache__"))
    for name, old, new in edits:
        path = folder / "vibro_sweep" / name
        text = path.read_text()
        assert text.count(old) == 1
        path.write_text(text.replace(old, new))
    (folder / "follow.py").write_text(FOLLOW)
    environment = os.environ | {"PYTHONPATH": str(folder), "NUMBA_CACHE_DIR": str(folder / "kernels")}
    done = subprocess.run(
        [sys.executable, "follow.py"], cwd=folder, env=environment, capture_output=True, text=True, check=True
    )
    special, where = json.loads(done.stdout)
    assert where.startswith(str(folder))
    return special


def test_a_speed_that_an_impact_passes_is_a_row_and_a_line(tmp_path):
    row, line, values = '    Bifurcation("closed", ', "    x[TEST.above] = -1.0\n", {"slow": 0.2, "fast": 0.25}
    rows = "".join(f'    Bifurcation("{name}", "the first impact has this speed", test="{name}"),\n' for name in values)
    tests = "".join(f"    x[TEST.{name}] = abs(b.events[0].motion[0]) - {value}\n" for name, value in values.items())
    found = special_points(tmp_path, [(TABLE, row, rows + row), (TESTS, line, line + tests)])
    assert [kind for kind, *_ in found] == ["graze", "fast", "slow", "pitchfork", "graze"]
    assert found[2][2] / found[1][2] == pytest.approx(0.8, rel=1e-12)


def test_a_pitchfork_is_taken_out_of_the_table_alone(tmp_path):
    text = (ROOT / "vibro_sweep" / TABLE).read_text()
    rows = [
        re.search(begin, text, re.DOTALL)[0]
        for begin in (
            r' {4}Bifurcation\("pitchfork".*?\),\n(?= {4}B)',
            r' {4}Point\("pitchfork_graze".*?\),\n(?= {4}P)',
        )
    ]
    found = special_points(tmp_path, [(TABLE, row, "") for row in rows])
    assert [kind for kind, *_ in found] == ["graze", "graze"]
