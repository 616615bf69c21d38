"""What the command line does, Python does by the same words."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure
from support import ROOT, sample, slow_cases
from support.contents import numbers
from support.oscillators import PAPER, PAPER_NUMBERS
from support.programs import main

import vibro_sweep as vs
from vibro_sweep.types import Continuation, Scene

NUMBERS = f"{{{PAPER_NUMBERS}, b: 6.6}}"
SWEEP = f"""
system: {NUMBERS}
sweep: {{b: {{start: 6.5, stop: 6.9, num: 21}}}}
orbit: {{transient: 500, record: 60}}
observe: [section, impacts]
"""
BRANCHES = f"""
system: {NUMBERS.replace("6.6", "2")}
continue:
  from: {{itinerary: LR}}
  parameter: {{b: [0.3, 6.8]}}
  depth: 1
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("both")
    (path / "sweep.yaml").write_text(SWEEP)
    (path / "lr.yaml").write_text(BRANCHES)
    vs.run(vs.load_scene(path / "sweep.yaml"), path / "sweep.h5")
    vs.run(vs.load_scene(path / "lr.yaml"), path / "lr.h5")
    vs.windows(path / "sweep.h5", output=path / "sweep.windows.h5")
    return path


@pytest.mark.parametrize("path", sorted((ROOT / "configs").rglob("*.yaml")), ids=lambda path: path.stem)
def test_a_scene_that_is_written_and_read_again_says_the_same(path, tmp_path):
    scene = vs.load_scene(path)
    assert isinstance(scene, (Scene, Continuation)) and scene.source == path
    (tmp_path / path.name).write_text(scene.to_yaml())
    again = vs.load_scene(tmp_path / path.name)
    assert str(again) == str(scene) and type(again) is type(scene) and again.system == scene.system
    assert again.to_yaml() == scene.replace().to_yaml() == scene.to_yaml()


@pytest.mark.slow
def test_the_graze_of_a_scene_of_branches_is_that_of_its_oscillator(folder, capsys):
    assert main(["grazing", str(folder / "lr.yaml")]) == 0
    assert "b*    = 6.7057167409730" in capsys.readouterr().out


@pytest.mark.parametrize("of, command", sample(1, [("sweep", "run"), ("lr", "run"), ("sweep", "windows")]))
def test_files_are_those_of_the_command_line(folder, tmp_path, of, command):
    given, made = ("sweep.h5", "sweep.windows.h5") if command == "windows" else (f"{of}.yaml", f"{of}.h5")
    assert main([command, str(folder / given), "-o", str(tmp_path / "file.h5"), "--quiet"]) == 0
    assert numbers(tmp_path / "file.h5") == numbers(folder / made)


def test_a_report_says_what_became_of_branches(folder):
    """Also of a file that was complete already."""
    report = vs.run(vs.load_scene(folder / "lr.yaml"), folder / "lr.h5")
    with vs.open(folder / "lr.h5") as data:
        assert report.points == data.sizes["branch"] and report.statuses == {"ok": report.points}
    assert report.bad == 0 and report.computed == 0 and report.seconds > 0


@pytest.mark.slow
def test_a_scene_of_branches_is_changed_as_one_of_a_sweep_is(folder):
    scene = vs.load_scene(folder / "lr.yaml")
    changed = scene.replace(depth=0, parameter={"omega": (0.6, 0.7)}, system=scene.system.replace(R=0.7))
    assert changed.depth == 0 and changed.parameter == {"omega": (0.6, 0.7)} and changed.system.R == 0.7
    assert changed.source == scene.source and scene.depth == 1
    begins = scene.replace(origin="branches", begin="a: file, #1.h5", special=3)
    assert (begins.origin, begins.begin, begins.special) == ("branches", "a: file, #1.h5", 3)
    free = scene.replace(origin="free", begin=None)
    assert free.origin == "free" and free.replace(origin="state", begin=(0, 1, 0, 2)).begin == (0, 1, 0, 2)
    for wrong, words in (
        ({"depth": -1}, "continue.depth"),
        ({"dept": 1}, "dept: unknown"),
        ({"text": ""}, "unknown"),
        ({"follow": [0] * 10**6}, "follow"),
    ):
        with pytest.raises(vs.SceneError, match=words):
            scene.replace(**wrong)


def test_what_a_sweep_will_take_is_known_before(folder):
    scene = vs.load_scene(folder / "sweep.yaml")
    estimate = vs.estimate(scene)
    assert estimate.orbits == 21 and estimate.seconds > 0
    with pytest.raises(vs.VibroSweepError, match="workers: 0 is not allowed"):
        vs.estimate(scene, workers=0)
    with pytest.raises(TypeError, match="a Scene of orbits"):
        vs.estimate(vs.load_scene(folder / "lr.yaml"))


def ends(windows) -> list:
    return [(one.lo, one.hi, one.period, one.itinerary) for one in windows]


