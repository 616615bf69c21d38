"""Units of what was given in SI: in labels of every kind of picture, and in files."""

import copy
import re

import numpy as np
import pytest
from support.figures import made
from support.programs import main

import vibro_sweep as vs

PHYSICAL = vs.System.physical(M1=2, M2=8, K1=2000, K2=10_000, C1=5, C2=25, P1=10, P2=0, Omega=26.0, R=0.7, B=0.012)
CHAIN = vs.Oscillator.named(
    "chain", m=[2, 8], k=[0, 2000, 10_000], c=[0, 5, 25], force=[10, 0], omega=26.0, R=0.7, b=0.012, units="SI"
)
WORDS = ["section", "lyapunov", "impacts", "energy", "convergence"]
SHORT = {"transient": 60, "record": 8}
MOTION = {"observe": WORDS, "trajectory": {"periods": 1, "samples": 5}} | SHORT


BALL = {"zeta": 0.1, "F": 1, "omega": 1, "b": 1, "k_stop": 2, "c_stop": 1, "preload": 0.1}
OBSERVED = {"lyapunov": ["lyapunov"], "impact_power": ["energy"]}


@pytest.mark.parametrize(
    ("name", "units", "told", "shown"),
    [
        ("x1", (2, 0.005, 0.1), "0.005 m", " [5 mm]"),
        ("v1", (2, 0.5, 0.1), "5.0 m s-1", " [5 m/s]"),
        ("omega", (2, 0.5, 0.25), "4.0 rad s-1", " [4 rad/s]"),
        ("lyapunov", (2, 0.5, 0.25), "4.0 s-1", " [4/s]"),
        ("impact_power", (2, 0.5, 0.5), "4.0 W", " [4 W]"),
        ("k_stop", (2, 0.5, 0.5), "8.0 N m-1", " [8 N/m]"),
        ("c_stop", (2, 0.5, 0.5), "4.0 N s m-1", " [4 N s/m]"),
        ("x1", (2, 0.001, 0.1), "0.001 m", " [mm]"),
        ("impact_power", (1, 0.001, 1), "1e-06 W", " [\N{MICRO SIGN}W]"),
        ("x1", (1, 0.9999999e-3, 1), "0.0009999999 m", " [mm]"),
        ("x1", (1, 0.9, 1), "0.9 m", " [900 mm]"),
        ("preload", (1000, 0.001, 1), "N", " [N]"),
        ("lyapunov", (2, 0.5, 1.0000000000000002), "0.9999999999999998 s-1", " [1/s]"),
        ("impact_power", (1e-200, 1e-99, 1e-150), "1e+52 W", " [1e+52 W]"),
        ("v1", (1, 1e-300, 1e300), "1", ""),
        ("impact_power", (1, 1e300, 1), "1", ""),
        ("x1", "SI", "m", " [m]"),
        ("lyapunov", "SI", "s-1", " [1/s]"),
        ("k_stop", "SI", "N m-1", " [N/m]"),
        ("tau", (2, 0.5, 0.5), "rad", ""),
        ("F", "SI", "N", " [N]"),
        ("period", "SI", "1", ""),
        ("v1", None, "1", ""),
        ("omega", None, "1", ""),
    ],
)
def test_a_unit(name, units, told, shown):
    """As the data have it, and as a label shows it."""
    system = vs.Oscillator.named("one_mass", **BALL, units=units)
    axis = {name if name in {*BALL, "tau"} else "b": [1.0, 1.5]}
    observe = OBSERVED.get(name, ["section"])
    assert vs.sweep(system, axis, observe=observe, transient=0, record=2)[name].attrs["units"] == told
    assert label_of(told) == "$x_1$" + shown


def label_of(units) -> str:
    """Of a coordinate with these units."""
    data = made({}, {"x1": np.arange(9.0)})
    data.x1.attrs |= {} if units is None else {"units": units}
    return vs.plot(data, "iteration").axes[0].get_ylabel()


@pytest.mark.parametrize("text", [None, "", "nondimensional", "$x$", r"\frac", "m" * 100])
def test_what_has_no_place_in_a_label(text):
    assert label_of(text) == "$x_1$"


def test_they_belong_to_the_system():
    assert PHYSICAL.units == (2.0, 10 / 2000, np.sqrt(2 / 2000)) and CHAIN.units == (1, 1, 1)
    for system in (PHYSICAL, CHAIN):
        for other in (system.replace(b=0.02), copy.deepcopy(system)):
            assert other.units == system.units
    assert eval(repr(PHYSICAL), {"System": vs.System}) == PHYSICAL
    assert vs.System(**{name: getattr(PHYSICAL, name) for name in PHYSICAL.numbers}).units is None


