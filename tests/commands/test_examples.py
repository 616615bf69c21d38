"""Example scenes: they come with the package, can be copied, and run where they are copied to."""

import re
import tomllib
from pathlib import Path

import pytest
from support import ROOT
from support.programs import ended, main

import vibro_sweep as vs
from vibro_sweep.types import Continuation


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_without_a_name_it_is_the_one_of_the_readme(folder, capsys):
    assert main(["new"]) == 0
    assert capsys.readouterr().out.splitlines() == ["quickstart.yaml", "scene.schema.json"]
    assert vs.load_scene("quickstart.yaml").to_yaml() == vs.load_scene(ROOT / "configs/quickstart.yaml").to_yaml()
    assert main(["check", "quickstart.yaml"]) == 0
    capsys.readouterr()
    assert main(["schema"]) == 0
    assert Path("scene.schema.json").read_text() == capsys.readouterr().out


EXAMPLES = sorted((ROOT / "configs").glob("**/*.yaml"))


@pytest.mark.parametrize("name", [path.stem for path in EXAMPLES])
def test_every_example_is_a_scene_that_finds_its_schema(folder, name):
    assert main(["new", name]) == 0
    text = Path(f"{name}.yaml").read_text()
    assert text.startswith("# yaml-language-server: $schema=./scene.schema.json\n") and "configs/" not in text
    scene = vs.load_scene(f"{name}.yaml")
    assert scene.parameter if isinstance(scene, Continuation) else scene.n_points > 0


def test_each_example_has_a_name_of_its_own_and_says_what_it_is_for():
    names = {path.stem for path in EXAMPLES}
    listed = ended("new", "nothing").err.strip().rpartition("; there are ")[2].split(", ")
    assert set(listed) == names and len(listed) == len(EXAMPLES) == len(names) > 20
    table = (ROOT / "docs/reference/scenes.md").read_text().partition("| name | what it is for |\n| --- | --- |\n")[2]
    purposes = dict(re.findall(r"\| `(\w+)` \| (.*) \|\n", table.partition("\n\n")[0] + "\n"))
    assert purposes.keys() == names
    assert all(20 < len(purpose) < 300 and purpose[-1] in ".?" for purpose in purposes.values())


def test_commands_in_a_copy_name_files_beside_it(folder):
    assert main(["new", "plane_edges"]) == 0
    text = Path("plane_edges.yaml").read_text()
    assert "run plane_edges.yaml" in text and "run plane_clearance_frequency.yaml" in text


def test_an_unchanged_copy_is_no_obstacle(folder, capsys):
    assert main(["new", "basins"]) == main(["new", "basins"]) == 0
    with Path("basins.yaml").open("a") as file:
        file.write("# mine\n")
    assert main(["new", "basins"]) == 2 and Path("basins.yaml").read_text().endswith("# mine\n")
    assert "basins.yaml exists" in capsys.readouterr().err


def test_what_exists_is_kept(folder, capsys):
    Path("quickstart.yaml").write_text("mine")
    Path("scene.schema.json").write_text("mine too")
    assert main(["new"]) == 2
    assert "quickstart.yaml exists" in capsys.readouterr().err
    assert main(["new", "basins"]) == 0
    assert capsys.readouterr().out == "basins.yaml\n"
    assert Path("quickstart.yaml").read_text() == "mine" and Path("scene.schema.json").read_text() == "mine too"


def test_what_is_packed():
    """The wheel takes what `new` copies; sdist all that tests need."""
    build = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]
    assert {"configs", "CHANGELOG.md"} == build["wheel"]["force-include"].keys()
    assert {"configs", "docs", "tests", "CHANGELOG.md", "CITATION.cff"} <= set(build["sdist"]["include"])
    for name in [*build["wheel"]["force-include"], *build["sdist"]["include"]]:
        assert (ROOT / name).exists()
