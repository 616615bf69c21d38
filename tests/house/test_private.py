"""Tests see the package from outside: which files import what is inside it stands in a list that may only shrink.

Inside is all but `vibro_sweep`, `vibro_sweep.types` and the program, `vibro_sweep.__main__`. The subject of `house/` is
the inside; these files are not listed.
"""

import ast
import re

from support import ROOT

TESTS = ROOT / "tests"
LIST = TESTS / "house" / "private.txt"
PUBLIC = {"vibro_sweep", "vibro_sweep.types", "vibro_sweep.__main__"}


def imported(text: str) -> set[str]:
    """Modules of the package that a text imports, also within functions; a name of the package itself is public."""
    found = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            found.add(node.module)
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
    return {name for name in found if name.partition(".")[0] == "vibro_sweep"}


def private_imports() -> dict[str, set[str]]:
    """Modules inside the package that each file of the tests imports."""
    paths = [path for path in sorted(TESTS.rglob("*.py")) if path.relative_to(TESTS).parts[0] != "house"]
    assert len(paths) > 50
    found = {path.relative_to(TESTS).as_posix(): imported(path.read_text()) - PUBLIC for path in paths}
    return {name: modules for name, modules in found.items() if modules}


def listed() -> dict[str, str]:
    """Files of the list, each with its reason: the piece that it proves, or the issue that deletes it."""
    lines = [line for line in LIST.read_text().splitlines() if line and not line.startswith("#")]
    files = [re.fullmatch(r"(\S+\.py)  +((?:proves \S|\d+: \S).*)", line) for line in lines]
    assert all(files), lines
    return {match[1]: match[2] for match in files}


def test_only_listed_files_look_inside():
    """Another one is to be written by public names; one that no longer looks inside is to leave the list."""
    assert private_imports().keys() == listed().keys()


def test_few_files_stay_that_look_inside():
    stay = [name for name, reason in listed().items() if reason.startswith("proves")]
    assert len(stay) <= 15 and sum(len((TESTS / name).read_text().splitlines()) for name in stay) <= 1800


def test_an_import_from_inside_is_seen():
    text = (
        "import vibro_sweep as vs\nfrom vibro_sweep.types import Branch\nfrom vibro_sweep.engine.records import new\n"
    )
    text += "def function():\n    import vibro_sweep.files.opening\n"
    assert imported(text) - PUBLIC == {"vibro_sweep.engine.records", "vibro_sweep.files.opening"}
