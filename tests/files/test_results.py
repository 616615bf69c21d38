"""Results of Python as tables, Datasets, pictures and files, and read again: the same numbers, bit for bit."""

import json
import os
import re
import sys

import numpy as np
import pytest
from support import slow_cases
from support.oscillators import PAPER, PAPER_NUMBERS

import vibro_sweep as vs

SYSTEM = PAPER.replace(b=4.0)
BALL = vs.Oscillator.named("one_mass", k=0, zeta=0.0, F=1.0, omega=1.0, R=0.5, b=0.0, constant=-0.5, stops="left")


def same_specials(one, other):
    assert [point.type for point in one] == [point.type for point in other]
    for x, y in zip(one, other, strict=True):
        assert x.parameters == y.parameters and (x.error == y.error or np.isnan([x.error, y.error]).all())
        assert (x.stop, x.kind, x.impact, x.criticality) == (y.stop, y.kind, y.impact, y.criticality)
        assert (x.orbit.itinerary, x.orbit.period, x.orbit.status) == (
            y.orbit.itinerary,
            y.orbit.period,
            y.orbit.status,
        )
        scale = np.abs(x.multipliers).max(initial=1.0)
        np.testing.assert_allclose(x.multipliers, y.multipliers, rtol=0, atol=1e-12 * scale)


def check_html(result):
    """It says what `repr` says, and has a row for each line of the table."""
    text, rows = result._repr_html_(), result.to_dataframe()
    assert text.startswith("<pre>&lt;") and text.count("<tr") == (len(rows) + 1 if len(rows) else 0)
    of_rows = [one.orbit for one in getattr(result, "special", result if isinstance(result, list) else [])]
    assert text.count("<svg") == sum(one.period > 0 for one in of_rows)


@pytest.fixture(scope="module")
def orbit():
    return vs.periodic_orbit(SYSTEM, itinerary="R")


@pytest.fixture(scope="module")
def branch(orbit):
    return vs.continue_orbit(orbit, "b", (3.0, 4.5))


def test_an_orbit(orbit, tmp_path):
    assert orbit.save(tmp_path / "o.json") == tmp_path / "o.json"
    again = vs.load(tmp_path / "o.json")
    assert again.impacts.tobytes() == orbit.impacts.tobytes() and again.system == orbit.system
    data = vs.open(tmp_path / "o.json")
    assert data.identical(orbit.to_xarray()) and data.attrs["kind"] == "periodic_orbit"
    assert (data.attrs["itinerary"], data.attrs["period"], data.attrs["b"]) == ("R", 1, 4.0)
    np.testing.assert_array_equal(data.multiplier_re + 1j * data.multiplier_im, orbit.multipliers)
    flown = vs.simulate(SYSTEM, [float(data[name][0]) for name in ("x1", "v1", "x2", "v2")], 1)
    np.testing.assert_allclose(flown.section[-1], flown.section[0], rtol=0, atol=1e-12)
    assert orbit.to_dataframe()["t"].tolist() == orbit.impacts["t"].tolist()
    assert flown.to_xarray().attrs["kind"] == "orbit" and len(flown.to_dataframe()) == len(flown.impacts)
    for one in (orbit, flown):
        check_html(one)
        assert vs.plot(one, width=85).axes
    nothing = vs.periodic_orbit(SYSTEM.replace(b=50.0), itinerary="R")
    check_html(nothing)
    with pytest.raises(ValueError, match="no motion"):
        nothing.to_xarray()


