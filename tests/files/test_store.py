"""The file as others find it: its datasets, their description, its size; and files that are none of ours."""

import json

import h5py
import numpy as np
import pytest
import xarray
from support import slow_cases
from support.contents import described
from support.stored import ALL, IMPACTS, LYAPUNOV, PLANE, SECTION, SWEEP, scene_of

import vibro_sweep as vs

TRAJECTORY = "trajectory: {periods: 2, samples: 5}\n"
MOTION = {f"trajectory_{name}" for name in ("x1", "v1", "x2", "v2")}
CROSSED = {f"trajectory_section_{name}" for name in ("x1", "v1", "x2", "v2")}
HITS = {f"trajectory_impact_{name}" for name in ("t_over_T", "side", "v1", "v1_after", "x2", "v2")}
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
    **{name: {"t_over_T": 5} for name in MOTION},
    **{name: {"trajectory_section": 3} for name in CROSSED},
    **{name: {"trajectory_impact": 5} for name in HITS},
    **{name: {"exponent": 4} for name in ("lyapunov", "lyapunov_error")},
}


# Users' programs know these words and codes.
STATUSES = {
    "not_computed": -1,
    "ok": 0,
    "too_many_impacts_in_a_period": 1,
    "not_finite": 2,
    "rates_too_far_apart": 3,
    "contact_unresolved": 4,
    "beyond_a_stop": 5,
    "not_settled": 6,
}
SMALL = ("one orbit", "impact section", "random", "follow both", "plane")


@pytest.fixture(scope="module", params=[*SMALL, *slow_cases(*[kind for kind in KINDS if kind not in SMALL])])
def made(request, tmp_path_factory):
    """A kind, and its file."""
    path = tmp_path_factory.mktemp("made") / "out.h5"
    vs.run(scene_of(KINDS[request.param][0]), path)
    return request.param, path


def test_xarray_opens_it(made):
    """The dimensions of the contract, a coordinate for each, and no dataset that nobody asked for."""
    kind, path = made
    content, lead, names = KINDS[kind]
    with xarray.open_dataset(path, engine="h5netcdf") as data, vs.open(path) as own:
        assert set(own.attrs) == set(data.attrs)
        for name, value in data.attrs.items():  # what is known at the end, `open` adds
            plain = name not in ("history", "provenance", "sweep_dimensions")
            assert not plain or np.array_equal(own.attrs[name], value), name
        if kind == "follow both":  # texts of fixed length
            data["start"] = data["start"].astype(str)
        assert own.equals(data)
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
        if "t_over_T" in data:
            np.testing.assert_allclose(data["t_over_T"], np.arange(5) / 2, rtol=1e-15)


def test_everything_is_described(made):
    with h5py.File(made[1]) as file:
        for name, dataset in file.items():
            if name == "check":  # a group, for this program alone
                continue
            assert dataset.attrs["units"] and dataset.attrs["long_name"], name
            for dimension in () if dataset.is_scale else dataset.dims:
                assert len(dimension) == 1 and dimension[0].is_scale, name
                assert dimension[0].shape == (dataset.shape[[*dataset.dims].index(dimension)],)
        status = file["status"]
        assert status.dtype == np.int8 and status.attrs["flag_values"].dtype == np.int8
        words = status.attrs["flag_meanings"].split(" ")
        assert dict(zip(words, status.attrs["flag_values"].tolist(), strict=True)) == STATUSES


def test_root_attributes(path):
    scene = scene_of(SWEEP + "start: {random: 2, seed: 7}  # a comment stays\n")
    vs.run(scene, path, workers=2)
    with vs.open(path) as data:
        assert data.attrs["Conventions"] == "CF-1.11" and data.attrs["format"] == 3
        title, text, history = (data.attrs[name] for name in ("title", "scene", "history"))
        assert "the_scene" in title and text == scene.text and "# a comment stays" in text
        assert [line.split()[1] for line in history.splitlines()] == ["begun", "complete"]
        provenance = json.loads(data.attrs["provenance"])
    assert {"vibro_sweep", "python", "numpy", "numba", "h5py", "cpu", "code"} <= provenance.keys()
    assert (provenance["threads"], provenance["seed"]) == (2, 7) and provenance["wall_time_s"] >= 0


def test_size_is_what_the_file_takes(path):
    scene = scene_of(PLANE + ALL + TRAJECTORY.replace("5", "20000"))
    vs.run(scene, path)
    size = vs.estimate(scene).bytes
    assert size == pytest.approx(path.stat().st_size, abs=100_000) and size > 3_000_000


# What is not a file of ours


@pytest.fixture
def foreign(path):
    """A cut file, no HDF5 at all, an empty file, HDF5 of somebody else's."""
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
    ],
)
def test_foreign_files(foreign, name, words):
    path = foreign / name
    for read in (vs.open, described, lambda path: vs.run(scene_of(SWEEP), path, mode="resume")):
        with pytest.raises(vs.StoreError, match=words) as error:
            read(path)
        assert str(path) in str(error.value)


@pytest.mark.parametrize("read, words", [(vs.open, "no such file"), (described, "does not exist")])
def test_no_file(path, read, words):
    with pytest.raises(vs.StoreError, match=words) as error:
        read(path)
    assert str(path) in str(error.value)
