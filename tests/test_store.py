"""The file as others find it: complete, described, and never lost."""

import json
import os
import pickle
import subprocess
import sys

import h5py
import numpy as np
import pytest
import xarray

import vibro_sweep as vs
from vibro_sweep import store
from vibro_sweep.driver import blocks, compute
from vibro_sweep.model.status import STATUSES
from vibro_sweep.scene import parse_scene
from vibro_sweep.store import StoreError, describe
from vibro_sweep.store.attributes import text

SYSTEM = (
    "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}\norbit: {transient: 3, record: 4}\n"
)
SWEEP = "sweep: {b: {values: [6.5, 6.6, 6.7]}}\n"
PLANE = "sweep: {R: {values: [0.7, 0.8]}, b: {values: [6.5, 6.6, 6.7]}}\n"
ALL = "observe: [section, lyapunov, impacts]\n"
TRAJECTORY = "trajectory: {periods: 2, samples: 5}\n"
SECTION = {"x1", "v1", "x2", "v2", "period"}
LYAPUNOV = {"lyapunov", "lyapunov_residual", "lyapunov_error"}
IMPACTS = {"impacts_right", "impacts_left", "min_impact_speed", "contact_error", "sticking_time"}
MOTION = {f"trajectory_{name}" for name in ("x1", "v1", "x2", "v2")}
CROSSED = {f"trajectory_section_{name}" for name in ("x1", "v1", "x2", "v2")}
HITS = {f"trajectory_impact_{name}" for name in ("time", "side", "v1", "v1_after", "x2", "v2")}
RUNNING = MOTION | CROSSED | HITS | {"trajectory_impacts"}

# the text after SYSTEM: (the dimensions of the sweep and the starts, the datasets)
KINDS = {
    "one orbit": (ALL, {}, SECTION | LYAPUNOV | IMPACTS),
    "section alone": (SWEEP, {"b": 3}, SECTION),
    "impact section": (SWEEP + "section: {kind: impact}", {"b": 3}, SECTION | {"phase"}),
    "exponents alone": (SWEEP + "observe: [lyapunov]", {"b": 3}, LYAPUNOV),
    "impacts alone": (SWEEP + "observe: [impacts]", {"b": 3}, IMPACTS),
    "trajectory alone": (SWEEP + TRAJECTORY + "observe: []", {"b": 3}, RUNNING),
    "random": (SWEEP + "start: {random: 2}\n" + ALL, {"b": 3, "start": 2}, SECTION | LYAPUNOV | IMPACTS),
    "one random": (SWEEP + "start: {random: 1}", {"b": 3}, SECTION),
    "follow": (SWEEP + "start: {follow: up}", {"b": 3}, SECTION),
    "follow both": (PLANE + "start: {follow: both}\n" + TRAJECTORY, {"R": 2, "b": 3, "start": 2}, SECTION | RUNNING),
    "plane": (PLANE + ALL + TRAJECTORY, {"R": 2, "b": 3}, SECTION | LYAPUNOV | IMPACTS | RUNNING),
}
EXTRA = {
    **{name: {"sample": 4} for name in ("x1", "v1", "x2", "v2", "phase")},
    **{name: {"time": 5} for name in MOTION},
    **{name: {"trajectory_section": 3} for name in CROSSED},
    **{name: {"trajectory_impact": 5} for name in HITS},
    **{name: {"exponent": 4} for name in ("lyapunov", "lyapunov_error")},
}


def scene_of(text):
    return parse_scene(SYSTEM + text, "some/folder/the_scene.yaml")


@pytest.fixture
def path(tmp_path):
    return tmp_path / "out.h5"


