"""Units by their names, a frequency in place of omega, where the stops stand: given, shown, and read back."""

import numpy as np
import pytest
from support.programs import ended

import vibro_sweep as vs
from vibro_sweep.types import Units

LEVER = dict(m=[2.4], k=[9500, 0], c=[3, 0], force=[40], k_stop=180000, c_stop=45, units="SI")
ORBIT = dict(transient=300, record=20, observe=["section", "contacts"])


@pytest.mark.parametrize(
    "names, sizes",
    [
        ({"mass": "kg", "length": "mm", "time": "s"}, (1, 1e-3, 1)),
        ({"length": "mm", "force": "N", "time": "s"}, (1e3, 1e-3, 1)),
        ({"mass": "g", "length": "mm", "time": "ms"}, (1e-3, 1e-3, 1e-3)),
        ({"mass": "t", "force": "kN", "time": "s"}, (1e3, 1, 1)),
        ({"mass": "kg", "length": "mm", "force": "N"}, (1, 1e-3, np.sqrt(1e-3))),
    ],
)
def test_units_by_name(names, sizes):
    mass = vs.Oscillator(1, 1, 0.1, force=1, contact_normal=1, omega=1, R=0.7, b=1, units=names)
    assert np.allclose(mass.units, sizes, rtol=1e-15)


@pytest.mark.parametrize(
    "names",
    [{"mass": "kg", "length": "mm"}, {"mass": "mm", "length": "kg", "time": "s"}, {"mass": "kg", "length": "furlong",
     "time": "s"}, {"mass": "kg", "length": "mm", "time": "s", "force": "N"}, {"area": "m", "mass": "kg", "time": "s"}],
)  # fmt: skip
def test_what_are_no_units(names):
    with pytest.raises(vs.ParameterError, match=r"units: .* is not allowed"):
        vs.Oscillator(1, 1, 0.1, force=1, contact_normal=1, omega=1, R=0.7, b=1, units=names)


@pytest.mark.parametrize("make", [lambda **more: vs.Oscillator.named("chain", **LEVER, b=1.5e-3, stops="right", **more),
                                  lambda **more: vs.System(10, 5, 0.05, 0, R=0.8, b=4, **more)])  # fmt: skip
def test_a_frequency_is_omega_over_two_pi(make):
    system = make(frequency=10)
    assert system.omega == 2 * np.pi * 10 and abs(system.frequency - 10) < 1e-14
    assert system == make(omega=2 * np.pi * 10) and system.replace(frequency=12) == system.replace(omega=24 * np.pi)
    with pytest.raises(
        vs.ParameterError, match="frequency: 10 is not allowed; it must be left out where omega is given"
    ):
        make(frequency=10, omega=3)


def test_a_frequency_among_physical_quantities():
    numbers = dict(M1=2, M2=8, K1=2000, K2=10000, C1=5, C2=25, P1=10, P2=0, R=0.7, B=0.012)
    assert vs.System.physical(**numbers, frequency=4.5) == vs.System.physical(**numbers, Omega=9 * np.pi)


def test_stops_by_their_positions():
    paper = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8)
    both = vs.System(**paper, stop_left=-4, stop_right=6)
    assert (both.b, both.offset, both.stops) == (5, 1, "both")
    assert both.positions == {"stop_right": 6, "stop_left": -4}
    assert both.replace(stop_right=8).positions == {"stop_right": 8, "stop_left": -4}  # the other one stays
    for side, other, sign in (("right", "left", 1), ("left", "right", -1)):
        alone = vs.System(**paper, **{f"stop_{side}": sign * 2.5})
        assert (alone.b, alone.stops, alone.positions) == (2.5, side, {f"stop_{side}": sign * 2.5})
        assert alone.replace(**{f"stop_{other}": -sign * 1.0}).stops == "both"
    with pytest.raises(vs.ParameterError, match="stop_right: 3 is not allowed; it must be left out where b is given"):
        vs.System(**paper, b=1, stop_right=3)
    with pytest.raises(vs.ParameterError, match="above stop_left"):
        vs.System(**paper, stop_left=2, stop_right=1)


