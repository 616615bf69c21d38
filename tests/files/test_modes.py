"""`mode` of a run where a file, or a part, exists: new, resume, overwrite."""

import os

import h5py
import pytest
from support.contents import described
from support.stored import SWEEP, broken_off, scene_of

import vibro_sweep as vs


def test_new_refuses_what_is_there(path):
    scene = scene_of(SWEEP)
    part = broken_off(scene, path)
    before = open(part, "rb").read()
    with pytest.raises(vs.StoreError, match="is an interrupted run"):
        vs.run(scene, path)
    assert open(part, "rb").read() == before
    report = vs.run(scene, path, mode="resume")
    assert 0 < report.computed < report.points
    path.chmod(0o444)
    before = path.read_bytes()
    again = vs.run(scene, path)
    assert again == report and again.computed == 0 and path.read_bytes() == before
    with pytest.raises(vs.StoreError, match=r"exists, .*\n.*another scene"):
        vs.run(scene_of(SWEEP.replace("6.7", "6.71")), path)


def test_new_refuses_a_damaged_file(path):
    scene = scene_of(SWEEP)
    vs.run(scene, path)
    with h5py.File(path) as file:
        offset = file["x1"].id.get_chunk_info(0).byte_offset
    with open(path, "rb+") as file:
        file.seek(offset)
        file.write(b"damage")
    with pytest.raises(vs.StoreError, match=r"exists, .*\n.*damaged: x1 \(1 chunk\); `resume` computes that again"):
        vs.run(scene, path)
    assert vs.run(scene, path, mode="resume").computed > 0


def test_resume_refuses_another_scene(path):
    part = broken_off(scene_of(SWEEP), path)
    other = scene_of(SWEEP.replace("6.7", "6.71"))
    with pytest.raises(vs.StoreError, match="another scene"):
        vs.run(other, path, mode="resume")
    os.rename(part, path)
    with pytest.raises(vs.StoreError, match="another scene"):
        vs.run(other, path, mode="resume")


def test_resume_refuses_other_code(path, monkeypatch):
    broken_off(scene_of(SWEEP), path)
    monkeypatch.setattr("vibro_sweep.driver.code_hash.code_hash", lambda: "0123456789abcdef")
    with pytest.raises(vs.StoreError, match="other code"):
        vs.run(scene_of(SWEEP), path, mode="resume")


def test_resume_of_nothing_is_a_run(path):
    vs.run(scene_of(SWEEP), path, mode="resume")
    assert "3 of 3" in described(path)


def test_resume_of_a_complete_file_changes_nothing(path):
    vs.run(scene_of(SWEEP), path)
    before, written = path.read_bytes(), path.stat().st_mtime_ns
    seen = []
    report = vs.run(scene_of(SWEEP), path, mode="resume", progress=lambda *progress: seen.append(progress))
    assert (report.points, report.bad, report.computed, seen) == (3, 0, 0, [(3, 3)])
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
    assert "3 of 3" in described(path)
