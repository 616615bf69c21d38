"""The program from outside: exit status, messages, and what it leaves on the disk."""

import gc
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
import xarray as xr
from support import ROOT
from support.cli import NUMBERS, assert_refused, scene
from support.contents import bytes_in
from support.programs import ended, main, on_a_terminal

import vibro_sweep as vs


def test_from_the_shell(scene_folder):
    (scene_folder / "bad.yaml").write_text(scene(R="1.5"))
    done = subprocess.run(
        [sys.executable, "-m", "vibro_sweep", "run", "bad.yaml"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("vibro-sweep: error: bad.yaml: system.R = 1.5: must be")
    assert len(done.stderr.splitlines()) == 1


def test_help_waits_for_no_heavy_import():
    command = [sys.executable, "-X", "importtime", "-m", "vibro_sweep", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    heavy = {"numpy", "numba", "h5py", "matplotlib", "pydantic", "scipy"}
    assert not heavy & {line.rsplit("|")[-1].strip() for line in done.stderr.splitlines()}


@pytest.mark.parametrize("command", [["run", "good.yaml", "--quiet"], ["plot", "good.h5"]], ids=lambda c: c[0])
def test_garbage_is_looked_for_when_all_is_imported(scene_folder, command):
    """`program` puts that off; nothing large may gather while a command computes or draws."""
    if command[0] == "plot":
        assert main(["run", "good.yaml", "--quiet"]) == 0
    gc.disable()
    try:
        assert main(command) == 0
        assert gc.isenabled()
    finally:
        gc.enable()
        gc.unfreeze()


def test_version(capsys):
    import vibro_sweep

    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"vibro-sweep {vibro_sweep.__version__}\n"


def test_schema(capsys):
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out)["$schema"] == "http://json-schema.org/draft-07/schema#"


def test_grazing(scene_folder, capsys):
    assert main(["grazing", "good.yaml"]) == 0
    lines = capsys.readouterr().out.splitlines()
    b, tau = (float(line.split("=")[1]) for line in lines[:2])
    assert abs(b - 6.70571674097302) < 1e-13 and abs(tau - 2.229306509033) < 1e-12
    assert "(19) holds" in lines[-1]


def test_grazing_curve_of_a_frequency_sweep(scene_folder, capsys):
    (scene_folder / "plane.yaml").write_text(scene("sweep: {omega: {values: [0.6, 0.63]}, b: {values: [5, 6]}}"))
    assert main(["grazing", "plane.yaml"]) == 0
    filled, header, first, last = capsys.readouterr().out.splitlines()
    assert filled == "# the gap is just filled at omega = 0.612731647564"
    assert header == "# omega b* tau*" and first.startswith("0.6 ")
    omega, b, tau = map(float, last.split())
    assert omega == 0.63 and abs(b - 6.70571674097302) < 1e-13 and abs(tau - 2.229306509033) < 1e-12


def test_grazing_of_two_frequencies_says_where(scene_folder, capsys):
    (scene_folder / "plane.yaml").write_text(scene("sweep: {omega: {values: [0.6, 0.7]}, zeta: {values: [0.1, 0.2]}}"))
    assert main(["grazing", "plane.yaml"]) == 0
    assert capsys.readouterr().out.startswith("at the first point of the sweep: omega = 0.6, zeta = 0.1\n")


def test_grazing_does_not_depend_on_the_start(scene_folder, capsys):
    (scene_folder / "plane.yaml").write_text(scene("sweep: {x1: {values: [0, 1]}, v1: {values: [0, 1]}}"))
    assert main(["grazing", "plane.yaml"]) == 0
    assert capsys.readouterr().out.startswith("b*    = 6.7057167409730")


def test_check(scene_folder, capsys):
    assert main(["check", "good.yaml"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("good.yaml: b = 6.5 .. 6.7 (3 values)\n") and "3 points" in out
    assert re.search(r"  time      about [0-9.e+-]+ (s|min|h) here( beside what else runs now, .* alone)?\n", out)
    assert [path.name for path in scene_folder.iterdir()] == ["good.yaml"]


@pytest.mark.parametrize(
    "stops, where, sign", [("right", "(right stop, t = 0)", 1), ("left", "(left stop, t = T/2)", -1)]
)
def test_grazing_of_one_stop(scene_folder, capsys, stops, where, sign):
    (scene_folder / "one.yaml").write_text(scene(stops=stops))
    assert main(["grazing", "one.yaml"]) == 0
    line = capsys.readouterr().out.splitlines()[2]
    numbers = [float(part.split()[0].strip(",")) for part in line.split(": ")[1:]]
    assert line.endswith(where) and "negative" not in line
    system = vs.System(**{key: float(value) for key, value in NUMBERS.items()}, stops=stops)
    # without stops this motion is steady, and touches the stop half a period later on the left
    orbit = vs.simulate(system.replace(b=100), vs.grazing(system).state, 1)
    assert np.allclose(orbit.sample([system.period / 2 if stops == "left" else 0.0])[0], numbers, atol=1e-9)
    assert np.sign(numbers[0]) == sign


def test_run_then_look(scene_folder, capsys):
    assert main(["run", "good.yaml", "--plot"]) == 0
    captured = capsys.readouterr()
    machine, (line, *_) = captured.out.splitlines()[:5], captured.out.splitlines()[5:]
    assert machine[0].startswith("  machine   natural frequencies 0.6526, 1.084 (as omega)") and len(machine) == 5
    assert "without contact: nowhere in 6.5 to 6.7; from 6.706 on" in machine[3]
    assert line.startswith("good.h5: 3 points in ") and line.endswith("all ok") and captured.err == ""
    assert {path.name for path in scene_folder.iterdir()} >= {"good.yaml", "good.h5", "good.png"}
    assert main(["info", "good.h5"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "good.h5: vibro_sweep: good" and lines[1].split() == ["b", "6.5", "..", "6.7", "(3", "values)"]
    assert "computed     3 of 3 orbits (100 %)" in lines and "checksums    all hold" in lines
    assert main(["plot", "good.h5", "-o", "picture.svg"]) == 0
    assert (scene_folder / "picture.svg").exists()


def test_several_files(scene_folder, capsys):
    """Each is said or drawn; a damaged one is told, and its exit status, whatever its place."""
    assert main(["run", "good.yaml", "--quiet"]) == 0
    shutil.copy("good.h5", "other.h5")
    with open("other.h5", "r+b") as file:
        with h5py.File("other.h5") as h5:
            file.seek(h5["x1"].id.get_offset())
        file.write(b"12345678")
    files = ["other.h5", "good.h5"]
    capsys.readouterr()
    assert main(["info", *files]) == 2
    text = capsys.readouterr().out
    assert text.count("\ncomputed     3 of 3") == 2 and "\n\ngood.h5: vibro_sweep: good\n" in text
    assert main(["info", "--json", *files]) == 2
    other, good = map(json.loads, capsys.readouterr().out.splitlines())
    assert (other["file"], good["file"], good["damaged"]) == ("other.h5", "good.h5", "") and "x1" in other["damaged"]
    assert good["statuses"] == {"ok": 3} and good["axes"] == {"b": [6.5, 6.6, 6.7]} and good["attributes"]["R"] == 0.8
    assert good["variables"]["x1"]["dimensions"] == ["b", "sample"] and good["complete"] is True
    assert main(["plot", "good.h5", "good.h5", "-o", "x.png"]) == 2
    assert "--output names one picture" in capsys.readouterr().err
    shutil.copy("good.h5", "again.h5")
    assert main(["plot", "good.h5", "other.h5", "again.h5"]) == 2
    captured = capsys.readouterr()
    assert captured.out.split() == ["good.png", "again.png"] and "other.h5" in captured.err
    assert (scene_folder / "again.png").exists() and not (scene_folder / "other.png").exists()
    Path("folder").mkdir()
    shutil.copy("good.h5", "folder/good.h5")
    assert main(["plot", "good.h5", "folder/good.h5"]) == 2
    assert "good.h5 and folder/good.h5 would both be drawn into good.png" in capsys.readouterr().err


def test_ctrl_c_ends_several_files(scene_folder, capsys, monkeypatch):
    assert main(["run", "good.yaml", "--quiet"]) == 0
    shutil.copy("good.h5", "again.h5")
    begun = []

    def interrupted(path, *_, **options):
        begun.append(path)
        raise KeyboardInterrupt

    monkeypatch.setattr("vibro_sweep.plotting.plot.write_pictures", interrupted)
    assert main(["plot", "good.h5", "again.h5"]) == 130 and len(begun) == 1


@pytest.mark.slow
def test_windows_and_branches_as_json(scene_folder, capsys):
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
    vs.sweep(system, {"b": {"start": 5.4, "stop": 5.8, "num": 5}}, output="range.h5")
    capsys.readouterr()
    assert main(["windows", "range.h5", "--json"]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    windows = vs.load("range.windows.h5")
    tables = json.loads(line)["tables"]
    specials = [row["type"] for row in tables["special"]]
    found = [(row["lo"], row["hi"], specials[row["upper"]], row["period"]) for row in tables["window"]]
    assert sorted(found) == sorted((w.lo, w.hi, w.upper.type, w.period) for w in windows)
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="R"), "b", (4, 7))
    branch.save("branch.h5")
    assert main(["info", "branch.h5", "--json"]) == 0
    known = json.loads(capsys.readouterr().out)
    assert known["kind"] == "branches" and known["sealed"] is True
    table = known["tables"]["special"]
    assert [row["type"] for row in table] == [point.type for point in branch.special]
    assert [row["value_b"] for row in table] == [point.parameters["b"] for point in branch.special]
    with xr.open_dataset("branch.h5", engine="h5netcdf", decode_times=False) as data:
        data.assign_attrs(provenance="by hand", odd=np.nan).to_netcdf("copy.h5", engine="h5netcdf")
    assert main(["info", "copy.h5", "missing.h5", "branch.h5", "--json"]) == 2
    assert main(["info", "copy.h5", "branch.h5", "--json"]) == 0
    copy, again = map(json.loads, capsys.readouterr().out.splitlines())
    assert (copy["sealed"], copy["made_by"], copy["attributes"]["odd"]) == (False, "by hand", None)
    assert copy["tables"] == again["tables"] == known["tables"]


def test_existing_file_is_kept_unless_told(scene_folder, capsys):
    assert main(["run", "good.yaml", "-o", "file.h5", "--quiet"]) == 0
    assert capsys.readouterr().out == ""
    (scene_folder / "good.yaml").write_text(scene("sweep: {b: {values: [6.5, 6.6]}}"))
    words = ["file.h5 exists", "--overwrite replaces it", "another scene", "- sweep: {b: {values: [6.5, 6.6, 6.7]}}"]
    assert_refused(capsys, scene_folder, ["run", "good.yaml", "-o", "file.h5"], words)
    (scene_folder / "file.h5").write_bytes(b"old")
    assert main(["run", "good.yaml", "-o", "file.h5", "--quiet", "--overwrite"]) == 0
    assert (scene_folder / "file.h5").read_bytes().startswith(b"\x89HDF")


def test_run_again(scene_folder, capsys):
    assert main(["run", "good.yaml", "--plot"]) == 0
    before = bytes_in(scene_folder)
    capsys.readouterr()
    assert main(["run", "good.yaml"]) == 0
    assert capsys.readouterr().out == "good.h5 is complete already, from the same scene: 3 points, all ok\n"
    assert bytes_in(scene_folder) == before
    assert main(["run", "good.yaml", "--plot"]) == 0
    assert capsys.readouterr().out.endswith("good.png\n") and bytes_in(scene_folder) == before
    (scene_folder / "good.png").write_text("a picture by hand")
    words = ["good.png exists", "--overwrite replaces it"]
    assert_refused(capsys, scene_folder, ["run", "good.yaml", "--plot"], words)
    assert_refused(capsys, scene_folder, ["plot", "good.h5"], words)
    assert main(["plot", "good.h5", "--overwrite"]) == 0


def test_file_of_another_version_is_kept(scene_folder, capsys, monkeypatch):
    with monkeypatch.context() as other:
        other.setattr("vibro_sweep.driver.code_hash.code_hash", lambda: "another")
        assert main(["run", "good.yaml", "--quiet"]) == 0
    words = ["good.h5 exists", "other code", "--overwrite replaces it"]
    assert_refused(capsys, scene_folder, ["run", "good.yaml"], words)


def test_bad_points_are_counted_by_name(scene_folder, capsys, monkeypatch):
    report = SimpleNamespace(
        points=1003, bad=3, statuses={"ok": 1000, "not_finite": 2, "beyond_a_stop": 1}, seconds=1.234, computed=1003
    )
    monkeypatch.setattr("vibro_sweep.driver.run.run", lambda *_: report)
    assert main(["run", "good.yaml"]) == 1
    first, *others = capsys.readouterr().out.splitlines()
    assert first == "good.h5: 1,003 points in 1.2 s, 3 with a bad status (not_finite 2, beyond_a_stop 1)"
    advice = dict(line.split(": ", 1) for line in others)
    assert list(advice) == ["not_finite", "beyond_a_stop"]
    documented = (ROOT / "docs/reference/statuses.md").read_text()
    assert all(f"*What to do:* {text}\n" in documented for text in advice.values())
    assert main(["run", "good.yaml", "--quiet"]) == 1


def test_interruption(scene_folder, capsys, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("vibro_sweep.driver.run.run", interrupted)
    assert main(["run", "good.yaml", "-o", "my file.h5"]) == 130
    err = capsys.readouterr().err
    assert err == "vibro-sweep: interrupted; to continue: vibro-sweep run good.yaml -o 'my file.h5' --resume\n"


def test_what_run_is_told(scene_folder, monkeypatch):
    told = []

    def record(scene, output, workers, executor, progress, mode):
        told.append((scene.name, str(output), workers, executor, progress is not None, mode))
        return SimpleNamespace(points=3, bad=0, statuses={"ok": 3}, seconds=0.0, computed=3)

    monkeypatch.setattr("vibro_sweep.driver.run.run", record)
    assert main(["run", "good.yaml"]) == 0
    assert main(["run", "good.yaml", "--workers", "3", "--resume", "--quiet"]) == 0
    assert main(["run", "good.yaml", "-o", "x.h5", "--overwrite"]) == 0
    assert told == [  # progress is told but with --quiet
        ("good", "good.h5", None, None, True, "new"),
        ("good", "good.h5", 3, None, False, "resume"),
        ("good", "x.h5", None, None, True, "overwrite"),
    ]


@pytest.mark.parametrize(
    "clearance, stop, observe, said",
    [
        ("100", {}, "[section, impacts]", True),
        ("100", {}, "[section]", False),  # not known
        ("3", {}, "[section, impacts]", False),
        ("100", {"R": None, "k_stop": "10"}, "[contacts]", True),
        ("100", {"R": None, "k_stop": "10"}, "[section, impacts]", False),  # of a soft stop these say nothing
    ],
)
def test_info_says_that_no_orbit_touches_a_stop(scene_folder, clearance, stop, observe, said):
    (scene_folder / "far.yaml").write_text(scene(f"observe: {observe}", b=clearance, **stop))
    assert main(["run", "far.yaml", "--quiet"]) == 0
    assert ("no orbit touches a stop" in ended("info", "far.h5").out) is said


@pytest.mark.slow
def test_progress_on_a_terminal(scene_folder):
    assert b"3/3" in on_a_terminal("-m", "vibro_sweep", "run", "good.yaml")