def test_of_numbers_that_others_decide():
    common = {"M": [[2]], "K": [[3]], "force": [1], "contact_normal": [1], "omega": 1, "b": 1, "R": 0.7, "units": "SI"}
    powers = {0: "N", 1: "kg m s-1", 2: "kg m", 0.5: "1"}
    for power, unit in powers.items():
        assert vs.Oscillator(**common, force_power=power).described["force1"].units == unit
    ball = {"zeta": 0.1, "F": 1, "omega": 1, "R": 0.5, "b": 1}
    assert vs.Oscillator.named("one_mass", **ball).described["F"].units == "N"
    assert vs.Oscillator.named("one_mass", **ball, base=True).described["F"].units == "m"


def factor(units: str) -> float:
    return float(first) if re.match(r"[\d.]", first := units.split()[0]) else 1.0


@pytest.fixture(scope="module")
def both():
    """One oscillator in nondimensional numbers with units, and in SI."""
    hertz = np.array([24.0, 26.0])
    one = vs.sweep(PHYSICAL, {"omega": hertz * PHYSICAL.units.s}, **MOTION)
    return one, vs.sweep(CHAIN, {"omega": hertz}, **MOTION)


@pytest.mark.slow
def test_the_same_motion_in_two_units(both):
    one, other = both
    units = {name: re.sub(r"^[\d.e-]+ ", "", values.attrs["units"]) for name, values in one.variables.items()}
    assert {"m", "m s-1", "s-1", "W", "s", "rad s-1", "rad", "1"} == {*units.values()}
    for name, values in one.variables.items():
        if values.dtype.kind == "f" and "error" not in name and "residual" not in name and name != "lyapunov_running":
            assert other[name].attrs["units"] == units[name]
            in_si = factor(values.attrs["units"]) * values.values
            np.testing.assert_allclose(in_si, other[name].values, rtol=1e-6, atol=1e-9, err_msg=name)


