"""A file that is damaged: this is told, and what is lost is computed again."""

import os

import h5py
import numpy as np
import pytest
from support import slow_cases
from support.changes import flip, place_of
from support.contents import arrays_of, assert_same_bits, described
from support.faults import BLOCK, TEXT, counted
from support.programs import main
from support.scene_texts import parsed

import vibro_sweep as vs


def flip_a_number(path, name, point=0, bit=0):
    """Turn a bit over in a number of a point, behind HDF5's back."""
    begin, size = place_of(path, name)
    flip(path, begin + size * point // 400, bit)


@pytest.mark.parametrize("name", ["x1", "status", *slow_cases("lyapunov", "impacts_right")])
def test_a_flipped_bit(scene, path, whole, name, capsys):
    vs.run(scene, path)
    flip_a_number(path, name, point=7)
    with pytest.raises(vs.StoreError, match=rf"damaged: {name} at 1 point; `--resume` computes that again"):
        vs.open(path)
    assert f"damaged      {name} at 1 point" in described(path)
    if name == "x1":
        assert main(["plot", str(path)]) == 2
        assert f"damaged: {name} at 1 point" in capsys.readouterr().err
        with pytest.raises(vs.StoreError, match=f"damaged: {name} at 1 point"):
            vs.windows(path)
    computed = []
    vs.run(scene, path, mode="resume", progress=lambda done, _: computed.append(done))
    assert computed[0] == 399
    assert_same_bits(arrays_of(path), whole)
    assert "checksums    all hold" in described(path) and os.listdir(path.parent) == [path.name]


def test_what_is_not_read_is_not_verified(scene, path):
    vs.run(scene, path)
    flip_a_number(path, "lyapunov_residual")
    assert vs.plot(path).axes
    with pytest.raises(vs.StoreError, match="damaged: lyapunov_residual at 1 point"):
        vs.open(path)


@pytest.mark.parametrize("name", ["b", *slow_cases("sample")])
def test_a_flipped_bit_of_the_structure(scene, path, name):
    vs.run(scene, path)
    flip(path, place_of(path, name)[0], 3)
    for read in (vs.open, described, lambda path: vs.run(scene, path, mode="resume")):
        with pytest.raises(vs.StoreError, match="is damaged: its structure is not the one that was written; overwrite"):
            read(path)


def test_a_damaged_file_of_other_code_is_left_alone(scene, path, monkeypatch):
    """Its missing points could not be computed as the others were."""
    vs.run(scene, path)
    flip_a_number(path, "x1")
    before = path.read_bytes()
    monkeypatch.setattr("vibro_sweep.driver.code_hash.code_hash", lambda: "0123456789abcdef")
    with pytest.raises(vs.StoreError, match="other code, 0123456789abcdef, another numpy or numba, or a processor"):
        vs.run(scene, path, mode="resume")
    assert path.read_bytes() == before and os.listdir(path.parent) == [path.name]


@pytest.mark.slow
@pytest.mark.parametrize("count", [20, 60])
def test_flipped_bits_are_never_silent(scene, path, whole, count):
    """Anywhere in the file: it is refused, or a dataset is named, or what is read is what was written."""
    vs.run(scene, path)
    content, rng, refused = path.read_bytes(), np.random.default_rng(6), 0
    for place in rng.integers(0, len(content), count).tolist():
        path.write_bytes(content)
        flip(path, place, int(rng.integers(0, 8)))
        try:
            vs.open(path).close()
        except vs.StoreError:
            refused += 1
        else:
            assert_same_bits(arrays_of(path), whole)
    assert refused > 2 * count / 3


@pytest.mark.parametrize("keep", [0.5, *slow_cases(0.1, 0.99)])
def test_a_file_cut_off(scene, path, keep, capsys):
    vs.run(scene, path)
    os.truncate(path, int(keep * path.stat().st_size))
    for read in (vs.open, described, lambda path: vs.run(scene, path, mode="resume")):
        with pytest.raises(vs.StoreError, match="not an HDF5 file, or it is damaged"):
            read(path)
    for command in ("info", "plot"):
        assert main([command, str(path)]) == 2
        err = capsys.readouterr().err
        assert str(path) in err and "Traceback" not in err
    vs.run(scene, path, mode="overwrite")
    vs.open(path).close()


@pytest.mark.parametrize("name", ["x1", *slow_cases("status", "period")])
def test_damage_of_a_run_that_was_interrupted(scene, path, whole, name):
    """It costs the points that it is in."""
    with pytest.raises(ZeroDivisionError):
        vs.run(scene, path, workers=1, block=BLOCK, progress=lambda done, _: 1 / (done < 300))
    before = counted(described(path))[0]
    for point in (3, 200):
        flip_a_number(path, name, point, 2)
    assert f"damaged      {name} at 2 points" in described(path) and counted(described(path))[0] == before
    computed = []
    vs.run(scene, path, mode="resume", progress=lambda done, _: computed.append(done))
    assert computed[0] == before - 2
    assert_same_bits(arrays_of(path), whole)


def a_power_failure(synced: bytes, later: bytes, rng) -> bytes:
    """A file as at the last fsync, with any of the pages written since."""
    pages = range(0, len(synced), 4096)
    return b"".join((later if rng.random() < 0.5 else synced)[at : at + 4096] for at in pages)


@pytest.mark.slow
def test_after_power_failures(scene, path, whole, monkeypatch):
    """What the disk may hold after a power failure is continued to the same file."""
    synced, crashes, rng = [], [], np.random.default_rng(3)
    monkeypatch.setattr("vibro_sweep.files.sweep_file.SECONDS", 0.0)
    monkeypatch.setattr("vibro_sweep.files.sweep_file.to_disk", lambda _: synced.append(path.read_bytes()))

    def progress(*_):
        if synced:
            crashes.append((synced[-1], path.read_bytes()))

    vs.run(scene, path, workers=1, block=BLOCK, progress=progress)
    for k, (before, later) in enumerate(crashes):
        for _ in range(20):
            path.write_bytes(a_power_failure(before, later, rng))
            with h5py.File(path) as file:
                done, x1 = file["status"][()] != -1, file["x1"][()]
            assert np.array_equal(x1[done], whole["x1"][done], equal_nan=True), f"crash {k}"
        vs.run(scene, path, mode="resume")
        assert_same_bits(arrays_of(path), whole)


def test_one_orbit_is_checked_too(path):
    scene = parsed(TEXT.replace("sweep: {b: {start: 6.5, stop: 6.9, num: 400}}", ""))
    vs.run(scene, path)
    flip(path, place_of(path, "min_impact_speed")[0], 0)
    with pytest.raises(vs.StoreError, match="damaged: min_impact_speed at 1 point"):
        vs.open(path)
