"""Oscillators that cannot be: one message each, which names the key, the value and what is allowed."""

import math

import numpy as np
import pytest

import vibro_sweep as vs
from vibro_sweep.model.parameters import ParameterError
from vibro_sweep.scene import SceneError, parse_scene

GOOD = dict(M=[[1, 0], [0, 2]], K=[[2, -1], [-1, 3]], force=[1, 0], contact_normal=[1, 0], omega=0.7, b=1, R=0.8)

# what is changed -> the key that the message names, and words that it has
BAD_OSCILLATORS = {
    "M not square": (dict(M=[[1, 0, 0], [0, 1, 0]]), "M", "square matrix"),
    "M of rows of different lengths": (dict(M=[[1, 0], [1]]), "M", "square matrix"),
    "M of text": (dict(M=[["a", 0], [0, 1]]), "M", "square matrix"),
    "M none": (dict(M=None), "M", "square matrix"),
    "M empty": (dict(M=[]), "M", "square matrix"),
    "M a list": (dict(M=[1, 2]), "M", "square matrix"),
    "M complex": (dict(M=[[1j, 0], [0, 1]]), "M", "square matrix"),
    "M not finite": (dict(M=[[math.nan, 0], [0, 1]]), "M", "finite"),
    "M not symmetric": (dict(M=[[1, 0.5], [0, 1]]), "M", "entries 1, 2 and 2, 1 differ: 0.5 and 0"),
    "M singular": (dict(M=[[1, 0], [0, 0]]), "M", "positive definite"),
    "M negative": (dict(M=[[1, 0], [0, -1]]), "M", "positive definite"),
    "M too large": (dict(M=np.eye(17), K=np.eye(17), contact_normal=[1] + 16 * [0], force=0), "M", "1 to 16 masses"),
    "K of another size": (dict(K=np.eye(3)), "K", "as there are 2 masses in M"),
    "K not symmetric": (dict(K=[[1, -1], [-1.1, 2]]), "K", "symmetric"),
    "K negative": (dict(K=[[1, -2], [-2, 1]]), "K", "positive semidefinite"),
    "K none": (dict(K=None), "K", "square matrix"),
    "K infinite": (dict(K=[[math.inf, 0], [0, 1]]), "K", "finite"),
    "K a number": (dict(K=1.0), "K", "as there are 2 masses in M"),
    "C negative": (dict(C=[[-0.1, 0], [0, 0.1]]), "C", "positive semidefinite"),
    "C not symmetric": (dict(C=[[0.1, 0.1], [0, 0.1]]), "C", "symmetric"),
    "C of another size": (dict(C=[[0.1]]), "C", "as there are 2 masses in M"),
    "C and ratios": (dict(C=np.eye(2), modal_damping=[0.1, 0.1]), "modal_damping", "left out where C is given"),
    "C and Rayleigh": (dict(C=np.eye(2), rayleigh=[0.1, 0.1]), "rayleigh", "left out where C is given"),
    "ratios and Rayleigh": (
        dict(modal_damping=[0.1, 0.1], rayleigh=[0.1, 0.1]), "rayleigh", "left out where modal_damping is given",
    ),
    "a ratio too few": (dict(modal_damping=[0.1]), "modal_damping", "a list of 2 numbers, one for each mode"),
    "a negative ratio": (dict(modal_damping=[0.1, -0.1]), "modal_damping[1]", ">= 0"),
    "three of Rayleigh": (dict(rayleigh=[0.1, 0.1, 0.1]), "rayleigh", "a list of 2 numbers"),
    "negative Rayleigh": (dict(rayleigh=[-0.1, 0.1]), "rayleigh[0]", ">= 0"),
    "force too long": (dict(force=[1, 0, 0]), "force", "a list of 2 numbers, one for each mass"),
    "force a number": (dict(force=1.0), "force", "a list of 2 numbers"),
    "force of text": (dict(force=["1", 0]), "force[0]", "a number"),
    "force not finite": (dict(force=[math.inf, 0]), "force[0]", "finite"),
    "force a word": (dict(force="sin"), "force", "a list of numbers"),
    "force_cos too short": (dict(force_cos=[1]), "force_cos", "a list of 2 numbers"),
    "constant too short": (dict(constant=[1]), "constant", "a list of 2 numbers"),
    "power of text": (dict(force_power="2"), "force_power", "a number"),
    "contact_normal zero": (dict(contact_normal=[0, 0]), "contact_normal", "other than zero"),
    "contact_normal next to zero": (dict(contact_normal=[1e-200, 0]), "contact_normal", "from 1e-100 to 1e+100"),
    "contact_normal too long": (dict(contact_normal=[1, 0, 0]), "contact_normal", "a list of 2 numbers"),
    "contact_normal a matrix": (dict(contact_normal=[[1, 0]]), "contact_normal", "a list of finite numbers"),
    "contact_normal not finite": (dict(contact_normal=[math.nan, 1]), "contact_normal", "a list of finite numbers"),
    "omega zero": (dict(omega=0), "omega", "> 0"),
    "omega not finite": (dict(omega=math.inf), "omega", "finite number > 0"),
    "b zero of two stops": (dict(b=0), "b", "> 0"),
    "b negative of two stops": (dict(b=-1), "b", "> 0"),
    "b not finite": (dict(b=math.inf, stops="right"), "b", "finite number"),
    "offset of text": (dict(offset="0"), "offset", "a number"),
    "R above one": (dict(R=1.5), "R", "from 0 to 1"),
    "R_left negative": (dict(R_left=-0.1), "R_left", "from 0 to 1"),
    "tau a word": (dict(tau="graze"), "tau", "'grazing'"),
    "no stop at all": (dict(stops="none"), "stops", "both, right or left"),
    "stops a number": (dict(stops=2), "stops", "both, right or left"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD_OSCILLATORS)
def test_bad_oscillators(name):
    changes, key, words = BAD_OSCILLATORS[name]
    vs.Oscillator(**GOOD)
    with pytest.raises(ParameterError) as error:
        vs.Oscillator(**(GOOD | changes))
    assert error.value.key == key and words in str(error.value)
    assert str(error.value).count("\n") == 0 and len(str(error.value)) < 2500


CHAIN = "type: chain, m: [1, 2], k: [1, 1, 0], force: [1, 0], omega: 0.7, b: 1, R: 0.8"
ONE = "type: one_mass, zeta: 0.02, F: 1, omega: 0.7, b: 1, R: 0.8"
BAD_SCENES = {
    "no such model": ("type: chains", ['system.type = "chains"', "did you mean `chain`?"]),
    "a model in a list": ("type: [chain]", ["system.type = [\"chain\"]", "allowed: two_mass"]),
    "a key of another model": (f"{ONE}, mu_m: 2", ["system.mu_m", "unknown key", "allowed here: k, zeta"]),
    "a number missing": (ONE.replace("F: 1, ", ""), ["system.F: missing"]),
    "stiffness negative": (f"{ONE}, k: -1", ["system.k = -1", ">= 0"]),
    "a spring too few": (CHAIN.replace("[1, 1, 0]", "[1, 1]"), ["system.k", "3 numbers, one for each spring"]),
    "a force too many": (CHAIN.replace("force: [1, 0]", "force: [1, 0, 0]"), ["system.force", "2 numbers"]),
    "a mass zero": (CHAIN.replace("m: [1, 2]", "m: [1, 0]"), ["system.m[1]", "> 0"]),
    "masses no list": (CHAIN.replace("m: [1, 2]", "m: 1"), ["system.m = 1", "list of numbers"]),
    "no such mass": (f"{CHAIN}, stop_at: 3", ["system.stop_at = 3", "from 1 to 2"]),
    "base no flag": (f"{ONE}, base: 2", ["system.base"]),
    "matrix not square": (
        "type: linear, M: [[1, 0]], K: [[1]], contact_normal: [1], omega: 1, b: 1, R: 1", ["system.M", "square matrix"],
    ),
    "matrix missing": ("type: linear, M: [[1]], contact_normal: [1], omega: 1, b: 1, R: 1", ["system.K: missing"]),
    "two stops without a clearance": (ONE.replace("b: 1", "b: 0"), ["system.b = 0", "> 0"]),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD_SCENES)
def test_bad_scenes(name):
    system, words = BAD_SCENES[name]
    with pytest.raises(SceneError) as error:
        parse_scene(f"system: {{{system}}}\norbit: {{transient: 1, record: 1}}")
    assert len(error.value.problems) == 1
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize(
    ("sweep", "words"),
    [
        ("{m3: {values: [1, 2]}}", "sweep.m3"),
        ("{m1: {values: [0, 2]}}", "sweep.m1 = 0: must be a finite number > 0"),
        ("{x3: {values: [0, 1]}}", "sweep.x3"),
        ("{b: {values: [-1, 1]}}", "sweep.b = -1: must be a finite number > 0"),
        ("{x1: {values: [0, 3]}}", "sweep.x1 = 3: is behind a stop"),
    ],
)
def test_bad_sweeps(sweep, words):
    with pytest.raises(SceneError, match=words.replace("(", r"\(")):
        parse_scene(f"system: {{{CHAIN}}}\nsweep: {sweep}\norbit: {{transient: 1, record: 1}}")


def test_a_sweep_of_a_list_that_is_not_given():
    text = "{type: linear, M: [[1]], K: [[1]], contact_normal: [1], omega: 1, b: 1, R: 1}"
    with pytest.raises(
        SceneError, match=r"sweep\.modal_damping1: is one of modal_damping, which is not given"
    ) as error:
        parse_scene(
            f"system: {text}\nsweep: {{modal_damping1: {{values: [0, 1]}}}}\norbit: {{transient: 1, record: 1}}"
        )
    assert len(error.value.problems) == 1


def test_an_oscillator_is_not_changed():
    oscillator = vs.Oscillator(**GOOD)
    with pytest.raises(AttributeError):
        oscillator.b = 2
    with pytest.raises(ParameterError, match="one of"):
        oscillator.replace(mass=3)
    assert oscillator.replace(force2=3.0).force == (1.0, 3.0) and oscillator.force2 == 0.0
