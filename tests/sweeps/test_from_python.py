"""Sweeps without YAML: the same numbers as a scene gives, and scenes that cannot say what they are not."""

import dataclasses
import pickle

import numpy as np
import pytest
from support import ROOT
from support.oscillators import PAPER, PAPER_NUMBERS
from support.scene_texts import parsed

import vibro_sweep as vs
from vibro_sweep.types import Section, Start, Trajectory

SYSTEM = PAPER.replace(b=6.6)
SCENES = sorted(path for path in ROOT.glob("configs/**/*.yaml") if path.parent.name != "branches")
SHORT = dict(transient=20, record=10)


def scene(more, orbit="{transient: 20, record: 10}"):
    return parsed(f"system: {{{PAPER_NUMBERS}}}\norbit: {orbit}\n{more}")


def assert_same(one, other):
    """Two scenes, number by number."""
    for field in dataclasses.fields(one):
        if field.name == "sweep":
            assert list(one.sweep) == list(other.sweep)
            assert all(np.array_equal(one.sweep[key], other.sweep[key]) for key in one.sweep)
        elif field.name not in ("name", "as_written", "source", "system_file"):
            assert getattr(one, field.name) == getattr(other, field.name), field.name


# Scenes and their text


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_yaml_and_back(path):
    one = vs.load_scene(path)
    if one.system_file is None:
        assert one.text == path.read_text()
    else:  # with the numbers of that file: a result must not depend on it
        assert one.text == one.to_yaml()
    assert_same(parsed(one.to_yaml()), one)


@pytest.mark.parametrize(
    "text",
    [
        "sweep: {b: {values: [6, 7, 6.5e300]}}",
        "sweep: {b: {values: [1e-9, 0.1]}}\nobserve: []\ntrajectory: {periods: 2, samples: 30}",
        "sweep: {b: {start: 5, stop: 6, step: 0.3}, x1: {values: [1, 2]}}\nstart: {v1: 0.1}",
        "sweep: {b: {values: [6, 7]}, tau: {start: 1, stop: 0, num: 7}}\nsection: {kind: impact, stop: left}",
        "sweep: {b: {values: [6, 7]}}\nstart: {follow: both, x1: 0.5, v2: -1e-7}",
        "sweep: {b: {values: [6]}}\nstart: {random: 7, seed: 3}\nobserve: [attractors, impacts]",
        "sweep: {b: {values: [6]}}\ndynamics: map\norder: 2\nexpand_at: 6.71",
    ],
)
def test_all_kinds_of_scenes_and_back(text):
    one = scene(text)
    assert_same(parsed(one.to_yaml()), one)


def test_text_never_says_something_else():
    given = scene("sweep: {b: {values: [6, 7]}}  # mine")
    assert given.text == given.as_written and "# mine" in given.text
    for changed in (
        dataclasses.replace(given, record=50),
        given.replace(record=50),
        given.replace(record=np.int64(50)),
    ):
        assert "# mine" not in changed.text and parsed(changed.text).record == 50
    assert_same(given.replace(record=50).replace(record=10), given)
    assert pickle.loads(pickle.dumps(given)).text == given.text
    with pytest.raises(vs.SceneError, match=r"orbit\.record = 0: must be a whole number >= 1"):
        _ = dataclasses.replace(given, record=0).text


def test_file_of_a_changed_scene_says_what_was_computed(tmp_path):
    changed = dataclasses.replace(scene("sweep: {b: {values: [6, 7]}}"), record=5)
    vs.run(changed, tmp_path / "a.h5")
    with vs.open(tmp_path / "a.h5") as data:
        assert data.sizes["sample"] == 5 and parsed(data.attrs["scene"]).record == 5
    vs.run(parsed(changed.text), tmp_path / "a.h5")  # the same scene


@pytest.mark.parametrize(
    "changes, expected",
    [
        (dict(system=SYSTEM.replace(R=0.5)), f"system: {{{PAPER_NUMBERS.replace('0.8', '0.5')}"),
        (dict(sweep={"omega": np.array([0.6, 0.7])}), "sweep: {omega: {values: [0.6, 0.7]}}"),
        (dict(sweep={"b": {"start": 5, "stop": 6, "num": 11}}), "sweep: {b: {start: 5, stop: 6, num: 11}}"),
        (dict(sweep=None), "b: 6, tau: grazing"),
        (dict(start=(0.5, 0, 0, 1)), "start: {x1: 0.5, v2: 1}"),
        (dict(start=Start("random", count=3, seed=2)), "start: {random: 3, seed: 2}"),
        (dict(start={"follow": "up"}), "start: {follow: up}"),
        (dict(section=Section("impact", "left")), "section: {kind: impact, stop: left}"),
        (dict(observe=("impacts",)), "observe: [impacts]"),
        (dict(trajectory=Trajectory(3, 40)), "trajectory: {periods: 3, samples: 40}"),
        (dict(dynamics="map", order=2), "order: 2"),
        (dict(transient=7.0), "orbit: {transient: 7, record: 10}"),
    ],
    ids=str,
)
def test_replace(changes, expected):
    assert expected in scene("sweep: {b: {values: [6, 7]}}").replace(**changes).to_yaml()


