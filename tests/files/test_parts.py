"""The part of a run, against a plain list of its blocks: killed anywhere, what was whole is there, and nothing else."""

import io
import itertools
import os

import numpy as np
import portalocker
import pytest

import vibro_sweep as vs
from vibro_sweep.store import appending, heap, names, parts
from vibro_sweep.store.parts import PartError, Scan

SKELETON = b"skeleton " * 20


@pytest.fixture
def path(tmp_path):
    return tmp_path / "out.h5.part"


def begun(path):
    part = appending.make(path)
    part.begin(parts.new_head(SKELETON, None, parts.new_run_id()), SKELETON)
    return part


def of(raw):
    """The arrays of a record."""
    return {"a": np.frombuffer(raw, np.uint8)}


def written(path, count=6):
    """A part with some blocks, its bytes, and where each block ends."""
    rng, blocks, ends = np.random.default_rng(1), [], []
    part = begun(path)
    for k in range(count):
        blocks.append(([[k, k + 1]], rng.bytes(int(rng.integers(0, 60)))))
        part.append(blocks[-1][0], of(blocks[-1][1]))
        ends.append(path.stat().st_size)
    part.close()
    return blocks, path.read_bytes(), ends


def read(content):
    """The blocks of a part, and how many are damaged."""
    file = io.BytesIO(content)
    head = parts.read_head(file)
    parts.copy_skeleton(file, head, io.BytesIO())
    scan = Scan(FileLike(content), head)
    found = [(record.key, content[record.at : record.at + record.layout[0][2][0]]) for record in scan]
    return found, scan.damaged


class FileLike(io.BytesIO):
    def fileno(self):
        raise OSError(0, "no holes to be skipped")


def test_what_is_written_is_read(path):
    blocks, content, _ = written(path)
    assert read(content) == (blocks, 0)


def test_killed_while_a_block_is_written(path):
    """However much of it got to the disk: the whole blocks count, and a run goes on behind them."""
    blocks, content, ends = written(path)
    for cut in range(ends[0], len(content)):
        whole = int(np.searchsorted(ends, cut, "right"))
        assert read(content[:cut]) == (blocks[:whole], 0)
    path.write_bytes(content[:-1])
    part = appending.lock(path)
    part.go_on(parts.read_head(part.file), ends[-2])
    part.append([[9, 10]], of(b"more"))
    part.close()
    assert read(path.read_bytes()) == ([*blocks[:-1], ([[9, 10]], b"more")], 0)


def test_every_flipped_bit_is_found(path):
    """It costs the block that it is in, and no other; in the head or the skeleton, all is refused."""
    blocks, content, ends = written(path, 4)
    first = len(content) - (ends[-1] - ends[0]) - (ends[0] - parts.read_head(io.BytesIO(content)).start - len(SKELETON))
    for place, bit in itertools.product(range(len(content)), (0, 7)):
        changed = bytearray(content)
        changed[place] ^= 1 << bit
        if place < first:
            with pytest.raises(PartError):
                read(bytes(changed))
            continue
        hit = int(np.searchsorted(ends, place, "right"))
        found, damaged = read(bytes(changed))
        assert found == blocks[:hit] + blocks[hit + 1 :] and damaged == 1


def test_one_holder(path):
    first = begun(path)
    with pytest.raises(BlockingIOError):
        appending.lock(path)
    with pytest.raises(FileExistsError):
        appending.make(path)
    first.close()
    appending.lock(path).close()


def test_without_locks_the_first_finds_out(path, monkeypatch):
    def unsupported(*_):
        raise portalocker.LockException("no locks here")

    monkeypatch.setattr(appending.portalocker, "lock", unsupported)
    first, second = begun(path), appending.lock(path)
    second.go_on(parts.read_head(second.file), path.stat().st_size)
    second.append([[0, 1]], of(b"kept"))
    with pytest.raises(vs.StoreError, match="changed by another program"):
        first.append([[0, 1]], of(b"lost"))
    first.close()
    second.append([[1, 2]], of(b" too"))
    second.close()
    assert [data for _, data in read(path.read_bytes())[0]] == [b"kept", b" too"]


def test_a_full_disk_leaves_whole_blocks(path, monkeypatch):
    part = begun(path)
    part.append([], of(b"kept"))
    before = path.read_bytes()

    class Full(io.FileIO):
        left = 3

        def write(self, data):
            if self.left == 0:
                raise OSError(28, "No space left on device")
            self.left -= 1
            return super().write(data[:10])

    part.file.close()
    part.file = Full(path, "r+")
    with pytest.raises(vs.StoreError, match="No space left on device; make room"):
        part.append([], of(bytes(100)))
    assert path.read_bytes() == before
    part.close()


def test_a_hole_is_not_searched(path):
    """A part that somebody has made a terabyte long is read at once."""
    blocks, content, _ = written(path)
    with open(path, "r+b") as file:
        file.seek(len(content))
        file.write(b"garbage" * 20)
        file.truncate(2**40)
    with parts.open_regular(path) as file:
        scan = Scan(file, parts.read_head(file))
        assert [record.key for record in scan] == [key for key, _ in blocks] and scan.damaged == 1


# Names


def test_nothing_is_replaced_unasked(tmp_path):
    new, path = tmp_path / "new", tmp_path / "file"
    new.write_text("new")
    path.write_text("other")
    old = names.stamp(path)
    with pytest.raises(FileExistsError):
        names.publish(new, path, None)
    path.write_text("changed")
    with pytest.raises(FileExistsError):
        names.publish(new, path, old)
    names.publish(new, path, names.stamp(path))
    assert path.read_text() == "new" and os.listdir(tmp_path) == ["file"]


@pytest.mark.parametrize("links", [True, False])
def test_a_name_is_given_only_if_it_is_free(tmp_path, monkeypatch, links):
    """Also at the very last moment, and where a file system has no hard links."""

    def unsupported(*_):
        raise PermissionError(1, "no hard links here")

    if not links:
        monkeypatch.setattr(names.os, "link", unsupported)
    new, path = tmp_path / "new", tmp_path / "file"
    new.write_text("new")
    path.symlink_to(tmp_path / "elsewhere")
    monkeypatch.setattr(names, "stamp", lambda _: None)  # it was not there yet when this was looked at
    with pytest.raises(FileExistsError):
        names.publish(new, path, None)
    assert not (tmp_path / "elsewhere").exists()
    path.unlink()
    names.publish(new, path, None)
    assert path.read_text() == "new" and os.listdir(tmp_path) == ["file"]


# The heap


def test_heaps_that_hdf5_cannot_walk_through(tmp_path):
    body = bytearray(4096)
    body[:16] = heap.START + (4096).to_bytes(8, "little")
    body[16:32] = (1).to_bytes(2, "little") + bytes(6) + (5).to_bytes(8, "little")
    body[32:40] = b"hello\0\0\0"
    body[40:64] = (3).to_bytes(2, "little") + bytes(6) + (8).to_bytes(8, "little") + b"position"  # 2 was removed
    body[64:80] = bytes(8) + (4096 - 64).to_bytes(8, "little")  # the rest is free
    whole = io.BytesIO(body)
    last, checksum = heap.measured(whole, 0)
    assert last == 3
    heap.verify(whole, 0, last, checksum)
    for place in range(80):
        changed = bytearray(body)
        changed[place : place + 16] = bytes(16)
        if changed != body:
            try:
                heap.verify(io.BytesIO(changed), 0, last, checksum)
            except heap.HeapError:
                continue
            assert changed[:64] == body[:64], place  # only the size of what is free
