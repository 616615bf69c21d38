"""`mode` of a run where a file exists: new, resume, overwrite."""

import fcntl
import os

import pytest
from support.changes import place_of
from support.contents import described
from support.stored import SWEEP, broken_off, scene_of

import vibro_sweep as vs


def test_new_refuses_what_is_there(path):
    scene = scene_of(SWEEP)
    broken_off(scene, path)
    before = path.read_bytes()
    with pytest.raises(vs.StoreError, match="is an interrupted run: 2 of 3 points are not computed; `resume` computes"):
        vs.run(scene, path)
    assert path.read_bytes() == before
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
    offset, _ = place_of(path, "x1")
    with open(path, "rb+") as file:
        file.seek(offset)
        file.write(b"damage")
    with pytest.raises(vs.StoreError, match="is damaged: x1 at 1 point; `resume` computes that"):
        vs.run(scene, path)
    assert vs.run(scene, path, mode="resume").computed > 0


def test_resume_refuses_another_scene(path):
    broken_off(scene_of(SWEEP), path)
    with pytest.raises(vs.StoreError, match="another scene"):
        vs.run(scene_of(SWEEP.replace("6.7", "6.71")), path, mode="resume")


def test_a_scene_that_says_the_same_is_the_same(path):
    broken_off(scene_of(SWEEP), path)
    other = scene_of(SWEEP.replace("6.5, 6.6", "6.50,   6.6") + "# a remark\n")
    assert vs.run(other, path, mode="resume").computed > 0


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
    before = path.read_bytes()
    seen = []
    report = vs.run(scene_of(SWEEP), path, mode="resume", progress=lambda *progress: seen.append(progress))
    assert (report.points, report.bad, report.computed, seen) == (3, 0, 0, [(3, 3)])
    assert path.read_bytes() == before
    assert os.listdir(path.parent) == [path.name]


def test_a_complete_file_is_as_new(path):
    """For `make`, which compares times."""
    vs.run(scene_of(SWEEP), path)
    os.utime(path, (1, 1))
    vs.run(scene_of(SWEEP), path)
    assert path.stat().st_mtime > 1


def test_overwrite_begins_with_the_new_file(path):
    old, new = scene_of(SWEEP), scene_of(SWEEP.replace("6.7", "6.71"))
    vs.run(old, path)
    broken_off(new, path, mode="overwrite")
    vs.run(new, path, mode="resume")
    with vs.open(path) as data:
        assert data["b"].values.tolist() == [6.5, 6.6, 6.71]
    assert os.listdir(path.parent) == [path.name]


def test_what_is_refused_leaves_the_old_file(path):
    vs.run(scene_of(SWEEP), path)
    before = path.read_bytes()
    huge = scene_of("sweep: {R: {start: 0.5, stop: 0.9, num: 30000}, b: {start: 6, stop: 7, num: 30000}}\n")
    with pytest.raises(vs.StoreError, match=r"needs [\d,]+ MB, and only [\d,]+ MB are free"):
        vs.run(huge, path, mode="overwrite")
    assert path.read_bytes() == before


def test_an_interrupted_run_of_version_2_is_refused(path):
    path.with_name("x.h5.part").write_bytes(b"\x89vibro_sweep\r\n\x1a\n" + bytes(100))
    with pytest.raises(vs.StoreError, match=r"is an interrupted run of vibro_sweep 0\.2, which this version does not"):
        vs.open(path.with_name("x.h5.part"))


def test_overwrite_of_a_damaged_file(path):
    path.write_bytes(b"not HDF5")
    vs.run(scene_of(SWEEP), path, mode="overwrite")
    assert "3 of 3" in described(path)


@pytest.mark.parametrize("module, call", [(os, "open"), (fcntl, "flock"), (os, "lstat")])
def test_ctrl_c_while_a_file_is_locked_leaves_no_lock(path, monkeypatch, module, call):
    """It comes out of whichever system call the main thread is in, and then the next run is free to begin."""
    scene, real = scene_of(SWEEP), getattr(module, call)

    def interrupted(what, *arguments):
        result = real(what, *arguments)
        if call == "flock" or str(what).endswith(".lock"):
            monkeypatch.setattr(module, call, real)
            raise KeyboardInterrupt
        return result

    monkeypatch.setattr(module, call, interrupted)
    with pytest.raises(KeyboardInterrupt):
        vs.run(scene, path)
    assert not list(path.parent.glob("*.lock"))
    assert vs.run(scene, path).computed == 3
