"""The tables inside the package: what is declared in one place, and what is made of it elsewhere in the package."""

import ast
import runpy

import numpy as np
import pytest
from support import ROOT
from support.scene_texts import parsed

import vibro_sweep as vs
from vibro_sweep.checks.not_computed import ROWS
from vibro_sweep.driver.blocks import plan_of
from vibro_sweep.engine.records import new_results, result_of
from vibro_sweep.engine.simd.kernel_cache import ENGINE, SHARED
from vibro_sweep.oscillator.catalogue import OF_A_SYSTEM
from vibro_sweep.oscillator.models import MODELS
from vibro_sweep.oscillator.other_words import own_name
from vibro_sweep.scene import resolved_numbers
from vibro_sweep.tables.coordinates import MOST_MASSES
from vibro_sweep.tables.observables import DIMENSIONS, VARIABLES

PAPER = "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0.1, omega: 0.63, R: 0.8, b: 6.6}"
NEEDS = {"section": "states", "lyapunov": "states lyapunov", "impacts": "impacts", "convergence": "states lyapunov",
         "multipliers": "states lyapunov", "attractors": "states lyapunov attractors"}  # fmt: skip


def test_the_page_on_your_machine_says_what_is_refused():
    said = (ROOT / "docs" / "start" / "your_machine.md").read_text().partition("| your machine has | take |\n")[2]
    table = said.partition("\n\n")[0].splitlines()[1:]
    assert table == [f"| {row.machine} | {row.instead} |" for row in ROWS] and len(table) > 6
    names = [name for row in ROWS for name in row.names]
    assert len(names) == len({*names})


def test_records_of_the_kernels_have_the_types_of_files():
    inside = [row for row in VARIABLES if row.in_kernel]
    assert len(inside) > 20
    for row in inside:
        field, shape = result_of(2)[row.name], tuple(DIMENSIONS[name].extent for name in row.dimensions)
        assert (field.base, field.shape) == (np.dtype(row.dtype), shape)
        np.testing.assert_array_equal(new_results(())[row.name], np.full(shape, row.fill))


def test_reference_pages_are_up_to_date():
    pages = runpy.run_path(str(ROOT / "docs/reference_pages.py"))["pages"]()
    old = [name for name, text in pages.items() if (ROOT / "docs/reference" / name).read_text() != text]
    assert old == [], "python docs/reference_pages.py docs/reference"


@pytest.mark.parametrize("word, needed", NEEDS.items())
def test_nothing_else_is_computed(word, needed):
    plan = plan_of(parsed(f"{PAPER}\norbit: {{transient: 3, record: 60}}\nobserve: [{word}]\n"))
    assert {name for name in ("states", "lyapunov", "impacts", "attractors") if getattr(plan, name)} == {
        *needed.split()
    }
    assert bool(plan.parts) == bool(plan.lyapunov)


def test_kernels_compile_in_only_what_names_their_cache():
    """An edit to any other table leaves the compiled kernels as they are."""
    jitted = 0
    for path in ENGINE.rglob("*.py"):
        tree = ast.parse(path.read_text())
        homes = {}
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("vibro_sweep.tables"):
                homes |= {
                    alias.asname or alias.name: f"{[*node.module.split('.'), alias.name][2]}.py" for alias in node.names
                }
        for node in (node for node in tree.body if isinstance(node, ast.FunctionDef)):
            if {"jit", "inline", "noinline", "exported"} & {ast.unparse(mark) for mark in node.decorator_list}:
                jitted += 1
                used = {name.id for name in ast.walk(node) if isinstance(name, ast.Name)}
                assert {homes[name] for name in used & homes.keys()} <= {*SHARED}, (path, node.name)
    assert jitted > 100


def test_every_example_has_its_numbers():
    """What a file would say of each scene that comes with the package."""
    scenes = sorted(path for path in (ROOT / "configs").rglob("*.yaml") if path.parent.name != "branches")
    assert len(scenes) > 10
    for path in scenes:
        scene = vs.load_scene(path)
        kinds = (resolved_numbers.attributes, resolved_numbers.dimensions, resolved_numbers.matrices)
        known = {name for numbers in kinds for name in numbers(scene)} | {*scene.sweep}
        usual = (None, 0.0)
        numbers = scene.system.numbers.items()
        needed = {x for x, value in numbers if value not in usual and value != resolved_numbers.USUAL.get(x)}
        needed = {name for name in needed if name not in map(own_name, scene.sweep)}
        needed |= {name for name, value in scene.system.options.items() if value is not None}
        needed -= {"units"}  # which each variable has
        assert {*needed, "transient", "record"} <= known, path.name
        assert "b_star" in known or {"b_right", "b_left"} <= known, path.name


@pytest.mark.parametrize("name", MODELS)
def test_a_name_means_the_same_in_all_models(name):
    for key, row in MODELS[name].flat(MOST_MASSES).items():
        assert (row.symbol, row.label) == (OF_A_SYSTEM[key].symbol, OF_A_SYSTEM[key].label), key