def test_a_sweep_over_the_frequency_is_one_over_omega(tmp_path):
    """Its numbers have the bits of a sweep over these omega, and its file has both coordinates."""
    system = vs.Oscillator.named("chain", **LEVER, stop_right=1.5e-3, frequency=5)
    hertz = np.array([6.0, 8.0, 11.0])
    data = vs.sweep(system, {"frequency": hertz}, **ORBIT)
    other = vs.sweep(system, {"omega": 2 * np.pi * hertz}, **ORBIT)
    assert data.x1.dims == ("frequency", "sample") and data.frequency.attrs["units"] == "Hz"
    assert np.array_equal(data.omega, other.omega) and data.omega.dims == ("frequency",)
    for name in ("x1", "v1", "period", "contact_force_max", "status"):
        assert np.array_equal(data[name].values, other[name].values), name
    assert "omega" not in data.attrs and "frequency" not in data.attrs
    (tmp_path / "again.yaml").write_text(data.attrs["scene"])
    assert np.array_equal(vs.load_scene(tmp_path / "again.yaml").sweep["frequency"], hertz)


def test_branches_and_curves_along_the_frequency():
    """The same special points as along omega, over 2 pi."""
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, frequency=0.1, R=0.8, b=4)
    orbit = vs.periodic_orbit(system, itinerary="R")
    by_frequency = vs.continue_orbit(orbit, "frequency", (0.09, 0.11))
    by_omega = vs.continue_orbit(orbit, "omega", (0.18 * np.pi, 0.22 * np.pi))
    pairs = list(zip(by_frequency.special, by_omega.special, strict=True))
    assert len(pairs) > 2 and [a.type for a, _ in pairs] == [b.type for _, b in pairs]
    assert all(abs(2 * np.pi * a.parameters["frequency"] - b.parameters["omega"]) < 1e-9 for a, b in pairs)
    assert by_frequency.points.frequency.dims == ("point",) and "frequency" in by_frequency.points.coords
    special = next(point for point in by_frequency.special if point.type not in ("boundary", "sticking"))
    curve = vs.bifurcation_curve(special, ("frequency", "b"), ((0.09, 0.11), (3.8, 4.2)))
    assert len(curve.points.frequency) > 3


