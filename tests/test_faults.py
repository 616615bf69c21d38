"""What can break on the way: the user is told, nothing is silently wrong, and what is computed can be gone on with."""

import contextlib
import json
import os
import resource
import shutil
import subprocess
import sys

import h5py
import numpy as np
import pytest
from support import ROOT
from support.scenes import arrays_of, assert_same_bits

import vibro_sweep as vs
from vibro_sweep import cli, plotting, store
from vibro_sweep.driver import blocks, compute
from vibro_sweep.scene import parse_scene
from vibro_sweep.store import StoreError, describe, layout

TEXT = """
system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}
sweep: {b: {start: 6.5, stop: 6.9, num: 400}}
orbit: {transient: 5, record: 60}
observe: [section, lyapunov, impacts]
"""  # 1 MB


@pytest.fixture
def path(tmp_path):
    return tmp_path / "folder" / "out.h5"


@pytest.fixture(autouse=True)
def folder(path):
    path.parent.mkdir()


@pytest.fixture
def scene(monkeypatch):
    monkeypatch.setattr("vibro_sweep.driver.memory.BLOCK_BYTES", 100_000)  # some ten blocks
    return parse_scene(TEXT, "the_scene.yaml")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "whole.h5"
    vs.run(parse_scene(TEXT), path)
    return arrays_of(path)


def counted(text):
    """What `info` says: done, missing, failed."""
    words = [line.split() for line in text.splitlines()]
    return tuple(
        int(line[1].replace(",", "")) for line in words if line and line[0] in ("computed", "missing", "failed")
    )


def failing_run(scene, path, words, after=3, fault=lambda: None, mode="new"):
    """The message of a run that meets `fault` after some blocks."""
    seen = []

    def progress(done, _):
        seen.append(done)
        if len(seen) == after + 1:
            fault()

    with pytest.raises(StoreError, match=words) as error:
        vs.run(scene, path, workers=1, progress=progress, mode=mode)
    assert "\n" not in str(error.value)
    return str(error.value), seen


# The disk


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
    scene = parse_scene(TEXT.replace("num: 400", "num: 4000"))
    with pytest.raises(StoreError, match=r"out.h5.part needs \d+ MB, and only 3 MB are free in"):
        vs.run(scene, path, progress=lambda *_: pytest.fail("a run that cannot end was begun"))
    assert os.listdir(path.parent) == []


def test_disk_full_in_mid_run(small_disk, scene, path, whole):
    message, seen = failing_run(scene, path, "No space left on device; make room", fault=lambda: fill(path.parent))
    assert "`resume` continues it" in message
    failing_run(scene, path, "No space left on device", after=-1, mode="resume")  # still full
    (path.parent / "other").unlink()
    done, missing, failed = counted(describe(f"{path}.part"))
    assert 0 < seen[3] <= done < 400 and missing == 400 - done and failed == 0
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)
    assert os.listdir(path.parent) == [path.name]


@pytest.mark.parametrize("room", [0, 80_000, 400_000])
def test_disk_full_while_the_file_is_made(small_disk, scene, path, whole, capfd, room):
    """After the last block: HDF5 would say that all is well."""

    def fill_up(done, total):
        if done == total:
            fill(path.parent)
            os.truncate(path.parent / "other", max(0, os.path.getsize(path.parent / "other") - room))

    with pytest.raises(StoreError, match="No space left on device; make room"):
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


@pytest.mark.parametrize("size", [1_000, 30_000, 300_000, 800_000])
def test_a_disk_that_takes_no_more(scene, path, whole, size):
    """At every stage: while the part is made, and in its blocks."""
    with file_size_limit(size):
        failing_run(scene, path, "File too large; make room|unable to|too large", after=-1)
    if size > 300_000:
        assert 0 < counted(describe(f"{path}.part"))[0] < 400
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)
    assert os.listdir(path.parent) == [path.name]


def test_disk_full_by_the_command_line(scene, path, tmp_path, capsys):
    (tmp_path / "the_scene.yaml").write_text(TEXT)
    command = ["run", str(tmp_path / "the_scene.yaml"), "-o", str(path), "--workers", "1"]
    with file_size_limit(800_000):
        assert cli.main(command) == 2
    assert capsys.readouterr().err == (
        f"vibro-sweep: error: {path}.part: File too large; make room; "
        "what was computed until then is kept: --resume continues it\n"
    )
    assert cli.main([*command, "--resume"]) == 0


