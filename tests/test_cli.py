"""The program from outside: exit status, messages, and what it leaves on the disk."""

import json
import re
import subprocess
import sys
import time
from types import SimpleNamespace

import numpy as np
import pytest

import vibro_sweep as vs
from vibro_sweep.cli import main

NUMBERS = dict(mu_m="10", mu_k="5", zeta="0.05", f2="0", omega="0.63", R="0.8", b="6.6")
PHYSICAL = dict(M1="1", M2="10", K1="1", K2="5", C1="0.1", C2="0.5", P1="1", P2="0", Omega="0.63", R="0.8", B="6")


def scene(more="", orbit="{transient: 2, record: 3}", **changes):
    """The text of a good scene with some of the system's numbers changed (None: left out) and lines added."""
    numbers = ", ".join(f"{key}: {value}" for key, value in (NUMBERS | changes).items() if value is not None)
    return f"system: {{{numbers}}}\norbit: {orbit}\n{more}\n"


def physical(more="tau: grazing", **changes):
    numbers = ", ".join(f"{key}: {value}" for key, value in (PHYSICAL | changes).items())
    return f"system: {{physical: {{{numbers}}}, {more}}}\norbit: {{transient: 2, record: 3}}\n"


def swept(axis):
    return scene(f"sweep: {{{axis}}}")


