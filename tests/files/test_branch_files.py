"""Scenes with `continue`: their messages, the files that they make, and the pictures of these."""

import json

import jsonschema
import numpy as np
import pytest
import xarray as xr
import yaml
from support import ROOT, sample, slow_cases
from support.contents import numbers, words_of
from support.oscillators import PAPER, PAPER_NUMBERS
from support.programs import ended, main
from support.scene_texts import parsed

import vibro_sweep as vs

NUMBERS = f"{{{PAPER_NUMBERS}, b: 2}}"
LR = "{itinerary: LR, periods: 1}"
RANGE = "{b: [0.3, 6.8]}"


def text(begin=LR, parameter=RANGE, more="depth: 1", numbers=NUMBERS):
    return f"system: {numbers}\ncontinue:\n  from: {begin}\n  parameter: {parameter}\n  {more}\n"


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("branches") / "lr.h5"
    vs.run(parsed(text(), "lr.yaml"), path)
    return path


def test_it_holds_what_follow_branches_finds(file):
    orbit = vs.periodic_orbit(PAPER, itinerary="LR")
    found = vs.follow_branches(orbit, "b", (0.3, 6.8), depth=1)
    with xr.open_dataset(file, engine="h5netcdf") as data:
        assert data.attrs["kind"] == "branches" and data.attrs["mu_m"] == 10
        assert data.sizes["branch"] == len(found)
        np.testing.assert_array_equal(data["branch_generation"], [item.generation for item in found])
        np.testing.assert_array_equal(data["branch_parent"], [-1 if i.parent is None else i.parent for i in found])
        begin = 0
        for i, item in enumerate(found):
            points, size = item.branch.points, int(data["branch_row_size"][i])
            rows = slice(begin, begin + size)
            np.testing.assert_array_equal(data["b"][rows], points["b"])
            np.testing.assert_array_equal(data["x2"][rows], points["x2"])
            np.testing.assert_array_equal(data["unstable"][rows], points["unstable"])
            special = np.array(words_of(data["special_type"]))[data["special_branch"].values == i]
            assert special.tolist() == [one.type for one in item.branch.special]
            begin += size
        assert begin == data.sizes["point"]
        assert int((data["branch_row_size"] * data["branch_impacts"]).sum()) == data.sizes["impact"]


@pytest.mark.slow
def test_a_point_of_the_file_is_where_a_scene_goes_on(file, tmp_path):
    """Over the pitchfork of the symmetric orbit, and along another number from it."""
    with vs.open(file) as data:
        at = words_of(data["special_type"]).index("pitchfork")
        value = float(data["special_value"][at, 0])
    scene = parsed(text(f"{{branches: {file}, special: {at}}}", more="depth: 0"))
    vs.run(scene, tmp_path / "beyond.h5")
    with vs.open(tmp_path / "beyond.h5") as data:
        assert data["branch_symmetric"].values.tolist() == [0]  # the two mirror images are one branch
        assert float(data["b"].max()) == pytest.approx(value, abs=1e-9)
    parameter = "{omega: [0.62, 0.64]}"
    vs.run(parsed(text(f"{{branches: {file}, special: {at}}}", parameter, "depth: 0")), tmp_path / "o.h5")
    with vs.open(tmp_path / "o.h5") as data:
        assert data["branch_symmetric"].values[0] == 1 and data["omega"].values[0] == 0.62
        assert data.attrs["b"] == value and "tau" not in data.attrs  # of that point; grazing changes with omega


def test_it_does_not_depend_on_interruptions(file, tmp_path):
    def stop(done, total):
        if done == 2:
            raise KeyboardInterrupt

    scene = parsed(text(), "lr.yaml")
    with pytest.raises(KeyboardInterrupt):
        vs.run(scene, tmp_path / "lr.h5", progress=stop)
    vs.run(scene, tmp_path / "lr.h5", mode="resume")
    assert numbers(tmp_path / "lr.h5") == numbers(file)


@pytest.mark.slow
def test_two_workers_make_the_same_file(file, tmp_path):
    vs.run(parsed(text(), "lr.yaml"), tmp_path / "lr.h5", workers=2)
    assert numbers(tmp_path / "lr.h5") == numbers(file)


@pytest.mark.parametrize(
    "begin, parameter, number",
    sample(
        1,
        [
            ("free", RANGE.replace("0.3", "1.5"), 1),
            ("{grazing: 1}", "{b: [6, 7]}", 2),  # RL, and of the mirror images R and L one
            ("{state: {x1: 3.0, v1: 0.3, x2: 1, v2: 0}, periods: 1}", "{b: [1.5, 2.5]}", 1),
        ],
    ),
)
def test_other_beginnings(begin, parameter, number, tmp_path):
    numbers = NUMBERS.replace("b: 2", "b: 6.75") if begin == "free" or "grazing" in begin else NUMBERS
    if "state" in begin:
        orbit = vs.periodic_orbit(PAPER, itinerary="LR")
        begin = "{state: {" + ", ".join(f"{k}: {v}" for k, v in zip(("x1", "v1", "x2", "v2"), orbit.state)) + "}}"  # noqa: B905
    vs.run(parsed(text(begin, parameter, "depth: 0", numbers)), tmp_path / "x.h5")
    with vs.open(tmp_path / "x.h5") as data:
        assert data.sizes["branch"] == number


