"""How many edits something new takes: made in a copy of the package, as docs/development/architecture.md says."""

import json
import os
import re
import shutil
import subprocess
import sys

import pytest
from support import ROOT

pytestmark = pytest.mark.slow
BEGIN = """
import json
import numpy as np
import vibro_sweep as vs
given = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8)
system = vs.System(**given, b=3.0)
"""
FOLLOW = """
branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary="LR"), "b", (0.3, 6.8))
special = [(one.type, one.parameters["b"], float(one.orbit.impacts["v1"][0])) for one in branch.special]
"""
SWEEP = """
def swept(system, axis):
    return vs.sweep(system, axis, transient=300, record=40, observe=["section", "lyapunov", "impacts"])
def apart(one, other):
    return max(float(np.abs(one[name] - other[name]).max()) for name in ("x1", "v2", "lyapunov"))
"""
PARAMETER = (
    SWEEP
    + """
near = vs.System(**given, b=1.2, mu_g=0.5)
q = near.linear
by_matrices = vs.Oscillator(q.M, q.K, q.C, force=[1, 0], contact_normal=[1, 0], omega=0.63, R=0.8, b=1.2)
data = swept(near, {"mu_g": [0.0, 0.5]})
errors = [apart(data.isel(mu_g=1), swept(by_matrices, {"b": [1.2]}).isel(b=0))]
errors += [apart(data.isel(mu_g=0), swept(system, {"b": [1.2]}).isel(b=0))]
errors += [abs(float(data.b_star[1]) - vs.grazing(by_matrices).b), abs(vs.grazing(near).b - vs.grazing(by_matrices).b)]
branch = vs.continue_orbit(vs.periodic_orbit(near, itinerary="LR"), "mu_g", (0.3, 0.7))
special = [errors, branch.points.sizes["point"] > 2, vs.System.physical.__doc__ is not None, "mu_g" in str(near)]
"""
)
OBSERVABLE = (
    SWEEP
    + """
data = swept(system.replace(R=0.3), {"b": [0.2, 3.0]})
special = [data.chatters.values.tolist(), data.chatters.attrs["description"], data.chatters.dtype.str]
"""
)
MODEL = (
    SWEEP
    + """
seesaw = vs.Oscillator.named("pendulum", length=2.0, omega=0.9, R=0.7, b=0.3)
mass = vs.Oscillator.named("one_mass", k=0.5, zeta=0.0, F=1, omega=0.9, R=0.7, b=0.3, tau=0.0)
data = swept(seesaw.replace(tau=0.0), {"length": [1.0, 2.0]}).isel(length=1)
other = swept(mass, {"b": [0.3]}).isel(b=0)
special = [float(np.abs(data.x1 - other.x1).max()), seesaw.named("pendulum", **seesaw.arguments) == seesaw]
"""
)
PICTURE = (
    SWEEP
    + """
import vibro_sweep.plotting.plot
from matplotlib.figure import Figure
from vibro_sweep.scene import json_schema
data = swept(system, {"b": [2.0, 3.0, 4.0]})
figure = vs.plot(data, "periods", xlim=(2, 4), output="periods.svg")
into = Figure().subplots()
vs.plot(data, "periods", into)
special = [figure.axes[0].get_xlabel(), len(figure.axes[0].lines), len(into.lines), into.get_legend() is not None]
special += [vibro_sweep.plotting.plot.kinds(data)[-1], "periods" in str(json_schema())]
"""
)
PERIODS = '''"""The periods of orbits over a parameter."""

from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.kind import picture
from vibro_sweep.plotting.labels import legend_below


def shows(result: DrawnSweep) -> bool:
    """A sweep over one key; section."""
    return len(result.sweep) == 1 and "period" in result


@picture(shows)
def periods(result: DrawnSweep) -> Panels:
    """The period of each orbit."""
    ((key, values),) = result.sweep.items()

    def draw(axes):
        lines = axes[0, 0].plot(values, result.array("period")[:, 0], "o", label="period")
        axes[0, 0].set(xlabel=result.axis(key), ylabel="period")
        legend_below(axes, lines, 1)

    return Panels(result.title("Periods"), 3.0, draw)
'''
TABLE, TESTS = "tables/bifurcations.py", "engine/continuation/branch_tests.py"
SPEEDS = {"slow": 0.2, "fast": 0.25}
PENDULUM = '''"""A pendulum that strikes walls: one number, its length."""

import numpy as np

from vibro_sweep.oscillator.linear import Linear, contact
from vibro_sweep.oscillator.models.declaration import CONTACT, OF_STOPS, UNITS, WHICH_STOPS, Model
from vibro_sweep.oscillator.stacks import matrix
from vibro_sweep.tables.quantity import POSITIVE, Parameter


def pendulum(*, length, omega, tau, **stops) -> Linear:
    return Linear(
        M=matrix([[1]]), K=matrix([[1 / np.asarray(length)]]), C=np.zeros((1, 1)),
        constant=np.zeros(1), sine=np.ones(1), cosine=np.zeros(1), omega=omega,
        tau=None if isinstance(tau, str) else tau, contacts=[contact(np.ones(1), **stops)],
    )


MODEL = Model(
    name="pendulum", title="a pendulum between two walls", sketch="", equations="", source="", masses=lambda given: 1,
    numbers=(Parameter("length", "length", "length", "l", "m", POSITIVE, free_motion=True), *CONTACT),
    options=(WHICH_STOPS, *OF_STOPS, UNITS), build=pendulum,
)
'''


