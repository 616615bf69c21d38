"""The journal against a plain array of bytes: killed anywhere, the file is as some commit left it."""

import os
import subprocess
import sys

import h5py
import numpy as np
import pytest

from vibro_sweep import journal
from vibro_sweep.journal import Journal, log_path, recover


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(bytes(100))
    return path


@pytest.fixture
def rarely(monkeypatch):
    """No checkpoint but those asked for."""
    monkeypatch.setattr(journal, "CHECKPOINT_SECONDS", np.inf)


def begun(path):
    result = Journal(path)
    result.open()
    return result


def change(file, model, rng):
    """A few writes, overlapping and beyond the end too; the file as it must be then."""
    model = bytearray(model)
    for _ in range(rng.integers(1, 5)):
        at, data = int(rng.integers(0, 150)), rng.bytes(int(rng.integers(1, 60)))
        model = model.ljust(at + len(data), b"\0")
        model[at : at + len(data)] = data
        file.seek(at)
        file.write(data)
    file.seek(0)
    assert file.read() == model
    return bytes(model)


def test_what_is_read_back(path, rarely):
    rng, model = np.random.default_rng(1), path.read_bytes()
    file = begun(path)
    for step in range(60):
        model = change(file, model, rng)
        file.commit()
        if step % 7 == 0:
            file.checkpoint()
            assert path.read_bytes() == model
    at = rng.integers(0, len(model), (50, 2))
    for first, count in at.tolist():
        file.seek(first)
        assert file.read(count) == model[first : first + count]
    file.close()
    assert path.read_bytes() == model and os.listdir(path.parent) == [path.name]


def test_killed_while_the_journal_is_written(path, rarely):
    """However much of it got to the disk: the last whole commit counts."""
    rng, states, ends = np.random.default_rng(2), [path.read_bytes()], []
    file = begun(path)
    for _ in range(5):
        states.append(change(file, states[-1], rng))
        file.commit()
        ends.append(os.path.getsize(log_path(path)))
    log, main = open(log_path(path), "rb").read(), path.read_bytes()
    assert main == states[0]  # not touched yet
    for cut in range(24, len(log) + 1):
        copy = path.with_name("copy")
        copy.write_bytes(main)
        copy.with_name("copy.journal").write_bytes(log[:cut])
        recover(copy)
        assert copy.read_bytes() == states[np.searchsorted(ends, cut, "right")]
    file.close()


def test_killed_while_the_file_is_written(path, rarely, monkeypatch):
    """However many of the changes got there, and half of one."""
    rng, model = np.random.default_rng(3), path.read_bytes()
    file = begun(path)
    for _ in range(4):
        model = change(file, model, rng)
        file.commit()
    log, main = open(log_path(path), "rb").read(), bytearray(path.read_bytes())
    copy = path.with_name("copy")
    for (where, length), data in file._logged.items():
        for got in (length // 2, length):
            main = main.ljust(where + got, b"\0")
            main[where : where + got] = data[:got]
            copy.write_bytes(main)
            copy.with_name("copy.journal").write_bytes(log)
            recover(copy)
            assert copy.read_bytes() == model
    file.close()


def test_uncommitted_is_dropped(path):
    rng, model = np.random.default_rng(4), path.read_bytes()
    file = begun(path)
    model = change(file, model, rng)
    file.commit()
    change(file, model, rng)
    file.close()
    assert path.read_bytes() == model


def test_a_flipped_bit_in_the_journal_ends_it(path, rarely):
    rng, states = np.random.default_rng(5), [path.read_bytes()]
    file = begun(path)
    for _ in range(2):
        states.append(change(file, states[-1], rng))
        file.commit()
    log = bytearray(open(log_path(path), "rb").read())
    copy = path.with_name("copy")
    copy.write_bytes(path.read_bytes())
    log[-1] ^= 1
    copy.with_name("copy.journal").write_bytes(log)
    recover(copy)
    assert copy.read_bytes() == states[1]
    file.close()


def test_what_is_left_from_before_the_journal_was_emptied(path, rarely):
    """After a power failure its end may be back; an older change must not follow a newer one."""
    file = begun(path)
    for data in (b"first ", b"second"):
        file.seek(0)
        file.write(data)
        file.commit()
    old = open(log_path(path), "rb").read()
    file.checkpoint()
    file.seek(0)
    file.write(b"third ")
    file.commit()
    log, copy = open(log_path(path), "rb").read(), path.with_name("copy")
    copy.write_bytes(path.read_bytes())
    copy.with_name("copy.journal").write_bytes(log + old[len(log) :])
    recover(copy)
    assert copy.read_bytes()[:6] == b"third "
    file.close()


def test_one_holder(path):
    first = begun(path)
    with pytest.raises(BlockingIOError):
        Journal(path)
    recover(path)  # a reader: nothing to do while the holder is alive
    first.seek(0)
    first.write(b"mine")
    first.commit()
    first.close()
    begun(path).close()
    assert path.read_bytes()[:4] == b"mine"


def test_without_locks_the_second_takes_over_and_the_first_finds_out(path, monkeypatch):
    def unsupported(*_):
        raise OSError("no locks here")

    monkeypatch.setattr(journal.fcntl, "flock", unsupported)
    first = begun(path)
    first.write(b"kept")
    first.commit()
    second = begun(path)
    first.seek(0)
    first.write(b"lost")
    with pytest.raises(BlockingIOError):
        first.commit()
    first.close()
    second.seek(4)
    second.write(b" too")
    second.commit()
    second.close()
    assert path.read_bytes()[:8] == b"kept too"


KILLED = """
import os, signal, sys
import h5py, numpy as np
from vibro_sweep import journal
journal.CHECKPOINT_SECONDS = float(sys.argv[2])
file = journal.Journal(sys.argv[1])
file.open()
with h5py.File(file, "r+") as data:
    for k in range(20):
        data["x"][100 * k : 100 * k + 100] = k
        data.flush()
        file.commit()
    data["x"][:] = -1  # of a step that does not end
    data.flush()
    os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.parametrize("seconds", ["inf", "0"])
def test_hdf5_after_a_kill(tmp_path, seconds):
    path = tmp_path / "x.h5"
    with h5py.File(path, "w", libver="v110") as file:
        file.create_dataset("x", (2000,), "f4", chunks=(150,), fletcher32=True)
    assert subprocess.run([sys.executable, "-c", KILLED, path, seconds], check=False).returncode == -9
    with h5py.File(path) as file:
        assert np.any(file["x"]) == (seconds == "0")
    recover(path)
    with h5py.File(path) as file:
        assert np.array_equal(file["x"], np.repeat(np.arange(20), 100))
    assert os.listdir(tmp_path) == ["x.h5"]


def test_a_reader_takes_nothing_over(path, monkeypatch):
    """Where the file system has no locks, it cannot know whether the writer is alive."""

    def unsupported(*_):
        raise OSError("no locks here")

    monkeypatch.setattr(journal.fcntl, "flock", unsupported)
    file = begun(path)
    file.write(b"kept")
    recover(path)
    file.commit()
    file.close()
    assert path.read_bytes()[:4] == b"kept"
