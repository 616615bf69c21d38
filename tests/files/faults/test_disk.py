"""A disk that is full, or takes no more, and an output that is removed during the run."""

import contextlib
import errno
import itertools
import os
import resource
import shutil
import subprocess

import pytest
from support import slow_cases
from support.contents import arrays_of, assert_same_bits, described
from support.faults import BLOCK, TEXT, counted, failing_run
from support.programs import main
from support.scene_texts import parsed

import vibro_sweep as vs


@pytest.fixture
def small_disk(path):
    """A file system of 3 MB at the folder."""
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=3m", "tmpfs", path.parent], capture_output=True, check=False
    )
    if mounted.returncode:
        pytest.skip("a small tmpfs cannot be mounted here (not root)")
    yield path.parent
    subprocess.run(["umount", "-l", path.parent], check=True)


def fill(folder):
    """Another program's file that leaves no room."""
    with contextlib.suppress(OSError), open(folder / "other", "wb", buffering=0) as file:
        while True:
            file.write(bytes(4096))


def test_a_disk_too_small_is_said_before_anything_is_computed(small_disk, path):
    scene = parsed(TEXT.replace("num: 400", "num: 4000"))
    with pytest.raises(vs.StoreError, match=r"out.h5 needs \d+ MB, and only 3 MB are free in"):
        vs.run(scene, path, progress=lambda *_: pytest.fail("a run that cannot end was begun"))
    assert os.listdir(path.parent) == []


def test_a_disk_that_others_fill_during_the_run(small_disk, scene, path, whole):
    """The room for all blocks was taken at the beginning."""
    seen = []

    def progress(done, _):
        seen.append(done)
        if len(seen) == 3:
            fill(path.parent)

    vs.run(scene, path, workers=1, progress=progress, block=BLOCK)
    assert_same_bits(arrays_of(path), whole)


@contextlib.contextmanager
def file_size_limit(size):
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("size", [1_000, *slow_cases(30_000, 300_000, 800_000)])
def test_a_disk_that_takes_no_more(scene, path, whole, size):
    """When the file is made: nothing is computed, and nothing is left."""
    with file_size_limit(size):
        failing_run(scene, path, "File too large; make room|unable to|too large", after=-1)
    assert os.listdir(path.parent) == []
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


def test_a_write_that_fails(scene, path, whole, monkeypatch):
    """As on file systems that copy what is written: what is on the disk is kept."""
    written, count = os.pwrite, itertools.count()

    def pwrite(*arguments):
        if next(count) > 100:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return written(*arguments)

    with monkeypatch.context() as patch:
        patch.setattr("vibro_sweep.files.sweep_file.SECONDS", 0.0)
        patch.setattr(os, "pwrite", pwrite)
        message, _ = failing_run(scene, path, "No space left on device; make room", after=-1)
    assert "`resume` continues it" in message and 0 < counted(described(path))[0] < 400
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)
    assert os.listdir(path.parent) == [path.name]


def test_what_did_not_reach_the_disk_has_no_status(scene, path, whole, monkeypatch):
    """After a failure a second attempt may say that all is well, and the numbers are gone."""
    answers = iter([None, OSError(errno.EIO, os.strerror(errno.EIO))])

    def to_disk(_):
        if answer := next(answers, None):
            raise answer

    with monkeypatch.context() as patch:
        patch.setattr("vibro_sweep.files.sweep_file.SECONDS", 0.0)
        patch.setattr("vibro_sweep.files.sweep_file.to_disk", to_disk)
        failing_run(scene, path, "Input/output error", after=-1)
    assert counted(described(path))[0] == BLOCK
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


def test_disk_full_by_the_command_line(scene, path, tmp_path, capsys):
    (tmp_path / "the_scene.yaml").write_text(TEXT)
    command = ["run", str(tmp_path / "the_scene.yaml"), "-o", str(path), "--workers", "1"]
    with file_size_limit(800_000):
        assert main(command) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"vibro-sweep: error: {path}: ") and "the file is not made" in told
    assert main([*command, "--resume"]) == 0


@pytest.mark.parametrize("remove", [lambda path: shutil.rmtree(path.parent), lambda path: path.unlink()])
def test_what_is_removed_during_the_run(scene, path, monkeypatch, remove):
    monkeypatch.setattr("vibro_sweep.files.sweep_file.SECONDS", 0.0)
    failing_run(scene, path, "was removed, or replaced, during the run", fault=lambda: remove(path))
    assert not path.exists()