def edited(folder, edits, files=()):
    """A copy of the package with these edits; files : added, as path and text"""
    shutil.copytree(ROOT / "vibro_sweep", folder / "vibro_sweep", ignore=shutil.ignore_patterns("__pycache__"))
    for name, old, new in edits:
        path = folder / "vibro_sweep" / name
        text = path.read_text()
        assert text.count(old) == 1
        path.write_text(text.replace(old, new))
    for name, text in files:
        (folder / "vibro_sweep" / name).write_text(text)


def found(folder, program):
    """What a program finds with the package in this folder."""
    (folder / "program.py").write_text(BEGIN + program + "print(json.dumps([special, vs.__file__]))")
    environment = os.environ | {"PYTHONPATH": str(folder), "NUMBA_CACHE_DIR": str(folder / "kernels")}
    done = subprocess.run([sys.executable, "program.py"], cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    special, where = json.loads(done.stdout)
    assert where.startswith(str(folder))
    return special


def parameter():
    """A spring from the first mass to the ground."""
    table, last = "oscillator/models/two_mass.py", '              free_motion=True, optional=True, follows="mu_k"),\n'
    row = '    Parameter("mu_g", "third spring", "", "g", "1", NOT_NEGATIVE, default=0.0, free_motion=True),\n'
    return [
        (table, last, last + row),
        (table, "tau, mu_c=None, **stops", "tau, mu_c=None, mu_g=0.0, **stops"),
        (table, "K=matrix([[1, -1], [-1, 1 + mu_k]])", "K=matrix([[1 + mu_g, -1], [-1, 1 + mu_k]])"),
    ]


def observable():
    """Its row stands in the architecture page."""
    row, line = '    _impacts("sticking_time",', "    result.sticking_time = o.rest_time\n"
    new = '    _impacts("chatters", "chatter sequences", "chatter sequences that end in sticking", dtype="i8"),\n'
    added = "    result.chatters = o.chatters\n"
    return [("tables/observables.py", row, new + row), ("engine/observed/observe.py", line, line + added)]


def kind_of_picture():
    row = '    "convergence": "convergence.convergence",\n'
    return [("tables/picture_kinds.py", row, row + '    "periods": "periods.periods",\n')]


def passed_speeds():
    row, line = '    Bifurcation("closed", ', "    x[TEST.above] = -1.0\n"
    rows = "".join(f'    Bifurcation("{name}", "the first impact has this speed", test="{name}"),\n' for name in SPEEDS)
    tests = "".join(f"    x[TEST.{name}] = abs(b.events[0].motion[0]) - {value}\n" for name, value in SPEEDS.items())
    return [(TABLE, row, rows + row), (TESTS, line, line + tests)]


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """A copy with all that is added here, so that its kernels are compiled once."""
    folder = tmp_path_factory.mktemp("package")
    edits = [*parameter(), *observable(), *kind_of_picture(), *passed_speeds()]
    edited(folder, edits, [("oscillator/models/pendulum.py", PENDULUM), ("plotting/periods.py", PERIODS)])
    return folder


def test_a_parameter_is_a_row_and_a_formula(package):
    errors, *seen = found(package, PARAMETER)
    assert max(errors) < 1e-11 and seen == [True] * 3


def test_an_observable_is_a_row_and_a_line(package):
    counts, text, kind = found(package, OBSERVABLE)
    assert counts[0] >= 40 and counts[1] == 0 and (text, kind) == ("Chatter sequences that end in sticking.", "<i8")


def test_a_model_is_one_file(package):
    error, same = found(package, MODEL)
    assert error < 1e-9 and same


def test_a_picture_is_a_function_and_a_row(package):
    label, *drawn, last, in_schema = found(package, PICTURE)
    assert label == "clearance $b$" and drawn == [1, 1, True] and last == "periods" and in_schema
    assert (package / "periods.svg").stat().st_size > 1000


def test_a_speed_that_an_impact_passes_is_a_row_and_a_line(package):
    special = found(package, FOLLOW)
    assert [kind for kind, *_ in special] == ["graze", "fast", "slow", "pitchfork", "graze"]
    assert special[2][2] / special[1][2] == pytest.approx(0.8, rel=1e-12)


def test_a_pitchfork_is_taken_out_of_the_table_alone(tmp_path):
    text = (ROOT / "vibro_sweep" / TABLE).read_text()
    rows = [
        re.search(begin, text, re.DOTALL)[0]
        for begin in (
            r' {4}Bifurcation\("pitchfork".*?\),\n(?= {4}B)',
            r' {4}Point\("pitchfork_graze".*?\),\n(?= {4}P)',
        )
    ]
    edited(tmp_path, [(TABLE, row, "") for row in rows])
    assert [kind for kind, *_ in found(tmp_path, FOLLOW)] == ["graze", "graze"]