BAD_SCENES = {
    # what the text is: (the text, what the message must contain)
    "unknown key": (scene("colour: blue"), ["colour", "blue", "unknown key"]),
    "misspelt key": (scene("observ: [section]"), ["observ", "did you mean `observe`"]),
    "misspelt system key": (scene(zetta="0.1"), ["system.zetta", "0.1", "did you mean `zeta`"]),
    "misspelt value": (scene("observe: [lyapunow]"), ["observe[0]", "lyapunow", "did you mean `lyapunov`"]),
    "missing key": (scene(mu_k=None), ["system.mu_k", "missing"]),
    "missing orbit": (scene().split("orbit")[0], ["orbit", "missing"]),
    "number as text": (scene(R="'0.8'"), ["system.R", '"0.8"', "must be a number, not text"]),
    "1e-9 as PyYAML reads it": (
        scene(zeta="'1e-9'"),
        ["system.zeta", '"1e-9"', "must be a number, not text"],
    ),
    "boolean": (scene(f2="true"), ["system.f2", "true", "must be a number"]),
    "empty value": (scene(b="~"), ["system.b", "null", "must be a number"]),
    "list for a number": (scene(b="[6, 7]"), ["system.b", "[6, 7]", "must be a number"]),
    "number for a mapping": (
        "system: 3\norbit: {transient: 1, record: 1}",
        ["system", "3", "must be a mapping"],
    ),
    "NaN": (scene(omega=".nan"), ["system.omega", ".nan", "finite"]),
    "infinity": (scene(mu_m=".inf"), ["system.mu_m", ".inf", "finite"]),
    "overflow": (scene(mu_m="1e999"), ["system.mu_m", ".inf", "finite"]),
    "negative mass": (scene(mu_m="-10"), ["system.mu_m", "-10", "> 0"]),
    "R above 1": (scene(R="1.5"), ["system.R", "1.5", "from 0 to 1"]),
    "R below 0": (scene(R="-0.1"), ["system.R", "-0.1", "from 0 to 1"]),
    "no clearance": (scene(b="0"), ["system.b", "0", "> 0"]),
    "negative clearance": (scene(b="-6.6"), ["system.b", "-6.6", "> 0"]),
    "phase": (scene(tau="grasing"), ["system.tau", "grasing", "did you mean `grazing`"]),
    "stops": (scene(stops="none"), ["system.stops", "none", "both, right, left"]),
    "physical damping": (physical(C2="0.6"), ["system.physical.C2", "0.6", "C1/K1", "proportional"]),
    "physical and not": (physical("b: 3"), ["system.b", "3", "unknown key"]),
    "start behind a stop": (scene("start: {x1: 7}"), ["start.x1", "7", "6.6"]),
    "start behind a swept stop": (
        scene("start: {x1: -6.55}\nsweep: {b: {start: 6.5, stop: 7, num: 3}}"),
        ["start.x1", "-6.55", "6.5"],
    ),
    "step 0": (swept("b: {start: 6, stop: 7, step: 0}"), ["sweep.b.step", "0", "must not be 0"]),
    "step of the wrong sign": (
        swept("b: {start: 6, stop: 7, step: -0.1}"),
        ["sweep.b.step", "-0.1", "sign", "> 0"],
    ),
    "empty sweep": (swept("b: {values: []}"), ["sweep.b.values", "[]", "empty"]),
    "sweep of nothing": (swept(""), ["sweep", "one key or two"]),
    "three swept keys": (
        swept("b: {values: [1]}, R: {values: [1]}, f2: {values: [1]}"),
        ["sweep", "f2", "one key or two"],
    ),
    "step and number": (
        swept("b: {start: 6, stop: 7, step: 1, num: 3}"),
        ["sweep.b.step", "1", "start, stop, num"],
    ),
    "swept value outside": (swept("R: {start: 0, stop: 1.5, step: 0.5}"), ["sweep.R", "1.5", "from 0 to 1"]),
    "values out of order": (
        swept("b: {values: [6, 7, 6.5]}"),
        ["sweep.b.values", "[6, 7, 6.5]", "rise or fall"],
    ),
    "value twice": (swept("b: {values: [6, 6]}"), ["sweep.b.values", "[6, 6]", "twice"]),
    "1e12 values": (
        swept("b: {start: 1, stop: 2, step: 1e-12}"),
        ["sweep.b.step", "1e-12", "1.00e+12", "1e+07"],
    ),
    "1e12 points": (
        swept("b: {start: 1, stop: 2, num: 1e6}, R: {start: 0, stop: 1, num: 1e6}"),
        ["sweep", '["b", "R"]', "1e+12 points", "1e+09"],
    ),
    "1e12 recorded": (
        scene(orbit="{transient: 0, record: 1e12}"),
        ["orbit.record", "1000000000000", "at most"],
    ),
    "fraction of a period": (
        scene(orbit="{transient: 0.5, record: 1}"),
        ["orbit.transient", "0.5", "whole number"],
    ),
    "nothing recorded": (scene(orbit="{transient: 0, record: 0}"), ["orbit.record", "0", ">= 1"]),
    "no random start": (scene("start: {random: 0}"), ["start.random", "0", ">= 1"]),
    "follow without sweep": (scene("start: {follow: up}"), ["start.follow", "up", "no sweep"]),
    "section at a missing stop": (
        scene("section: {kind: impact, stop: left}", stops="right"),
        ["section.stop", "left", "no such stop"],
    ),
    "nothing to compute": (scene("observe: []"), ["observe", "[]", "nothing"]),
    "one sample": (scene("trajectory: {periods: 1, samples: 1}"), ["trajectory.samples", "1", ">= 2"]),
    "empty file": ("", ["null", "must be a mapping"]),
    "not YAML": ("system: {mu_m: 10", ["line 1"]),
    "key twice": (scene("model: flow\nmodel: map"), ["'model'", "twice"]),
    "alias bomb": ("a: &a [x]\nb: &b [*a, *a]\nc: [*b, *b]", ["anchors are not allowed", "&a"]),
    "deep nesting": ("[" * 10_000, ["nested"]),
    "escape of no character": (scene('model: "\\UFFFFFFFF"'), ["line 3", "an escape of no character"]),
    "escape of half a character": (scene('model: "\\uD800"'), ["line 3", "an escape of no character"]),
    "axis beyond the floats": (
        swept("tau: {start: -1.0e+308, stop: 1.0e+308, num: 3}"),
        ["sweep.tau.stop", "1e+308", "1e+300"],
    ),
    "integer beyond the floats": (scene(b="1" + 400 * "0"), ["system.b", "1000", "must be a number"]),
    "physical mass too small": (physical(M1="1e-200", M2="1e200"), ["system.physical.M2", "1e+200", "mu_m = inf"]),
    "physical damping that vanishes": (
        physical(C1="1e-300", C2="5e-300", K1="1e100", K2="5e100"),
        ["system.physical.C1", "1e-300", "zeta = 0.0"],
    ),
    "physical force beyond the floats": (physical(P1="1e308", P2="1e308"), ["system.physical.P2", "f2 = 0.0"]),
    "start of a swept number": (
        scene("start: {x1: 1}\nsweep: {x1: {values: [0, 1]}}"),
        ["start.x1", "1", "is swept", "leave it out"],
    ),
    "section that is not observed": (
        scene("section: {kind: impact}\nobserve: [lyapunov]"),
        ["section.kind", "impact", "not observed", "leave it out"],
    ),
    "observed twice": (scene("observe: [section, impacts, section]"), ["observe", "names section twice"]),
    "record of a machine's memory": (
        scene(orbit="{transient: 0, record: 1e9}"),
        ["orbit.record", "1000000000", "MB of memory at once", "at most 400 MB"],
    ),
    "samples of a machine's memory": (
        scene("trajectory: {periods: 1, samples: 1e9}"),
        ["trajectory.samples", "1000000000", "MB of memory at once", "at most 400 MB"],
    ),
    "Python object": ("system: !!python/object/apply:os.system [ls]", ["tags are not allowed", "os.system"]),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty current folder with a good scene in it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good.yaml").write_text(scene("sweep: {b: {values: [6.5, 6.6, 6.7]}}"))
    return tmp_path


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def assert_refused(capsys, folder, arguments, words):
    before = contents(folder)
    assert main(arguments) == 2
    captured = capsys.readouterr()
    for word in words:
        assert word in captured.err
    assert captured.out == ""
    assert captured.err.lower().count("error:") == 1 and "Traceback" not in captured.err
    assert contents(folder) == before


@pytest.mark.parametrize("command", ["run", "check", "grazing"])
@pytest.mark.parametrize("name", BAD_SCENES)
def test_bad_scene(folder, capsys, name, command):
    text, words = BAD_SCENES[name]
    (folder / "bad.yaml").write_text(text)
    assert_refused(capsys, folder, [command, "bad.yaml"], ["vibro-sweep: error: bad.yaml: ", *words])


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["rum", "good.yaml"], ["rum"]),
        (["run"], ["SCENE.yaml"]),
        (["run", "none.yaml"], ["SCENE.yaml", "none.yaml", "does not exist"]),
        (["run", "."], ["SCENE.yaml", "'.'", "directory"]),
        (["run", "good.yaml", "--fast"], ["--fast"]),
        (["run", "good.yaml", "--workers", "0"], ["--workers", "'0'", ">= 1"]),
        (["run", "good.yaml", "--workers", "many"], ["--workers", "'many'", ">= 1"]),
        (["run", "good.yaml", "--resume", "--overwrite"], ["--resume", "--overwrite", "exclude"]),
        (["run", "good.yaml", "-o", "old.h5"], ["old.h5", "exists", "--overwrite"]),
        (["run", "good.yaml", "-o", "half.h5"], ["half.h5.part", "in the way", "move it away"]),
        (["run", "good.yaml", "-o", "good.yaml", "--overwrite"], ["good.yaml", "the scene itself"]),
        (["run", "good.yaml", "-o", "none/new.h5"], ["none/new.h5", "no folder"]),
        (["run", "good.yaml", "-o", "."], [".", "is a folder"]),
        (["run", "good.yaml", "-o", "/proc/new.h5"], ["/proc/new.h5", "cannot write"]),
        (["run", "good.yaml", "--overwrite", "-o", "old.h5/new.h5"], ["old.h5/new.h5", "no folder"]),
        (["run", "binary.yaml"], ["binary.yaml", "not UTF-8"]),
        (["info", "none.h5"], ["FILE.h5", "none.h5", "does not exist"]),
        (["info", "good.yaml"], ["good.yaml", "HDF5"]),
        (["plot", "good.yaml"], ["good.yaml", "HDF5"]),
        (["plot", "none.h5"], ["FILE.h5", "none.h5", "does not exist"]),
        (["check", "none.yaml"], ["SCENE.yaml", "none.yaml", "does not exist"]),
    ],
    ids=" ".join,
)
def test_bad_command_line(folder, capsys, arguments, words):
    (folder / "old.h5").write_text("years of work")
    (folder / "half.h5.part").write_text("hours of work")
    (folder / "binary.yaml").write_bytes(b"system: \xff\xfe")
    assert_refused(capsys, folder, arguments, words)


