"""Scenes: every form of the contract is read, to the last digit, and the JSON Schema says the same."""

import json

import jsonschema
import numpy as np
import pytest
import yaml
from support import ROOT, sample
from support.oscillators import PAPER_NUMBERS
from support.programs import ended
from support.scene_texts import parsed

import vibro_sweep as vs

CONFIGS = ROOT / "configs"
NUMBERS = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
SYSTEM = f"system: {{{PAPER_NUMBERS}, b: 6.6}}"
SCHEMA = json.loads(ended("schema").out)
SYSTEM_FORM = SCHEMA["definitions"]["SystemForm"]
WORDS = ("stops", "release", "units", "type")  # of a system; its other keys are numbers
SOFT = {name: number for name, number in NUMBERS.items() if name != "R"} | {"k_stop": 100, "c_stop": 1, "tau": 0}
BASE = f"{SYSTEM}\norbit: {{transient: 10, record: 4}}\n"


def sweep(text):
    return parsed(f"{BASE}sweep: {text}").sweep


class TestAxes:
    def test_paper_sweep_is_the_decimal_grid(self):
        b = sweep("{b: {start: 6.5, stop: 6.9, step: 0.0002}}")["b"]
        assert b.shape == (2001,)
        assert b.tolist() == [(65000 + 2 * i) / 10000 for i in range(2001)]

    @pytest.mark.parametrize(
        "axis, values",
        [
            ("{start: 1, stop: 2, step: 0.5}", [1, 1.5, 2]),
            ("{start: 2, stop: 1, step: -0.5}", [2, 1.5, 1]),
            ("{start: 1, stop: 2, step: 0.3}", [1, 1.3, 1.6, 1.9]),
            ("{start: 0.7, stop: 1, step: 0.1}", [0.7, 0.8, 0.9, 1]),
            ("{start: 1, stop: 2, step: 5}", [1]),
            ("{start: 1, stop: 2, step: 1e19}", [1]),
            ("{start: 1, stop: 3e19, step: 1e19}", [1, 1e19, 2e19]),
            ("{start: 1, stop: 1, step: -1}", [1]),
            ("{start: 1, stop: 2, num: 5}", [1, 1.25, 1.5, 1.75, 2]),
            ("{start: 2, stop: 1, num: 2e0}", [2, 1]),
            ("{start: 0.1, stop: 0.3, num: 3}", [0.1, 0.2, 0.3]),
            ("{values: [1, 3, 3.5]}", [1, 3, 3.5]),
            ("{values: [3.5, 1]}", [3.5, 1]),
            ("{values: [1e-9]}", [1e-9]),
        ],
    )
    def test_forms(self, axis, values):
        read = sweep(f"{{b: {axis}}}")["b"]
        assert read.tolist() == values and read.dtype == float and not read.flags.writeable

    def test_steps_that_are_no_short_decimals(self):
        b = sweep("{b: {start: 0.12345678901234567, stop: 10, step: 0.0312345678901234567}}")["b"]
        assert np.allclose(b, 0.12345678901234567 + 0.0312345678901234567 * np.arange(len(b)), rtol=1e-15)

    def test_no_step_passes_the_stop(self):
        values = sweep("{R: {start: 0, stop: 1, step: 0.35}}")["R"]
        assert values.tolist() == [0, 0.35, 0.7]