@pytest.mark.parametrize("kind", KINDS)
def test_xarray_opens_it(path, kind):
    """The dimensions of the contract, a coordinate for each, and no dataset that nobody asked for."""
    content, lead, names = KINDS[kind]
    vs.run(scene_of(content), path)
    with xarray.open_dataset(path, engine="h5netcdf") as data, vs.open(path) as own:
        for attributes in (own.attrs, data.attrs):
            if lead.keys() <= {"start"}:  # h5netcdf has its own word for a list of nothing
                attributes["sweep_dimensions"] = []
        assert own.identical(data)
        assert set(data.data_vars) == names | {"status"}
        for name, array in data.data_vars.items():
            assert array.sizes == lead | EXTRA.get(name, {}), name
            assert set(array.dims) <= set(array.coords), name
        assert np.all(data["status"] == 0)
        for name, values in scene_of(content).sweep.items():
            assert np.array_equal(data[name], values)
        if kind == "follow both":
            assert data["start"].values.tolist() == ["up", "down"]
        if kind == "random":
            assert data["start"].values.tolist() == [0, 1]
        if "sample" in data:
            assert data["sample"].values.tolist() == [0, 1, 2, 3]
        if "exponent" in data:
            assert data["exponent"].values.tolist() == [1, 2, 3, 4]
        if "time" in data:
            np.testing.assert_allclose(data["time"], np.arange(5) / 2, rtol=1e-15)


@pytest.mark.parametrize("kind", KINDS)
def test_everything_is_described(path, kind):
    vs.run(scene_of(KINDS[kind][0]), path)
    with h5py.File(path) as file:
        for name, dataset in file.items():
            assert dataset.attrs["units"] and dataset.attrs["long_name"], name
            for dimension in () if dataset.is_scale else dataset.dims:
                assert len(dimension) == 1 and dimension[0].is_scale, name
                assert dimension[0].shape == (dataset.shape[[*dataset.dims].index(dimension)],)
        status = file["status"]
        assert status.dtype == np.int8 and status.attrs["flag_values"].dtype == np.int8
        meanings = text(status, "flag_meanings").split(" ")
        assert dict(zip(status.attrs["flag_values"].tolist(), meanings, strict=True)) == {
            code: one.name for code, one in STATUSES.items()
        }
        assert (meanings[0], meanings[1]) == ("not_computed", "ok") and status.attrs["flag_values"][0] == -1


def test_root_attributes(path):
    scene = scene_of(SWEEP + "start: {random: 2, seed: 7}  # a comment stays\n")
    vs.run(scene, path, workers=2)
    with h5py.File(path) as file:
        assert text(file, "Conventions") == "CF-1.11" and file.attrs["format"] == 2
        assert "the_scene" in text(file, "title")
        assert text(file, "scene") == scene.text and "# a comment stays" in scene.text
        assert [line.split()[1] for line in text(file, "history").splitlines()] == ["begun", "complete"]
        provenance = json.loads(file.attrs["provenance"])
    assert {"vibro_sweep", "python", "numpy", "numba", "h5py", "cpu", "code"} <= provenance.keys()
    assert (provenance["threads"], provenance["seed"]) == (2, 7) and provenance["wall_time_s"] >= 0


def test_size_is_what_the_file_takes(path):
    scene = scene_of(PLANE + ALL + TRAJECTORY.replace("5", "20000"))
    vs.run(scene, path)
    assert store.size(scene) == pytest.approx(path.stat().st_size, abs=100_000)
    assert store.size(scene) > 3_000_000


# While it is written


class Interruption(Exception):  # noqa: N818
    pass


def broken_off(scene, path, mode="new"):
    """The unfinished file of a run that ends after its first block."""

    def progress(done, _):
        if done:
            raise Interruption

    with pytest.raises(Interruption):
        vs.run(scene, path, workers=1, progress=progress, mode=mode)
    return f"{path}.part"


def test_an_unfinished_file_can_be_read(path):
    part = broken_off(scene_of(SWEEP + ALL), path)
    assert not path.exists()
    with vs.open(part) as data:
        computed = data["status"].values == 0
        assert 0 < np.count_nonzero(computed) < 3
        assert np.all(np.isfinite(data["x1"][computed])) and np.all(np.isnan(data["x1"][~computed]))
        assert np.all(data["status"][~computed] == -1)


