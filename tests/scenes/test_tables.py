"""Each number and each variable is declared once: what is made of the tables of model/ follows them."""

import ast
import dataclasses
import io

import h5py
import numpy as np
import pytest
import typer
from support import ROOT
from support.scene_texts import parsed

import vibro_sweep as vs
from vibro_sweep.cli import reference
from vibro_sweep.cli.commands import app
from vibro_sweep.cli.reference_pages.status_page import MESSAGES
from vibro_sweep.driver.blocks import plan_of
from vibro_sweep.engine.records import POINT, new_results, result_of
from vibro_sweep.engine.simd.jit import ENGINE, SHARED
from vibro_sweep.model.bifurcations import TYPES
from vibro_sweep.model.catalogue import AXES
from vibro_sweep.model.dimensions import DIMENSIONS
from vibro_sweep.model.exponents import CERTAIN
from vibro_sweep.model.observables import VARIABLES, WORDS, asked_for
from vibro_sweep.model.outcomes import BRANCHES, EDGES, ORBITS, POINTS, REASONS
from vibro_sweep.model.parameters import BY_NAME, NAMES, OTHER_STOPS
from vibro_sweep.model.state import state
from vibro_sweep.model.status import STATUSES
from vibro_sweep.model.trajectory_variables import TRAJECTORY
from vibro_sweep.model.units import unit_in
from vibro_sweep.model.wording import sentence
from vibro_sweep.store.creating import skeleton_of, sweep_run

SYSTEM = {"mu_m": 10, "mu_k": 5, "zeta": 0.05, "f2": 0.1, "omega": 0.63, "R": 0.8, "b": 6.6}
SCENE = f"system: {SYSTEM}\norbit: {{transient: 3, record: 60}}\n".replace("'", "")
JIT = {"jit", "inline", "noinline", "exported"}
LONGEST_LABEL = 30  # characters, beside an axis


def scene_of(observe, more=""):
    scene = SCENE.replace("R: 0.8", "k_stop: 100") if "contacts" in observe else SCENE
    return parsed(f"{scene}observe: [{', '.join(observe)}]\n{more}")


def skeleton(scene):
    return h5py.File(io.BytesIO(skeleton_of(sweep_run(scene, {}), b"0" * 16)), "r")


class TestTheTablesThemselves:
    def test_names_are_there_once(self):
        names = [*NAMES, *DIMENSIONS, *(one.name for one in VARIABLES)]
        assert len(names) == len(set(names))

    @pytest.mark.parametrize("one", VARIABLES, ids=lambda one: one.name)
    def test_a_variable_has_known_dimensions_and_words(self, one):
        assert set(one.asked_by) <= {*WORDS, TRAJECTORY} and set(one.dimensions) <= DIMENSIONS.keys()
        assert one.asked_by or one.name == "status"

    def test_labels_are_short_enough_for_axes_and_texts_say_more(self):
        for one in (*AXES.values(), *VARIABLES):
            assert 0 < len(one.long_name) <= LONGEST_LABEL and one.text and "\n" not in one.text, one

    def test_the_state_is_interleaved(self):
        assert state(2) == ("x1", "v1", "x2", "v2")


