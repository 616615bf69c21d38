"""The package as a user meets it at a prompt: names, help, types, and what is shown of objects."""

import contextlib
import inspect
import io
import pydoc
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import vibro_sweep as vs

NUMBERS = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
SYSTEM = vs.System(**NUMBERS)
SCENE = "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}\norbit: {transient: 5, record: 4}\n"

USER_SCRIPT = '''
"""Touches every public name, as a script of a careful user would."""

from pathlib import Path
from typing import Any, Literal

import numpy as np
import vibro_sweep as vs
from vibro_sweep.types import Branch, PeriodicOrbit, Scene

system: vs.System = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6, tau="grazing", stops="both")
physical = vs.System.physical(
    M1=np.float64(1), M2=10, K1=1, K2=5, C1=0.1, C2=0.5, P1=1, P2=0, Omega=0.63, R=0.8, B=6, stops="right"
)
wider = system.replace(b=6.7)
clearance: float = vs.grazing(system).b
orbit = vs.simulate(system, (0.0, 0.0, 0.0, 0.0), periods=10)
section: np.ndarray = orbit.section
times = orbit.impacts["t"]
orbit.plot(periods=2).savefig("orbit.png")
print(orbit.to_xarray().attrs, orbit.sample([1.0]), orbit.status.note, orbit.sticking)
spectrum = vs.lyapunov(system, (0, 0, 0, 0), transient=10, record=100)
residual: float = spectrum.residual
print(spectrum.error.max(), spectrum[0])
mapping = vs.discontinuity_map(system, order=2)
print(mapping((6.7, 0, 3, 0)) + mapping.jacobian((6.7, 0, 3, 0))[0])
scene = vs.load_scene(Path("scene.yaml")).replace(record=5)
text: str = scene.to_yaml()
mode: Literal["new", "resume", "overwrite"] = "overwrite"
assert isinstance(scene, Scene)
seconds: float = vs.estimate(scene, workers=1).seconds
report = vs.run(scene, "sweep.h5", workers=1, mode=mode)
bad: int = report.bad
with vs.open("sweep.h5") as data:
    figure = vs.plot(data, "bifurcation")
    figure.savefig("figure.png")
    vs.plot(data, xlim=(6.5, 6.9), size=(5, 3), dpi=80, output="zoom.png", overwrite=True)
    print(len(vs.windows(data, "b", output="windows.h5", workers=1, mode="overwrite")))
for window in vs.windows("sweep.h5"):
    print(window.lo, window.lower.type, window.hi, window.upper.error, window.period, window.orbit.stable)
found = vs.sweep(system, {"b": np.linspace(6.5, 6.6, 3)}, transient=10, record=4)
print(found.lyapunov)
page = vs.explore(system, "b", bounds=(6.5, 6.7))
print(page.url)
page.close()
file: Path = vs.page(system, "diagram.html", bounds=(6.5, 6.7))
print(file.name)
periodic = vs.periodic_orbit(system.replace(b=6.9), state=(0, 0, 0, 0))
periodic.save("orbit.json")
again = vs.load("orbit.json")
assert isinstance(again, PeriodicOrbit)
print(vs.open("orbit.json").attrs["kind"], again.to_xarray(), again.to_dataframe().t.max())
print(vs.quiet(system, "b", (6.6, 7.0)).ranges)
branch = vs.continue_orbit(again, "b", (6.6, 7.0))
loaded = vs.load(branch.save("branch.h5"))
print(isinstance(loaded, Branch), branch.to_dataframe(), vs.plot(branch, variable="multiplier"))
for special in branch.special:
    if special.type == "graze":
        print(vs.switch(special), vs.sticking_onset(special))
        curve = vs.bifurcation_curve(special, ("b", "omega"), ((6, 7), (0.6, 0.7)))
        print(curve.points.b, curve.closed, curve.begins.type, [one.parameters["omega"] for one in curve.special])
print([one.itinerary for one in vs.born_at_grazing(system, periods=1)])
print(len(vs.follow_branches(again, "b", (6.6, 7.0), depth=1)))
given: dict[str, Any] = dict(rayleigh=(0.1, 0), force=[1, 0], contact_normal=[1, -1], omega=0.8, b=1, R=0.7)
pair = vs.Oscillator([[1, 0], [0, 2]], np.eye(2), **given)
print(vs.grazing(pair).b_right, vs.simulate(pair.replace(b=0.5), (0, 0, 0, 0), periods=2).impacts["xdot"])
wall = vs.Contact([1, 0], b=1.0, R=0.7, stops="right")
print(vs.Oscillator([[1, 0], [0, 2]], np.eye(2), force=[1, 0], omega=0.8, contacts=[wall]).contacts)
try:
    vs.System(mu_m=-1, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
except vs.ParameterError as error:
    print(error.key, error.value, error.allowed)
errors = (vs.VibroSweepError, vs.SceneError, vs.StoreError, vs.PlotError, vs.RunError)
'''