SCENE = """
system: {type: chain, m: [2.4], k: [9500, 0], c: [3, 0], force: [40], k_stop: 180000, c_stop: 45, stop_right: 0.0015,
  units: SI}
sweep: {frequency: {start: 9, stop: 19.9, num: 12}}
orbit: {transient: 300, record: 20}
observe: [section, contacts]
picture: {units: [mm, Hz]}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("lever")
    (place / "lever.yaml").write_text(SCENE)
    (place / "omega.yaml").write_text(
        SCENE.replace("frequency: {start: 9, stop: 19.9, num: 12}", "omega: {values: [60, 70]}").replace(
            "picture: {units: [mm, Hz]}", ""
        )
    )
    for name in ("lever", "omega"):
        vs.run(vs.load_scene(place / f"{name}.yaml"), place / f"{name}.h5")
    return place


def test_what_is_shown_has_the_units_of_the_scene(folder):
    stored = vs.open(folder / "lever.h5")
    assert stored.x1.attrs["units"] == "m" and stored.attrs["picture_units"] == "mm, Hz"
    figure = vs.plot(folder / "lever.h5")
    assert figure.axes[0].get_ylabel() == "$x_1$ at $t = 0$ mod $T$ [mm]"
    assert figure.axes[-1].get_xlabel() == "forcing frequency $f$ [Hz]"
    assert "$b = 1.5$ mm" in figure.get_suptitle() and "$F = 40$ N" in figure.get_suptitle()
    dots = np.concatenate([line.get_ydata() for line in figure.axes[0].lines if line.get_marker() == "."])
    known = stored.x1.values[np.isfinite(stored.x1.values)]
    assert np.allclose(sorted({*dots}), sorted({*(1000 * known)}), rtol=1e-14)
    (stop,) = {*np.ravel([line.get_ydata() for line in figure.axes[0].lines if line.get_gid() == "stop"])}
    assert stop == 1.5
    assert "[m]" in vs.plot(folder / "lever.h5", units="m").axes[0].get_ylabel()


def test_a_sweep_over_omega_is_shown_over_the_frequency(folder):
    figure = vs.plot(folder / "omega.h5", units="Hz")
    assert figure.axes[-1].get_xlabel() == "forcing frequency $f$ [Hz]"
    x = np.unique(np.concatenate([line.get_xdata() for line in figure.axes[0].lines if line.get_marker() == "."]))
    assert np.allclose(x, np.array([60, 70]) / (2 * np.pi), rtol=1e-14)
    assert vs.plot(folder / "omega.h5").axes[-1].get_xlabel() == r"forcing frequency $\omega$ [rad/s]"


@pytest.mark.parametrize("kind", ["phase-portrait", "contact-force", "history"])
def test_motions_in_other_units(folder, kind):
    """The force of a stop is k times its depth, whatever units both have."""
    scene = vs.load_scene(folder / "omega.yaml").replace(trajectory={"periods": 1, "samples": 401})
    vs.run(scene, folder / f"{kind}.h5")
    wide, figure = (vs.plot(folder / f"{kind}.h5", kind, units=units) for units in ("m", "mm, Hz, N"))
    for ax, other in zip(wide.axes, figure.axes, strict=True):
        for line, scaled in zip(ax.lines, other.lines, strict=True):
            if len(line.get_ydata()) < 3:  # a stop, from below to above
                continue
            y, shown = (np.asarray(one.get_ydata(), float) for one in (line, scaled))
            factor = 1000 if "[mm" in other.get_ylabel() else 1
            assert np.allclose(y * factor, shown, rtol=1e-9, atol=1e-9 * np.nanmax(np.abs(shown)), equal_nan=True)


def test_a_dataset_whose_units_were_changed_is_drawn_at_the_same_place(folder):
    data = vs.open(folder / "lever.h5").load()
    changed = data.copy()
    others = {"x1": (1000, "mm"), "v1": (1000, "millimeter / second"), "contact_force_max": (1e-3, "kN")}
    for name, (factor, unit) in others.items():
        changed[name] = (data[name].dims, data[name].values * factor, data[name].attrs | {"units": unit})
    drawn = [vs.plot(one, units="m") for one in (data, changed)]
    for ax, other in zip(*(figure.axes for figure in drawn), strict=True):
        assert ax.get_ylabel() == other.get_ylabel()
        for line, same in zip(ax.lines, other.lines, strict=True):
            assert np.allclose(line.get_ydata(), same.get_ydata(), rtol=1e-14, equal_nan=True)
    found, again = vs.windows(data), vs.windows(changed)
    assert np.allclose([(one.lo, one.hi) for one in found], [(one.lo, one.hi) for one in again], rtol=1e-9)
    changed["x1"].attrs["units"] = "kg"
    with pytest.raises(vs.PlotError, match=r"x1.attrs\['units'\]: 'kg' is not allowed; it must be a unit such as 'm'"):
        vs.plot(changed)
    with pytest.raises(ValueError, match=r"x1.attrs\['units'\]"):
        vs.windows(changed)
    bare = vs.sweep(vs.System(10, 5, 0.05, 0, 0.63, 0.8, 4), {"b": [4.0, 5.0]}, transient=0, record=4)
    bare["x1"].attrs["units"] = "mm"
    with pytest.raises(vs.PlotError, match="it must be left out: it has no unit"):
        vs.plot(bare)


@pytest.mark.parametrize("units", ["furlong", "mm, m", 3, "rad"])
def test_what_are_no_units_to_show(folder, units):
    with pytest.raises(vs.PlotError, match=r"units: .* is not allowed; it must be names of units"):
        vs.plot(folder / "lever.h5", units=units)


def test_units_of_a_system_without_any():
    data = vs.sweep(vs.System(10, 5, 0.05, 0, 0.63, 0.8, 4), {"b": [4.0, 5.0]}, transient=0, record=4)
    with pytest.raises(vs.PlotError, match="units: 'mm' is not allowed; it must be left out: the system has no units"):
        vs.plot(data, units="mm")


def test_tables_have_these_units(folder):
    status, out, _ = ended("windows", folder / "lever.h5", "-o", folder / "w.h5", "--overwrite")
    assert status == 0 and "windows in frequency [Hz]:" in out and "19.5368024" in out
    status, out, _ = ended("info", folder / "omega.h5", "--units", "Hz")
    assert status == 0 and "  frequency  9.5493 .. 11.1408 Hz (2 values)" in out
    status, out, _ = ended("table", folder / "lever.h5", "--variable", "x1", "--units", "um,Hz")
    head, first, *_ = out.splitlines()
    assert head == "frequency [Hz],sample,x1 [\N{MICRO SIGN}m]"
    value = float(first.split(",")[2])
    assert np.isclose(value, 1e6 * float(vs.open(folder / "lever.h5").x1[0, 0]), rtol=1e-12)
    status, out, _ = ended("grazing", folder / "lever.yaml")
    assert status == 0 and out.splitlines()[0] == "# the gap is just filled at frequency [Hz] = 19.5368024089"


def test_units_is_a_type():
    assert isinstance(vs.Oscillator(1, 1, contact_normal=1, omega=1, R=1, b=1, units="SI").units, Units)
