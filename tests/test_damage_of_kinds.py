"""Every kind of file, damaged or edited, before every command: a few cases always, all of them with `-m soak`."""

import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
from support import damage
from support.changed_files import chunked
from support.kinds_of_files import KINDS, write_scenes

from vibro_sweep.cli import main
from vibro_sweep.store import parts
from vibro_sweep.store.pieces import Pieces

BEYOND = [
    pytest.param(name, some, full, id=f"{some} {name}", marks=mark)
    for some, full, mark, names in (
        (1, False, pytest.mark.slow, ("follow", "branches")),
        (20, True, pytest.mark.soak, KINDS),
    )
    for name in names
]


@pytest.mark.parametrize("name, some, slow", BEYOND)
def test_never_another_number_and_never_a_traceback(kinds, tmp_path, monkeypatch, capsys, name, some, slow):
    monkeypatch.chdir(tmp_path)
    counts, failures = damage.table(kinds, name, some, slow)
    if slow:
        with capsys.disabled():
            print(f"\n{damage.in_words(name, counts)}")
    assert not failures, "\n".join(failures[:20])
    assert counts.total() > 20 * some


@pytest.mark.parametrize("name", KINDS)
def test_a_flipped_bit_names_file_and_dataset(kinds, tmp_path, monkeypatch, name):
    """In the first chunk of the last dataset that has one."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds / f"{name}.h5", "x.h5")
    chosen = chunked(Path("x.h5"))[-1]
    with h5py.File("x.h5") as file:
        at = file[chosen].id.get_chunk_info(0).byte_offset
    content = bytearray(Path("x.h5").read_bytes())
    content[at + 20] ^= 1
    Path("x.h5").write_bytes(content)
    assert chosen in damage.said(["info", "x.h5"]).message
    for told in (damage._opened("x.h5"), damage._plotted_dataset("x.h5")):
        assert told.outcome == damage.REFUSED and "x.h5" in told.message and chosen in told.message


def test_a_list_of_numbers_that_is_a_text(kinds, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds / "linear.h5", "x.h5")
    with h5py.File("x.h5", "a") as file:
        file.attrs.create("along", "no such thing")
    for words in (["info", "x.h5"], ["plot", "x.h5"]):
        told = damage.said(words)
        assert told.outcome == damage.REFUSED and "x.h5 is damaged (its attribute `along`" in told.message


def test_a_quantity_without_its_own_dimension(kinds, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds / "follow.h5", "x.h5")
    with h5py.File("x.h5", "a") as file:
        shape = file["status"].shape
        del file["lyapunov"]
        file["lyapunov"] = np.zeros(shape)
    for words in (["info", "x.h5"], ["plot", "x.h5"]):
        told = damage.said(words)
        assert told.outcome == damage.REFUSED and "`lyapunov` and its own dimensions" in told.message


ODD = {
    "no piece": ({"note": "x"}, b""),
    "a key that is no text": ({"piece": [1], "arrays": []}, b""),
    "no arrays": ({"piece": "0:0"}, b""),
    "too short": ({"piece": "0:0", "arrays": [["a", "<f8", [1000]]]}, b"12345678"),
    "too long": ({"piece": "0:0", "arrays": [["a", "<f8", [1]]]}, b"1234567812345678"),
    "no type of numbers": ({"piece": "0:1", "arrays": [["a", "nonsense", [1]]]}, b"12345678"),
    "objects": ({"piece": "0:1", "arrays": [["a", "O", [1]]]}, b"12345678"),
}


def test_a_part_with_records_of_somebody_else(kinds, tmp_path, monkeypatch):
    """With their checksums right: they are no pieces, and the run goes on without them."""
    monkeypatch.chdir(tmp_path)
    write_scenes(tmp_path)
    shutil.copy(kinds / "sweep.h5", "sweep.h5")
    plain, kept = Pieces.write, []

    def stopped(self, key, arrays):
        plain(self, key, arrays)
        kept.append(key)
        raise OSError("the disk is gone")

    words, part = KINDS["windows"].command("windows"), Path("windows.h5.part")
    with monkeypatch.context() as patch:
        patch.setattr(Pieces, "write", stopped)
        assert main(words) == 2
    good = part.read_bytes()
    with parts.open_regular(part) as file:
        identity = parts.read_head(file).identity
    for name, (text, data) in ODD.items():
        part.write_bytes(good + b"".join(map(bytes, parts.record(identity, text, [memoryview(data)]))))
        assert damage.said(["info", str(part)]).outcome == damage.REFUSED, name
        assert main([*words, "--resume"]) == 0, name
        assert damage.contents(Path("windows.h5")) == damage.contents(kinds / "windows.h5"), name
        Path("windows.h5").unlink()
