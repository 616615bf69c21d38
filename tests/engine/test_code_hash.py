"""Equal identities give equal numbers: each module that numbers depend on changes it, and nothing else does."""

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from support import slow_cases

import vibro_sweep
from vibro_sweep.driver import code_hash
from vibro_sweep.engine.simd import kernel_cache

PACKAGE = Path(vibro_sweep.__file__).parent
MODULES = {path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py")}
COUNTED = {path.relative_to(PACKAGE).as_posix() for path in code_hash.sources()}

# What is reached from the code that computes and makes no number: the store's reading and writing, and the version.
NUMBERLESS = {
    "__init__.py",
    "driver/__init__.py",
    "driver/block_size.py",
    "driver/code_hash.py",
    "driver/cost.py",
    "driver/memory_needed.py",
    "files/__init__.py",
    "files/making.py",
}


@pytest.fixture
def copy(tmp_path, monkeypatch):
    """A copy of the package, of which identities are taken."""
    home = tmp_path / "vibro_sweep"
    shutil.copytree(PACKAGE, home, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(code_hash, "HOME", home)
    return home


def now():
    return code_hash.code_hash.__wrapped__()


def test_a_copy_has_the_same_identity(copy):
    assert now() == code_hash.code_hash()


@pytest.mark.slow
def test_each_module_that_makes_numbers_changes_it(copy):
    before = now()
    assert len(COUNTED) > 40
    for name in sorted(COUNTED):
        whole = (copy / name).read_bytes()
        (copy / name).write_bytes(whole + b"\n# another\n")
        assert now() != before, name
        (copy / name).write_bytes(whole)
    assert now() == before


def test_other_modules_do_not(copy):
    before = now()
    others = MODULES - COUNTED
    assert {"cli/commands.py", "files/sweep_file.py", "plotting/sweeps.py", "driver/executors.py"} <= others
    for name in others:
        (copy / name).write_text("another\n")
    assert now() == before


def test_modules_that_come_and_go_change_it(copy):
    seen = {now()}
    (copy / "oscillator" / "new.py").write_text("")
    seen.add(now())
    (copy / "oscillator" / "new.py").rename(copy / "analysis" / "new.py")
    seen.add(now())
    assert len(seen) == 3


@pytest.mark.parametrize("library", code_hash.LIBRARIES)
def test_the_libraries_that_compute_change_it(copy, monkeypatch, library):
    before, real = now(), code_hash.version
    monkeypatch.setattr(code_hash, "version", lambda name: "0.0.1" if name == library else real(name))
    assert now() != before


def test_all_that_the_numbers_of_a_run_reach_is_counted():
    """Everything that is imported on the way from a scene to the arrays of its file, and to its attributes."""
    reached, todo = (
        set(),
        {"driver/compute.py", "driver/attractor_ids.py", "scene/resolved_numbers.py", "scene/scene.py"},
    )
    while todo:
        name = todo.pop()
        reached.add(name)
        todo |= imported(name) - reached - NUMBERLESS
    assert "oscillator/modes.py" in reached and "engine/variational/spectrum.py" in reached
    assert reached <= COUNTED, reached - COUNTED


def imported(name):
    """Modules of the package that a module imports, anywhere in it."""
    found = set()
    for node in ast.walk(ast.parse((PACKAGE / name).read_text())):
        if isinstance(node, ast.Import):
            words = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            parts = ["vibro_sweep", *Path(name).parts[:-1]]
            base = ".".join(parts[: len(parts) + 1 - node.level]) if node.level else ""
            whole = ".".join(filter(None, [base, node.module]))
            words = [whole, *(f"{whole}.{alias.name}" for alias in node.names)]
        else:
            continue
        for word in words:
            path = word.replace(".", "/").removeprefix("vibro_sweep/")
            found |= {path + ".py", path + "/__init__.py"} & MODULES if word.startswith("vibro_sweep.") else set()
    return found


@pytest.mark.slow
def test_the_compiled_kernels_are_those_of_the_engine_alone(tmp_path):
    """An edited message compiles nothing anew: the folder is named by the engine's sources."""
    home = tmp_path / "vibro_sweep"
    shutil.copytree(PACKAGE, home, ignore=shutil.ignore_patterns("__pycache__"))

    def folder():
        code = "from vibro_sweep.engine.simd import kernel_cache; print(kernel_cache.source_hash())"
        command = [sys.executable, "-c", code]
        environment = os.environ | {"PYTHONPATH": str(tmp_path)}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        return done.stdout.strip()

    assert folder() == kernel_cache.source_hash()
    with (home / "scene" / "problems.py").open("a") as file:
        file.write("# another\n")
    assert folder() == kernel_cache.source_hash()
    with (home / "tables" / "outcomes.py").open("a") as file:
        file.write("# another\n")
    assert folder() != kernel_cache.source_hash()


@pytest.mark.parametrize("setting", ["NUMBA_CPU_FEATURES=+avx2", *slow_cases("OPENBLAS_CORETYPE=Prescott")])
def test_processors_that_round_otherwise_have_other_identities(setting):
    """One without fused multiply-adds, one for which BLAS adds in another order; told by a setting."""
    code = "from vibro_sweep.driver.code_hash import code_hash; print(code_hash())"
    name, _, value = setting.partition("=")
    run = subprocess.run([sys.executable, "-c", code], env=os.environ | {name: value}, capture_output=True, text=True)
    assert len(run.stdout.strip()) == 16 and run.stdout.strip() != code_hash.code_hash()
