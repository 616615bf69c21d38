"""Scenes that continue from the file of a sweep or of branches: from which orbits, and of which oscillator."""

import numpy as np
import pytest
from support import sample
from support.contents import words_of
from support.oscillators import PAPER_NUMBERS
from support.scene_texts import parsed
from support.windows import SYSTEM, few  # noqa: F401

import vibro_sweep as vs

NUMBERS = f"{PAPER_NUMBERS}, b: 6.6"


def scene(begin, start, stop, key="b", numbers=NUMBERS):
    parameter = f"parameter: {{{key}: [{start!r}, {stop!r}]}}"
    return parsed(f"system: {{{numbers}}}\ncontinue:\n  from: {begin}\n  {parameter}\n  depth: 0\n")


def special_points(path) -> set[tuple[str, int, float]]:
    """Type, period of the branch and parameter of all special points of a file."""
    with vs.open(path) as data:
        own = data["special_branch"].values
        types = words_of(data["special_type"])
        values = data["special_value"].values[:, 0].round(11)
        return set(zip(types, data["branch_period"].values[own].tolist(), values.tolist(), strict=True))


@pytest.mark.slow
def test_branches_of_a_sweep_pass_its_windows(few, tmp_path):  # noqa: F811
    """Every end of every window is a special point of a branch that was followed anew."""
    vs.run(scene(f"{{sweep: {few}}}", 5.1, 6.8), tmp_path / "b.h5")
    found, windows = special_points(tmp_path / "b.h5"), vs.windows(few)
    assert len(windows) == 9
    for window in windows:
        for end in (window.lower, window.upper):
            if end.type != "boundary":
                assert (end.type, window.period, round(end.parameters["b"], 11)) in found, window
    with vs.open(few) as sweep, vs.open(tmp_path / "b.h5") as data:
        assert data.attrs["source"] == sweep.attrs["identity"] and data.attrs["omega"] == 0.63


@pytest.mark.slow
def test_the_largest_windows(few, tmp_path):  # noqa: F811
    """As wide as they are within the range, in which the free motion's window is a short one."""
    lo, hi, count = 5.1, 6.71, 3
    vs.run(scene(f"{{sweep: {few}, largest: {count}}}", lo, hi), tmp_path / "b.h5")
    windows = sorted(vs.windows(few), key=lambda one: max(min(one.hi, hi), lo) - max(min(one.lo, hi), lo))
    with vs.open(tmp_path / "b.h5") as data:
        assert sorted(data["branch_period"].values) == sorted(one.period for one in windows[-count:])
        assert data["branch_impacts"].values.all()


def test_the_number_that_a_file_has_may_be_left_out():
    given = NUMBERS.replace(", b: 6.6", "")
    assert scene("{sweep: s.h5}", 5, 7, numbers=given).system.b == 5


@pytest.mark.slow
def test_a_range_beside_the_orbits_of_the_sweep(few, tmp_path):  # noqa: F811
    """The window of period 13 begins at 6.59468; its first orbit in the sweep is at 6.596, outside of the range."""
    vs.run(scene(f"{{sweep: {few}}}", 6.59, 6.595), tmp_path / "b.h5")
    with vs.open(tmp_path / "b.h5") as data:
        assert data["branch_period"].values.tolist() == [13]
        assert float(data["b"].min()) == pytest.approx(6.594680526617, abs=1e-11)
        assert float(data["b"].max()) == 6.595


@pytest.mark.slow
def test_the_row_of_a_plane(tmp_path):
    axes = {"omega": [0.62, 0.63], "b": [6.8, 7.8, 8.8]}
    vs.sweep(SYSTEM, axes, transient=300, record=20, output=tmp_path / "plane.h5", workers=1)
    begin = f"{{sweep: {tmp_path / 'plane.h5'}}}"
    for omega in axes["omega"]:
        vs.run(scene(begin, 5, 9, numbers=NUMBERS.replace("0.63", str(omega))), tmp_path / f"{omega}.h5")
        with vs.open(tmp_path / f"{omega}.h5") as data:
            ends = data["special_value"].values[data["branch_begins"].values, 0]
            assert data.attrs["omega"] == omega
            assert np.abs(ends - vs.grazing(SYSTEM.replace(omega=omega)).b).min() < 1e-12
    vs.windows(tmp_path / "plane.h5", "b", tmp_path / "windows.h5")
    for panel in vs.plot(tmp_path / "plane.h5", windows=tmp_path / "windows.h5").axes[:2]:
        drawn = [line.get_xydata() for line in panel.lines if line.get_gid() == "window end"]
        expected = [[omega, vs.grazing(SYSTEM.replace(omega=omega)).b] for omega in axes["omega"]]
        for place in expected:
            assert np.abs(np.concatenate(drawn) - place).max(axis=1).min() < 1e-12
    with pytest.raises(ValueError, match=r"plane\.h5 has no row with omega = 0\.64"):
        vs.run(scene(begin, 5, 9, numbers=NUMBERS.replace("0.63", "0.64")), tmp_path / "no.h5")