@pytest.mark.parametrize("part", [False, True])
def test_what_is_opened_can_be_copied_and_sent(path, part):
    scene = scene_of(PLANE + ALL)
    path = broken_off(scene, path) if part else vs.run(scene, path) and path
    with vs.open(path) as data:
        sent = pickle.loads(pickle.dumps(data))
        assert sent.identical(data) and data.copy(deep=True).identical(data)
        sent.close()
        assert data["x1"][0, 1:, ::2].shape == (2, 2) and data.isel(b=[2, 0])["b"].values.tolist() == [6.7, 6.5]


def test_a_file_that_is_being_written_can_be_read(path):
    scene = scene_of(SWEEP)
    with store.writer(scene, path, "new"):
        part = f"{path}.part"
        assert "computed     0 of 3" in in_another_process(
            f"from vibro_sweep.store import describe as d; print(d('{part}'))"
        )
        assert "{'b': 3, 'sample': 4}" in in_another_process(
            f"import vibro_sweep as v; print(dict(v.open('{part}').sizes))"
        )


def in_another_process(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


@pytest.mark.parametrize("mode", ["new", "resume", "overwrite"])
def test_one_writer(path, mode):
    """A second one is refused, and does the first no harm."""
    scene = scene_of(SWEEP)
    with store.writer(scene, path, "new") as first:
        code = f"""
from pathlib import Path
from vibro_sweep import store
from vibro_sweep.scene import scene
with store.writer(scene.parse_scene({scene.text!r}), Path({str(path)!r}), {mode!r}):
    print("let in")"""
        answer = in_another_process(code)
        assert "StoreError" in answer and "let in" not in answer
        assert ("being written" in answer) == (mode != "new")
        assert first.missing((slice(None),)) and first.done() == 0
    assert "0 of 3" in describe(f"{path}.part")
    vs.run(scene, path, mode="resume")
    assert "3 of 3" in describe(path)


@pytest.mark.parametrize("starts", [1, 2])
def test_what_is_missing_and_what_is_done(path, starts):
    scene = scene_of(PLANE + f"start: {{random: {starts}}}\nobserve: [impacts]")
    (*_, last) = blocks.blocks(scene, points_per_block=2)
    with store.writer(scene, path, "new") as file:
        everything = (slice(None), slice(None))
        assert file.done() == 0 and file.missing(everything)
        file.write(*compute.compute(last))
        assert file.done() == starts
        assert file.missing(everything) and file.missing((slice(1, 2), slice(1, 3)))
        assert not file.missing((slice(1, 2), slice(2, 3)))


def test_describe_says_how_far_it_is(path):
    scene = scene_of(SWEEP + ALL)
    part = broken_off(scene, path)
    assert "computed     1 of 3 orbits (33.33 %)" in describe(part)
    vs.run(scene, path, mode="resume")
    text = describe(path)
    assert "computed     3 of 3 orbits (100 %)" in text and "complete" in text and "|sum of exponents" in text
    for name in SECTION | LYAPUNOV | IMPACTS | {"b"}:
        assert name in text


# Going on, or starting again


def test_new_refuses_what_is_there(path):
    scene = scene_of(SWEEP)
    part = broken_off(scene, path)
    before = open(part, "rb").read()
    with pytest.raises(StoreError, match="is an interrupted run"):
        vs.run(scene, path)
    assert open(part, "rb").read() == before
    report = vs.run(scene, path, mode="resume")
    assert 0 < report.computed < report.points
    path.chmod(0o444)
    before = path.read_bytes()
    again = vs.run(scene, path)
    assert again == report and again.computed == 0 and path.read_bytes() == before
    with pytest.raises(StoreError, match=r"exists, .*\n.*another scene"):
        vs.run(scene_of(SWEEP.replace("6.7", "6.71")), path)


def test_new_refuses_a_damaged_file(path):
    scene = scene_of(SWEEP)
    vs.run(scene, path)
    with h5py.File(path) as file:
        offset = file["x1"].id.get_chunk_info(0).byte_offset
    with open(path, "rb+") as file:
        file.seek(offset)
        file.write(b"damage")
    with pytest.raises(StoreError, match=r"exists, .*\n.*damaged: x1 \(1 chunk\); `resume` computes that again"):
        vs.run(scene, path)
    assert vs.run(scene, path, mode="resume").computed > 0


def test_resume_refuses_another_scene(path):
    part = broken_off(scene_of(SWEEP), path)
    other = scene_of(SWEEP.replace("6.7", "6.71"))
    with pytest.raises(StoreError, match="another scene"):
        vs.run(other, path, mode="resume")
    os.rename(part, path)
    with pytest.raises(StoreError, match="another scene"):
        vs.run(other, path, mode="resume")


def test_resume_refuses_other_code(path, monkeypatch):
    broken_off(scene_of(SWEEP), path)
    monkeypatch.setattr("vibro_sweep.identity.identity", lambda: "0123456789abcdef")
    with pytest.raises(StoreError, match="other code"):
        vs.run(scene_of(SWEEP), path, mode="resume")


def test_resume_of_nothing_is_a_run(path):
    vs.run(scene_of(SWEEP), path, mode="resume")
    assert "3 of 3" in describe(path)


def test_resume_of_a_complete_file_changes_nothing(path, monkeypatch):
    vs.run(scene_of(SWEEP), path)
    before, written = path.read_bytes(), path.stat().st_mtime_ns
    monkeypatch.setattr("vibro_sweep.driver.sweep.orbit_seconds", None)  # nothing is computed
    seen = []
    report = vs.run(scene_of(SWEEP), path, mode="resume", progress=lambda *progress: seen.append(progress))
    assert (report.points, report.bad, seen) == (3, 0, [(3, 3)])
    assert path.read_bytes() == before and path.stat().st_mtime_ns == written
    assert os.listdir(path.parent) == [path.name]


def test_a_part_that_was_given_the_name_of_the_file_is_completed(path):
    vs.run(scene_of(SWEEP), path)
    with vs.open(path) as data:
        whole = data.load()
    path.unlink()
    os.rename(broken_off(scene_of(SWEEP), path), path)
    vs.run(scene_of(SWEEP), path, mode="resume")
    with vs.open(path) as data:
        assert data.equals(whole)
    assert os.listdir(path.parent) == [path.name]


def test_overwrite_keeps_the_old_file_until_the_new_one_is_complete(path):
    old, new = scene_of(SWEEP), scene_of(SWEEP.replace("6.7", "6.71"))
    vs.run(old, path)
    before = path.read_bytes()
    broken_off(new, path, mode="overwrite")
    assert path.read_bytes() == before
    vs.run(new, path, mode="resume")  # goes on with the new one
    with vs.open(path) as data:
        assert data["b"].values.tolist() == [6.5, 6.6, 6.71]
    assert os.listdir(path.parent) == [path.name]


def test_overwrite_of_a_damaged_file(path):
    path.write_bytes(b"not HDF5")
    vs.run(scene_of(SWEEP), path, mode="overwrite")
    assert "3 of 3" in describe(path)


# What is not a file of ours


@pytest.fixture
def foreign(path):
    """A cut file, no HDF5 at all, an empty file, HDF5 of somebody else's, and none."""
    vs.run(scene_of(SWEEP), path)
    whole = path.read_bytes()
    contents = {"cut": whole[: len(whole) // 2], "text": b"system: {}\n", "empty": b""}
    for name, content in contents.items():
        path.with_name(name).write_bytes(content)
    with h5py.File(path.with_name("other"), "w") as file:
        file["status"] = 0
    return path.parent


@pytest.mark.parametrize(
    "name, words",
    [
        ("cut", "not an HDF5 file, or it is damaged"),
        ("text", "not an HDF5 file, or it is damaged"),
        ("empty", "not an HDF5 file, or it is damaged"),
        ("other", "none that vibro-sweep wrote"),
        ("none", "no such file"),
    ],
)
def test_foreign_files(foreign, name, words):
    path = foreign / name
    resume = [lambda: vs.run(scene_of(SWEEP), path, mode="resume")] if name != "none" else []
    for read in (lambda: vs.open(path), lambda: describe(path), *resume):
        with pytest.raises(StoreError, match=words) as error:
            read()
        assert str(path) in str(error.value)
