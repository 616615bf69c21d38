"""A disk that is full, or takes no more, and an output that is removed during the run."""

import contextlib
import os
import resource
import shutil
import subprocess

import pytest
from support import slow_cases
from support.contents import arrays_of, assert_same_bits, described
from support.faults import TEXT, counted, failing_run
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
    with pytest.raises(vs.StoreError, match=r"out.h5.part needs \d+ MB, and only 3 MB are free in"):
        vs.run(scene, path, progress=lambda *_: pytest.fail("a run that cannot end was begun"))
    assert os.listdir(path.parent) == []


def test_disk_full_in_mid_run(small_disk, scene, path, whole):
    message, seen = failing_run(scene, path, "No space left on device; make room", fault=lambda: fill(path.parent))
    assert "`resume` continues it" in message
    failing_run(scene, path, "No space left on device", after=-1, mode="resume")  # still full
    (path.parent / "other").unlink()
    done, missing, failed = counted(described(f"{path}.part"))
    assert 0 < seen[3] <= done < 400 and missing == 400 - done and failed == 0
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)
    assert os.listdir(path.parent) == [path.name]


@pytest.mark.parametrize("room", [80_000, *slow_cases(0, 400_000)])
def test_disk_full_while_the_file_is_made(small_disk, scene, path, whole, capfd, room):
    """After the last block: HDF5 would say that all is well."""

    def fill_up(done, total):
        if done == total:
            fill(path.parent)
            os.truncate(path.parent / "other", max(0, os.path.getsize(path.parent / "other") - room))

    with pytest.raises(vs.StoreError, match="No space left on device; make room"):
        vs.run(scene, path, progress=fill_up)
    assert sorted(os.listdir(path.parent)) == ["other", "out.h5.part"]
    (path.parent / "other").unlink()
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)
    assert capfd.readouterr().err == ""


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
    """At every stage: while the part is made, and in its blocks."""
    with file_size_limit(size):
        failing_run(scene, path, "File too large; make room|unable to|too large", after=-1)
    if size > 300_000:
        assert 0 < counted(described(f"{path}.part"))[0] < 400
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)
    assert os.listdir(path.parent) == [path.name]


def test_disk_full_by_the_command_line(scene, path, tmp_path, capsys):
    (tmp_path / "the_scene.yaml").write_text(TEXT)
    command = ["run", str(tmp_path / "the_scene.yaml"), "-o", str(path), "--workers", "1"]
    with file_size_limit(800_000):
        assert main(command) == 2
    assert capsys.readouterr().err == (
        f"vibro-sweep: error: {path}.part: File too large; make room; "
        "what was computed until then is kept: --resume continues it\n"
    )
    assert main([*command, "--resume"]) == 0


def test_output_folder_removed(scene, path, whole):
    message, seen = failing_run(scene, path, "was removed during the run", fault=lambda: shutil.rmtree(path.parent))
    assert "it is there again, with all that was computed" in message
    assert counted(described(f"{path}.part"))[0] == seen[-1] > 0
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


def test_part_removed(scene, path, whole):
    _, seen = failing_run(scene, path, "was removed", fault=lambda: os.unlink(f"{path}.part"))
    assert counted(described(f"{path}.part"))[0] == seen[-1] > 0
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


def test_output_folder_removed_for_good(scene, path, tmp_path):
    def remove():
        shutil.rmtree(path.parent)
        path.parent.write_text("in its place")

    failing_run(scene, path, "was removed during the run, and cannot be put back", fault=remove)
