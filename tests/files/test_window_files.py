"""The file of a sweep's windows: what is in it, that it does not depend on how it was made, and the commands."""

import numpy as np
import pytest
import xarray as xr
from support.contents import numbers, words_of
from support.programs import ended, main
from support.windows import SYSTEM, few  # noqa: F401

import vibro_sweep as vs


@pytest.fixture(scope="module")
def file(few, tmp_path_factory):  # noqa: F811
    path = tmp_path_factory.mktemp("file") / "few.windows.h5"
    vs.windows(few, output=path)
    return path


def test_it_holds_the_windows(few, file):  # noqa: F811
    with xr.open_dataset(file, engine="h5netcdf") as data, vs.open(file) as own, vs.open(few) as sweep:
        windows = vs.windows(few)
        assert data.attrs["kind"] == "windows" and data.attrs["sweep"] == sweep.attrs["identity"]
        np.testing.assert_array_equal(data["window_lo"], [window.lo for window in windows])
        np.testing.assert_array_equal(data["window_hi"], [window.hi for window in windows])
        np.testing.assert_array_equal(data["window_period"], [window.period for window in windows])
        np.testing.assert_array_equal(data["window_symmetric"], [window.symmetric for window in windows])
        types = words_of(data["special_type"])
        first = np.append(0, np.cumsum(data["branch_row_size"].values * data["branch_impacts"].values))
        for w, window in enumerate(windows):
            branch = int(data["window_branch"][w])
            sides = data["impact_side"].values[first[branch] :][: int(data["branch_impacts"][branch])]
            assert "".join("R" if side > 0 else "L" for side in sides) == window.itinerary
            for name, special in (("window_lower", window.lower), ("window_upper", window.upper)):
                at = int(data[name][w])
                assert types[at] == special.type
                assert float(data["special_value"][at, 0]) == special.parameters["b"]
                assert float(data["b"][int(data["special_point"][at])]) == special.parameters["b"]
        flags = data["special_type"].attrs
        assert flags["flag_meanings"].split()[:2] == ["fold", "flip"] and flags["flag_values"][1] == 1
        for name in data.variables:
            np.testing.assert_array_equal(own[name], data[name])


@pytest.mark.slow
def test_a_run_that_is_interrupted_goes_on(few, file, tmp_path):  # noqa: F811
    calls = []

    def stop(done, total):
        calls.append(done)
        if len(calls) == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        vs.windows(few, output=tmp_path / "w.h5", progress=stop)
    assert not (tmp_path / "w.h5").exists()
    with pytest.raises(vs.StoreError, match="interrupted run; `resume` continues it"):
        vs.windows(few, output=tmp_path / "w.h5")
    vs.windows(few, output=tmp_path / "w.h5", mode="resume")
    first, second = numbers(file), numbers(tmp_path / "w.h5")
    assert first == second
    assert [path.name for path in tmp_path.iterdir()] == ["w.h5"]


@pytest.mark.slow
def test_two_workers_make_the_same_file(few, file, tmp_path):  # noqa: F811
    vs.windows(few, output=tmp_path / "w.h5", workers=2)
    assert numbers(tmp_path / "w.h5") == numbers(file)


@pytest.mark.slow
def test_dask_makes_the_same_file(few, file, tmp_path):  # noqa: F811
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        words = ["-o", tmp_path / "w.h5", "--quiet", "--scheduler", cluster.scheduler_address]
        assert ended("windows", few, *words).status == 0
    assert numbers(tmp_path / "w.h5") == numbers(file)


@pytest.mark.slow
def test_windows_are_not_drawn_over_a_sweep(few, file):  # noqa: F811
    """The sweep is drawn, with the windows; the other way round was an internal error."""
    with pytest.raises(vs.PlotError, match="draw the sweep, with these windows"):
        vs.plot(file, over=few)


