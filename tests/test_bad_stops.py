"""Stops that cannot be: one message each, which names the key and what is allowed, and exit status 2."""

import math

import numpy as np
import pytest

import vibro_sweep as vs
from vibro_sweep.cli.commands import main
from vibro_sweep.scene import SceneError, parse_scene

PAPER = "mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, b: 5"
PHYSICAL = "M1: 2, M2: 20, K1: 800, K2: 4000, C1: 4, C2: 20, P1: 10, P2: 0, Omega: 12.6, B: 0.05"
ORBIT = "orbit: {transient: 1, record: 2}\n"


def scene(stops, more="", system=PAPER, orbit=ORBIT):
    return f"system: {{{system}, {stops}}}\n{orbit}{more}\n"


def physical(stops, more="", beside=""):
    return f"system: {{physical: {{{PHYSICAL}, {stops}}}{beside}}}\n{ORBIT}{more}\n"


def one_mass(stops):
    return scene(stops, system="type: one_mass, zeta: 0.1, F: 1, omega: 1, b: 1")


SOFT = "k_stop: 100"
SCENES = {  # the scene, and what its message says
    "stiffness zero": (scene("k_stop: 0"), "system.k_stop", "> 0"),
    "stiffness negative": (scene("k_stop: -5"), "system.k_stop", "> 0"),
    "stiffness not a number": (scene("k_stop: .nan"), "system.k_stop", "finite"),
    "stiffness infinite": (scene("k_stop: .inf"), "system.k_stop", "finite"),
    "stiffness a word": (scene("k_stop: stiff"), "system.k_stop", "number"),
    "stiffness in quotes": (scene("k_stop: '100'"), "system.k_stop", "without quotes"),
    "stiffness a list": (scene("k_stop: [1, 2]"), "system.k_stop", "number"),
    "stiffness true": (scene("k_stop: true"), "system.k_stop", "number"),
    "stiffness with a unit": (scene("k_stop: 100 N/m"), "system.k_stop", "no units"),
    "stiffness null": (scene("k_stop:"), "system", "k_stop"),
    "R and stiffness": (scene("R: 0.8, k_stop: 100"), "system.k_stop", "left out where R is given"),
    "R and stiffness on the left": (
        scene("R: 0.8, R_left: 0.5, k_stop_left: 3"), "system.k_stop_left", "left out where R_left is given",
    ),
    "no law": (scene("offset: 0"), "system.R", "k_stop, of a compliant stop"),
    "a law of the left stop alone": (scene("k_stop_left: 3"), "system.R", "k_stop"),
    "damping alone": (scene("c_stop: 1"), "system.R", "k_stop"),
    "damping negative": (scene(f"{SOFT}, c_stop: -1"), "system.c_stop", ">= 0"),
    "damping of a rigid stop": (scene("R: 0.8, c_stop: 1"), "system.c_stop", "belongs to a stop with k_stop"),
    "damping infinite": (scene(f"{SOFT}, c_stop: .inf"), "system.c_stop", "finite"),
    "preload without stiffness": (scene("R: 0.8, preload: 1"), "system.preload", "belongs to a stop with k_stop"),
    "preload negative": (scene(f"{SOFT}, preload: -0.1"), "system.preload", "from 0"),
    "preload a word": (scene(f"{SOFT}, preload: some"), "system.preload", "number"),
    "preload of a rigid left stop": (
        scene(f"{SOFT}, R_left: 0.8, preload_left: 1"), "system.preload_left", "belongs to a stop with k_stop_left",
    ),
    "left stiffness negative": (scene(f"{SOFT}, k_stop_left: -1"), "system.k_stop_left", "> 0"),
    "left stiffness without a left stop": (
        scene(f"{SOFT}, k_stop_left: 50, stops: right"), "system.k_stop_left", "there is no left stop",
    ),
    "left restitution without a left stop": (
        one_mass(f"{SOFT}, R_left: 0.5, stops: right"), "system.R_left", "there is no left stop",
    ),
    "stiffness of a rigid stop swept": (
        physical("R: 0.5", "\nsweep: {k_stop: {values: [1, 2]}}"), "sweep.k_stop", "left out where R is given",
    ),
    "left damping without a left stop": (
        one_mass(f"{SOFT}, c_stop_left: 5, stops: right"), "system.c_stop_left", "there is no left stop",
    ),
    "left damping negative": (scene(f"{SOFT}, c_stop_left: -1"), "system.c_stop_left", ">= 0"),
    "release unknown": (scene(f"{SOFT}, release: speed"), "system.release", "displacement"),
    "release a number": (scene(f"{SOFT}, release: 1"), "system.release", "displacement"),
    "release of rigid stops": (scene("R: 0.8, release: force"), "system.release", "no stop is compliant"),
    "stiffness misspelt": (scene("kstop: 100"), "system.kstop", "k_stop"),
    "capital letter": (scene("K_stop: 100"), "system.K_stop", "k_stop"),
    "physical: R and stiffness": (physical("R: 0.8, k_stop: 1e6"), "k_stop", "left out where R is given"),
    "physical: stiffness negative": (physical("k_stop: -1"), "k_stop", "> 0"),
    "physical: stiffness infinite": (physical("k_stop: .inf"), "k_stop", "finite"),
    "physical: preload of a rigid stop": (physical("R: 0.8, preload: 1"), "preload", "k_stop"),
    "physical: no law": (physical("B0: 0"), "R", "k_stop"),
    "physical: release unknown": (physical("k_stop: 1e6", beside=", release: never"), "release", "displacement"),
    "physical: release of rigid stops": (
        physical("R: 0.8", beside=", release: force"), "release", "no stop is compliant",
    ),
    "sweep over both laws": (
        scene(SOFT, "sweep: {R: {values: [0.5, 0.6]}}"), "k_stop", "left out where R is given",
    ),
    "sweep through zero": (scene(SOFT, "sweep: {k_stop: {start: -1, stop: 1, num: 3}}"), "sweep.k_stop", "> 0"),
    "sweep of damping of a rigid stop": (scene("R: 0.8", "sweep: {c_stop: {values: [0, 1]}}"), "c_stop", "k_stop"),
    "sweep of the release": (scene(SOFT, "sweep: {release: {values: [force]}}"), "sweep.release", ""),
    "plane of both laws": (
        scene("offset: 0", "sweep: {R: {values: [0.5]}, k_stop: {values: [5]}}"), "k_stop", "left out where R is given",
    ),
    "plane with a negative preload": (
        scene(SOFT, "sweep: {b: {values: [4, 5]}, preload: {values: [0, -1]}}"), "sweep.preload", "from 0",
    ),
    "damping swept of a rigid stop": (
        scene("R: 0.8", "sweep: {c_stop: {values: [0, 1]}}"), "sweep.c_stop", "belongs to a stop with k_stop",
    ),
    "map": (scene(SOFT, "dynamics: map"), "dynamics", "rigid"),
    "map with one rigid stop": (scene("R: 0.8, k_stop_left: 5", "dynamics: map"), "dynamics", "rigid"),
    "contacts of rigid stops": (scene("R: 0.8", "observe: [contacts]"), "observe", "rigid"),
    "contacts misspelt": (scene(SOFT, "observe: [contact]"), "observe", "contacts"),
    "contacts twice": (scene(SOFT, "observe: [contacts, contacts]"), "observe", "twice"),
    "impact section": (scene(SOFT, "section: {kind: impact, stop: right}"), "section.stop", "no impacts"),
    "impact section of the other stop": (
        scene(f"{SOFT}, R_left: 0.5", "section: {kind: impact, stop: right}"), "section.stop", "the other stop",
    ),
    "start behind a rigid stop": (scene(f"{SOFT}, R_left: 0.5", "start: {x1: -7}"), "start", "stop"),
    "followed in a random start": (scene(SOFT, "start: {random: 0}"), "start.random", ""),
    "two kinds of oscillator": (scene(f"{SOFT}, mu: 3"), "system.mu", ""),
}  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_scenes(name):
    text, key, allowed = SCENES[name]
    with pytest.raises(SceneError) as caught:
        parse_scene(text)
    said = caught.value.problems
    assert len(said) == 1, said
    assert key in said[0] and allowed in said[0], said


