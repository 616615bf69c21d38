"""What can break on the way: the user is told, nothing is silently wrong, and what is computed can be gone on with."""

import contextlib
import json
import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from test_sweep import arrays_of, assert_same_bits

import vibro_sweep as vs
from vibro_sweep import cli, journal, plotting, store
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
    monkeypatch.setattr("vibro_sweep.cost.BLOCK_BYTES", 100_000)  # some ten blocks
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


def let_go(journal):
    """What the operating system does with a journal whose program is killed."""
    os.close(journal._log)
    os.close(journal._file)


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
    """At every stage: while the file is made, in the journal, in the file itself."""
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
        "what was computed until then is kept: `resume` continues it\n"
    )
    assert cli.main([*command, "--resume"]) == 0


def test_output_folder_removed(scene, path, whole):
    message, seen = failing_run(scene, path, "was removed during the run", fault=lambda: shutil.rmtree(path.parent))
    assert "it is there again, with all that was computed" in message
    assert counted(describe(f"{path}.part"))[0] == seen[-1] > 0
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


def test_journal_removed(scene, path, whole):
    _, seen = failing_run(scene, path, "was removed", fault=lambda: os.unlink(f"{path}.part.journal"))
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


def test_a_damaged_file_of_other_kernels_is_left_alone(scene, path, monkeypatch):
    """Its missing points could not be computed as the others were."""
    vs.run(scene, path)
    flip(path, "x1")
    before = path.read_bytes()
    monkeypatch.setattr("vibro_sweep.store.opening.source_hash", lambda: "0123456789abcdef")
    with pytest.raises(StoreError, match="other kernels, 0123456789abcdef; overwrite it"):
        vs.run(scene, path, mode="resume")
    assert path.read_bytes() == before and os.listdir(path.parent) == [path.name]


def test_several_flipped_bits(scene, path, whole):
    vs.run(scene, path)
    for name, chunk in (("x1", 0), ("x1", 1), ("status", 0), ("b", 0)):
        flip(path, name, bit=3, chunk=chunk)
    assert "damaged      status (1 chunk), b (1 chunk), x1 (2 chunks)" in describe(path)
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


def test_flipped_bits_are_never_silent(scene, path, whole):
    """Anywhere in the file: it is refused, or a dataset is named, or what is read is what was written."""
    vs.run(scene, path)
    content, rng, refused = path.read_bytes(), np.random.default_rng(6), 0
    for place in rng.integers(0, len(content), 150).tolist():
        changed = bytearray(content)
        changed[place] ^= 1 << int(rng.integers(0, 8))
        path.write_bytes(changed)
        try:
            vs.open(path).close()
        except StoreError:
            refused += 1
        else:
            assert_same_bits(arrays_of(path), whole)
    assert refused > 100


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


def test_a_file_cut_off_in_mid_run(scene, path):
    """It is not filled up again: HDF5 would take the zeros in the hole for numbers."""
    failing_run(scene, path, "another program cut it off", fault=lambda: os.truncate(f"{path}.part", 3000))
    for read in (lambda: vs.open(f"{path}.part"), lambda: vs.run(scene, path, mode="resume")):
        with pytest.raises(StoreError, match="damaged"):
            read()
    vs.run(scene, path, mode="overwrite")


def test_a_file_cut_off_after_a_kill(scene, path, monkeypatch):
    monkeypatch.setattr(journal.Journal, "close", let_go)
    monkeypatch.setattr(journal, "CHECKPOINT_SECONDS", np.inf)
    with pytest.raises(ZeroDivisionError):
        vs.run(scene, path, workers=1, progress=lambda done, _: 1 / (done < 200))
    monkeypatch.undo()
    os.truncate(f"{path}.part", 3000)
    with pytest.raises(StoreError, match="not an HDF5 file, or it is damaged"):
        vs.open(f"{path}.part")
    with pytest.raises(StoreError, match="another program cut it off"):
        vs.run(scene, path, mode="resume")


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


def test_plain_readers_of_a_running_run(scene, path):
    """Others need no option to look at it."""
    with store.writer(scene, path, "new"), h5py.File(f"{path}.part") as file:
        assert np.all(file["status"][()] == -1) and np.all(np.isnan(file["x1"]))


def test_reading_puts_right_what_a_kill_left(scene, path, whole, monkeypatch):
    monkeypatch.setattr(journal, "CHECKPOINT_SECONDS", np.inf)
    monkeypatch.setattr(journal.Journal, "close", let_go)
    with pytest.raises(ZeroDivisionError):
        vs.run(scene, path, workers=1, progress=lambda done, _: 1 / (done < 200))
    monkeypatch.undo()
    with h5py.File(f"{path}.part") as file:
        assert np.all(file["status"][()] == -1)
    with plotting.result.Result(f"{path}.part") as result:
        assert result.done.sum() >= 200
    assert os.listdir(path.parent) == [f"{path.name}.part"]
    vs.run(parse_scene(TEXT, "the_scene.yaml"), path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


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
def test_killed_at_random_moments(monkeypatch):
    """Ten of the hundred kills of benchmarks/kills.py: each costs at most the block that each worker is at."""
    monkeypatch.syspath_prepend(Path(__file__).parents[1] / "benchmarks")
    import kills

    found, _, same = kills.measure(10, 2, 7)
    assert same
    assert len({kill.when for kill in found}) > 1
    assert all(0 <= kill.blocks <= 2 for kill in found)