def test_output_folder_removed(scene, path, whole):
    message, seen = failing_run(scene, path, "was removed during the run", fault=lambda: shutil.rmtree(path.parent))
    assert "it is there again, with all that was computed" in message
    assert counted(describe(f"{path}.part"))[0] == seen[-1] > 0
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


def test_part_removed(scene, path, whole):
    _, seen = failing_run(scene, path, "was removed", fault=lambda: os.unlink(f"{path}.part"))
    assert counted(describe(f"{path}.part"))[0] == seen[-1] > 0
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


def test_output_folder_removed_for_good(scene, path, tmp_path):
    def remove():
        shutil.rmtree(path.parent)
        path.parent.write_text("in its place")

    failing_run(scene, path, "was removed during the run, and cannot be put back", fault=remove)


# The file


def flip(path, name, bit=0, chunk=0):
    """Turn a bit over in a chunk, behind HDF5's back."""
    with h5py.File(path) as file:
        where = file[name].id.get_chunk_info(chunk)
        place = where.byte_offset + where.size // 2
        box = tuple(slice(at, at + n) for at, n in zip(where.chunk_offset, file[name].chunks, strict=True))
    with open(path, "r+b") as file:
        file.seek(place)
        byte = file.read(1)[0]
        file.seek(place)
        file.write(bytes([byte ^ 1 << bit]))
    return box


@pytest.mark.parametrize("name", ["x1", "lyapunov", "impacts_right", "status", "b"])
def test_a_flipped_bit(scene, path, whole, name, capsys):
    vs.run(scene, path)
    box = flip(path, name)
    with pytest.raises(OSError, match="read data"), h5py.File(path) as file:
        file[name][()]
    with pytest.raises(StoreError, match=rf"damaged: {name} \(1 chunk\); `run --resume`"):
        vs.open(path)
    assert f"damaged      {name} (1 chunk)" in describe(path)
    if name != "lyapunov":  # which the picture of the section does not need
        assert cli.main(["plot", str(path)]) == 2
        assert f"`{name}` cannot be read, it is damaged" in capsys.readouterr().err
    computed = []
    vs.run(scene, path, mode="resume", progress=lambda done, _: computed.append(done))
    assert computed[0] == (400 if name == "b" else 400 - len(range(400)[box[0]]))
    assert_same_bits(arrays_of(path), whole)
    assert f"damage found, to be computed again: {name} (1 chunk)" in describe(path)
    assert "checksums    all hold" in describe(path) and os.listdir(path.parent) == [path.name]


@pytest.mark.parametrize("name", ["impacts_right", "impacts_left", "status", "period"])
def test_zeros_that_become_ones(scene, path, whole, name):
    """Two bytes at a time, as a worn-out disk may give them: Fletcher-32 alone does not see it."""
    vs.run(scene, path)
    with h5py.File(path) as file:
        where = file[name].id.get_chunk_info(0)
    content = bytearray(path.read_bytes())
    chunk = slice(where.byte_offset, where.byte_offset + where.size)
    found = content.index(bytes(4), chunk.start)
    assert found < chunk.stop
    content[found : found + 4] = b"\xff" * 4
    path.write_bytes(content)
    with pytest.raises(StoreError, match=rf"damaged: {name} \(1 chunk\)"):
        vs.open(path)
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


def test_a_damaged_file_of_other_code_is_left_alone(scene, path, monkeypatch):
    """Its missing points could not be computed as the others were."""
    vs.run(scene, path)
    flip(path, "x1")
    before = path.read_bytes()
    monkeypatch.setattr("vibro_sweep.identity.identity", lambda: "0123456789abcdef")
    with pytest.raises(StoreError, match="other code, 0123456789abcdef, or another numpy or numba; overwrite it"):
        vs.run(scene, path, mode="resume")
    assert path.read_bytes() == before and os.listdir(path.parent) == [path.name]


def test_several_flipped_bits(scene, path, whole):
    vs.run(scene, path)
    for name, chunk in (("x1", 0), ("x1", 1), ("status", 0), ("b", 0)):
        flip(path, name, bit=3, chunk=chunk)
    assert "damaged      status (1 chunk), b (1 chunk), x1 (2 chunks)" in describe(path)
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