COMMANDS = {name: SCENES[name] for name in ("stiffness negative", "R and stiffness", "physical: release unknown")}


@pytest.mark.parametrize("name", COMMANDS)
def test_the_command_says_it_in_one_message(name, tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    text, key, allowed = COMMANDS[name]
    (tmp_path / "bad.yaml").write_text(text)
    assert main(["check", "bad.yaml"]) == 2
    said = capfd.readouterr()
    assert key in said.err and allowed in said.err and "Traceback" not in said.err + said.out


NUMBERS = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, b=5)
soft = lambda: vs.System(**NUMBERS, k_stop=100)  # noqa: E731
ball = lambda **stops: vs.Oscillator.named("one_mass", zeta=0, F=1, omega=1, b=1, **stops)  # noqa: E731
CALLS = {
    "nothing": (lambda: vs.System(**NUMBERS), "k_stop"),
    "a complex stiffness": (lambda: vs.System(**NUMBERS, k_stop=1j), "k_stop"),
    "a stiffness of text": (lambda: ball(k_stop="10"), "k_stop"),
    "not a number": (lambda: ball(k_stop=math.nan), "k_stop"),
    "an array": (lambda: ball(k_stop=np.ones(2)), "k_stop"),
    "a name that there is not": (lambda: ball(k_stop=1, d_stop=2), "d_stop"),
    "replaced by both": (lambda: soft().replace(R=0.5), "k_stop"),
    "replaced by a word": (lambda: soft().replace(release="late"), "release"),
    "a release that is None": (lambda: ball(k_stop=1, release=None), "release"),
    "matrices": (
        lambda: vs.Oscillator([[1]], [[1]], contact_normal=[1], omega=1, b=1, k_stop=1, preload=-1), "preload",
    ),
    "physical": (
        lambda: vs.System.physical(
            M1=2, M2=20, K1=800, K2=4000, C1=4, C2=20, P1=10, P2=0, Omega=12.6, B=0.05, k_stop=-8e5
        ),
        "k_stop",
    ),
    "sweep": (lambda: vs.sweep(soft(), {"k_stop": [1, 0]}, transient=1, record=1), "k_stop"),
    "sweep of another law": (lambda: vs.sweep(soft(), {"R": [0.5]}, transient=1, record=1), "k_stop"),
    "sweep that observes nothing": (
        lambda: vs.sweep(soft(), {"b": [5]}, transient=1, record=1, observe=["touches"]), "observe",
    ),
    "simulate behind a rigid stop": (lambda: vs.simulate(ball(k_stop=100, R_left=0.5), (-9, 0), 1), "behind"),
    "basins behind a rigid stop": (
        lambda: vs.sweep(
            soft().replace(R_left=0.5), {"x1": [-9, 0], "v1": [0, 1]}, transient=1, record=1, observe=["attractors"]
        ),
        "stop",
    ),
    "orbits born at grazing": (lambda: vs.born_at_grazing(soft()), "rigid"),
    "the mapping": (lambda: vs.discontinuity_map(soft()), "rigid"),
}  # fmt: skip


@pytest.mark.parametrize("name", CALLS)
def test_python(name):
    call, said = CALLS[name]
    with pytest.raises((vs.VibroSweepError, TypeError)) as caught:
        call()
    assert said in str(caught.value)