@pytest.mark.slow
def test_the_numbers_of_the_oscillator_are_those_of_the_special_point(few, tmp_path):  # noqa: F811
    """A branch in omega has the b of the special point, not that of the scene; so does one from that branch."""
    vs.run(scene(f"{{sweep: {few}}}", 6.5, 6.7), tmp_path / "b.h5")
    with vs.open(tmp_path / "b.h5") as data:
        at = words_of(data["special_type"]).index("fold")
        value = float(data["special_value"][at, 0])
    begin = f"{{branches: {tmp_path / 'b.h5'}, special: {at}}}"
    vs.run(scene(begin, 0.62, 0.64, "omega"), tmp_path / "omega.h5")
    with vs.open(tmp_path / "omega.h5") as data:
        assert data.attrs["b"] == value != 6.6
        types = words_of(data["special_type"])
        omega = data["special_value"].values[:, 0]
        end = int(np.argmin(np.where(np.array(types) == "boundary", np.inf, np.abs(omega - 0.63))))
        held = float(omega[end])
    begin = f"{{branches: {tmp_path / 'omega.h5'}, special: {end}}}"
    vs.run(scene(begin, 6.5, 6.7), tmp_path / "again.h5")
    with vs.open(tmp_path / "again.h5") as data:
        assert data.attrs["omega"] == held
        along = data["b"].values[: int(data["branch_row_size"][0])]
        assert along.min() <= value <= along.max()


@pytest.mark.parametrize(
    "numbers, start, stop, key, words",
    sample(
        2,
        [
            (NUMBERS.replace("0.8", "0.7"), 5.2, 6.8, "b", r"R = 0\.7 in system, and 0\.8 in .*few\.h5"),
            (NUMBERS + ", stops: right", 5.2, 6.8, "b", "stops = 'right' in system, and 'both' in "),
            (NUMBERS + ", tau: 1", 5.2, 6.8, "b", r"tau = 1\.0 in system, and 'grazing' in "),
            (NUMBERS, 0.6, 0.7, "omega", "parameter: 'omega' is not allowed; it must be b"),
            (NUMBERS, 1.2, 1.8, "b", r"continue\.from\.sweep: no orbit of \S+ with b in 1\.2 \.\. 1\.8"),
        ],
    ),
)
def test_what_does_not_fit_is_refused(few, tmp_path, numbers, start, stop, key, words):  # noqa: F811
    """And nothing is left behind."""
    with pytest.raises(ValueError, match=words):
        vs.run(scene(f"{{sweep: {few}}}", start, stop, key, numbers), tmp_path / "no.h5")
    assert not list(tmp_path.iterdir())


def test_a_file_of_another_kind_is_refused(few, tmp_path):  # noqa: F811
    vs.run(scene("free", 6.5, 6.8, numbers=NUMBERS.replace("6.6", "6.75")), tmp_path / "free.h5")
    with pytest.raises(ValueError, match=r"free\.h5 holds branches, no sweep"):
        vs.run(scene(f"{{sweep: {tmp_path / 'free.h5'}}}", 6.5, 6.8), tmp_path / "no.h5")
    with pytest.raises(ValueError, match=r"few\.h5 holds no branches"):
        vs.run(scene(f"{{branches: {few}, special: 0}}", 6.5, 6.8), tmp_path / "no.h5")
    with pytest.raises(vs.StoreError, match="there is no such file"):
        vs.run(scene("{sweep: none.h5}", 6.5, 6.8), tmp_path / "no.h5")


@pytest.mark.slow
def test_another_sweep_is_another_run(few, tmp_path):  # noqa: F811
    """A run that began from one sweep does not go on from another one of the same name."""
    copy = tmp_path / "sweep.h5"
    copy.write_bytes(few.read_bytes())
    vs.run(scene(f"{{sweep: {copy}}}", 6.5, 6.8), tmp_path / "b.h5")
    vs.sweep(SYSTEM, {"b": [6.9, 7.0]}, transient=5, record=5, output=tmp_path / "other.h5", workers=1)
    copy.write_bytes((tmp_path / "other.h5").read_bytes())
    with pytest.raises(vs.StoreError, match="was made from something else"):
        vs.run(scene(f"{{sweep: {copy}}}", 6.5, 6.8), tmp_path / "b.h5", mode="resume")