@pytest.mark.slow
def test_orbits_that_are_not_found_are_no_beginning(tmp_path):
    """Of those born at a graze without damping, one of twice the period is not found."""
    numbers = "{type: one_mass, k: 1, zeta: 0, F: 0.5, omega: 0.8, stops: left, R: 0.8, b: 1}"
    vs.run(parsed(text("{grazing: 2}", "{R: [0, 1]}", "depth: 0", numbers)), tmp_path / "x.h5")
    with vs.open(tmp_path / "x.h5") as data:
        assert data.sizes["branch"] == 1


@pytest.mark.slow
def test_commands(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lr.yaml").write_text(text(more="depth: 0"))
    assert main(["check", "lr.yaml"]) == 0
    assert "branches in b = 0.3 .. 6.8" in capsys.readouterr().out
    assert main(["run", "lr.yaml", "--plot"]) == 0
    told = capsys.readouterr().out
    assert "pitchfork (sub)" in told and "3.8928194355634" in told
    assert main(["info", "lr.h5"]) == 0
    assert "branches: 1, special points: 3" in capsys.readouterr().out
    assert main(["plot", "lr.h5", "--variable", "x1", "-o", "x1.svg"]) == 0
    drawn = (tmp_path / "x1.svg").read_text()
    assert "BP pitchfork" in drawn and 'id="stable"' in drawn and 'id="unstable"' in drawn
    assert main(["plot", "lr.h5", "--variable", "x9"]) == 2
    assert "variable 'x9' is not allowed; there are x1, v1" in capsys.readouterr().err
    sweep = vs.sweep(PAPER, {"b": np.linspace(1, 3, 9)}, transient=50, record=10, output="s.h5", workers=1)
    sweep.close()
    assert main(["plot", "lr.h5", "--over", "s.h5", "-o", "over.svg"]) == 0
    (tmp_path / "none.yaml").write_text(text("{itinerary: LLLLLLLL}"))
    assert main(["run", "none.yaml"]) == 2
    assert "continue.from.itinerary: no orbit was found" in capsys.readouterr().err


@pytest.mark.parametrize("variable", ["impact_speed", *slow_cases("multiplier", "stop_distance")])
def test_variables_that_a_picture_can_show(file, variable, tmp_path):
    assert main(["plot", str(file), "--variable", variable, "-o", str(tmp_path / "a.svg")]) == 0


@pytest.mark.slow
def test_the_scene_that_comes_with_the_package(tmp_path):
    scene = vs.load_scene(ROOT / "configs" / "branches" / "symmetric.yaml")
    schema = jsonschema.Draft7Validator(json.loads(ended("schema").out))
    schema.validate(yaml.safe_load(scene.text))
    assert not schema.is_valid(yaml.safe_load(scene.text + "\norbit: {transient: 1, record: 1}\n"))
    vs.run(scene, tmp_path / "symmetric.h5")
    with vs.open(tmp_path / "symmetric.h5") as data:
        found = dict(zip(words_of(data["special_type"]), data["special_value"].values[:, 0].tolist(), strict=True))
        assert found["neimark_sacker"] == pytest.approx(4.347417989446, abs=1e-11)
        assert data["branch_generation"].values.tolist() == [0, 1, 1, 1, 2, 2]


@pytest.mark.slow
def test_the_cascade_towards_sticking(tmp_path):
    """Impacts added one by one, at grazes that accumulate at the onset of sticking (60 impacts written out)."""
    vs.run(vs.load_scene(ROOT / "configs" / "branches" / "sticking.yaml"), tmp_path / "sticking.h5")
    with vs.open(tmp_path / "sticking.h5") as data:
        assert data["branch_impacts"].values.tolist() == [4 + 2 * i for i in range(13)]
        assert data["branch_parent"].values.tolist() == list(range(-1, 12))
        types = np.array(words_of(data["special_type"]))
        values = data["special_value"].values[:, 0]
        onsets = values[types == "sticking"]
        assert len(onsets) >= 3 and (data["special_point"].values[types == "sticking"] == -1).all()
        assert np.abs(onsets - 0.064639143358).max() < 1e-12
        lowest = [values[data["special_branch"].values == i].max() for i in range(13)]
        assert (np.diff(lowest) < 0).all()
