"""A good file, an unfinished one, what may stand in their place, and whether a command left all alone."""

import os
import shutil
import stat
from pathlib import Path

import h5py
import pytest

import vibro_sweep as vs
from support.oscillators import PAPER_NUMBERS
from support.programs import main
from support.scene_texts import parsed

TEXT = f"""
system: {{{PAPER_NUMBERS}, b: 6.6}}
sweep: {{b: {{start: 6.5, stop: 6.9, num: 12}}}}
orbit: {{transient: 5, record: 6}}
observe: [section, lyapunov, impacts]
"""
SCENE = parsed(TEXT, "the_scene.yaml")


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return write_files(tmp_path_factory.mktemp("files"))


def write_files(folder: Path) -> Path:
    """A complete file, whole.h5, and half.h5, with three of four blocks."""
    vs.run(SCENE, folder / "whole.h5")

    def stop(done, _):
        if done >= 9:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        vs.run(SCENE, folder / "half.h5", workers=1, block=3, progress=stop)
    return folder


@pytest.fixture
def folder(files, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.yaml").write_text(TEXT)
    shutil.copy(files / "whole.h5", "x.h5")
    shutil.copy(files / "half.h5", "y.h5")
    return tmp_path


def seen(folder):
    """All that is in a folder, as it is."""
    result = {}
    for path in sorted(folder.rglob("*")):
        status = path.lstat()
        kind = stat.S_IFMT(status.st_mode)
        content = path.read_bytes() if kind == stat.S_IFREG and status.st_size < 10**8 else None
        target = os.readlink(path) if kind == stat.S_IFLNK else None
        result[path.name] = kind, status.st_size, status.st_mtime_ns, content, target
    return result


def refused(capsys, arguments, *words):
    """One message, status 2."""
    assert main(list(map(str, arguments))) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1 and "Traceback" not in told and all(word in told for word in words), told


def link_to(place):
    Path("victim").write_text("years of work")
    place.symlink_to("victim")


OBSTACLES = {
    "text": lambda place: place.write_text("years of work"),
    "link": link_to,
    "dangling": lambda place: place.symlink_to("nowhere"),
    "pipe": os.mkfifo,
    "folder": Path.mkdir,
    "device": lambda place: place.symlink_to("/dev/null"),
    "hdf5": lambda place: h5py.File(place, "w").close(),
}
