"""Pictures: what a file can show, outputs, and errors."""

import ast
import subprocess
import sys
from pathlib import Path

import h5py
import matplotlib.pyplot
import numpy as np
import pytest
from support import slow_cases
from support.pictures import exponents, write

import vibro_sweep as vs
from vibro_sweep import plotting
from vibro_sweep.plotting.style import edges, limits


def test_kinds_follow_from_what_the_file_holds(tmp_path, sweep, branches, trajectory):
    assert plotting.kinds(sweep) == ["bifurcation", "lyapunov", "impacts", "iteration"]
    assert plotting.kinds(branches) == ["bifurcation", "lyapunov", "iteration"]
    assert plotting.kinds(trajectory) == ["phase-portrait", "configuration", "history", "film", "iteration"]
    b = np.arange(1.0, 4)
    only = write(tmp_path / "only.h5", {"b": b}, {"lyapunov": exponents(3)})
    assert plotting.kinds(only) == ["lyapunov"]
    plane = write(tmp_path / "plane.h5", {"b": b, "R": b / 10}, {"period": np.ones((3, 3), int)})
    assert plotting.kinds(plane) == ["plane"]


@pytest.mark.parametrize(
    ("suffix", "magic"), [(".png", b"\x89PNG"), *slow_cases((".svg", b"<?xml"), (".pdf", b"%PDF"))]
)
def test_the_suffix_is_the_format(sweep, tmp_path, suffix, magic):
    output = tmp_path / f"figure{suffix}"
    assert plotting.plot(sweep, output) == [output]
    assert output.read_bytes().startswith(magic)


@pytest.mark.slow
def test_the_picture_lies_in_the_current_folder_unless_told_otherwise(sweep, tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert plotting.plot(sweep) == [Path("sweep.png")]
    part = sweep.rename(tmp_path / "other.h5.part")
    assert plotting.plot(part) == [Path("other.png")]
    assert sorted(path.name for path in Path().iterdir()) == ["other.png", "sweep.png"]


def test_kind_all_writes_each_kind(trajectory, tmp_path):
    written = plotting.plot(trajectory, tmp_path / "fig.svg", kind="all")
    assert [path.name for path in written] == [
        "fig-phase-portrait.svg",
        "fig-configuration.svg",
        "fig-history.svg",
        "fig-film.svg",
        "fig-iteration.svg",
    ]
    assert all(path.stat().st_size > 1000 for path in written)


@pytest.mark.parametrize("output", ["figure.jpg", "figure", "figure.h5"])
def test_an_output_of_another_format_is_refused(sweep, tmp_path, output):
    with pytest.raises(vs.PlotError, match=r"\.png, \.svg, \.pdf"):
        plotting.plot(sweep, tmp_path / output)
    assert not (tmp_path / output).exists()


def test_an_unknown_kind_names_the_ones_there_are(sweep):
    with pytest.raises(vs.PlotError, match=r"'plane'.*bifurcation, lyapunov, impacts, iteration"):
        plotting.plot(sweep, kind="plane")


def test_the_result_is_never_overwritten(sweep, tmp_path):
    odd = sweep.rename(tmp_path / "result.png")
    before = odd.read_bytes()
    with pytest.raises(vs.PlotError, match=r"that is .*result\.png, which is read for it"):
        plotting.plot(odd, odd)
    assert odd.read_bytes() == before


def test_a_folder_that_is_not_there(sweep, tmp_path):
    with pytest.raises(vs.PlotError, match="cannot be written"):
        plotting.plot(sweep, tmp_path / "nowhere" / "figure.png")


def test_files_that_are_no_results(tmp_path):
    with pytest.raises(vs.PlotError, match="no such file"):
        plotting.kinds(tmp_path / "missing.h5")
    text = tmp_path / "text.h5"
    text.write_text("system: {}\n" * 100)
    with pytest.raises(vs.PlotError, match="not an HDF5 file"):
        plotting.plot(text)
    with h5py.File(tmp_path / "foreign.h5", "w") as file:
        file["status"] = np.zeros(3)
    with pytest.raises(vs.PlotError, match="none that vibro-sweep wrote"):
        plotting.kinds(tmp_path / "foreign.h5")


def test_nothing_to_show(tmp_path):
    b = np.arange(1.0, 4)
    none = write(tmp_path / "none.h5", {"b": b}, {"x1": np.full((3, 2), np.nan)}, done=np.zeros(3, bool))
    assert plotting.kinds(none) == []
    with pytest.raises(vs.PlotError, match="no point is computed"):
        plotting.plot(none)
    numbers = write(tmp_path / "numbers.h5", {}, {"lyapunov": np.zeros(4)})
    with pytest.raises(vs.PlotError, match="lyapunov, status"):
        plotting.figure(numbers)


@pytest.mark.slow
def test_drawing_needs_no_display_and_no_engine(sweep):
    code = (
        "import sys; from vibro_sweep import plotting; plotting.plot(sys.argv[1], kind='all');"
        "heavy = {'numba', 'pydantic', 'matplotlib.pyplot', 'vibro_sweep.engine',"
        " 'vibro_sweep.scene', 'vibro_sweep.driver', 'vibro_sweep.analysis', 'yaml'};"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code, sweep], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_figure_leaves_pyplot_alone(sweep):
    plotting.figure(sweep)
    assert matplotlib.pyplot.get_fignums() == []


def test_plotting_imports_nothing_that_computes():
    """Neither at its start nor within a function."""
    modules = list(Path(plotting.__file__).parent.glob("*.py"))
    assert len(modules) > 8
    for module in modules:
        for node in ast.walk(ast.parse(module.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                assert node.level == 0, module
                names = [f"{node.module}.{alias.name}" for alias in node.names]
            for name in names:
                if name.startswith("vibro_sweep."):
                    assert name.split(".")[1] in ("plotting", "store", "model"), (module.name, name)
                assert name.split(".")[0] != "yaml", module.name


def test_edges_lie_halfway():
    np.testing.assert_allclose(edges([1, 2, 4]), [0.5, 1.5, 3, 5])
    np.testing.assert_allclose(edges([0]), [-0.5, 0.5])


def test_limits_ignore_gaps():
    low, high = limits([np.nan, 1, 3])
    assert low < 1
    assert 3 < high < 3.2
