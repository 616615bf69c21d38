"""Pictures as files: what exists is replaced only when asked for, but for our own that nobody has changed."""

import os
import stat
import struct
import subprocess
import sys
import zlib
from pathlib import Path

import h5py
import matplotlib.image
import matplotlib.pyplot
import numpy as np
import pytest
from matplotlib.figure import Figure
from support import slow_cases
from support.files import OBSTACLES, refused, seen
from support.oscillators import PAPER
from support.programs import main
from support.scene_texts import parsed

import vibro_sweep as vs

SUFFIXES = (".png", ".jpg", ".svg", ".pdf", ".eps")


@pytest.mark.parametrize("suffix", slow_cases(*SUFFIXES))
def test_a_picture_of_ours_is_drawn_anew_until_somebody_changes_it(folder, suffix):
    path = Path(f"a{suffix}")
    vs.plot("x.h5", output=path)
    first = path.stat().st_ino
    vs.plot("x.h5", output=path)
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
            vs.plot("x.h5", output=path)
        assert path.read_bytes() == changed
    vs.plot("x.h5", output=path, overwrite=True)
    vs.plot("x.h5", output=path)
    assert not [name for name in os.listdir() if name.startswith(".")]


@pytest.mark.slow
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_seal_makes_no_picture_worse(folder, suffix):
    """It is a chunk of text, or a comment."""
    vs.plot("x.h5", output=f"a{suffix}")
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
    if suffix == ".jpg":
        from PIL import Image

        with Image.open("a.jpg") as picture:
            assert (
                picture.info["comment"].startswith(b"vibro_sweep sha256:") and picture.convert("L").getextrema()[0] < 99
            )
    if suffix == ".eps":
        assert content.splitlines()[-2] == b"showpage" and content.splitlines()[-1].startswith(b"% vibro_sweep sha256:")


@pytest.mark.parametrize(
    "what", ["text", "link", *slow_cases(*(obstacle for obstacle in OBSTACLES if obstacle not in ("text", "link")))]
)
def test_what_is_no_picture_of_ours_is_left_alone(folder, capsys, what):
    OBSTACLES[what](folder / "x.png")
    before = seen(folder)
    refused(capsys, ["plot", "x.h5"], "x.png")
    refused(capsys, ["plot", "y.h5", "-o", "x.png"], "x.png")
    assert seen(folder) == before
    if what not in ("text", "hdf5"):
        refused(capsys, ["plot", "x.h5", "--overwrite"], "x.png")
        assert seen(folder) == before
    else:
        assert main(["plot", "x.h5", "--overwrite"]) == 0


def test_a_link_to_the_data_is_left_alone(folder, capsys):
    Path("x.png").symlink_to("x.h5")
    Path("z.png").symlink_to("y.h5")
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
    """While it is drawn, of which its title is a part."""
    plain = Figure.suptitle

    def drawn(self, *arguments, **options):
        Path("x.png").write_text("years of work")
        return plain(self, *arguments, **options)

    monkeypatch.setattr(Figure, "suptitle", drawn)
    with pytest.raises(vs.PlotError, match="exists, and is not a picture"):
        vs.plot("x.h5", output="x.png")
    assert Path("x.png").read_text() == "years of work"


def test_a_picture_that_appears_at_the_last_moment(folder, monkeypatch):
    plain = Figure.savefig

    def saved(self, *arguments, **options):
        plain(self, *arguments, **options)
        Path("x.png").write_text("years of work")

    monkeypatch.setattr(Figure, "savefig", saved)
    with pytest.raises(vs.PlotError, match="has just appeared"):
        vs.plot("x.h5", output="x.png")
    assert Path("x.png").read_text() == "years of work"


def test_permissions_are_those_of_any_new_file(folder):
    vs.plot("x.h5", output="x.png")
    Path("any").write_text("")
    assert stat.S_IMODE(os.stat("x.png").st_mode) == stat.S_IMODE(os.stat("any").st_mode)


@pytest.mark.parametrize(
    ("suffix", "magic"),
    [
        *[(".png", b"\x89PNG"), (".jpg", b"\xff\xd8\xff"), (".eps", b"%!PS-Adobe-3.0 EPSF")],
        *slow_cases((".svg", b"<?xml"), (".pdf", b"%PDF")),
    ],
)
def test_the_suffix_is_the_format(folder, capfd, suffix, magic):
    assert main(["plot", "x.h5", "-o", f"figure{suffix}"]) == 0
    assert capfd.readouterr().err == ""
    assert Path(f"figure{suffix}").read_bytes().startswith(magic)