def test_a_branch(branch, tmp_path):
    branch.save(tmp_path / "b.h5")
    again = vs.load(tmp_path / "b.h5")
    assert type(again) is type(branch) and again.points.identical(branch.points)
    assert (again.parameter, again.closed, again.status) == (branch.parameter, branch.closed, branch.status)
    same_specials(branch.special, again.special)
    assert repr(again) == repr(branch) and again.to_dataframe().equals(branch.to_dataframe())
    check_html(again)
    assert again.to_dataframe()["type"].tolist() == ["graze", "neimark_sacker", "boundary"]
    with vs.open(tmp_path / "b.h5") as data:
        assert data.attrs["kind"] == "branches" and data.equals(branch.to_xarray())
    assert [one.itinerary for one in vs.switch(again.begins)] == [one.itinerary for one in vs.switch(branch.begins)]
    lines = [vs.plot(one).axes[0].lines[0].get_xydata() for one in (branch, again)]
    np.testing.assert_array_equal(*lines)
    again.save(tmp_path / "again.h5")
    assert vs.load(tmp_path / "again.h5").points.identical(branch.points)
    with pytest.raises(FileExistsError, match=r"b\.h5"):
        branch.save(tmp_path / "b.h5")


@pytest.mark.parametrize("system, begin", [(SYSTEM.replace(b=2.0), "LR"), (SYSTEM.replace(b=7.0), ""), (BALL, "L")])
def test_branches_of_other_orbits(system, begin, tmp_path):
    """Symmetric, without impacts, of one mass."""
    name = "F" if begin == "L" else "b"
    value = system.numbers[name]
    branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary=begin), name, (0.6 * value, 1.4 * value))
    branch.save(tmp_path / "b.h5")
    again = vs.load(tmp_path / "b.h5")
    assert again.points.identical(branch.points)
    same_specials(branch.special, again.special)


@pytest.mark.slow
def test_a_curve(branch, tmp_path):
    ends = {"neimark_sacker": ((3.8, 4.5), (0.6, 0.66)), "graze": ((3.0, 3.5), (0.62, 0.64))}
    for kind, bounds in ends.items():
        special = next(one for one in branch.special if one.type == kind)
        curve = vs.bifurcation_curve(special, ("b", "omega"), bounds)
        curve.save(tmp_path / f"{kind}.h5")
        again = vs.load(tmp_path / f"{kind}.h5")
        assert again.points.identical(curve.points) and repr(again) == repr(curve)
        assert (again.type, again.parameters, again.closed) == (kind, ("b", "omega"), curve.closed)
        same_specials(curve.special, again.special)
        assert [one.touches for one in again.special] == [one.touches for one in curve.special]
        check_html(again)
        assert again.plot(curve).axes and vs.plot(again).axes
        with vs.open(tmp_path / f"{kind}.h5") as data:
            assert data.attrs["kind"] == "curves" and data.equals(again.to_xarray())


@pytest.mark.slow
def test_windows(tmp_path):
    swept = vs.sweep(
        SYSTEM, {"b": np.linspace(6.4, 6.65, 8)}, observe=["section"], transient=800, record=200, workers=1
    )
    windows = vs.windows(swept, output=tmp_path / "w.h5")
    table = windows.to_dataframe()
    assert table["lo"].tolist() == [one.lo for one in windows] and set(table["lower"]) <= {"graze", "fold", "flip"}
    windows.save(tmp_path / "saved.h5")
    for name in ("w.h5", "saved.h5"):
        again = vs.load(tmp_path / name)
        assert again.to_dataframe().equals(table) and repr(again) == repr(windows) and len(again) > 2
        assert (again.window == windows.window).all() and (again.reason == windows.reason).all()
        for one, other in zip(windows, again, strict=True):
            same_specials([one.lower, one.upper], [other.lower, other.upper])
            np.testing.assert_array_equal(one.orbit.multipliers, other.orbit.multipliers)
        assert [(one.window, one.lo, one.hi, one.values, one.at) for one in again.unvisited] == [
            (one.window, one.lo, one.hi, one.values, one.at) for one in windows.unvisited
        ]
        np.testing.assert_array_equal([one.state for one in again.unvisited], [one.state for one in windows.unvisited])
    with vs.open(tmp_path / "w.h5") as data:
        assert data.equals(windows.to_xarray())
    check_html(windows)
    assert windows.plot().axes


