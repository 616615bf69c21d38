"""Scenes with two numbers in `parameter`: curves in files, charts, and the edges of a plane."""

import numpy as np
import pytest
import xarray as xr
from support.contents import numbers, words_of
from support.oscillators import PAPER, PAPER_NUMBERS
from support.programs import main
from support.scene_texts import parsed

import vibro_sweep as vs

NAMES, BOX = ("b", "omega"), ((2.5, 6), (0.58, 0.68))
NUMBERS = f"{{{PAPER_NUMBERS}, b: 4}}"
ALONG = "{b: [2.5, 6], omega: [0.58, 0.68]}"


pytestmark = pytest.mark.slow  # curves compile a kernel of their own, which takes half a minute


def text(begin="{itinerary: LR}", parameter=ALONG, more="depth: 0", numbers=NUMBERS):
    return f"system: {numbers}\ncontinue:\n  from: {begin}\n  parameter: {parameter}\n  {more}\n"


@pytest.fixture(scope="module")
def curve():
    branch = vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=4), itinerary="LR"), "b", (2.5, 6))
    return vs.bifurcation_curve(next(s for s in branch.special if s.type == "pitchfork"), NAMES, BOX, virtual=False)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("curves") / "lr.h5"
    vs.run(parsed(text(more="of: [pitchfork]\n  depth: 0"), "lr.yaml"), path)
    return path


def test_the_file_holds_the_curve(file, curve):
    with xr.open_dataset(file, engine="h5netcdf") as data:
        assert data.attrs["kind"] == "curves" and data.attrs["mu_m"] == 10 and "tau" not in data.attrs
        assert words_of(data["branch_type"]) == ["pitchfork"]
        for name in (*NAMES, "x1", "v2", "multiplier_re", "residual", "unstable"):
            np.testing.assert_allclose(data[name], curve.points[name], rtol=1e-12, atol=1e-13)
        assert not data["status"].values.any() and data.sizes["impact"] == 2 * data.sizes["point"]
        assert words_of(data["special_type"]) == [special.type for special in curve.special]
        at = data["special_point"].values
        for i, name in enumerate(NAMES):
            np.testing.assert_array_equal(data[name].values[at], data["special_value"].values[:, i])
        expected = [vs.grazing(PAPER.replace(omega=float(omega))).b for omega in data["omega"].values]
        np.testing.assert_allclose(data["b_star"], expected, rtol=1e-13)


def test_a_point_of_codimension_two_of_a_file_is_where_a_scene_goes_on(tmp_path):
    """From the degenerate pitchfork to curves through it; along one number from its orbit."""
    parameter = "{b: [3, 3.9], omega: [0.6, 0.62]}"
    first = tmp_path / "first.h5"
    numbers = NUMBERS.replace("b: 4", "b: 3.8").replace("0.63", "0.615")
    vs.run(parsed(text(parameter=parameter, more="of: [pitchfork]\n  depth: 0", numbers=numbers)), first)
    with vs.open(first) as data:
        at = words_of(data["special_type"]).index("degenerate_flip")
        place = data["special_value"].values[at].tolist()
    begin = f"{{branches: {first}, special: {at}}}"
    second = tmp_path / "second.h5"
    vs.run(parsed(text(begin, parameter, "depth: 0", numbers)), second)
    with vs.open(second) as data:
        assert "pitchfork" in words_of(data["branch_type"])
        assert np.abs(data["special_value"].values - place).max(axis=1).min() < 1e-10


@pytest.mark.parametrize(
    "begin, numbers, words",
    [
        ("{branches: FILE, special: 99}", NUMBERS, "continue.from.special: 99 is not allowed; it must be < "),
        ("{branches: FILE, special: 0}", NUMBERS.replace("10", "9"), "mu_m = 9.0 in system, and 10.0 in"),
    ],
)
def test_what_is_wrong_is_said(begin, numbers, words, file, tmp_path, capsys):
    (tmp_path / "x.yaml").write_text(text(begin.replace("FILE", str(file)), numbers=numbers))
    assert main(["run", str(tmp_path / "x.yaml"), "-o", str(tmp_path / "x.h5")]) == 2
    assert words in capsys.readouterr().err