@pytest.mark.parametrize("count", [50, pytest.param(500, marks=pytest.mark.slow)])
def test_flipped_bits_are_never_silent(scene, path, whole, count):
    """Anywhere in the file: it is refused, or a dataset is named, or what is read is what was written."""
    vs.run(scene, path)
    content, rng, refused = path.read_bytes(), np.random.default_rng(6), 0
    for place in rng.integers(0, len(content), count).tolist():
        changed = bytearray(content)
        changed[place] ^= 1 << int(rng.integers(0, 8))
        path.write_bytes(changed)
        try:
            vs.open(path).close()
        except StoreError:
            refused += 1
        else:
            assert_same_bits(arrays_of(path), whole)
    assert refused > 2 * count / 3


def test_one_orbit_is_checked_too(path):
    """A number that is no chunk lies in a header with a checksum."""
    scene = parse_scene(TEXT.replace("sweep: {b: {start: 6.5, stop: 6.9, num: 400}}", ""))
    vs.run(scene, path)
    with h5py.File(path) as file:
        number = file["min_impact_speed"][()]
    content = path.read_bytes()
    assert content.count(number.tobytes()) == 1
    changed = bytearray(content)
    changed[content.index(number.tobytes())] ^= 1
    path.write_bytes(changed)
    for read in (vs.open, describe):
        with pytest.raises(StoreError, match="damaged"):
            read(path)


@pytest.mark.parametrize("keep", [0.1, 0.5, 0.99])
def test_a_file_cut_off(scene, path, keep, capsys):
    vs.run(scene, path)
    os.truncate(path, int(keep * path.stat().st_size))
    for read in (vs.open, describe, lambda path: vs.run(scene, path, mode="resume")):
        with pytest.raises(StoreError, match="not an HDF5 file, or it is damaged"):
            read(path)
    for command in ("info", "plot"):
        assert cli.main([command, str(path)]) == 2
        err = capsys.readouterr().err
        assert str(path) in err and "Traceback" not in err
    vs.run(scene, path, mode="overwrite")
    vs.open(path).close()


@pytest.mark.parametrize("keep", [0.0, 0.01, 0.5, 0.999])
def test_a_part_cut_off_in_mid_run(scene, path, whole, keep):
    """The run stops, and goes on from the blocks that are left; no hole is taken for numbers."""

    def cut():
        os.truncate(f"{path}.part", int(keep * os.path.getsize(f"{path}.part")))

    failing_run(scene, path, "was changed by another program", fault=cut)
    if keep == 0.5:
        with vs.open(f"{path}.part") as data:
            assert np.all(np.isfinite(data["x1"][data["status"] == 0]))
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


@pytest.mark.parametrize("where", [0.3, 0.6])
def test_a_flipped_bit_in_a_part(scene, path, whole, where):
    """It costs the block that it is in, and is told; the blocks behind it stay."""
    with pytest.raises(ZeroDivisionError):
        vs.run(scene, path, workers=1, progress=lambda done, _: 1 / (done < 300))
    part = path.with_name(path.name + ".part")
    before = counted(describe(part))[0]
    content = bytearray(part.read_bytes())
    content[int(where * len(content))] ^= 4
    part.write_bytes(content)
    assert "damaged      1 block of the run" in describe(part) and 0 < counted(describe(part))[0] < before
    with pytest.raises(StoreError, match="is damaged: 1 block of the run"):
        vs.open(part)
    with pytest.raises(ZeroDivisionError):
        vs.run(scene, path, workers=1, progress=lambda done, _: 1 / (done < before), mode="resume")
    vs.open(part).close()  # what was lost is there again
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)
    assert "damage found, to be computed again: 1 block of the run" in describe(path)


# Two runs


def test_two_runs_on_one_file(scene, path, tmp_path):
    """By the command line; HDF5's own locks are not needed."""
    text = tmp_path / "the_scene.yaml"
    text.write_text(TEXT)
    with store.writer(scene, path, "new"):
        for option in ("--resume", "--overwrite"):
            second = subprocess.run(
                [sys.executable, "-m", "vibro_sweep", "run", text, "-o", path, option],
                capture_output=True,
                text=True,
                check=False,
                env=os.environ | {"HDF5_USE_FILE_LOCKING": "FALSE"},
            )
            assert second.returncode == 2
            assert second.stderr == f"vibro-sweep: error: {path}.part is being written by another run\n"


