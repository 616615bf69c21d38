"""Who may import whom among tests and benchmarks: what is shared stands in tests/support/ and tests/reference/."""

import ast

import pytest
from support import ROOT


def imported(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)


@pytest.mark.parametrize("folder", ["tests", "tests/support", "tests/reference", "benchmarks"])
def test_nobody_imports_a_test(folder):
    modules = list((ROOT / folder).glob("*.py"))
    assert modules
    for path in modules:
        wrong = [name for name in imported(path) if name.startswith("test_")]
        assert not wrong, (path, wrong)


def test_references_share_nothing_with_the_package():
    """They are what the package is held against."""
    for path in (ROOT / "tests" / "reference").glob("*.py"):
        assert not [name for name in imported(path) if name.partition(".")[0] == "vibro_sweep"], path