@pytest.mark.slow
def test_windows_of_a_dataset_are_those_of_its_file(folder, tmp_path):
    expected = ends(vs.windows(folder / "sweep.h5"))
    with vs.open(folder / "sweep.h5") as data:
        assert ends(vs.windows(data)) == ends(vs.windows(data.load())) == expected
        seen: list = []
        found = vs.windows(data, output=tmp_path / "w.h5", progress=lambda done, total: seen.append((done, total)))
        assert ends(found) == expected == ends(vs.windows(data, output=tmp_path / "w.h5"))  # which is complete
        assert seen[-1] == (21, 21)
        half = vs.windows(data.isel(b=slice(0, 11)))
        assert half.window.shape == (11, 1) and 0 < len(half) <= len(expected)
    assert numbers(tmp_path / "w.h5") == numbers(folder / "sweep.windows.h5")


@pytest.mark.slow
def test_windows_of_a_part_are_not_taken_for_those_of_the_whole(folder, tmp_path):
    with vs.open(folder / "sweep.h5") as data:
        left, right = data.isel(b=slice(0, 11)), data.isel(b=slice(10, 21))
        vs.windows(left, output=tmp_path / "left.h5")
        for other in (data, right):
            with pytest.raises(vs.StoreError, match="made from something else"):
                vs.windows(other, output=tmp_path / "left.h5")
        with pytest.raises(vs.PlotError, match="windows of another sweep"):
            vs.plot(data, windows=tmp_path / "left.h5")


def test_a_row_of_a_plane_is_the_sweep_at_its_value():
    system = PAPER.replace(b=6.6)
    axes = {"b": np.linspace(6.6, 6.7, 5), "R": [0.7, 0.8]}
    plane = vs.sweep(system, axes, observe=["section"], transient=500, record=60)
    row = vs.sweep(system.replace(R=0.7), {"b": axes["b"]}, observe=["section"], transient=500, record=60)
    assert ends(vs.windows(plane.sel(R=0.7))) == ends(vs.windows(row)) != ends(vs.windows(plane.sel(R=0.8)))


def test_what_is_not_a_sweep_has_no_windows(folder):
    with vs.open(folder / "lr.h5") as data, pytest.raises(ValueError, match="holds branches, not a sweep"):
        vs.windows(data)
    built = vs.sweep(lambda b: PAPER.replace(b=b), {"b": [6.5, 6.6]}, observe=["section"], record=2)
    with pytest.raises(ValueError, match="type: 'build' is not allowed"):
        vs.windows(built)
    with pytest.raises(TypeError, match="data: 3 is not allowed"):
        vs.windows(3)
    with pytest.raises(ValueError, match="mode: 'resume' is not allowed"):
        vs.windows(folder / "sweep.h5", mode="resume")


OPTIONS = [
    ({}, []),
    *slow_cases(
        ({"kind": "iteration", "at": {"b": 6.7}}, ["--kind", "iteration", "--at", "b=6.7"]),
        ({"size": (5, 3), "dpi": 80}, ["--size", "5", "3", "--dpi", "80"]),
        ({"xlim": (6.6, 6.8), "ylim": (-1, 1)}, ["--xlim", "6.6", "6.8", "--ylim", "-1", "1"]),
        ({"width": 85, "variable": "v1"}, ["--width", "85", "--variable", "v1"]),
        ({"windows": "sweep.windows.h5"}, ["--windows", "sweep.windows.h5"]),
    ),
]


@pytest.mark.parametrize("options, given", OPTIONS)
def test_pictures_are_those_of_the_command_line(folder, tmp_path, monkeypatch, options, given):
    monkeypatch.chdir(folder)
    assert main(["plot", "sweep.h5", "-o", str(tmp_path / "one.png"), *given]) == 0
    vs.plot("sweep.h5", output=tmp_path / "two.png", **options)
    np.testing.assert_array_equal(plt.imread(tmp_path / "one.png"), plt.imread(tmp_path / "two.png"))


def test_branches_are_drawn_over_a_sweep(folder, tmp_path, monkeypatch):
    """Both may be Datasets."""
    monkeypatch.chdir(folder)
    assert main(["plot", "lr.h5", "-o", str(tmp_path / "one.png"), "--over", "sweep.h5"]) == 0
    with vs.open("lr.h5") as branches, vs.open("sweep.h5") as sweep:
        vs.plot(branches, over=sweep, output=tmp_path / "two.png")
    np.testing.assert_array_equal(plt.imread(tmp_path / "one.png"), plt.imread(tmp_path / "two.png"))


def test_a_picture_replaces_nothing_unasked(folder, tmp_path):
    (tmp_path / "mine.png").write_text("mine")
    with pytest.raises(vs.PlotError, match="mine"):
        vs.plot(folder / "sweep.h5", output=tmp_path / "mine.png")
    vs.plot(folder / "sweep.h5", output=tmp_path / "mine.png", overwrite=True)
    assert (tmp_path / "mine.png").read_bytes().startswith(b"\x89PNG")
    for wrong in ({"size": (5, 3), "ax": Figure().add_subplot()}, {"xlim": (1,)}, {"output": "no.xyz"}):
        with pytest.raises(vs.PlotError):
            vs.plot(folder / "sweep.h5", **wrong)