# vs.sweep


def test_sweep_is_what_a_scene_gives(tmp_path):
    values = np.linspace(6.5, 6.9, 7)
    found = vs.sweep(SYSTEM, {"b": values}, observe=("section", "lyapunov", "impacts"), **SHORT)
    yaml = f"sweep: {{b: {{values: {values.tolist()}}}}}\nobserve: [section, lyapunov, impacts]"
    vs.run(scene(yaml), tmp_path / "a.h5")
    with vs.open(tmp_path / "a.h5") as data:
        assert set(found.variables) == set(data.variables)
        for name in data.variables:
            assert np.array_equal(found[name].values, data[name].values, equal_nan=found[name].dtype.kind == "f"), name
    assert np.array_equal(found.b, values)
    assert_same(parsed(found.attrs["scene"]), scene(yaml).replace(system=SYSTEM))


def test_sweep_of_two_numbers_into_a_file(tmp_path):
    axes = {"omega": {"start": 0.6, "stop": 0.61, "step": 0.005}, "b": [5, 6]}
    calls = []
    data = vs.sweep(
        SYSTEM,
        axes,
        observe=["impacts"],
        output=tmp_path / "a.h5",
        progress=lambda *done: calls.append(done),
        workers=1,
        **SHORT,
    )
    assert data.impacts_right.shape == (3, 2) and data.omega.values.tolist() == [0.6, 0.605, 0.61]
    assert (tmp_path / "a.h5").exists() and calls[-1] == (6, 6)
    again = vs.sweep(SYSTEM, axes, observe=["impacts"], output=tmp_path / "a.h5", **SHORT)
    assert again.equals(data)
    with pytest.raises(vs.StoreError, match="another scene"):
        vs.sweep(SYSTEM, axes, observe=["impacts"], output=tmp_path / "a.h5", transient=20, record=11)


def test_sweep_leaves_nothing_behind(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    found = vs.sweep(SYSTEM, {"b": [6.5, 6.6]}, **SHORT)
    assert not list(tmp_path.iterdir()) and found.x1.shape == (2, 10)


@pytest.mark.parametrize("direction, first", [("up", 0), ("down", -1)])
def test_follow_from_a_given_state(direction, first):
    start = {"follow": direction, "x1": 1.5, "v1": -0.25, "x2": 0.5, "v2": 0.125}
    found = vs.sweep(SYSTEM, {"b": [6.5, 6.55, 6.6]}, start=start, **SHORT)
    orbit = vs.simulate(SYSTEM.replace(b=float(found.b[first])), (1.5, -0.25, 0.5, 0.125), 30)
    assert np.allclose(found.x1[first], orbit.section[21:, 0], rtol=0, atol=1e-9)
    assert found.attrs["start_x1"] == 1.5 and found.attrs["start_v2"] == 0.125
    from_rest = vs.sweep(SYSTEM, {"b": [6.5, 6.55, 6.6]}, start={"follow": direction}, **SHORT)
    assert not np.allclose(found.x1[first], from_rest.x1[first], atol=1e-3)


# Pictures and datasets


def test_orbit_as_dataset():
    orbit = vs.simulate(SYSTEM, (0, 0, 0, 0), 50, start_time=1.0)
    data = orbit.to_xarray()
    assert np.array_equal(data.x1, orbit.section[:, 0]) and np.array_equal(data.t, orbit.section_times)
    assert np.array_equal(data.impact_v1, orbit.impacts["v1"]) and data.impact_t.dims == ("impact",)
    assert data.attrs["b"] == 6.6 and data.attrs["status"] == "ok" and data.attrs["start_time"] == 1.0
    rest = vs.simulate(SYSTEM.replace(R=0.0, b=1.0), (0, 0, 0, 0), 20)
    assert len(rest.sticking) and rest.to_xarray().rest_t_on.shape == rest.sticking.shape


def test_exponents_with_their_error():
    found = vs.lyapunov(SYSTEM, (0, 0, 0, 0), transient=200, record=2000)
    assert isinstance(found, np.ndarray) and found.shape == (4,) and (np.diff(found) <= 0).all()
    assert found.error.shape == (4,) and (found.error >= 0).all()
    assert abs(found.residual) < 1e-9
    longer = vs.lyapunov(SYSTEM, (0, 0, 0, 0), transient=200, record=200_000)
    assert (abs(longer - found) < 6 * found.error + 1e-9).all()
    again = pickle.loads(pickle.dumps(found))
    assert np.array_equal(again, found) and np.array_equal(again.error, found.error)
    assert again.residual == found.residual
    for derived in (found + 1, found[:2], found.sum(), np.exp(found)):
        assert not hasattr(derived, "residual")
    sweep = vs.sweep(SYSTEM, {"b": [6.6]}, transient=200, record=2000)
    assert np.array_equal(sweep.lyapunov_error[0], found.error)
