"""The kernel of a page: its formulas are the model's, its bits those of native code, its numbers those of a sweep."""

import lzma
import math
import subprocess
import sys
from operator import attrgetter
from types import SimpleNamespace

import numpy as np
import pytest
from support.page_memory import Memory, Module, Native

import vibro_sweep as vs
from vibro_sweep.engine.points.any_points import kind_of
from vibro_sweep.engine.records import Kind, result_of
from vibro_sweep.oscillator.linear import MOTION, stacked
from vibro_sweep.oscillator.own_time import in_own_time, rate_of
from vibro_sweep.standalone import kernel_module
from vibro_sweep.standalone.formulas import LAWS, STOPS, formulas_of
from vibro_sweep.standalone.kernel_module import kernel_name, module_of

SET_UP, DIAGRAM = 0, 1
TRANSIENT, RECORD, COLUMNS = 400, 60, 40
NAMES = {"Infinity": math.inf, "NaN": math.nan}

PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4.2)
BALL = vs.Oscillator.named("one_mass", zeta=0.05, F=1.0, omega=0.8, b=0.5, stops="right", R=0.7, k=1.0)
SOFT = vs.Oscillator.named("one_mass", zeta=0.05, F=1.0, omega=0.8, b=0.5, k_stop=50.0, c_stop=0.2)
CHAIN = vs.Oscillator.named(
    "chain", m=[1, 2, 1], k=[1, 1, 1, 1], c=[0.1, 0.1, 0.1, 0.1], force=[1, 0, 0], omega=0.7, b=0.6, R=0.6,
)  # fmt: skip
SHAKEN = vs.Oscillator(
    [[1, 0], [0, 2]], [[2, -1], [-1, 2]], modal_damping=[0.01, 0.02], force=[1, 0.3], contact_normal=[1, -1], omega=0.8,
    b=0.5, R=0.7, force_power=2,
)  # fmt: skip
CAVITY = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.1, zeta=0.05, F=0.4, omega=1.0, b=1.0, R=0.8)
SOFT_AND_RIGID = vs.Oscillator.named(
    "one_mass", zeta=0.05, F=1.0, omega=0.8, b=0.5, R=0.7, k_stop_left=50.0, c_stop_left=0.2
)
BY_FORCE = vs.Oscillator.named("one_mass", zeta=0.05, F=1.0, omega=0.8, b=0.5, k_stop=50.0, c_stop=2, release="force")


def evaluated(system) -> np.ndarray:
    """The numbers of a page's formulas, in the system's own time."""
    numbers = dict(system.family.numbers)
    for name, quantity in system.described.items():
        if name in numbers and numbers[name] is None and quantity.follows:
            numbers[name] = numbers[quantity.follows]
    rate, names = rate_of(system.omega), {"v": SimpleNamespace(**numbers), **NAMES}
    return np.array([eval(text, dict(names)) / rate**power for text, power in formulas_of(system)])


@pytest.mark.parametrize("system", [PAPER, BALL, SOFT, CHAIN, SHAKEN, CAVITY, BY_FORCE])
def test_formulas_are_those_of_the_model(system):
    """Also with other numbers than those with which they were made."""
    for factor in (1.0, 0.83):
        other = system.replace(omega=factor * system.omega, b=1.1 * factor * system.b)
        q = in_own_time(other.linear, rate_of(other.omega))
        wanted = [np.ravel(attrgetter(name)(q)) for name in (*MOTION, *STOPS, *LAWS)]
        found = evaluated(other)
        tau = sum(len(one) for one in wanted[: len(MOTION) - 1])
        found[tau] = wanted[len(MOTION) - 1][0]  # a phase that follows is found by the page
        np.testing.assert_allclose(found, np.concatenate(wanted), rtol=4e-16, atol=1e-30)


@pytest.mark.parametrize(
    "place",
    [
        math.exp,
        abs,
        lambda b: b if b > 1 else 1.0,
        lambda b: 2 * b if b == 1 else b,
        lambda b: b or 1.0,
        lambda b: np.maximum(b, 1.0),
        lambda b: {1.0: 2.0}.get(b, b),
        lambda b: min(b, 2.0),
    ],
)
def test_a_model_that_computes_with_more_has_no_formulas(place):
    """A branch is one more: its formulas would be right of some numbers alone."""
    family = vs.types.Family(lambda b: PAPER.linear.with_contact(high=place(b)), {"b": 1.0})
    assert formulas_of(SimpleNamespace(family=family, described={})) is None


def test_modules_of_a_wheel_need_no_linker(tmp_path, monkeypatch):
    assert all(kernel_name(kernel_module.kind_named(name)) == name for name in kernel_module.SHIPPED)
    monkeypatch.setattr(kernel_module, "OF_WHEEL", tmp_path)
    monkeypatch.setattr(kernel_module, "find_spec", lambda name: None)
    monkeypatch.setattr(kernel_module.kernel_cache, "FOLDER", None)
    (tmp_path / kernel_module.shipped_name("2c")).write_bytes(lzma.compress(b"code"))
    (tmp_path / "page_2ck_of_another_engine.wasm.xz").write_bytes(lzma.compress(b"code"))
    assert module_of(Kind(2, True, False)) == b"code"
    with pytest.raises(ImportError, match=r"pip install 'vibro_sweep\[page\]'"):
        module_of(Kind(2, True, True))