@pytest.mark.slow
def test_the_file_of_a_scene_gives_a_list(tmp_path):
    (tmp_path / "s.yaml").write_text(
        f"system: {{{PAPER_NUMBERS}, b: 2.0}}\n"
        "continue: {from: {itinerary: LR}, parameter: {b: [0.3, 6.8]}, depth: 1}\n"
    )
    vs.run(vs.load_scene(tmp_path / "s.yaml"), tmp_path / "s.h5")
    found = vs.load(tmp_path / "s.h5")
    followed = vs.follow_branches(vs.periodic_orbit(SYSTEM.replace(b=2.0), itinerary="LR"), "b", (0.3, 6.8))
    assert len(found) == len(followed) > 2
    for one, other in zip(found, followed, strict=True):
        assert one.points.identical(other.branch.points)
        same_specials(other.branch.special, one.special)


@pytest.mark.slow
def test_a_number_that_breaks_the_symmetry(tmp_path):
    """At one value of the branch the oscillator is symmetric: there mirror images are not told either."""
    orbit = vs.periodic_orbit(SYSTEM.replace(b=2.0), itinerary="LR")
    branch = vs.continue_orbit(orbit, "offset", (-0.2, 0.2))
    branch.save(tmp_path / "b.h5")
    assert vs.load(tmp_path / "b.h5").points.identical(branch.points)
    (tmp_path / "s.yaml").write_text(
        f"system: {{{PAPER_NUMBERS}, b: 2, offset: 0}}\n"
        "continue: {from: {itinerary: LR}, parameter: {offset: [-0.2, 0.2]}, depth: 0}\n"
    )
    vs.run(vs.load_scene(tmp_path / "s.yaml"), tmp_path / "s.h5")
    (again,) = vs.load(tmp_path / "s.h5")
    assert again.points.identical(branch.points)
    with vs.open(tmp_path / "s.h5") as data:
        assert data.branch_sections.values.tolist() == [1]


def test_options_that_the_picture_of_an_orbit_does_not_have_are_refused(orbit, tmp_path):
    for option in ({"output": tmp_path / "o.png"}, {"xlim": (0, 1)}, {"relative": True}):
        with pytest.raises(
            vs.PlotError, match=f"^{next(iter(option))}: of an orbit `width`, `kind` and `units` are the only"
        ):
            vs.plot(orbit, **option)
    with pytest.raises(ValueError, match=r"^kind: "):
        vs.plot(orbit, kind="history")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("word, stops", [("R", 1), ("LR", 2)])
def test_a_small_portrait_is_the_orbit(word, stops):
    """It reaches its stops, never passes them, and jumps there by (1 + R) times the speed."""
    branch = vs.continue_orbit(vs.periodic_orbit(SYSTEM, itinerary=word), "b", (3.95, 4.05))
    orbit = branch.special[0].orbit
    walls, path = re.findall(r'<path d="(.*?)"', branch._repr_html_())[:2]
    walls = [int(place) for place in re.findall(r"M(\d+) 0v160", walls)]
    start, steps = path.removeprefix("M").split("l")
    x, y = np.cumsum(
        [[int(one) for one in pair.split()] for pair in [start, *re.findall(r"-?\d+ -?\d+", steps)]], axis=0
    ).T
    assert len(walls) == 2 and walls[0] == 8 and walls[1] == x.max() == 240 - 8
    assert (x.min() == walls[0]) == (stops == 2) and (x[0], y[0]) == (x[-1], y[-1])
    v = orbit.sample(np.linspace(0, orbit.period * SYSTEM.period, 5000))[:, 1]
    pixel = (160 - 2 * 8) / np.ptp(np.append(v, orbit.impacts["v1"]))
    jumps = np.diff(y)[(np.diff(x) == 0) & (x[1:] == walls[1])]
    assert np.abs(jumps).max() == pytest.approx((1 + SYSTEM.R) * np.abs(orbit.impacts["v1"]).max() * pixel, abs=2)


