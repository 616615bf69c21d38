"""A file or a part that is damaged: this is told, and what is lost is computed again."""

import json
import os

import h5py
import numpy as np
import pytest
from support import slow_cases
from support.changes import chunk_of, flip, zeros_to_ones
from support.contents import arrays_of, assert_same_bits, described
from support.faults import BLOCK, TEXT, counted, failing_run
from support.programs import main
from support.scene_texts import parsed

import vibro_sweep as vs


def flip_in_chunk(path, name, bit=0, chunk=0):
    """Turn a bit over in a chunk, behind HDF5's back; the part of the dataset that is lost."""
    begin, size = chunk_of(path, name, chunk)
    with h5py.File(path) as file:
        place, shape = file[name].id.get_chunk_info(chunk).chunk_offset, file[name].chunks
    flip(path, begin + size // 2, bit)
    return tuple(slice(at, at + length) for at, length in zip(place, shape, strict=True))


@pytest.mark.parametrize("name", ["x1", *slow_cases("b", "lyapunov", "impacts_right", "status")])
def test_a_flipped_bit(scene, path, whole, name, capsys):
    vs.run(scene, path)
    box = flip_in_chunk(path, name)
    with pytest.raises(OSError, match="read data"), h5py.File(path) as file:
        file[name][()]
    with pytest.raises(vs.StoreError, match=rf"damaged: {name} \(1 chunk\); `--resume`"):
        vs.open(path)
    assert f"damaged      {name} (1 chunk)" in described(path)
    if name != "lyapunov":  # which the picture of the section does not need
        assert main(["plot", str(path)]) == 2
        assert f"`{name}` cannot be read, it is damaged" in capsys.readouterr().err
    computed = []
    vs.run(scene, path, mode="resume", progress=lambda done, _: computed.append(done))
    assert computed[0] == (400 if name == "b" else 400 - len(range(400)[box[0]]))
    assert_same_bits(arrays_of(path), whole)
    assert f"damage found, to be computed again: {name} (1 chunk)" in described(path)
    assert "checksums    all hold" in described(path) and os.listdir(path.parent) == [path.name]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["status", *slow_cases("impacts_right", "impacts_left", "period")])
def test_zeros_that_become_ones(scene, path, whole, name):
    vs.run(scene, path)
    before = path.read_bytes()
    zeros_to_ones(name)(path, np.random.default_rng(1))
    assert path.read_bytes() != before
    with pytest.raises(vs.StoreError, match=rf"damaged: {name} \(1 chunk\)"):
        vs.open(path)
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


def test_a_damaged_file_of_other_code_is_left_alone(scene, path, monkeypatch):
    """Its missing points could not be computed as the others were."""
    vs.run(scene, path)
    flip_in_chunk(path, "x1")
    before = path.read_bytes()
    monkeypatch.setattr("vibro_sweep.driver.code_hash.code_hash", lambda: "0123456789abcdef")
    with pytest.raises(vs.StoreError, match="other code, 0123456789abcdef, another numpy or numba, or a processor"):
        vs.run(scene, path, mode="resume")
    assert path.read_bytes() == before and os.listdir(path.parent) == [path.name]


@pytest.mark.slow
def test_several_flipped_bits(scene, path, whole):
    vs.run(scene, path)
    for name, chunk in (("x1", 0), ("x1", 1), ("status", 0), ("b", 0)):
        flip_in_chunk(path, name, bit=3, chunk=chunk)
    assert "damaged      status (1 chunk), b (1 chunk), x1 (2 chunks)" in described(path)
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)


@pytest.mark.slow
@pytest.mark.parametrize("count", [20, pytest.param(500, marks=pytest.mark.slow)])
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


def test_one_orbit_is_checked_too(path):
    """A number that is not a chunk lies in a header with a checksum."""
    scene = parsed(TEXT.replace("sweep: {b: {start: 6.5, stop: 6.9, num: 400}}", ""))
    vs.run(scene, path)
    with h5py.File(path) as file:
        number = file["min_impact_speed"][()]
    content = path.read_bytes()
    assert content.count(number.tobytes()) == 1
    flip(path, content.index(number.tobytes()), 0)
    for read in (vs.open, described):
        with pytest.raises(vs.StoreError, match="damaged"):
            read(path)


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


@pytest.mark.slow
@pytest.mark.parametrize("keep", [0.5, *slow_cases(0.0, 0.01, 0.999)])
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


@pytest.mark.parametrize("where", [0.3, *slow_cases(0.6)])
def test_a_flipped_bit_in_a_part(scene, path, whole, where):
    """It costs the block that it is in, and is told; the blocks behind it stay."""
    with pytest.raises(ZeroDivisionError):
        vs.run(scene, path, workers=1, block=BLOCK, progress=lambda done, _: 1 / (done < 300))
    part = path.with_name(path.name + ".part")
    before = counted(described(part))[0]
    flip(part, int(where * part.stat().st_size), 2)
    assert "damaged      1 block of the run" in described(part) and 0 < counted(described(part))[0] < before
    with pytest.raises(vs.StoreError, match="is damaged: 1 block of the run"):
        vs.open(part)
    with pytest.raises(ZeroDivisionError):
        vs.run(scene, path, workers=1, block=BLOCK, progress=lambda done, _: 1 / (done < before), mode="resume")
    vs.open(part).close()  # what was lost is there again
    vs.run(scene, path, mode="resume")
    assert_same_bits(arrays_of(path), whole)
    assert "damage found, to be computed again: 1 block of the run" in described(path)


def test_provenance_that_is_illegible(scene, path):
    vs.run(scene, path)
    with h5py.File(path, "r+") as file:
        assert json.loads(file.attrs["provenance"])
        file.attrs["provenance"] = "{"
    with pytest.raises(vs.StoreError, match="damaged"):
        described(path)