def test_commands(file, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lr.yaml").write_text(text())
    assert main(["check", "lr.yaml"]) == 0
    told = capsys.readouterr().out
    assert "curves in b = 2.5 .. 6, omega = 0.58 .. 0.68" in told and "branches  in b" in told
    assert main(["info", str(file)]) == 0
    told = capsys.readouterr().out
    assert "curves: 1, special points:" in told and "degenerate_flip" in told
    assert main(["plot", str(file), "-o", "chart.svg"]) == 0
    drawn = (tmp_path / "chart.svg").read_text()
    assert "pitchfork" in drawn and "GPD" in drawn and "virtual" not in drawn
    assert main(["plot", str(file), "--relative", "-o", "relative.svg"]) == 0
    assert main(["plot", str(file), "--variable", "x1"]) == 2
    assert "variable 'x1' is not allowed; a chart has one where it lies over a plane" in capsys.readouterr().err


def test_charts_over_a_plane(file, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    vs.sweep(
        PAPER, {"omega": np.linspace(0.6, 0.66, 4), "b": np.linspace(3, 5, 5)}, transient=30, record=10,
        observe=("section", "lyapunov"), output="plane.h5", workers=1,
    ).close()  # fmt: skip
    assert main(["plot", str(file), "--over", "plane.h5", "-o", "over.svg"]) == 0
    assert main(["plot", str(file), "--over", "plane.h5", "--variable", "period", "-o", "period.svg"]) == 0
    (tmp_path / "largest.yaml").write_text(text("{sweep: plane.h5, largest: 3}"))
    assert main(["run", "largest.yaml"]) == 2
    assert "continue.from.largest: belongs to windows along one number; plane.h5 is a plane" in capsys.readouterr().err
    assert (tmp_path / "over.svg").read_text().count('id="curve"') >= 2
    assert main(["plot", str(file), "--over", "plane.h5", "--relative", "-o", "relative.svg"]) == 0
    assert (tmp_path / "relative.svg").read_text().count("<path") < 300  # cells are pixels
    capsys.readouterr()
    for more, words in (
        (["--over", "plane.h5", "--variable", "x9"], "variable 'x9' is not allowed; there are lyapunov"),
        (["--over", str(file)], "holds curves, and no sweep"),
        (["--kind", "plane"], "kind: does not belong to curves"),
        (["--at", "b=4"], "at: does not belong to curves"),
        (["--windows", str(file)], "windows: does not belong to curves"),
    ):
        assert main(["plot", str(file), *more]) == 2
        assert words in capsys.readouterr().err
    assert main(["plot", "plane.h5", "--over", "plane.h5"]) == 2
    assert "over: branches and curves are drawn over a sweep; plane.h5 is one itself" in capsys.readouterr().err


def test_real_parts_are_parts_of_the_whole_curve():
    """The graze that ends a window of period 8: between the two double grazes where it is a motion."""
    state = vs.simulate(PAPER.replace(b=5.6), (0, 0, 0, 0), 2000).section[-1]
    orbit = vs.periodic_orbit(PAPER.replace(b=5.6), state, 8)
    graze = next(s for s in vs.continue_orbit(orbit, "b", (5, 6)).special if s.type == "graze")
    whole = vs.bifurcation_curve(graze, NAMES, ((5, 7), (0.62, 0.65)))
    real = vs.bifurcation_curve(graze, NAMES, ((5, 7), (0.62, 0.65)), virtual=False)
    assert whole.points.virtual.any() and not real.points.virtual.any()
    places = np.array([[special.parameters[name] for name in NAMES] for special in whole.special])
    for special in real.special:
        assert special.type == "double_graze"
        assert np.abs(places - [special.parameters[name] for name in NAMES]).max(axis=1).min() < 1e-11


def test_it_depends_neither_on_interruptions_nor_on_workers(tmp_path):
    def stop(done, total):
        if done == 3:
            raise KeyboardInterrupt

    scene = parsed(text(more="depth: 1"), "lr.yaml")
    vs.run(scene, tmp_path / "one.h5")
    with pytest.raises(KeyboardInterrupt):
        vs.run(scene, tmp_path / "two.h5", progress=stop)
    vs.run(scene, tmp_path / "two.h5", mode="resume", workers=2)
    assert numbers(tmp_path / "two.h5") == numbers(tmp_path / "one.h5")
    with vs.open(tmp_path / "one.h5") as data:
        words = [
            (int(kind), int(period), int(impacts), value)
            for kind, period, impacts, value in zip(
                *(data[f"branch_{name}"].values for name in ("type", "period", "impacts")),
                [tuple(np.round(v, 6)) for v in data["special_value"].values[data["branch_begins"].values]],
                strict=True,
            )
        ]  # fmt: skip
        assert len(words) == len(set(words)) == 4  # each curve once


def test_edges_of_a_plane(tmp_path):
    """Most have a curve; where both orbits are said to be stable at both points, simulation carries them across."""
    plane = tmp_path / "plane.h5"
    keys = {"omega": np.linspace(0.64, 0.664, 7), "b": np.linspace(5.0, 7.2, 10)}
    with vs.sweep(PAPER, keys, transient=1500, record=64, output=plane, workers=1) as data:
        period = data["period"].values
        states = np.stack([data[name].isel(sample=-1).values for name in ("x1", "v1", "x2", "v2")], -1)
    parameter = "{omega: [0.63, 0.67], b: [4, 8]}"
    vs.run(parsed(text(f"{{sweep: {plane}}}", parameter, "depth: 0")), tmp_path / "edges.h5")
    with vs.open(tmp_path / "edges.h5") as data:
        one, other = (data[name].values for name in ("edge_from", "edge_to"))
        reason, names = data["edge_reason"].values, np.array(words_of(data["edge_reason"]))
        assert (data["edge_curve"].values[reason == 0] >= 0).all() and data.sizes["edge"] > 25
        assert (reason == 0).mean() > 0.7

    def stays(here, there) -> bool:
        """Whether an orbit keeps its period on its way, in small steps, to the numbers of its neighbour."""
        place = index(keys, here)
        state = states[place]
        for share in np.linspace(0, 1, 41):
            omega, b = map(float, (1 - share) * here + share * there)
            state = np.append(np.clip(state[0], -b, b), state[1:])
            flown = vs.simulate(PAPER.replace(omega=omega, b=b), state, 3000 if share == 1 else 300).section
            state = flown[-1]
        return bool(np.abs(state - flown[-1 - period[place]]).max() < 1e-6 * np.abs(state).max())

    both = np.flatnonzero(names == "stable_at_both")
    assert len(both)
    for a, b in zip(one[both], other[both], strict=True):
        for ends in ((a, b), (b, a)):
            assert not period[index(keys, ends[0])] or stays(*ends), (
                *ends,
                period[index(keys, a)],
                period[index(keys, b)],
            )


def index(keys, place) -> tuple[int, int]:
    return tuple(int(np.abs(values - value).argmin()) for values, value in zip(keys.values(), place, strict=True))