class TestScene:
    def test_least_scene(self):
        scene = parsed(BASE, "folder/least.yaml")
        assert scene.name == "least" and scene.text == BASE
        assert scene.system == vs.System(**NUMBERS)
        assert scene.dynamics == "flow" and scene.sweep == {} and scene.shape == () and scene.n_points == 1
        assert scene.start.kind == "state" and scene.start.state == (0, 0, 0, 0) and scene.n_starts == 1
        assert (scene.transient, scene.record) == (10, 4)
        assert scene.section.kind == "phase" and scene.observe == {"section"} and scene.trajectory is None

    def test_all_keys(self):
        scene = parsed(
            """
            system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, R: 0.8, tau: 0.5, stops: right}
            dynamics: flow
            sweep: {omega: {values: [0.6, 0.7]}, b: {start: 5, stop: 6, num: 3}}
            start: {random: 16, seed: 1}
            orbit: {transient: 1e3, record: 200}
            section: {kind: impact, stop: right}
            observe: [lyapunov, impacts, section]
            trajectory: {periods: 4, samples: 400}
            """
        )
        assert scene.system == vs.System(**(NUMBERS | dict(omega=0.6, b=5, tau=0.5)), stops="right")
        assert list(scene.sweep) == ["omega", "b"] and scene.shape == (2, 3, 16) and scene.n_points == 96
        assert (scene.start.kind, scene.start.count, scene.start.seed) == ("random", 16, 1)
        assert scene.transient == 1000
        assert (scene.section.kind, scene.section.stop) == ("impact", "right")
        assert scene.observe == {"section", "lyapunov", "impacts"}
        assert (scene.trajectory.periods, scene.trajectory.samples) == (4, 400)

    def test_physical_units(self):
        numbers = "M1: 2, M2: 20, K1: 8, K2: 40, C1: 0.4, C2: 2, P1: 3, P2: 1, Omega: 1.26, R: 0.8, B: 3.3"
        text = f"system: {{physical: {{{numbers}}}, stops: left}}\norbit: {{transient: 0, record: 1}}\n"
        system = parsed(text).system
        assert system.mu_m == 10 and system.mu_k == 5 and system.f2 == 0.25 and system.stops == "left"
        assert system.zeta == pytest.approx(0.05) and system.omega == pytest.approx(0.63)
        assert system.b == pytest.approx(6.6)
        for scale in (1e-200, 1e200):  # in other units of mass, stiffness and force
            masses = numbers.split(", P1")[0]
            scaled = ", ".join(
                f"{part.split(': ')[0]}: {float(part.split(': ')[1]) * scale}" for part in masses.split(", ")
            )
            other = parsed(text.replace(masses, scaled)).system
            assert other.zeta == pytest.approx(system.zeta) and other.omega == pytest.approx(system.omega)
        swept = parsed(text + "sweep: {b: {values: [1, 2]}}")
        assert swept.system == system.replace(b=1)
        unequal = text.replace("B: 3.3", "B: 3.3, B0: -0.4, R_left: 0.5, C2: 1").replace("C2: 2, ", "")
        assert parsed(unequal).system == system.replace(offset=-0.8, R_left=0.5, mu_c=2.5)
        beyond = text.replace("B: 3.3", "B: -3.3")  # one stop may stand anywhere
        assert parsed(beyond).system == system.replace(b=-6.6)

    @pytest.mark.parametrize("direction, n_starts", [("up", 1), ("down", 1), ("both", 2)])
    def test_follow(self, direction, n_starts):
        scene = parsed(f"{BASE}sweep: {{b: {{values: [6, 7]}}}}\nstart: {{follow: {direction}}}")
        assert scene.start.kind == "follow" and scene.start.direction == direction
        assert scene.n_starts == n_starts and scene.shape == ((2,) if n_starts == 1 else (2, 2))

    def test_one_random_start_makes_no_dimension(self):
        assert parsed(f"{BASE}start: {{random: 1}}").shape == ()

    def test_trajectory_alone(self):
        assert parsed(f"{BASE}observe: []\ntrajectory: {{periods: 1, samples: 2}}").observe == frozenset()

    def test_start_at_a_stop_and_beside_a_missing_one(self):
        assert parsed(f"{BASE}start: {{x1: 6.6}}").start.state[0] == 6.6
        one_sided = BASE.replace("b: 6.6", "b: 6.6, stops: right")
        assert parsed(f"{one_sided}start: {{x1: -100}}").start.state[0] == -100

    def test_parameters(self):
        scene = parsed(BASE + "sweep: {omega: {values: [0.6, 0.63]}, b: {values: [5, 6, 7]}}")
        parameters = scene.parameters()
        assert tuple(parameters) == tuple(scene.system.parameters())
        assert {array.shape for array in parameters.values()} == {(2, 3)}
        for i, omega in enumerate((0.6, 0.63)):
            for j, b in enumerate((5, 6, 7)):
                expected = scene.system.replace(omega=omega, b=b).parameters()
                found = {name: array[i, j] for name, array in parameters.items()}
                assert found == pytest.approx(expected, rel=1e-15)

    def test_parameters_of_one_orbit(self):
        parameters = parsed(BASE).parameters()
        assert parameters["tau"] == pytest.approx(2.229306509033, abs=1e-12) and parameters["b"].shape == ()

    def test_swept_phase(self):
        parameters = parsed(BASE + "sweep: {tau: {values: [0, 1]}}").parameters()
        assert parameters["tau"].tolist() == [0, 1]

    @pytest.mark.parametrize("values", ["[2, 3]", "[3, 2]", "[3]"])
    def test_undamped_resonance_has_no_grazing_phase(self, values):
        # mu_m = 1, mu_k = 7.875 has the mode omega_2 = 3 exactly
        system = "system: {mu_m: 1, mu_k: 7.875, zeta: 0, f2: 0, R: 0.8, b: 1}"
        text = f"{system}\norbit: {{transient: 10, record: 4}}\nsweep: {{omega: {{values: {values}}}}}"
        phase = parsed(text).parameters()["tau"]
        omega = json.loads(values)
        assert (phase == 0).tolist() == [value == 3 for value in omega]


STANDS_FOR = {"frequency": ("omega",), "stop_right": ("b",), "stop_left": ("b",)}


class TestSchema:
    def test_is_draft_7_without_newer_words(self):
        jsonschema.Draft7Validator.check_schema(SCHEMA)
        assert not {'"$defs"', '"prefixItems"'} & set(json.dumps(SCHEMA).replace(":", " ").split())

    @pytest.mark.parametrize("path", sample(3, sorted(CONFIGS.glob("*.yaml"))), ids=lambda path: path.stem)
    def test_configs_are_valid(self, path):
        assert path.read_text().startswith("# yaml-language-server: $schema=./scene.schema.json\n")
        assert vs.load_scene(path).name == path.stem
        jsonschema.Draft7Validator(SCHEMA).validate(yaml.safe_load(path.read_text()))

    @pytest.mark.parametrize("key", sample(5, [key for key in SYSTEM_FORM["properties"] if key not in WORDS]))
    def test_bounds_are_those_of_the_system(self, key):
        validator = jsonschema.Draft7Validator(SYSTEM_FORM)
        numbers = SOFT if "stop" in key or "preload" in key else NUMBERS
        for value in (-1, -1e-9, 0, 1e-9, 0.5, 1, 1 + 1e-9, 1e9):
            try:
                without = STANDS_FOR.get(key, ())
                vs.System(**{name: x for name, x in numbers.items() if name not in without} | {key: value})
                allowed = True
            except vs.ParameterError:
                allowed = False
            assert validator.is_valid({key: value}) == allowed, value

    def test_every_key_is_described(self):
        definitions = SCHEMA["definitions"]
        for name, definition in definitions.items():
            assert definition["additionalProperties"] is False and definition["description"]
            for key, schema in definition["properties"].items():
                assert schema.get("description"), (name, key)


def test_name_and_text_of_a_file(tmp_path):
    path = tmp_path / "my scene.yaml"
    path.write_text(BASE)
    scene = vs.load_scene(path)
    assert scene.name == "my scene" and scene.text == BASE
