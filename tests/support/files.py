"""Good files and parts to be damaged, what may stand in a file's place, and whether a command left all alone."""

import os
import shutil
import stat
from pathlib import Path

import h5py
import numpy as np
import pytest

import vibro_sweep as vs
from support.programs import main
from support.scene_texts import parsed
from vibro_sweep.cli.info import examine
from vibro_sweep.store.attributes import set_text, set_texts

TEXT = """
system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}
sweep: {b: {start: 6.5, stop: 6.9, num: 12}}
orbit: {transient: 5, record: 6}
observe: [section, lyapunov, impacts]
"""
SCENE = parsed(TEXT, "the_scene.yaml")


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return write_files(tmp_path_factory.mktemp("files"))


def write_files(folder: Path) -> Path:
    """A complete file, whole.h5, and half.h5.part, a part with three of four blocks."""
    vs.run(SCENE, folder / "whole.h5")

    def stop(done, _):
        if done >= 9:
            raise ZeroDivisionError

    with pytest.MonkeyPatch.context() as patch, pytest.raises(ZeroDivisionError):
        patch.setattr("vibro_sweep.driver.cost.BLOCKS_PER_WORKER", 4)
        vs.run(SCENE, folder / "half.h5", workers=1, progress=stop)
    return folder


@pytest.fixture
def folder(files, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.yaml").write_text(TEXT)
    shutil.copy(files / "whole.h5", "x.h5")
    shutil.copy(files / "half.h5.part", "y.h5.part")
    return tmp_path


def described(path):
    """What `info` prints of a file."""
    return examine(path).text


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


def elsewhere(file, name, how):
    """Replace a dataset by one whose numbers are in another file."""
    shape, dtype = file[name].shape, file[name].dtype
    scales = [] if file[name].is_scale else [dimension[0] for dimension in file[name].dims]
    del file[name]
    if how == "external storage":
        file.create_dataset(name, shape, dtype, external=[("victim", 0, h5py.h5f.UNLIMITED)])
    elif how == "external link":
        file[name] = h5py.ExternalLink("other.h5", name)
        return
    elif how == "soft link":
        file[name] = h5py.SoftLink(f"/{'v1' if name == 'x1' else 'x1'}")
        return
    elif how == "looping link":
        file[name] = h5py.SoftLink(f"/{name}")
        return
    else:
        layout = h5py.VirtualLayout(shape, dtype)
        layout[...] = h5py.VirtualSource("other.h5", name, shape)
        file.create_virtual_dataset(name, layout)
    for dimension, scale in zip(file[name].dims, scales, strict=False):
        dimension.attach_scale(scale)


LINKS = ["external storage", "external link", "soft link", "looping link", "virtual dataset"]


def edit_text(name, value):
    return lambda file: set_text(file, name, value)


EDITS = {
    **{
        f"no {name}": lambda file, name=name: file.attrs.pop(name)
        for name in ("title", "history", "scene", "quantities")
    },
    "no provenance": lambda file: file.attrs.pop("provenance"),
    "no sweep_dimensions": lambda file: file.attrs.pop("sweep_dimensions"),
    "provenance no object": edit_text("provenance", "[1, 2]"),
    "provenance no JSON": edit_text("provenance", "{"),
    "title a number": lambda file: file.attrs.create("title", 3),
    "no x1": lambda file: file.pop("x1"),
    "no lyapunov": lambda file: file.pop("lyapunov"),
    "no status": lambda file: file.pop("status"),
    "no b": lambda file: file.pop("b"),
    "x1 a group": lambda file: (file.pop("x1"), file.create_group("x1")),
    "x1 of another shape": lambda file: (file.pop("x1"), file.create_dataset("x1", data=np.zeros((3, 6)))),
    "x1 of texts": lambda file: (file.pop("x1"), file.create_dataset("x1", data=["a"] * 12)),
    "quantities of others": lambda file: set_texts(file, "quantities", ["nothing", ".", "/", "b/c", ""]),
    "dimensions of others": lambda file: set_texts(file, "sweep_dimensions", ["x1"]),
    "a later format": lambda file: file.attrs.modify("format", 3),
    "mu_m of several numbers": lambda file: file.attrs.create("mu_m", [1.0, 2.0, 3.0]),
    "omega a text": edit_text("omega", "0.63"),
    "stops a number": lambda file: file.attrs.create("stops", 2.0),
    "a map without its order": edit_text("dynamics", "map"),
    "no heap": lambda file: file.attrs.pop("heap"),
    "a heap of nonsense": lambda file: file.attrs.modify("heap", np.array([5, 5, 5], np.uint64)),
}
