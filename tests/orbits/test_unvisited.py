"""Stretches of windows that a sweep does not show, because its starts went to other attractors."""

import numpy as np
import pytest
import xarray as xr
from support import ROOT
from support.programs import main
from support.windows import SYSTEM

import vibro_sweep as vs
from vibro_sweep.driver.windows import run_windows

AWAY = 1e-6  # what is added to a listed start; the orbit attracts from there


def swept(folder, b, start):
    path = folder / "sweep.h5"
    vs.sweep(SYSTEM, {"b": b}, start=start, transient=400, record=60, output=path, workers=1)
    return path


@pytest.fixture(scope="module")
def beside_free(tmp_path_factory):
    """At two values an orbit of period 16, with impacts, where the free motion attracts as well."""
    start = (6.2767, 0.1407, 2.9878, 0.3474)
    return swept(tmp_path_factory.mktemp("unvisited"), [6.7, 6.734, 6.7345, 6.76, 6.8], start)


def check_start(windows, unvisited):
    """Simulated from the listed start, and from beside it, the oscillator goes to the window's orbit."""
    window, system = windows[unvisited.window], SYSTEM.replace(b=unvisited.at)
    assert window.lo <= unvisited.lo <= unvisited.at <= unvisited.hi <= window.hi
    flown = vs.simulate(system, unvisited.state, 10 * window.period)
    np.testing.assert_allclose(flown.section[:: window.period], np.tile(unvisited.state, (11, 1)), rtol=0, atol=1e-9)
    assert len(flown.impacts) == 10 * len(window.itinerary)
    beside = vs.simulate(system, unvisited.state + AWAY * np.array([-1, 1, 1, -1]), 400 * window.period)
    np.testing.assert_allclose(beside.section[-1], unvisited.state, rtol=0, atol=AWAY / 10)


def test_the_free_motion_beside_an_orbit_with_impacts(beside_free):
    """Its window begins at the grazing clearance, below the first value that shows the other orbit."""
    windows = vs.windows(beside_free)
    (unvisited,) = windows.unvisited
    assert (windows[unvisited.window].itinerary, unvisited.values, unvisited.hi) == ("", 2, 6.7345)
    assert unvisited.lo == windows[unvisited.window].lo == pytest.approx(vs.grazing(SYSTEM).b, rel=1e-14)
    assert unvisited.at == 6.7345  # the farther one from where the window ends
    check_start(windows, unvisited)


def test_a_stretch_within_a_window(tmp_path):
    """Values at both ends of the stretch, where the sweep ends before the window."""
    windows = vs.windows(swept(tmp_path, [5.6, 5.776, 5.78, 5.795], (4.5775, -0.8852, 2.0298, 0.1933)))
    (unvisited,) = windows.unvisited
    assert (windows[unvisited.window].period, windows[unvisited.window].itinerary) == (8, "RRRR")
    assert (unvisited.lo, unvisited.hi, unvisited.values, unvisited.at) == (5.776, 5.795, 3, 5.776)
    assert [windows[w].itinerary for w in windows.window.ravel()[1:3]] == ["R" * 9] * 2
    check_start(windows, unvisited)


def test_a_start_that_sees_it_is_enough(tmp_path):
    """A stretch counts as missed only if all starts of the sweep miss the orbit."""
    axes, both = {"b": [6.734, 6.7345, 6.76]}, {"follow": "both"}
    vs.sweep(SYSTEM, axes, start=both, transient=400, record=60, output=tmp_path / "s.h5", workers=1)
    windows = vs.windows(tmp_path / "s.h5")
    assert [windows[w].itinerary for w in windows.window[0]] == ["RRRR", ""]
    assert [window.other_attractor for window in windows] == [2, 2]
    assert windows.unvisited == []


@pytest.mark.slow
def test_the_file_and_the_table(beside_free, tmp_path, capsys):
    (unvisited,) = vs.windows(beside_free).unvisited
    run_windows(beside_free, tmp_path / "w.h5")
    with xr.open_dataset(tmp_path / "w.h5", engine="h5netcdf") as data:
        for name in ("window", "lo", "hi", "values", "at"):
            assert data[f"unvisited_{name}"].values.tolist() == [getattr(unvisited, name)]
        assert [float(data[f"unvisited_{name}"][0]) for name in ("x1", "v1", "x2", "v2")] == unvisited.state.tolist()
    assert main(["info", str(tmp_path / "w.h5")]) == 0
    told = capsys.readouterr().out
    assert "1 stretch of a window on which the sweep shows other attractors only" in told
    assert f"x1: {float(unvisited.state[0])!r}" in told
    assert main(["plot", str(beside_free), "--windows", str(tmp_path / "w.h5"), "-o", str(tmp_path / "s.svg")]) == 0
    assert 'id="unvisited"' in (tmp_path / "s.svg").read_text()


@pytest.mark.slow
def test_every_value_of_a_window_is_seen_or_listed(tmp_path):
    """A part of the quickstart, counted in another way."""
    scene = vs.load_scene(ROOT / "configs" / "quickstart.yaml")
    b = scene.sweep["b"]
    b = b[(b > 5.4) & (b < 5.83)]
    vs.run(scene.replace(sweep={"b": b.tolist()}, observe=["section"], picture=None), tmp_path / "q.h5", workers=1)
    windows = vs.windows(tmp_path / "q.h5")
    assert {windows[unvisited.window].period for unvisited in windows.unvisited} >= {8, 17}
    for w, window in enumerate(windows):
        for i, value in enumerate(b):
            if window.lo <= value <= window.hi:
                listed = [one for one in windows.unvisited if one.window == w and one.lo <= value <= one.hi]
                assert len(listed) == (windows.window[i, 0] != w)
    for unvisited in windows.unvisited:
        check_start(windows, unvisited)