class TestWhatFollows:
    def test_the_system_has_each_parameter_with_its_default(self):
        fields = {one.name: one.default for one in dataclasses.fields(vs.System)}
        assert fields.pop("stops") == "both" and fields.pop("units") is None
        assert fields.pop("release") == "displacement"
        given = {name: one.default for name, one in BY_NAME.items()}
        assert tuple(fields) == tuple(BY_NAME)
        assert {name: None if value is dataclasses.MISSING else value for name, value in fields.items()} == given

    def test_help_names_each_parameter_with_its_range(self):
        for one in BY_NAME.values():
            assert f"{one.name} : {one.text}" in vs.System.__doc__ and one.range.text in vs.System.__doc__

    def test_the_free_motion_depends_on_its_own_numbers_alone(self):
        system = vs.System(**SYSTEM)
        before = vs.grazing(system)
        for name, one in BY_NAME.items():
            if name in (each.name for each in OTHER_STOPS):  # its stops are rigid
                assert not one.free_motion
                continue
            value = getattr(system, name) or system.parameters()[name]
            other = vs.grazing(system.replace(**{name: 0.5 if name == "tau" else 1.1 * value}))
            changed = (other.b_right + other.b_left, other.tau) != (before.b_right + before.b_left, before.tau)
            assert changed == one.free_motion, name

    def test_records_of_the_kernels_have_the_files_types(self):
        assert POINT.names[: len(NAMES)] == NAMES
        empty = new_results(())
        for one in VARIABLES:
            if one.in_kernel:
                own = tuple(DIMENSIONS[name].extent for name in one.dimensions)
                assert (result_of(2)[one.name].base, result_of(2)[one.name].shape) == (np.dtype(one.dtype), own)
                np.testing.assert_array_equal(empty[one.name], np.full(own, one.fill))

    @pytest.mark.parametrize("name, text", reference.pages(ROOT).items())
    def test_a_reference_page_is_up_to_date(self, name, text):
        assert (ROOT / "docs" / "reference" / name).read_text() == text, (
            "python -m vibro_sweep.cli.reference docs/reference"
        )

    def test_the_reference_pages_have_everything(self):
        text = "".join(reference.pages(ROOT).values())
        for name in (*NAMES, *DIMENSIONS, *WORDS, *(one.name for one in VARIABLES)):
            assert f"`{name}`" in text, name

    def test_each_outcome_that_is_not_good_says_what_to_do(self):
        good = {"ok", "in_a_window", "chaos", "curve", "closed"}
        found = {one.name: one for one in (*STATUSES.values(), *TYPES)} | ORBITS | BRANCHES | POINTS | REASONS | EDGES
        assert {name for name, one in found.items() if not one.advice} == good
        text = (ROOT / "docs" / "reference" / "statuses.md").read_text()
        assert all(f"**`{name}`" in text for name in found)

    def test_common_messages_are_those_of_the_program(self):
        sources = "".join(
            path.read_text() for path in (ROOT / "vibro_sweep").rglob("*.py") if path.name != "status_page.py"
        )
        assert [part for part in MESSAGES if part not in sources] == []

    def test_each_command_and_option_is_in_the_reference(self):
        text = reference.pages(ROOT)["commands.md"]
        for name, command in typer.main.get_command(app).commands.items():
            section = text.partition(f"## `vibro-sweep {name}`\n")[2].partition("\n## ")[0]
            assert all(option in section for one in command.params for option in one.opts if option.startswith("-"))
            assert command.help.splitlines()[0] in section

    def test_kernels_compile_in_only_what_names_their_cache(self):
        """An edit to any other module of the model leaves the compiled kernels as they are."""
        count = 0
        for path in ENGINE.rglob("*.py"):
            tree = ast.parse(path.read_text())
            homes = {}  # name -> the module of the model that it, or its contents, come from
            for node in ast.walk(tree):
                if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("vibro_sweep.model"):
                    module = node.module.removeprefix("vibro_sweep.model").removeprefix(".")
                    homes |= {alias.name: f"{module or alias.name}.py" for alias in node.names}
            for node in tree.body:
                if isinstance(node, ast.FunctionDef) and any(ast.unparse(one) in JIT for one in node.decorator_list):
                    count += 1
                    used = {one.id for one in ast.walk(node) if isinstance(one, ast.Name)}
                    assert {homes[name] for name in used & homes.keys()} <= set(SHARED), (path, node.name)
        assert count > 100


class TestOnlyWhatIsAskedFor:
    @pytest.mark.parametrize("word", WORDS)
    def test_a_file_has_the_variables_of_its_words(self, word):
        with skeleton(scene_of([word])) as file:
            expected = {one.name for one in VARIABLES if word in one.asked_by and not one.at_impacts} | {"status"}
            own = {name for one in VARIABLES if one.name in expected for name in one.dimensions}
            assert set(file) == expected | own

    def test_the_phase_belongs_to_sections_at_impacts(self):
        assert "phase" in asked_for(frozenset({"section"}), True)
        assert "phase" not in asked_for(frozenset({"section"}), False)
        assert "phase" not in asked_for(frozenset({"lyapunov"}), True)

    @pytest.mark.parametrize("without", ["contacts", "energy"])  # of rigid stops, of compliant ones
    def test_each_dataset_is_described(self, without):
        more = "sweep: {b: {values: [6, 7]}, omega: {values: [0.6, 0.7]}}\ntrajectory: {periods: 2, samples: 5}\n"
        with skeleton(scene_of([word for word in WORDS if word != without], more)) as file:
            by_name = AXES | {one.name: one for one in VARIABLES}
            assert {"b", "omega", "tau", "b_star", "sample", "elapsed"} <= set(file)
            for name, dataset in file.items():
                one = by_name[name]
                for attribute, value in (
                    ("long_name", one.long_name),
                    ("description", sentence(one.text)),
                    ("units", unit_in(one.units, None)),
                ):
                    assert dataset.attrs[attribute].decode() == value, name
            assert file["lyapunov_error"].attrs["significant"] == CERTAIN == 2.0

    @pytest.mark.parametrize(
        ("word", "states", "lyapunov", "impacts", "attractors"),
        [
            ("section", True, False, False, False),
            ("lyapunov", True, True, False, False),
            ("multipliers", True, True, False, False),
            ("impacts", False, False, True, False),
            ("attractors", True, True, False, True),
            ("convergence", True, True, False, False),
        ],
    )
    def test_nothing_else_is_computed(self, word, states, lyapunov, impacts, attractors):
        plan = plan_of(scene_of([word]))
        assert (plan.states, plan.lyapunov, plan.impacts, plan.attractors) == (states, lyapunov, impacts, attractors)
        assert bool(plan.parts) == bool(plan.lyapunov)
