"""Every kind of file, damaged or edited, before every command: of damage a few cases of each kind."""

import json
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
from support import damage, sample, slow_cases
from support.changed_files import LONG, bit_in_chunk, chunked
from support.kinds_of_files import KINDS, PERIODIC
from support.programs import main

import vibro_sweep as vs
from vibro_sweep.store import parts
from vibro_sweep.store.writing import Writer


@pytest.mark.parametrize("name", slow_cases(*KINDS, PERIODIC))
def test_never_another_number_and_never_a_traceback(kinds, tmp_path, monkeypatch, name):
    """A case of each kind of damage, before commands that compute nothing; more of them by `tools.search`."""
    monkeypatch.chdir(tmp_path)
    counts, failures = damage.table(kinds, name, 1)
    assert not failures, "\n".join(failures[:20])
    assert counts.total() > 20


@pytest.mark.parametrize("name", ["windows", *slow_cases(*(name for name in KINDS if name != "windows"))])
def test_a_flipped_bit_names_file_and_dataset(kinds, tmp_path, monkeypatch, name):
    """In the first chunk of the last dataset that has one."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds(name), "x.h5")
    chosen = chunked(Path("x.h5"))[-1]
    bit_in_chunk(chosen)(Path("x.h5"), np.random.default_rng(1))
    assert chosen in damage.said(["info", "x.h5"]).message
    for told in (damage._opened("x.h5"), damage._plotted_dataset("x.h5")):
        assert told.outcome == damage.REFUSED and "x.h5" in told.message and chosen in told.message


def test_a_changed_digit_of_a_periodic_orbit(kinds, tmp_path):
    """Each digit of its impacts, one after the other."""
    text, path = kinds(PERIODIC).read_text(), tmp_path / "x.json"
    begin, end = text.index("unknowns"), text.index("residual")
    places = [i for i in range(begin, end) if text[i].isdigit()]
    for i in places[:: len(places) // 20]:
        changed = text[:i] + str((int(text[i]) + 1) % 10) + text[i + 1 :]
        if json.loads(changed) == json.loads(text):  # the last of seventeen digits
            continue
        path.write_text(changed)
        with pytest.raises(ValueError, match=r"x\.json: damaged: its "):
            vs.load(path)


@pytest.mark.parametrize(
    "attribute", ["kind", *slow_cases("provenance", "scene", "quantities", "parameters", "title", "format")]
)
def test_long_texts_are_shortened(kinds, tmp_path, monkeypatch, attribute):
    monkeypatch.chdir(tmp_path)
    path = Path(shutil.copy(kinds("windows"), "x.h5"))
    with h5py.File(path, "a") as file:
        file.attrs.create(attribute, LONG if attribute != "provenance" else f'{{"vibro_sweep": "{LONG}"}}')
    shutil.copy(kinds("sweep"), "sweep.h5")
    words = ["windows", "sweep.h5", "-o", "x.h5", "--quiet"]
    for told in (damage.said(["info", "x.h5"]), damage._opened("x.h5"), damage.said([*words, "--resume"])):
        assert LONG[:61] not in told.message, told.message


def test_a_list_of_numbers_that_is_a_text(kinds, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds("linear"), "x.h5")
    with h5py.File("x.h5", "a") as file:
        file.attrs.create("contact_normal", "no such thing")
    for words in (["info", "x.h5"], ["plot", "x.h5"]):
        told = damage.said(words)
        assert told.outcome == damage.REFUSED and "x.h5 is damaged (its attribute `contact_normal`" in told.message


ALL_COMPUTING = (*damage.COMPUTING, "vs.windows")
REFUSED_LATE = {  # kind of the file, its dataset or attribute, the value in it, words of the message
    "a scene that is none": ("sweep", "scene", "no such thing", "sweep.h5: scene: scene = "),
    "a swept number out of its range": ("sweep", "b", -1e30, "sweep.h5: b: -1e+30 is not allowed"),
    "a period of a million": ("windows", "branch_period", 10**6, "windows.h5: tables over 2000000 half periods"),
    "a period of a million in branches": ("branches", "branch_period", 10**6, "branches.h5: tables over 2000000 half"),
    "a plane of no scene": ("plane", "scene", "no such thing", "plane.h5: scene: scene = "),
    "a type without a curve": ("windows", "special_type", 7, "'boundary' in windows.h5; it must be one of fold"),
}


@pytest.mark.parametrize("case", sample(1, REFUSED_LATE))
def test_what_is_refused_late_names_the_file(kinds, tmp_path, monkeypatch, case):
    """Whatever computes from it, on the command line and in Python."""
    monkeypatch.chdir(tmp_path)
    name, where, value, words = REFUSED_LATE[case]
    file = str(shutil.copy(kinds(name), f"{name}.h5"))
    damage.write_scenes_of_commands()
    with h5py.File(file, "a") as content:
        if where in content:
            content[where][...] = value
        else:
            content.attrs[where] = value
    for key, call in damage.commands(name).items():
        if key in ALL_COMPUTING:
            told = call(file)
            assert told.outcome == damage.REFUSED and words in told.message, f"{key}: {told.message}"
            Path("made.h5.part").unlink(missing_ok=True)


def test_a_resumed_scene_of_long_text(kinds, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    damage.write_scenes_of_commands()
    shutil.copy(kinds("linear"), "linear.h5")
    with h5py.File("linear.h5", "a") as file:
        file.attrs.create("scene", LONG)
    for option in ("--resume", "--quiet"):
        told = damage.said([*KINDS["linear"].command("linear"), option])
        assert told.outcome == damage.REFUSED and LONG[:40] in told.message and LONG[:61] not in told.message


def test_a_quantity_without_its_own_dimension(kinds, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds("follow"), "x.h5")
    with h5py.File("x.h5", "a") as file:
        shape = file["status"].shape
        del file["lyapunov"]
        file["lyapunov"] = np.zeros(shape)
    for words in (["info", "x.h5"], ["plot", "x.h5"]):
        told = damage.said(words)
        assert told.outcome == damage.REFUSED and "`lyapunov` and its own dimensions" in told.message


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


def edited_part(part: Path, records) -> None:
    """With more records, their checksums right."""
    with parts.open_regular(part) as file:
        run_id = parts.read_head(file).run_id
    with part.open("ab") as file:
        for text, data in records:
            file.writelines(parts.record(run_id, text, [memoryview(data)]))


def test_a_part_with_records_of_somebody_else(kinds, tmp_path, monkeypatch):
    """They are not pieces, and the run goes on without them."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds("sweep"), "sweep.h5")
    words, part = KINDS["windows"].command("windows"), Path("windows.h5.part")
    key = begun(words, monkeypatch)
    edited_part(
        part, [({**text, "key": key} if text.get("key") == LAST else text, data) for text, data in ODD.values()]
    )
    assert damage.said(["info", str(part)]).outcome == damage.REFUSED
    assert main([*words, "--resume"]) == 0
    assert damage.contents(Path("windows.h5")) == damage.contents(kinds("windows"))


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
    assert damage.contents(Path(f"{name}.h5")) == damage.contents(kinds(name))