@pytest.mark.slow
def test_commands(few, tmp_path, monkeypatch, capsys):  # noqa: F811
    monkeypatch.chdir(tmp_path)
    before = few.read_bytes()
    assert main(["windows", str(few), "--plot"]) == 0
    told = capsys.readouterr().out
    assert "graze (nonsmooth fold, right)" in told and "6.70571674097" in told
    assert "of 13 in windows" in told
    assert few.read_bytes() == before
    assert (tmp_path / "few.windows.h5").exists() and (tmp_path / "few.windows.png").exists()
    assert main(["info", "few.windows.h5"]) == 0
    assert told.splitlines()[1:4] == capsys.readouterr().out.splitlines()[1:4]
    assert main(["plot", str(few), "--windows", "few.windows.h5", "-o", "strip.svg"]) == 0
    assert "GR graze, persistence" in (tmp_path / "strip.svg").read_text()
    part = ["--xlim", "5", "6.5", "-o", "part.svg"]
    assert main(["plot", str(few), "--windows", "few.windows.h5", *part]) == 0
    assert main(["windows", str(few)]) == 0  # complete already
    assert main(["run", "few.windows.h5"]) == 2
    other = vs.sweep(SYSTEM, {"b": [6.9, 7.0]},
                     transient=5, record=5, output="other.h5", workers=1)  # fmt: skip
    other.close()
    capsys.readouterr()
    assert main(["plot", "other.h5", "--windows", "few.windows.h5"]) == 2
    assert "has the windows of another sweep" in capsys.readouterr().err
    assert main(["windows", "other.h5", "-o", "few.windows.h5"]) == 2
    assert "overwrite" in capsys.readouterr().err


def test_the_table_of_a_plane_says_in_which_row_a_window_lies(tmp_path, monkeypatch, capsys):
    """Of a sweep that is not complete the command says so, and its bar only grows."""
    monkeypatch.chdir(tmp_path)
    done = []

    def stop(so_far, total):
        if so_far >= 12:
            raise KeyboardInterrupt

    scene = (
        "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, R: 0.8}\nsweep: {omega: {values: [0.62, 0.63, 0.64, 0.65]}, "
    )
    scene += "b: {start: 3, stop: 3.6, num: 4}}\norbit: {transient: 800, record: 60}\nobserve: [section]\n"
    (tmp_path / "plane.yaml").write_text(scene)
    with pytest.raises(KeyboardInterrupt):
        vs.run(vs.load_scene("plane.yaml"), "plane.h5", progress=stop, block=4)
    windows = vs.windows("plane.h5", "b", progress=lambda so_far, _: done.append(so_far))
    assert done == sorted(done) and len(windows)
    capsys.readouterr()
    assert main(["windows", "plane.h5", "--parameter", "b"]) == 0
    told = capsys.readouterr()
    assert "plane.h5 is not complete: " in told.err and " of 16 orbits are missing" in told.err
    title, names, *rows = told.out.splitlines()[1:]
    assert title == f"windows in b: {len(windows)}" and names.split()[:2] == ["omega", "from"]
    assert [float(row.split()[0]) for row in rows[: len(windows)]] == [window.held["omega"] for window in windows]


def test_what_an_interrupted_run_has_left_is_named(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "some.h5.pieces").mkdir()
    assert main(["info", "some.h5"]) == 2
    assert "some.h5.pieces beside it is of a run that was interrupted" in capsys.readouterr().err


def test_of_a_long_table_a_command_prints_the_beginning_and_the_end(few, file, monkeypatch, capsys):  # noqa: F811
    monkeypatch.setattr("vibro_sweep.cli.computing.FIRST", 3)
    monkeypatch.setattr("vibro_sweep.cli.computing.LAST", 2)
    assert main(["info", str(file)]) == 0
    whole = [line for line in capsys.readouterr().out.splitlines() if line]
    begin = next(i for i, line in enumerate(whole) if line.startswith("windows in b"))
    assert main(["windows", str(few), "-o", str(file)]) == 0  # it is complete
    name, *lines = capsys.readouterr().out.splitlines()
    assert (name, lines[:3]) == (str(file), whole[begin : begin + 3]) and len(lines) == 6
    assert f" lines more: vibro-sweep info {file}" in lines[3] and lines[4] in whole and lines[5] in whole
