"""The folder of compiled kernels: where it cannot be used they are compiled anew, and that is said once."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from support import slow_cases

PROGRAM = """
from vibro_sweep.engine.simd import jit

@jit.exported
def double(x):
    return 2.0 * x

@jit.exported
def triple(x):
    return 3.0 * x

print(double(1.5), triple(1.5), sum(double._whole.stats.cache_hits.values()))
"""


@pytest.fixture
def program(tmp_path):
    (tmp_path / "program.py").write_text(PROGRAM)

    def run(**environment):
        everything = {name: value for name, value in (os.environ | environment).items() if value is not None}
        done = subprocess.run(
            [sys.executable, "program.py"], cwd=tmp_path, env=everything, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        double, triple, hits = done.stdout.split()
        assert (double, triple) == ("3.0", "4.5")
        return int(hits), [line for line in done.stderr.splitlines() if not line.startswith("vibro-sweep: compil")]

    return run


def entries(folder, ending):
    found = sorted(Path(folder).rglob(f"program.double*{ending}"))
    assert found
    return found


@pytest.mark.slow
def test_why_there_is_a_wait_is_said_once(program, tmp_path):
    """For two kernels one message, and none where both are in the cache."""
    said = "import logging\nlogging.basicConfig(level=logging.INFO, format='%(message)s')\n"
    (tmp_path / "program.py").write_text(said + PROGRAM)
    for hits, messages in ((0, 1), (1, 0)):
        found, lines = program(NUMBA_CACHE_DIR=str(tmp_path / "cache"))
        assert found == hits and sum(line.startswith("compiling kernels, once") for line in lines) == messages


def test_a_second_start_compiles_nothing_and_loads_nothing_that_compiling_takes(program, tmp_path):
    """numba's own way to a kernel in the cache loads scipy and all of numba's registries: a quarter of a second.

    Nor does it make an object for each kernel that only kernels call.
    """
    with_part = PROGRAM.replace("@jit.exported", "@jit.jit\ndef half(x):\n    return 0.5 * x\n\n@jit.exported", 1)
    with_part = with_part.replace("return 2.0 * x", "return 4.0 * half(x)")
    told = "print('numba.np.linalg' in sys.modules, '_kernel' in vars(half), file=sys.stderr)\n"
    (tmp_path / "program.py").write_text("import sys\n" + with_part + told)
    folder = str(tmp_path / "cache")
    assert program(NUMBA_CACHE_DIR=folder) == (0, ["True True"])
    assert program(NUMBA_CACHE_DIR=folder) == (1, ["False False"])


@pytest.mark.parametrize("cuts", slow_cases([(".nbi", 0), (".nbc", 0.5)], [(".nbi", 0.5), (".nbc", 0)]))
def test_a_cut_entry_is_named_and_mended(program, tmp_path, cuts):
    """Index or code, empty or halved; what each start has mended the next one finds whole."""
    folder = str(tmp_path / "cache")
    program(NUMBA_CACHE_DIR=folder)
    for ending, keep in cuts:
        for path in entries(folder, ending):
            path.write_bytes(path.read_bytes()[: int(keep * path.stat().st_size)])
        hits, told = program(NUMBA_CACHE_DIR=folder)
        assert hits == 0 and len(told) == 1 and folder in told[0] and "compiled anew" in told[0], (ending, keep)
    assert program(NUMBA_CACHE_DIR=folder) == (1, [])


@pytest.fixture
def small_disk(tmp_path, request):
    """A file system of its own, of 16 kB or what is asked for."""
    place, size = tmp_path / "small", f"size={getattr(request, 'param', '16k')}"
    place.mkdir()
    made = subprocess.run(["mount", "-t", "tmpfs", "-o", size, "none", place], capture_output=True, check=False)
    if made.returncode:
        pytest.skip("no file system can be mounted here")
    yield place
    subprocess.run(["umount", place], check=True)


@pytest.mark.slow
def test_a_full_disk(program, small_disk):
    with (small_disk / "full").open("wb", buffering=0) as file:
        while file.write(b"\0" * 512) == 512:
            if shutil.disk_usage(small_disk).free == 0:
                break
    hits, told = program(NUMBA_CACHE_DIR=str(small_disk / "cache"))
    assert hits == 0 and len(told) == 1 and str(small_disk) in told[0] and "No space left on device" in told[0]


@pytest.mark.slow
def test_a_folder_that_cannot_be(program, tmp_path):
    (tmp_path / "file").write_text("")
    hits, told = program(NUMBA_CACHE_DIR=str(tmp_path / "file"))
    assert hits == 0 and len(told) == 1 and str(tmp_path / "file") in told[0]


@pytest.mark.slow
@pytest.mark.parametrize("small_disk", ["4m"], indirect=True)
def test_a_folder_that_can_only_be_read(program, small_disk):
    """Of another user, or of a container: what is there is loaded."""
    folder = str(small_disk / "cache")
    assert program(NUMBA_CACHE_DIR=folder) == (0, [])
    subprocess.run(["mount", "-o", "remount,ro", small_disk], check=True)
    assert program(NUMBA_CACHE_DIR=folder) == (1, [])


def test_one_of_several_processes_compiles(tmp_path):
    """The others wait for it, and load what it has compiled; no lock is left."""
    slow = "while not os.path.exists('go'):\n    time.sleep(0.01)\n"
    (tmp_path / "program.py").write_text(
        PROGRAM.replace("@jit", slow + "@jit", 1).replace("\n", "\nimport os, time\n", 1)
    )
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    options = {"cwd": tmp_path, "env": environment, "stdout": subprocess.PIPE, "text": True}
    several = [subprocess.Popen([sys.executable, "program.py"], **options) for _ in range(4)]
    (tmp_path / "go").write_text("")
    hits = sorted(int(one.communicate()[0].split()[-1]) for one in several)
    assert hits == [0, 1, 1, 1] and not [*tmp_path.rglob("*.lock")]


@pytest.mark.slow
def test_without_a_folder_the_wait_is_named(program, tmp_path):
    (tmp_path / "file").write_text("")
    said = "import logging\nlogging.basicConfig(level=logging.INFO, format='%(message)s')\n"
    (tmp_path / "program.py").write_text(said + PROGRAM)
    _, lines = program(NUMBA_CACHE_DIR=str(tmp_path / "file"))
    assert lines.count("compiling kernels") == 1


@pytest.mark.slow
def test_no_home(program, tmp_path, monkeypatch):
    """No HOME and nobody of this number: no folder `~` in the current one."""
    (tmp_path / "sitecustomize.py").write_text("import os\nos.path.expanduser = lambda path: path\n")
    before = {path.name for path in tmp_path.iterdir()}
    hits, told = program(NUMBA_CACHE_DIR=None, XDG_CACHE_HOME=None, HOME=None, PYTHONPATH=str(tmp_path))
    assert hits == 0 and len(told) == 1 and "NUMBA_CACHE_DIR" in told[0]
    assert {path.name for path in tmp_path.iterdir()} - before <= {"__pycache__"}


@pytest.mark.slow
def test_a_relative_cache_home_is_ignored(program, tmp_path):
    before = {path.name for path in tmp_path.iterdir()}
    hits, told = program(NUMBA_CACHE_DIR=None, XDG_CACHE_HOME="relative", HOME=str(tmp_path / "home"))
    assert (hits, told) == (0, []) and {path.name for path in tmp_path.iterdir()} - before == {"home"}


SWEEP = "vs.sweep(system, {'b': [6.6, 6.7]}, transient=10, record=10)"
SIMULATE = "vs.simulate(system, (0, 0, 0, 0), periods=10)"
BOTH = """
import vibro_sweep as vs
from vibro_sweep.engine import orbit_block

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
{}
print(orbit_block.run_points.compiled)
"""


@pytest.mark.slow
def test_sweeps_and_single_orbits_are_compiled_together(tmp_path):
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    compiled = []
    for what in (SIMULATE, SWEEP):
        command = [sys.executable, "-c", BOTH.format(what)]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        compiled.append(int(done.stdout))
    assert compiled == [1, 0]


NAMES = """
import sys

import numpy as np
from numba.core import itanium_mangler
from numba.core.typing.typeof import typeof

from vibro_sweep.engine.simd import jit

for size in map(int, sys.argv[1:]):
    print(itanium_mangler.mangle_type(typeof(np.empty(1, [("x", float, size)]))))
"""


def test_names_of_kernels_in_machine_code_tell_records_apart(tmp_path):
    """In all processes alike: numba counts records as they come up, and a kernel from the cache was called in place of
    another one (wrong numbers, or a crash)."""
    (tmp_path / "program.py").write_text(NAMES)

    def names(*sizes):
        command = [sys.executable, "program.py", *map(str, sizes)]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True).stdout.split()

    three, five = names(3, 5)
    assert three != five and names(5, 3) == [five, three]