def block(kernel, kind, systems, start) -> Memory:
    """A block of orbits of these systems, all from one state; the phase of the force is theirs."""
    states, m = 2 * kind.masses, len(systems)
    sizes = dict(
        orbits=m, record=RECORD, cells=512, logged=0, parts=20, hits=16, samples=3, periods=1, kept=2,
    )  # fmt: skip
    memory = Memory(kind, sizes, kernel.base)
    rate = rate_of(systems[0].omega)
    numbers = np.array([evaluated(system) for system in systems])
    width = memory.layout["machine"]
    numbers[:, width - 1] = [system.linear.tau for system in systems]
    memory.array("machines")[:] = numbers[:, :width].ravel()
    memory.array("stops")[:] = numbers[:, width : width + 4].ravel()
    if kind.compliant:
        memory.array("laws")[:] = numbers[:, width + 4 :].ravel()
    memory.values |= {"release": int(systems[0].linear.contact.by_force), "task": SET_UP, "plan.lyapunov": True}
    kernel.call(memory)
    assert memory.array("known", bool).all()
    starts = memory.array("starts").reshape(2, m, states + 3)
    starts[:] = [*start, 0, 0, np.nan]
    starts[..., 1:states:2] /= rate
    memory.array("results", np.uint8)[:] = np.tile(np.frombuffer(bytes.fromhex(memory.layout["fill"]), np.uint8), m)
    memory.array("sections")[:] = np.nan
    memory.values |= {
        "task": DIAGRAM, "plan.transient": TRANSIENT, "plan.record": RECORD, "plan.warm_up": 200, "plan.parts": 20,
        "plan.states": True,
    }  # fmt: skip
    for name in ("w.ensemble.records.times", "w.ensemble.records.samples"):
        memory.shapes[name][0] = 0
    kernel.call(memory)
    return memory


def swept(system, low, high):
    """COLUMNS of a system over b, with the values."""
    values = np.linspace(low, high, COLUMNS)
    return values, [system.replace(b=float(b)) for b in values]


def kind_of_system(system):
    return kind_of(stacked([system.linear]))


@pytest.fixture(scope="module")
def compliant(tmp_path_factory):
    """The kernel of one mass and compliant stops as LLVM's text and as a module, made in a process of their own."""
    folder = tmp_path_factory.mktemp("module")
    code = "import pathlib, sys; from vibro_sweep.standalone import kernel_module as k; "
    code += "text = k.kernel_text(k.kind_named(sys.argv[1])); pathlib.Path('kernel.ll').write_text(text); "
    code += "k.make(text, pathlib.Path('kernel.wasm'))"
    command = [sys.executable, "-c", code, kernel_name(kind_of_system(SOFT))]
    subprocess.run(command, check=True, cwd=folder)
    return (folder / "kernel.ll").read_text(), (folder / "kernel.wasm").read_bytes()


@pytest.mark.slow
def test_a_module_needs_nothing_but_its_memory():
    """No Python, no allocation, no function of a browser: sin, cos and four others are linked in."""
    wasmtime = pytest.importorskip("wasmtime")
    module = wasmtime.Module(wasmtime.Engine(), module_of(kind_of_system(PAPER)))
    assert [(one.module, one.name) for one in module.imports] == [("env", "memory")]


@pytest.mark.slow
def test_the_module_has_the_bits_of_native_code(compliant, tmp_path):
    """Of code that does not fuse multiply-adds and has the same sin, cos, exp, log, expm1 and hypot: all results.

    Of a mass with a compliant stop on the left and a rigid one on the right.
    """
    pytest.importorskip("wasmtime")
    text, module = compliant
    kind = kind_of_system(SOFT_AND_RIGID)
    _, systems = swept(SOFT_AND_RIGID, 0.3, 1.2)
    start = np.zeros(2 * kind.masses)
    found = block(Module(module), kind, systems, start)
    native = block(Native(text, tmp_path), kind, systems, start)
    for name in ("sections", "results", "points"):
        assert found.array(name, np.uint8).tobytes() == native.array(name, np.uint8).tobytes(), name


@pytest.mark.slow
@pytest.mark.parametrize("system, low, high", [(PAPER, 4.2, 7), (SOFT, 0.3, 1.2), (BY_FORCE, 0.3, 1.2)])
def test_the_module_has_the_numbers_of_a_sweep(compliant, system, low, high):
    """Of periodic orbits to what rounding of the data does; the others have the same statuses."""
    pytest.importorskip("wasmtime")
    kind = kind_of_system(system)
    module = compliant[1] if kind.compliant else module_of(kind)
    values, systems = swept(system, low, high)
    found = block(Module(module), kind, systems, np.zeros(2 * kind.masses))
    observed = ["section", "lyapunov", "impacts"] + ["contacts"] * kind.compliant
    data = vs.sweep(system, {"b": values}, transient=TRANSIENT, record=RECORD, observe=observed, workers=1)
    fields, size = found.layout["result"], found.layout["result"]["size"]
    results = found.array("results", np.uint8).reshape(COLUMNS, size)
    period = results[:, fields["period"][0] :][:, :4].copy().view("i4")[:, 0]
    status = results[:, fields["status"][0]].view("i1")
    periodic = (data.period.values > 0) & (period > 0)
    assert (status == data.status.values)[periodic].all()
    for name in [
        f"{what}_{side}" for what in ("impacts", "contacts") for side in ("left", "right") if what in observed
    ]:
        counted = found.array("results", np.uint8).view(result_of(kind.masses))[name]
        assert (counted == data[name].values)[periodic & (period == data.period.values)].all(), name
    assert (period == data.period.values).mean() > 0.9 and periodic.sum() > COLUMNS / 4
    gap = found.array("sections").reshape(COLUMNS, RECORD, -1)[..., 0]
    wanted, last = data.x1.values, RECORD - data.period.values
    same = [
        np.abs(gap[i, last[i] :] - wanted[i, last[i] :]).max()
        for i in np.flatnonzero(periodic & (period == data.period.values))
    ]
    assert np.quantile(same, 0.9) < 1e-10