def test_read_only_folder(folder, capsys, monkeypatch):
    # a superuser may write into any folder, so that the refusal of the system must be made up
    def refuse(**_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("tempfile.TemporaryFile", refuse)
    words = ["--output good.h5", "cannot write", "Permission denied"]
    assert_refused(capsys, folder, ["run", "good.yaml"], words)


def test_scheduler_without_its_package(folder, capsys, monkeypatch):
    monkeypatch.delitem(sys.modules, "vibro_sweep.driver.cluster", raising=False)
    monkeypatch.setitem(sys.modules, "distributed", None)
    words = ["--scheduler", "tcp://host:8786", "dask.distributed"]
    assert_refused(capsys, folder, ["run", "good.yaml", "--scheduler", "tcp://host:8786"], words)


def test_from_the_shell(folder):
    (folder / "bad.yaml").write_text(scene(R="1.5"))
    done = subprocess.run(
        [sys.executable, "-m", "vibro_sweep", "run", "bad.yaml"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("vibro-sweep: error: bad.yaml: system.R = 1.5: must be")
    assert len(done.stderr.splitlines()) == 1


def test_help_is_quick():
    start = time.perf_counter()
    command = [sys.executable, "-X", "importtime", "-m", "vibro_sweep", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert time.perf_counter() - start < 1
    heavy = {"numpy", "numba", "h5py", "matplotlib", "pydantic", "scipy"}
    assert not heavy & {line.rsplit("|")[-1].strip() for line in done.stderr.splitlines()}


def test_version(capsys):
    import vibro_sweep

    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"vibro-sweep {vibro_sweep.__version__}\n"


def test_schema(capsys):
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out)["$schema"] == "http://json-schema.org/draft-07/schema#"


def test_grazing(folder, capsys):
    assert main(["grazing", "good.yaml"]) == 0
    lines = capsys.readouterr().out.splitlines()
    b, tau = (float(line.split("=")[1]) for line in lines[:2])
    assert abs(b - 6.70571674097302) < 1e-13 and abs(tau - 2.229306509033) < 1e-12
    assert "(19) holds" in lines[-1]


def test_grazing_curve_of_a_frequency_sweep(folder, capsys):
    (folder / "plane.yaml").write_text(scene("sweep: {omega: {values: [0.6, 0.63]}, b: {values: [5, 6]}}"))
    assert main(["grazing", "plane.yaml"]) == 0
    header, first, last = capsys.readouterr().out.splitlines()
    assert header == "# omega b* tau*" and first.startswith("0.6 ")
    omega, b, tau = map(float, last.split())
    assert omega == 0.63 and abs(b - 6.70571674097302) < 1e-13 and abs(tau - 2.229306509033) < 1e-12


def test_grazing_of_two_frequencies_says_where(folder, capsys):
    (folder / "plane.yaml").write_text(scene("sweep: {omega: {values: [0.6, 0.7]}, zeta: {values: [0.1, 0.2]}}"))
    assert main(["grazing", "plane.yaml"]) == 0
    assert capsys.readouterr().out.startswith("at the first point of the sweep: omega = 0.6, zeta = 0.1\n")


def test_grazing_does_not_depend_on_the_start(folder, capsys):
    (folder / "plane.yaml").write_text(scene("sweep: {x1: {values: [0, 1]}, v1: {values: [0, 1]}}"))
    assert main(["grazing", "plane.yaml"]) == 0
    assert capsys.readouterr().out.startswith("b*    = 6.7057167409730")


def test_check(folder, capsys):
    assert main(["check", "good.yaml"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("good.yaml: b = 6.5 .. 6.7 (3 values)\n") and "3 points" in out
    assert re.search(r"  time      about [0-9.e+-]+ (s|min|h) here, once compiled\n", out)
    assert [path.name for path in folder.iterdir()] == ["good.yaml"]


@pytest.mark.parametrize(
    "stops, where, sign", [("right", "(right stop, t = 0)", 1), ("left", "(left stop, t = T/2)", -1)]
)
def test_grazing_of_one_stop(folder, capsys, stops, where, sign):
    (folder / "one.yaml").write_text(scene(stops=stops))
    assert main(["grazing", "one.yaml"]) == 0
    line = capsys.readouterr().out.splitlines()[2]
    numbers = [float(part.split()[0].strip(",")) for part in line.split(": ")[1:]]
    assert line.endswith(where) and "negative" not in line
    system = vs.System(**{key: float(value) for key, value in NUMBERS.items()}, stops=stops)
    # without stops this motion is steady, and touches the stop half a period later on the left
    orbit = vs.simulate(system.replace(b=100), vs.grazing(system).state, 1)
    assert np.allclose(orbit.sample([system.period / 2 if stops == "left" else 0.0])[0], numbers, atol=1e-9)
    assert np.sign(numbers[0]) == sign


def test_run_then_look(folder, capsys):
    assert main(["run", "good.yaml", "--plot"]) == 0
    captured = capsys.readouterr()
    assert captured.out.startswith("good.h5: 3 points in ") and "all ok" in captured.out and captured.err == ""
    assert {path.name for path in folder.iterdir()} >= {"good.yaml", "good.h5", "good.png"}
    assert main(["info", "good.h5"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "good.h5: vibro_sweep: good" and lines[1].split() == ["b", "6.5", "..", "6.7", "(3", "values)"]
    assert "computed     3 of 3 orbits (100 %)" in lines and "checksums    all hold" in lines
    assert main(["plot", "good.h5", "-o", "picture.svg"]) == 0
    assert (folder / "picture.svg").exists()


def test_existing_file_is_kept_unless_told(folder, capsys):
    assert main(["run", "good.yaml", "-o", "file.h5", "--quiet"]) == 0
    assert capsys.readouterr().out == ""
    (folder / "good.yaml").write_text(scene("sweep: {b: {values: [6.5, 6.6]}}"))
    words = ["file.h5 exists", "--overwrite replaces it", "another scene", "- sweep: {b: {values: [6.5, 6.6, 6.7]}}"]
    assert_refused(capsys, folder, ["run", "good.yaml", "-o", "file.h5"], words)
    (folder / "file.h5").write_bytes(b"old")
    assert main(["run", "good.yaml", "-o", "file.h5", "--quiet", "--overwrite"]) == 0
    assert (folder / "file.h5").read_bytes().startswith(b"\x89HDF")


def test_run_again(folder, capsys):
    assert main(["run", "good.yaml", "--plot"]) == 0
    before = contents(folder)
    capsys.readouterr()
    assert main(["run", "good.yaml"]) == 0
    assert capsys.readouterr().out == "good.h5 is complete already, from the same scene: 3 points, all ok\n"
    assert contents(folder) == before
    assert main(["run", "good.yaml", "--plot"]) == 0
    assert capsys.readouterr().out.endswith("good.png\n") and contents(folder) == before
    (folder / "good.png").write_text("a picture by hand")
    words = ["good.png exists", "--overwrite replaces it"]
    assert_refused(capsys, folder, ["run", "good.yaml", "--plot"], words)
    assert_refused(capsys, folder, ["plot", "good.h5"], words)
    assert main(["plot", "good.h5", "--overwrite"]) == 0


def test_file_of_another_version_is_kept(folder, capsys, monkeypatch):
    with monkeypatch.context() as other:
        other.setattr("vibro_sweep.identity.identity", lambda: "another")
        assert main(["run", "good.yaml", "--quiet"]) == 0
    words = ["good.h5 exists", "other code", "--overwrite replaces it"]
    assert_refused(capsys, folder, ["run", "good.yaml"], words)


def test_bad_points_are_counted_by_name(folder, capsys, monkeypatch):
    report = SimpleNamespace(
        points=1003, bad=3, statuses={"ok": 1000, "chatter": 2, "lost": 1}, seconds=1.234, computed=1
    )
    monkeypatch.setattr("vibro_sweep.driver.sweep.run", lambda *_: report)
    assert main(["run", "good.yaml"]) == 1
    assert capsys.readouterr().out == "good.h5: 1,003 points in 1.2 s, 3 with a bad status (chatter 2, lost 1)\n"
    assert main(["run", "good.yaml", "--quiet"]) == 1


def test_interruption(folder, capsys, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("vibro_sweep.driver.sweep.run", interrupted)
    assert main(["run", "good.yaml", "-o", "my file.h5"]) == 130
    err = capsys.readouterr().err
    assert err == "vibro-sweep: interrupted; to continue: vibro-sweep run good.yaml -o 'my file.h5' --resume\n"


def test_what_run_is_told(folder, monkeypatch):
    told = []

    def record(scene, output, workers, executor, progress, mode):
        told.append((scene.name, str(output), workers, executor, progress, mode))
        return SimpleNamespace(points=3, bad=0, statuses={"ok": 3}, seconds=0.0, computed=3)

    monkeypatch.setattr("vibro_sweep.driver.sweep.run", record)
    assert main(["run", "good.yaml"]) == 0
    assert main(["run", "good.yaml", "--workers", "3", "--resume", "--quiet"]) == 0
    assert main(["run", "good.yaml", "-o", "x.h5", "--overwrite"]) == 0
    assert told == [
        ("good", "good.h5", None, None, None, "new"),
        ("good", "good.h5", 3, None, None, "resume"),
        ("good", "x.h5", None, None, None, "overwrite"),
    ]


def test_progress_on_a_terminal(folder, capsys, monkeypatch):
    def run(scene, output, workers, executor, progress, mode):
        for done in range(4):
            progress(done, 3)
        return SimpleNamespace(points=3, bad=0, statuses={"ok": 3}, seconds=0.0, computed=3)

    monkeypatch.setattr("vibro_sweep.driver.sweep.run", run)
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    assert main(["run", "good.yaml"]) == 0
    assert "3/3" in capsys.readouterr().err