def test_readers_of_a_running_run(scene, path):
    """They see what is computed, whole blocks only, and write nothing."""
    with store.writer(scene, path, "new") as file:
        part = path.with_name(path.name + ".part")
        first, second, *_ = blocks.blocks(scene, 40)
        file.write(*compute.compute(first))
        before = part.read_bytes(), part.stat().st_mtime_ns
        with vs.open(part) as data, plotting.result.Result(part) as result:
            assert np.count_nonzero(data["status"] != -1) == result.done.sum() == 40
            assert np.all(np.isnan(data["x1"][40:])) and np.all(data["status"][40:] == -1)
            file.write(*compute.compute(second))
            assert np.count_nonzero(data["status"] != -1) == 40  # as it was when it was opened
        assert counted(describe(part))[0] == 80
        assert part.read_bytes()[: len(before[0])] == before[0] and os.listdir(path.parent) == [part.name]


# What does not belong together


def test_what_differs_is_said(scene, path):
    vs.run(scene, path)
    other = parse_scene(TEXT.replace("num: 400", "num: 401"))
    with pytest.raises(StoreError, match="another scene") as error:
        vs.run(other, path, mode="resume")
    told = str(error.value).splitlines()[-2:]
    assert told[0].startswith("  - sweep: {b: {start: 6.5, stop: 6.9, num: 400}}")
    assert told[1].startswith("  + sweep: {b: {start: 6.5, stop: 6.9, num: 401}}")


def test_provenance_that_is_illegible(scene, path):
    vs.run(scene, path)
    with h5py.File(path, "r+") as file:
        assert json.loads(file.attrs["provenance"])
        file.attrs["provenance"] = "{"
    with pytest.raises(StoreError, match="damaged"):
        describe(path)


# The shape of the file


@pytest.mark.parametrize("follow", [False, True])
def test_chunks(follow):
    """Large enough to be read at once, small enough to be written for a block, and cut as blocks are."""
    scene = parse_scene(
        TEXT.replace("sweep:", "sweep: {R: {start: 0.5, stop: 0.9, num: 3000},").replace(", {b:", ", b:")
        + "start: {follow: up}" * follow
    )
    assert scene.sweep_shape == (3000, 400)
    shapes = {n: layout.chunk_shape(scene, scene.shape + (60,) * (n == "x1"), 8) for n in ("x1", "lyapunov_residual")}
    assert shapes == (
        {"x1": (273, 1, 60), "lyapunov_residual": (3000, 5)}
        if follow
        else {"x1": (1, 200, 60), "lyapunov_residual": (40, 400)}
    )
    for shape in shapes.values():
        assert layout.CHUNK_BYTES / 2 < 8 * np.prod(shape) <= layout.CHUNK_BYTES


def test_a_large_file_is_made_at_once(path):
    """10^9 points: what is not computed takes no place, and reads as such."""
    scene = parse_scene(
        TEXT.replace("sweep:", "sweep: {R: {start: 0.5, stop: 0.9, num: 31600},")
        .replace(", {b:", ", b:")
        .replace("num: 400", "num: 31600")
        .replace("[section, lyapunov, impacts]", "[impacts]")
    )
    assert store.size(scene) > 39e9
    with h5py.File(path, "w", libver="v110") as file:
        layout.create(file, scene)
        assert file["status"].size > 9.98e8 and file["status"][31599, 31599] == -1
        assert np.isnan(file["sticking_time"][5, 7])
    assert path.stat().st_size < 3e6


@pytest.mark.slow
@pytest.mark.parametrize("by, count", [("1 worker", 4), ("2 workers", 6), ("Dask", 8)])
def test_killed_at_random_moments(monkeypatch, by, count):
    """Some of the kills of benchmarks/kills.py: each costs about the block that each worker is at."""
    monkeypatch.syspath_prepend(ROOT / "benchmarks")
    import kills

    found, _, same = kills.measure(count, by, 7)
    assert same and len(found) == count
    assert {kill.how for kill in found} & {"KILL", "INT", "KILL the scheduler"}
    assert all(0 <= kill.blocks <= (1 if by == "1 worker" else 2) for kill in found)
