"""Pictures as files: what exists is replaced only when asked for, but for our own that nobody has changed."""

import os
import stat
import struct
import zlib
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from support import slow_cases
from support.files import OBSTACLES, refused, seen
from support.programs import main

import vibro_sweep as vs
from vibro_sweep import plotting

SUFFIXES = (".png", ".svg", ".pdf")


@pytest.mark.parametrize("suffix", slow_cases(*SUFFIXES))
def test_a_picture_of_ours_is_drawn_anew_until_somebody_changes_it(folder, suffix):
    (path,) = plotting.plot("x.h5", f"a{suffix}")
    first = path.stat().st_ino
    plotting.plot("x.h5", path)
    assert path.stat().st_ino != first
    whole = path.read_bytes()
    rng = np.random.default_rng(1)
    changes = [whole + b"\n", whole[:-1], whole[: len(whole) // 2], b"", whole + whole]
    for place in rng.integers(0, len(whole), 4).tolist():
        changes.append(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
    for changed in changes:
        path.write_bytes(changed)
        with pytest.raises(
            vs.PlotError, match="exists, and is not a picture that vibro-sweep drew; --overwrite replaces it"
        ):
            plotting.plot("x.h5", path)
        assert path.read_bytes() == changed
    plotting.plot("x.h5", path, overwrite=True)
    plotting.plot("x.h5", path)
    assert not [name for name in os.listdir() if name.startswith(".")]


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".png", *slow_cases(".svg", ".pdf")])
def test_a_seal_makes_no_picture_worse(folder, suffix):
    """It is a chunk of text, or a comment."""
    plotting.plot("x.h5", f"a{suffix}")
    content = Path(f"a{suffix}").read_bytes()
    if suffix == ".png":
        assert matplotlib.image.imread("a.png").ndim == 3
        at, names = 8, []
        while at < len(content):
            length, name = struct.unpack_from(">I4s", content, at)
            (checksum,) = struct.unpack_from(">I", content, at + 8 + length)
            assert checksum == zlib.crc32(content[at + 4 : at + 8 + length])
            names.append(name)
            at += 12 + length
        assert at == len(content) and names[-2:] == [b"tEXt", b"IEND"]
    if suffix == ".svg":
        import xml.etree.ElementTree

        assert xml.etree.ElementTree.fromstring(content).tag.endswith("svg")
    if suffix == ".pdf":
        assert content.rstrip().splitlines()[-2] == b"%%EOF" and len(content.splitlines()[-1]) < 100


@pytest.mark.parametrize(
    "what", ["text", "link", *slow_cases(*(one for one in OBSTACLES if one not in ("text", "link")))]
)
def test_what_is_no_picture_of_ours_is_left_alone(folder, capsys, what):
    OBSTACLES[what](folder / "x.png")
    before = seen(folder)
    refused(capsys, ["plot", "x.h5"], "x.png")
    refused(capsys, ["plot", "y.h5.part", "-o", "x.png"], "x.png")
    assert seen(folder) == before
    if what not in ("text", "hdf5"):
        refused(capsys, ["plot", "x.h5", "--overwrite"], "x.png")
        assert seen(folder) == before
    else:
        assert main(["plot", "x.h5", "--overwrite"]) == 0


def test_a_link_to_the_data_is_left_alone(folder, capsys):
    Path("x.png").symlink_to("x.h5")
    Path("z.png").symlink_to("y.h5.part")
    before = seen(folder)
    for arguments in (
        ["plot", "x.h5"],
        ["plot", "x.h5", "-o", "z.png"],
        ["plot", "x.h5", "-o", "z.png", "--overwrite"],
    ):
        refused(capsys, arguments, "png")
    assert seen(folder) == before


def test_a_run_looks_first_whether_its_picture_is_in_the_way(folder, capsys):
    Path("out.png").write_text("years of work")
    before = seen(folder)
    refused(capsys, ["run", "scene.yaml", "-o", "out.h5", "--plot"], "out.png", "--overwrite")
    assert seen(folder) == before
    assert main(["run", "scene.yaml", "-o", "out.h5", "--plot", "--overwrite"]) == 0
    assert main(["run", "scene.yaml", "-o", "out.h5", "--plot", "--resume"]) == 0  # that one is ours


def test_a_picture_that_appears_meanwhile(folder, monkeypatch):
    def drawn(*_):
        Path("x.png").write_text("years of work")
        return figure(*_)

    figure = plotting._draw
    monkeypatch.setattr(plotting, "_draw", drawn)
    with pytest.raises(vs.PlotError, match="exists, and is not a picture"):
        plotting.plot("x.h5")
    assert Path("x.png").read_text() == "years of work"


def test_a_picture_that_appears_at_the_last_moment(folder, monkeypatch):
    from matplotlib.figure import Figure

    plain = Figure.savefig

    def saved(self, *arguments, **options):
        plain(self, *arguments, **options)
        Path("x.png").write_text("years of work")

    monkeypatch.setattr(Figure, "savefig", saved)
    with pytest.raises(vs.PlotError, match="has just appeared"):
        plotting.plot("x.h5")
    assert Path("x.png").read_text() == "years of work"


def test_permissions_are_those_of_any_new_file(folder):
    plotting.plot("x.h5")
    Path("any").write_text("")
    assert stat.S_IMODE(os.stat("x.png").st_mode) == stat.S_IMODE(os.stat("any").st_mode)