def test_an_orbit_without_impacts_is_drawn():
    gap = vs.periodic_orbit(SYSTEM.replace(b=7.0), itinerary="").plot().axes[1].lines[0].get_ydata()
    assert 6.7 < np.nanmax(gap) < 7


def test_a_sweep_says_its_kind(tmp_path):
    with vs.sweep(SYSTEM, {"b": [6.4, 6.5]}, transient=5, record=5, workers=1, output=tmp_path / "s.h5") as data:
        assert data.attrs["kind"] == "sweep" and vs.plot(data).axes


def test_without_pandas(orbit, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(vs.VibroSweepError, match="pandas") as caught:
        orbit.to_dataframe()
    assert isinstance(caught.value, ImportError)


def test_what_is_refused(branch, tmp_path):
    vs.sweep(SYSTEM, {"b": [6.4, 6.5]}, transient=5, record=5, workers=1, output=tmp_path / "sweep.h5").close()
    with pytest.raises(ValueError, match=r"sweep\.h5: it holds a sweep, which `vibro_sweep\.open` gives"):
        vs.load(tmp_path / "sweep.h5")
    (tmp_path / "other.json").write_text(json.dumps({"format": "of somebody else"}))
    os.mkfifo(tmp_path / "pipe")  # nobody writes into it
    for path in ("other.json", "none.h5", "pipe"):
        for read in (vs.load, vs.open):
            with pytest.raises(vs.VibroSweepError, match=path):
                read(tmp_path / path)
    with pytest.raises(vs.VibroSweepError, match="nowhere"):
        branch.save(tmp_path / "nowhere" / "b.h5")
    family = vs.periodic_orbit(SYSTEM.family, itinerary="R")
    with pytest.raises(ValueError, match="Family"):
        vs.continue_orbit(family, "b", (3.9, 4.1)).save(tmp_path / "f.h5")
    with pytest.raises(ValueError, match="Family"):
        family.to_xarray()


def test_a_sweep_without_windows(tmp_path):
    """Its orbits rest on a stop after infinitely many impacts."""
    swept = vs.sweep(SYSTEM, {"b": [0.03, 0.04]}, observe=["section"], transient=200, record=20, workers=1)
    windows = vs.windows(swept, output=tmp_path / "w.h5")
    windows.save(tmp_path / "saved.h5")
    for name in ("w.h5", "saved.h5"):
        again = vs.load(tmp_path / name)
        assert len(again) == len(windows) == len(again.to_dataframe()) == 0
        assert (again.reason == windows.reason).all() and again.reason.all()
    check_html(windows)


@pytest.mark.slow
@pytest.mark.parametrize("cut", [{"omega": 0.63}, *slow_cases({"b": slice(6.4, 6.5)})])
def test_windows_of_a_part_of_a_sweep(cut, tmp_path):
    """Of other shape than the sweep; a swept number of which one value is left is that of the windows."""
    axes = {"b": [6.4, 6.45, 6.5, 6.55], "omega": [0.6, 0.63]}
    swept = vs.sweep(SYSTEM, axes, observe=["section"], transient=800, record=200, workers=1)
    windows = vs.windows(swept.sel(cut))
    windows.save(tmp_path / "w.h5")
    again = vs.load(tmp_path / "w.h5")
    assert len(again) == len(windows) > 1 and (again.window == windows.window).all()
    for one, other in zip(windows, again, strict=True):
        assert one.orbit.system.omega == other.orbit.system.omega
        same_specials([one.lower, one.upper], [other.lower, other.upper])
        np.testing.assert_array_equal(one.orbit.multipliers, other.orbit.multipliers)
    again.save(tmp_path / "again.h5")
    assert vs.load(tmp_path / "again.h5").to_dataframe().equals(windows.to_dataframe())
