"""What the command line refuses: bad scenes, bad arguments, places that cannot be written."""

import sys

import pytest
from support.cli import assert_refused, scene

PHYSICAL = dict(M1="1", M2="10", K1="1", K2="5", C1="0.1", C2="0.5", P1="1", P2="0", Omega="0.63", R="0.8", B="6")


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
    "physical damping": (physical(C1="0", C2="0.6"), ["system.physical.C1", "0", "C2/C1"]),
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
    "key twice": (scene("dynamics: flow\ndynamics: map"), ["'dynamics'", "twice"]),
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


@pytest.mark.parametrize("command", ["run", "check", "grazing"])
@pytest.mark.parametrize("name", BAD_SCENES)
def test_bad_scene(scene_folder, capsys, name, command):
    text, words = BAD_SCENES[name]
    (scene_folder / "bad.yaml").write_text(text)
    assert_refused(capsys, scene_folder, [command, "bad.yaml"], ["vibro-sweep: error: bad.yaml: ", *words])


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
        (["run", "good.yaml", "-o", "good.yaml", "--overwrite"], ["good.yaml", "must not end in .yaml"]),
        (["run", "good.yaml", "-o", "none/new.h5"], ["none/new.h5", "no folder"]),
        (["run", "good.yaml", "-o", "."], [".", "is a folder"]),
        (["run", "good.yaml", "-o", "/proc/new.h5"], ["/proc/new.h5", "cannot write"]),
        (["run", "good.yaml", "--overwrite", "-o", "old.h5/new.h5"], ["old.h5/new.h5", "no folder"]),
        (["run", "binary.yaml"], ["binary.yaml", "not UTF-8"]),
        (["run", "x" * 5000], ["x" * 57 + "... File name too long"]),
        (["run", "good.yaml", "-o", "x" * 252], ["--output", "x" * 56 + "...", "and shorter"]),
        (["run", "good.yaml", "--workers", "x" * 5000], ["--workers", "x" * 50 + "..."]),
        (["x" * 5000], ["there is no command 'xxx", "..."]),
        (["info", "none.h5"], ["FILE.h5", "none.h5", "does not exist"]),
        (["info", "good.yaml"], ["good.yaml", "HDF5"]),
        (["plot", "good.yaml"], ["good.yaml", "HDF5"]),
        (["plot", "none.h5"], ["FILE.h5", "none.h5", "does not exist"]),
        (["check", "none.yaml"], ["SCENE.yaml", "none.yaml", "does not exist"]),
    ],
    ids=lambda words: " ".join(words)[:60],
)
def test_bad_command_line(scene_folder, capsys, arguments, words):
    (scene_folder / "old.h5").write_text("years of work")
    (scene_folder / "half.h5.part").write_text("hours of work")
    (scene_folder / "binary.yaml").write_bytes(b"system: \xff\xfe")
    assert_refused(capsys, scene_folder, arguments, words)


def test_read_only_folder(scene_folder, capsys, monkeypatch):
    # a superuser may write into any scene_folder, so that the refusal of the system must be made up
    def refuse(**_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("tempfile.TemporaryFile", refuse)
    words = ["--output good.h5", "cannot write", "Permission denied"]
    assert_refused(capsys, scene_folder, ["run", "good.yaml"], words)


def test_scheduler_without_its_package(scene_folder, capsys, monkeypatch):
    monkeypatch.delitem(sys.modules, "vibro_sweep.driver.cluster", raising=False)
    monkeypatch.setitem(sys.modules, "distributed", None)
    words = ["--scheduler", "tcp://host:8786", "dask.distributed"]
    assert_refused(capsys, scene_folder, ["run", "good.yaml", "--scheduler", "tcp://host:8786"], words)
