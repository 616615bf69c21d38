"""Who may import whom among tests and benchmarks: what is shared stands in tests/support/ and tests/reference/."""

import ast
import functools
import re

import pytest
from support import ROOT


@functools.cache
def imported(path):
    """Names of modules."""
    found = []
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module:
            found.append(node.module)
        elif isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
    return found


@pytest.mark.parametrize("folder", ["tests", "benchmarks"])
def test_nobody_imports_a_test(folder):
    modules = list((ROOT / folder).rglob("*.py"))
    assert modules
    for path in modules:
        wrong = [name for name in imported(path) if name.startswith("test_")]
        assert not wrong, (path, wrong)


def test_tests_stand_without_the_benchmarks():
    """Benchmarks import what they share with the tests; no test imports a benchmark, and none changes the path."""
    benchmarks = {path.stem for path in (ROOT / "benchmarks").glob("*.py")}
    for path in (ROOT / "tests").rglob("*.py"):
        assert not benchmarks.intersection(name.partition(".")[0] for name in imported(path)), path
        assert path.name == "test_layout.py" or not re.search(r"sys\.path\b|syspath", path.read_text()), path


def test_one_benchmark_module_finds_the_tests():
    """problem.py alone changes the path, and whoever imports from tests/ imports it."""
    for path in (ROOT / "benchmarks").glob("*.py"):
        rooms = {name.partition(".")[0] for name in imported(path)}
        assert ("sys.path" in path.read_text()) == (path.name == "problem.py"), path
        assert path.name == "problem.py" or "problem" in rooms or not rooms & {"support", "reference"}, path


def test_references_share_nothing_with_the_package():
    """They are what the package is held against."""
    for path in (ROOT / "tests" / "reference").glob("*.py"):
        assert not [name for name in imported(path) if name.partition(".")[0] == "vibro_sweep"], path