def test_names():
    names = [name for name in dir(vs) if not name.startswith("__")]
    assert names == vs.__all__ == sorted(vs.__all__)
    assert all(getattr(vs, name).__module__.startswith("vibro_sweep.") for name in names)
    assert {"__version__", "__doc__", "__file__"} <= set(dir(vs))


def test_help_has_every_function():
    shown = io.StringIO()
    with contextlib.redirect_stdout(shown):
        pydoc.Helper(output=shown)(vs)
    text = pydoc.plain(shown.getvalue())
    for name in vs.__all__:
        kind = "class" if inspect.isclass(getattr(vs, name)) else name
        assert f"    {kind}" in text and name in text, name
    assert "TYPE_CHECKING" not in text.split("DATA")[0] and "import_module" not in text


def test_every_public_object_says_what_it_raises_or_returns():
    for name in vs.__all__:
        assert inspect.getdoc(getattr(vs, name)), name


@pytest.mark.slow
def test_mypy_of_a_users_script(tmp_path):
    pytest.importorskip("mypy")
    for name in vs.__all__:
        assert f"vs.{name}" in USER_SCRIPT, name
    script = tmp_path / "script.py"
    script.write_text(USER_SCRIPT)
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), str(script)]
    path = {"MYPYPATH": "", "PATH": "/usr/bin:/bin"}
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, env=path, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    wrong = USER_SCRIPT.replace('stops="right"', 'stops="rihgt"').replace("mode=mode", 'mode="owerwrite"')
    script.write_text(wrong + "vs.sweeep\n")
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, env=path, check=False)
    for word in ("rihgt", "owerwrite", "sweeep"):
        assert word in done.stdout, done.stdout


@pytest.mark.slow
def test_the_users_script_runs(tmp_path):
    (tmp_path / "scene.yaml").write_text(SCENE + "sweep: {b: {values: [6.5, 6.6]}}")
    script = tmp_path / "script.py"
    script.write_text(USER_SCRIPT)
    done = subprocess.run([sys.executable, script], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "figure.png").stat().st_size > 1000 and (tmp_path / "orbit.png").stat().st_size > 1000


def test_reprs_are_short(tmp_path):
    orbit = vs.simulate(SYSTEM, (0, 0, 0, 0), periods=100)
    (tmp_path / "scene.yaml").write_text(SCENE + "sweep: {b: {start: 5, stop: 6, num: 1000}}")
    scene = vs.load_scene(tmp_path / "scene.yaml")
    for one in (orbit, scene, vs.discontinuity_map(SYSTEM), SYSTEM, vs.grazing(SYSTEM), orbit.status):
        assert 3 < len(repr(one)) <= 400, repr(one)
    assert "100 forcing periods" in repr(orbit) and "'ok'" in repr(orbit)
    assert "b = 5 .. 6 (1,000 values)" in repr(scene)
    assert "order 1" in repr(vs.discontinuity_map(SYSTEM))


def test_errors():
    for error in (vs.ParameterError, vs.SceneError, vs.StoreError, vs.PlotError):
        assert issubclass(error, ValueError)
    assert issubclass(vs.RunError, RuntimeError)


def test_a_missing_file(tmp_path):
    for kind in (FileNotFoundError, vs.StoreError):
        with pytest.raises(kind, match=r"none\.h5: there is no such file"):
            vs.open(tmp_path / "none.h5")
    with pytest.raises(FileNotFoundError) as caught:
        vs.open(str(tmp_path / "none.h5"))
    assert caught.value.filename == str(tmp_path / "none.h5")


@pytest.mark.parametrize("kind", [np.float64, np.float32, np.int64, np.float16])
def test_physical_system_from_numpy_numbers(kind):
    given = dict(M1=1, M2=10, K1=1, K2=5, C1=2, C2=10, P1=1, P2=0, Omega=3, R=1, B=6)
    assert vs.System.physical(**{name: kind(value) for name, value in given.items()}) == vs.System.physical(**given)


def test_py_typed_is_in_the_package():
    assert (Path(vs.__file__).parent / "py.typed").exists()


def test_an_orbit_waits_for_no_slow_import():
    """What draws, and splines, is imported when something is drawn."""
    code = "import sys, vibro_sweep as vs; vs.simulate, vs.periodic_orbit; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"matplotlib", "scipy.interpolate", "pandas", "xarray", "h5py"} & {*done.stdout.split()}
