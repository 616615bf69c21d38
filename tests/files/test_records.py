"""Parts of runs with records that are not theirs, and with skeletons that lead elsewhere; all checksums are right."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from support.changed_parts import records, with_skeleton
from support.changes import LINKS, elsewhere
from support.contents import numbers
from support.file_commands import REFUSED, said
from support.files import refused, seen
from support.kinds_of_files import KINDS
from support.programs import main

from vibro_sweep.store.writing import Writer


@pytest.mark.parametrize("how", LINKS)
def test_no_number_is_written_elsewhere(folder, capsys, how):
    shutil.copy("x.h5", "other.h5")
    Path("victim").write_bytes(bytes(range(256)) * 20)
    with_skeleton(lambda file: elsewhere(file, "x1", how))(Path("y.h5.part"), np.random.default_rng(1))
    before = seen(folder)
    for arguments in (["info", "y.h5.part"], ["plot", "y.h5.part"], ["run", "scene.yaml", "-o", "y.h5", "--resume"]):
        refused(capsys, arguments, "y.h5.part")
    assert seen(folder) == before


LAST = "the key of the last piece"
BYTE = [["a", "|u1", [1]]]
ODD = {
    "no piece": ({"key": {"note": "x"}, "arrays": []}, b""),
    "no key": ({"note": "x"}, b""),
    "a key that is not a text": ({"key": [1], "arrays": []}, b""),
    "no arrays": ({"key": "0:0"}, b""),
    "arrays of one word": ({"key": "0:0", "arrays": [["a"], 3]}, b""),
    "too short": ({"key": "0:0", "arrays": [["a", "<f8", [1000]]]}, b"12345678"),
    "too long": ({"key": "0:0", "arrays": [["a", "<f8", [1]]]}, b"1234567812345678"),
    "negative lengths": ({"key": "0:0", "arrays": [["a", "<f8", [-1, -1]]]}, b"12345678"),
    "endless lengths": ({"key": "0:0", "arrays": [["a", "<f8", [1e999]]]}, b"12345678"),
    "an empty array too long": ({"key": "0:0", "arrays": [["a", "<f8", [0, 10**30]]]}, b""),
    "no type of numbers": ({"key": "0:1", "arrays": [["a", "nonsense", [1]]]}, b"12345678"),
    "objects": ({"key": "0:1", "arrays": [["a", "O", [1]]]}, b"12345678"),
    "other names": ({"key": LAST, "arrays": BYTE}, b"1"),
}


def begun(words: list[str], patch, change=lambda piece: piece) -> str:
    """The part of a run that ended before its file was made, its pieces changed; returns the key of the last one."""
    plain, keys = Writer.write, []

    def changed(self, key, arrays):
        plain(self, key, change(arrays))
        keys.append(key)

    def stopped(*_):
        raise OSError("the disk is gone")

    with patch.context() as own:
        own.setattr(Writer, "write", changed)
        own.setattr(Writer, "finish", stopped)
        assert main(words) == 2
    return keys[-1]


def test_a_part_with_records_of_somebody_else(kinds, tmp_path, monkeypatch):
    """They are not pieces, and the run goes on without them."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds("sweep"), "sweep.h5")
    words, part = KINDS["windows"].command("windows"), Path("windows.h5.part")
    key = begun(words, monkeypatch)
    odd = [({**text, "key": key} if text.get("key") == LAST else text, data) for text, data in ODD.values()]
    records(*odd)(part, np.random.default_rng(1))
    assert said(["info", str(part)]).outcome == REFUSED
    assert main([*words, "--resume"]) == 0
    assert numbers(Path("windows.h5")) == numbers(kinds("windows"))


def renamed(piece):
    name, *others = piece
    return {"x": piece[name]} | {other: piece[other] for other in others}


CHANGES = {
    "another name": renamed,
    "one less": lambda piece: dict(list(piece.items())[1:]),
    "another shape": lambda piece: piece | {"value": piece["value"][1:]},
    "an index that is none": lambda piece: piece | {"branch_begins": np.int32(1000)},
    "no JSON": lambda piece: piece | {"beyond": np.zeros(3, np.uint8)},
    "other JSON": lambda piece: piece | {"beyond": np.frombuffer(b"[[1]]", np.uint8)},
}


@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", ["branches", "curves"])
def test_a_part_with_pieces_of_other_arrays(kinds, tmp_path, monkeypatch, name, change):
    """As another program may have written them: they are computed again."""
    monkeypatch.chdir(tmp_path)
    source = KINDS[name].source
    shutil.copy(kinds(source), f"{source}.h5")
    shutil.copy(kinds(name).with_suffix(".yaml"), f"{name}.yaml")
    words = KINDS[name].command(name)
    begun(words, monkeypatch, CHANGES[change])
    assert main([*words, "--resume"]) == 0
    assert numbers(Path(f"{name}.h5")) == numbers(kinds(name))
