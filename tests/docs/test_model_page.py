"""docs/how/models.md: what its table names exists, and what it says in numbers is so."""

import ast
import re

import pytest
from support import ROOT

import vibro_sweep as vs

PAGE = (ROOT / "docs" / "how" / "models.md").read_text()
NAMED = re.findall(r"`(\w+)` \(`([\w/]+\.py)`\)", PAGE)


def test_the_table_names_the_equations():
    table = PAGE.partition("| --- |")[2].partition("\n\n")[0]
    assert len(NAMED) == table.count("` (`") > 15
    for number in (3, 4, 5, 6, 7, 15, 16, 17, 18, 19, 38, 39, 40, 41, 48):
        assert f"({number})" in table


@pytest.mark.parametrize(("name", "file"), NAMED)
def test_every_function_of_the_table_exists(name, file):
    tree = ast.parse((ROOT / "vibro_sweep" / file).read_text())
    assert name in {node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}


def test_numbers_of_the_errata():
    page = (ROOT / "docs" / "papers" / "double_grazing.md").read_text()
    graze = vs.grazing(vs.System(R=0.8, mu_k=5, mu_m=10, zeta=0.05, f2=0, omega=0.63, b=6.6))
    for name, value, rounding in (("b*", graze.b, 2e-14), ("tau*", graze.tau, 1e-12)):
        said = [float(number) for number in re.findall(rf"{re.escape(name)} = (\d\.\d{{9,}})", page)]
        assert said and all(abs(number - value) < rounding for number in said), (name, said, value)
