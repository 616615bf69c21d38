"""What a prompt and a notebook show of objects: ten lines at most, with what matters, and the names of all numbers."""

import numpy as np
import pytest
from support import ROOT
from support.oscillators import PAPER

import vibro_sweep as vs

SYSTEM = PAPER.replace(b=0.4)
CHAIN = vs.Oscillator.named("chain", m=[1] * 6, k=[1] * 7, c=[0.1] * 7, force=[1, 0, 0, 0, 0, 0], omega=1, R=0.5, b=0.3)
SIXTEEN = np.random.default_rng(16).normal(size=(16, 16))
LARGE = vs.Oscillator(
    np.eye(16) + SIXTEEN @ SIXTEEN.T, SIXTEEN.T @ SIXTEEN, modal_damping=[0.01] * 16, force=SIXTEEN[0],
    contact_normal=SIXTEEN[1], omega=1, R=0.5, b=0.3, units="SI",
)  # fmt: skip
LINES, LETTERS = 10, 900


@pytest.fixture(scope="module")
def objects(kinds):
    orbit = vs.periodic_orbit(SYSTEM, itinerary="LLLRRR")
    branches = vs.follow_branches(orbit, "b", (0.37, 0.42), depth=1)
    branch = branches[0].branch
    pitchfork = next(one for one in branch.special if one.type == "pitchfork")
    curve = vs.bifurcation_curve(pitchfork, ("b", "omega"), ((0.36, 0.39), (0.629, 0.631)))
    windows = vs.windows(kinds("sweep"))
    return {
        "system": SYSTEM,
        "model": CHAIN,
        "sixteen masses": LARGE,
        "sixteen in a chain": vs.Oscillator.named(
            "chain", m=SIXTEEN[2] ** 2, k=[0.1] * 17, omega=1, R=0.5, b=0.3, force=SIXTEEN[3]
        ),
        "motion of sixteen": vs.grazing(LARGE),
        "orbit": vs.simulate(SYSTEM, np.zeros(4), 20),
        "exponents": vs.lyapunov(SYSTEM, np.zeros(4), 20, 20),
        "grazing": vs.grazing(SYSTEM),
        "mapping": vs.discontinuity_map(SYSTEM),
        "born": vs.born_at_grazing(SYSTEM)[0],
        "periodic orbit": orbit,
        "free motion": vs.periodic_orbit(SYSTEM.replace(b=8), itinerary=""),
        "no motion": vs.periodic_orbit(SYSTEM.replace(zeta=0.0, omega=1e-3), itinerary="R", periods=1),
        "many impacts": vs.periodic_orbit(SYSTEM.replace(b=6.1), np.zeros(4), 19),
        "branch": branch,
        "followed": branches[1],
        "special point": pitchfork,
        "curve": curve,
        "curve point": curve.begins,
        "windows": windows,
        "window": windows[0],
        "scene": vs.load_scene(kinds.folder / "sweep.yaml"),
    }


@pytest.mark.slow
def test_ten_lines(objects):
    for name, one in objects.items():
        text = repr(one)
        assert len(text.splitlines()) <= LINES and len(text) <= LETTERS, f"{name}: {text}"


TOLD = {
    "periodic orbit": ["LLLRRR", "period 1", "symmetric", ", stable", "multipliers 0.17", "b=0.4"],
    "free motion": ["no impacts", "period 1", "stable"],
    "branch": ["LLLRRR", "along b from 0.37 to", "points", "stable at", "pitchfork", "begins with", "ends with", "ok"],
    "followed": ["generation 1", "pitchfork", "of branch 0"],
    "special point": [
        "pitchfork (super) at b = 0.37386950048",
        "+-",
        "multipliers -1",
        "LLLRRR, period 1, symmetric",
    ],
    "curve": ["pitchfork", "omega 0.629 .. 0.631", "points", "begins with boundary", "ends with boundary"],
    "curve point": ["CurvePoint boundary (not followed beyond) at b = ", "omega = "],
    "windows": ["Windows in b: 3", "RRRR, period 8", "5.454438024 .. 5.809346285"],
    "window": ["RRRR, period 8", "2 orbits of the sweep", "begins with graze (nonsmooth fold, right)", "+-"],
}


@pytest.mark.parametrize("name", TOLD)
def test_what_matters(objects, name):
    text = repr(objects[name])
    assert all(one in text for one in TOLD[name]), text


def test_a_long_list_of_windows(objects):
    windows = objects["windows"]
    many = type(windows)(list(windows) * 20)
    many.parameter, many.unvisited = windows.parameter, windows.unvisited
    lines = repr(many).splitlines()
    assert len(lines) == LINES and lines[-1] == "  and 52 more>"


def test_of_many_masses_the_sizes():
    text = repr(LARGE)
    assert text.startswith("<linear: M=(16 x 16), K=(16 x 16), contact_normal=[") and "units='SI'" in text
    assert "modal_damping=[0.01] * 16, " in text and ", ... of 16], force_cos=[0.0] * 16, " in text
    few = vs.Oscillator(M=np.eye(2), K=np.eye(2), force=[1, 0], contact_normal=[1, 0], omega=1, R=0.5, b=0.3)
    assert eval(repr(few), {"Oscillator": vs.Oscillator}) == few


def test_what_scenes_say_of_them():
    scene = vs.load_scene(ROOT / "configs" / "quickstart.yaml")
    told = " ".join(str(scene.replace(system=LARGE)).split("  sweep")[0].split())
    assert len(told) <= LETTERS and "M = (16 x 16)" in told and "force1 .. force16 = [" in told
    assert "force_cos1 .. force_cos16 = [0.0] * 16" in told
    assert "constant6 = 0.0" in str(scene.replace(system=CHAIN, sweep={"k1": [1, 2]}))


def test_names_of_a_model_are_completed():
    assert {"b", "R", "omega", "m", "m1", "m6", "k7", "offset"} <= set(dir(CHAIN))
    assert {"b", "R", "mu_m", "tau"} <= set(dir(SYSTEM))
    assert all(hasattr(CHAIN, name) for name in dir(CHAIN))