LABELS = {
    "bifurcation": ["rad/s", "m", "1/s"],
    "lyapunov": ["rad/s", "1/s"],
    "impacts": ["rad/s"],
    "energy": ["rad/s", "W", "m"],
    "phase-portrait": ["m", "m/s"],
    "configuration": ["m"],
    "history": ["m"],
    "iteration": ["m"],
    "poincare": ["m", "m/s"],
    "convergence": ["1/s"],
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", LABELS)
def test_labels(both, kind):
    physical, chain = both
    assert {*units_in(vs.plot(chain, kind))} == {*LABELS[kind]}
    length = {"m": "5 mm", "m/s": "158.1 mm/s", "rad/s": "31.62 rad/s", "1/s": "31.62/s", "W": "1.581 W"}
    assert {*units_in(vs.plot(physical, kind))} == {length[one] for one in LABELS[kind]}
    without = physical.copy()
    for values in without.variables.values():
        values.attrs["units"] = "1"
    assert not units_in(vs.plot(without, kind))


def units_in(figure) -> list[str]:
    labels = [text for ax in figure.axes for text in (ax.get_xlabel(), ax.get_ylabel())]
    return [unit for text in labels for unit in re.findall(r" \[(.*)\]$", text)]


@pytest.mark.slow
def test_planes_and_basins():
    plane = vs.sweep(CHAIN, {"omega": [20.0, 24.0], "b": [0.01, 0.02]}, observe=["section", "lyapunov"], **SHORT)
    figure = vs.plot(plane)
    assert {*units_in(figure)} == {"rad/s", "m"} and "[1/s]" in figure.axes[2].get_xlabel()
    basins = vs.sweep(CHAIN, {"x1": [0.0, 0.01], "v1": [0.0, 0.01]}, observe=["section", "attractors"], **SHORT)
    assert units_in(vs.plot(basins)) == ["m", "m/s"]


@pytest.mark.slow
def test_orbits_branches_and_curves():
    system = PHYSICAL.replace(b=2.4)
    orbit = vs.periodic_orbit(system, itinerary="LR")
    assert units_in(orbit.plot()) == ["5 mm", "158.1 mm/s", "31.62 ms", "5 mm"]
    branch = vs.continue_orbit(orbit, "b", (1.5, 3.6))
    pitchfork = next(one for one in branch.special if one.type == "pitchfork")
    curve = vs.bifurcation_curve(pitchfork, ("b", "omega"), ((2.0, 3.6), (0.8, 0.95)))
    assert units_in(curve.plot()) == ["5 mm", "31.62 rad/s"]
    simulated = vs.simulate(CHAIN, np.zeros(4), 5)
    assert units_in(simulated.plot()) == ["m", "m/s", "s", "m"]
    assert simulated.to_xarray().t.attrs["units"] == "s"


NUMBERS = "m: [2, 8], k: [0, 2000, 10000], c: [0, 5, 25], force: [10, 0], omega: 28.27, R: 0.7, b: 0.012"
SCENE = f"""
system: {{type: chain, {NUMBERS}, units: SI}}
continue: {{from: {{itinerary: LR, periods: 1}}, parameter: ALONG, of: [pitchfork], depth: 0}}
"""


@pytest.mark.slow
def test_files_of_branches_and_curves(tmp_path):
    for along, values in (
        ("{b: [0.01, 0.018]}", "m"),
        ("{b: [0.0075, 0.018], omega: [25.3, 30]}", "1"),
    ):
        scene = tmp_path / f"{values}.yaml"
        text = SCENE.replace("ALONG", along)
        scene.write_text(text if values == "1" else text.replace(", of: [pitchfork], depth: 0", ""))
        assert main(["run", str(scene), "-o", str(tmp_path / f"{values}.h5"), "--quiet"]) == 0
        with vs.open(tmp_path / f"{values}.h5") as data:
            assert [data[name].attrs["units"] for name in ("b", "x1", "v1", "impact_t")] == ["m", "m", "m s-1", "s"]
            assert data["special_value"].attrs["units"] == values == data["special_error"].attrs["units"]
            expected = ["m", "m"] if values == "m" else ["m", "rad/s"]
            assert units_in(vs.plot(data)) == expected == units_in(vs.plot(tmp_path / f"{values}.h5"))


@pytest.mark.slow
def test_windows(tmp_path):
    vs.sweep(CHAIN, {"omega": [27.0, 27.1]}, observe=["section"], output=tmp_path / "s.h5", **SHORT)
    assert main(["windows", str(tmp_path / "s.h5"), "-o", str(tmp_path / "w.h5"), "--quiet"]) == 0
    with vs.open(tmp_path / "w.h5") as data:
        assert {data[name].attrs["units"] for name in ("window_lo", "window_hi", "omega", "unvisited_at")} == {
            "rad s-1"
        }


@pytest.mark.slow
def test_functions():
    """Of the user's own: their results have units if these are the same at all corners of the sweep."""
    physical = {"M1": 2, "M2": 8, "K1": 2000, "K2": 10_000, "C1": 5, "C2": 25, "P1": 10, "P2": 0, "Omega": 26, "R": 0.7}

    def gap(mm):
        return vs.System.physical(**physical, B=mm / 1000)

    def mass(M1):
        return vs.System.physical(**physical | {"M1": M1}, B=0.012)

    for function, axis, unit in ((gap, {"mm": [11, 12]}, "0.005 m"), (mass, {"M1": [2, 3]}, "1")):
        data = vs.sweep(function, axis, observe=["section"], transient=0, record=1)
        assert data.x1.attrs["units"] == unit and data[next(iter(axis))].attrs["units"] == "1"


def test_they_are_in_the_text_of_a_scene():
    data = vs.sweep(PHYSICAL, {"b": [2.0, 2.1]}, observe=["section"], transient=0, record=1)
    assert "units: [2, 0.005, 0.03162277660168379]" in data.attrs["scene"] and "units" not in data.attrs


@pytest.mark.slow
def test_limits_of_a_frequency_are_said_in_hertz_too():
    system = vs.Oscillator.named("one_mass", zeta=0.1, F=1, omega=6, R=0.5, b=1, units="SI")
    data = vs.sweep(system, {"omega": [2 * np.pi, 4 * np.pi]}, transient=2, record=2)
    with pytest.raises(vs.PlotError, match=r"has omega from 6.28319 to 12.5664 \[rad/s\], which is 1 to 2 Hz"):
        vs.plot(data, xlim=(1, 2))
    with pytest.raises(vs.PlotError, match=r"'Hz' is no axis here; allowed: omega \[rad/s\]"):
        vs.plot(data, "iteration", at={"Hz": 1})


def test_orbits_in_other_units():
    """Whatever the system has: numbers, names of axes and the title; the force and its law as well."""
    soft = dict(stop_right=1.5e-3, contact_normal=1, k_stop=1.8e5, c_stop=45)
    lever = vs.Oscillator(2.4, 9500, 3, force=40, frequency=10, units="SI", **soft)
    orbit = vs.simulate(lever, None, 60)
    one, other = orbit.plot(kind="contact-force"), vs.plot(orbit, kind="contact-force", units="mm, ms, kN")
    assert [ax.get_xlabel() for ax in other.axes] == ["time $t$ [ms]", "$x_1$ [mm]"]
    assert other.axes[0].get_ylabel() == "force of the stop [kN]" and "b = 1.5 mm" in other.get_suptitle()
    for before, after, across, up in zip(one.axes, other.axes, (1e3, 1e3), (1e-3, 1e-3), strict=True):
        for line, scaled in zip(before.lines, after.lines, strict=True):
            if line.get_label().endswith("stop") and len(line.get_xdata()) > 2:
                np.testing.assert_allclose(scaled.get_xdata(), across * np.asarray(line.get_xdata()), rtol=1e-12)
                np.testing.assert_allclose(scaled.get_ydata(), up * np.asarray(line.get_ydata()), rtol=1e-9, atol=1e-12)
    portrait = vs.periodic_orbit(lever, itinerary="R").plot(units="mm, ms").axes[0]
    assert (portrait.get_xlabel(), portrait.get_ylabel()) == ("gap [mm]", "gap velocity [mm/ms]")
    with pytest.raises(ValueError, match="units: 'mm' is not allowed; it must be left out"):
        vs.simulate(lever.replace(units=None), None, 5).plot(units="mm")