@pytest.mark.slow
def test_names_of_pictures(folder, tmp_path):
    """Of the file, in the current folder; of each kind, and of single orbits, with its name, so that none replaces the
    diagram."""
    (tmp_path / "here").mkdir()
    os.chdir(tmp_path / "here")
    assert main(["plot", "../x.h5"]) == main(["plot", "../y.h5"]) == 0
    diagram = Path("x.png").read_bytes()
    assert main(["plot", "../x.h5", "--at", "b=6.6", "--kind", "poincare"]) == 0
    assert main(["plot", "../x.h5", "-o", "all.svg", "--kind", "all"]) == 0
    assert main(["plot", "../x.h5", "-o", "at.svg", "--kind", "all", "--at", "b=6.6"]) == 0
    text = (folder / "scene.yaml").read_text().partition("\nsweep:")[0]
    vs.run(
        parsed(f"{text}\norbit: {{transient: 5, record: 5}}\ntrajectory: {{periods: 2, samples: 41}}"), "../motion.h5"
    )
    assert main(["plot", "../motion.h5", "-o", "motion.svg", "--kind", "all"]) == 0
    kinds = {
        "all": ("bifurcation", "lyapunov", "impacts", "iteration", "poincare"),
        "at": ("iteration", "poincare"),
        "motion": ("phase-portrait", "configuration", "history", "film", "iteration", "poincare"),
    }
    of_kinds = {f"{name}-{kind}.svg" for name, of_file in kinds.items() for kind in of_file}
    assert {*os.listdir()} == {"x.png", "y.png", "x-poincare.png", *of_kinds}
    assert Path("x.png").read_bytes() == diagram and all(Path(name).stat().st_size > 1000 for name in os.listdir())


def test_the_data_are_never_overwritten(folder):
    odd = Path("x.h5").rename("result.png")
    before = odd.read_bytes()
    with pytest.raises(vs.PlotError, match=r"that is .*result\.png, which is read for it"):
        vs.plot(odd, output=odd)
    assert odd.read_bytes() == before


@pytest.mark.parametrize("output", ["figure.bmp", "figure", "figure.h5"])
def test_an_output_of_another_format_is_refused(folder, output):
    with pytest.raises(vs.PlotError, match=r"\.png, \.jpg, \.svg, \.pdf, \.eps"):
        vs.plot("x.h5", output=output)
    assert not Path(output).exists()


def test_a_folder_that_is_not_there(folder):
    with pytest.raises(vs.PlotError, match="cannot be written"):
        vs.plot("x.h5", output="nowhere/figure.png")


def test_files_that_are_no_results(folder):
    Path("text.h5").write_text("system: {}\n" * 100)
    with h5py.File("foreign.h5", "w") as file:
        file["status"] = np.zeros(3)
    words = {"missing": "no such file", "text": "not an HDF5 file", "foreign": "none that vibro-sweep wrote"}
    for name, told in words.items():
        with pytest.raises(vs.PlotError, match=told):
            vs.plot(f"{name}.h5")


@pytest.mark.parametrize("arguments, options, dpi", [
    (["--size", "4", "3", "--dpi", "50"], dict(size=(4, 3), dpi=50), 50),
    *slow_cases(
        (["--at", "b=6.61"], dict(at={"b": 6.6}), None),
        (["--variable", "v1", "--kind", "iteration"], dict(variable="v1", kind="iteration"), None),
        (["--xlim", "6.55", "6.65", "--ylim", "-2", "7"], dict(xlim=(6.55, 6.65), ylim=(-2, 7)), None),
    ),
])  # fmt: skip
def test_options_of_the_command_line_are_those_of_python(folder, arguments, options, dpi):
    assert main(["plot", "x.h5", "-o", "a.png", *arguments]) == 0
    vs.plot("x.h5", output="b.png", **options)
    vs.plot("x.h5", output="c.png")
    assert Path("a.png").read_bytes() == Path("b.png").read_bytes() != Path("c.png").read_bytes()
    if dpi:
        assert matplotlib.image.imread("a.png").shape[:2] == (150, 200)


@pytest.mark.slow
def test_a_point_of_a_plane_is_chosen_by_two_numbers(folder):
    axes = {"b": [6, 6.6], "R": [0.7, 0.8]}
    vs.sweep(PAPER, axes, transient=5, record=5, observe=["section"], output="plane.h5").close()
    assert main(["plot", "plane.h5", "-o", "a.png", "--at", "b=6", "--at", "R=0.7"]) == 0
    vs.plot("plane.h5", output="b.png", at={"b": 6, "R": 0.7})
    vs.plot("plane.h5", output="c.png", at={"b": 6})
    assert Path("a.png").read_bytes() == Path("b.png").read_bytes() != Path("c.png").read_bytes()


@pytest.mark.slow
def test_drawing_needs_no_display_and_no_engine(folder):
    code = (
        "import sys, vibro_sweep as vs\n"
        "for kind in ('bifurcation', 'lyapunov', 'impacts', 'iteration', 'poincare'):\n"
        "    vs.plot('x.h5', kind, output=f'{kind}.png')\n"
        "heavy = {'numba', 'pydantic', 'matplotlib.pyplot', *(f'vibro_sweep.{room}' for room in"
        " ('engine', 'scene', 'driver', 'analysis'))}\n"
        "print(sorted(heavy & {*sys.modules}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    vs.plot("x.h5")
    assert matplotlib.pyplot.get_fignums() == []  # it is no figure of pyplot
