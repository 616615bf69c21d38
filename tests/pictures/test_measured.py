"""Measured points over diagrams, planes and branches, from files and from columns."""

import numpy as np
import pytest

import vibro_sweep as vs

SYSTEM = vs.Oscillator.named(
    "chain", m=[2.4], k=[9500, 0], c=[30, 0], force=[40], R=0.6, stop_right=1.5e-3, frequency=10, units="SI"
)
SHORT = dict(transient=60, record=8)


@pytest.fixture(scope="module")
def data():
    return vs.sweep(SYSTEM, {"frequency": [8.0, 10.0, 12.0]}, observe=["section", "impacts"], **SHORT)


def marked(ax):
    lines = [line for line in ax.lines if line.get_gid() == "measured"]
    return [tuple(np.asarray(part, float).tolist() for part in line.get_data()) for line in lines]


@pytest.mark.parametrize(
    "text, x, y",
    [
        ("frequency,x1\n9,0.5\n11,1.0\n", [9, 11], [0.5, 1.0]),  # in the units of the picture
        ("frequency [Hz],x1 [um],more\n9,500,1\n11,1000,2\n", [9, 11], [0.5, 1.0]),
        ("# x1 (m); frequency (kHz)\n0,0005; 0,009\n0,001; 0,011\n", [9, 11], [0.5, 1.0]),  # decimal commas
        (f"x1\tomega\n0.5\t{18 * np.pi}\n1.0\t{22 * np.pi}\n", [9, 11], [0.5, 1.0]),
        ("\ufefffrequency,x1\n9,0.5\n\n11,\n", [9, 11], [0.5, np.nan]),
        ("frequency,x1,remark\n# upwards\n9,0.5,good\n11,1,\n", [9, 11], [0.5, 1.0]),
        ("# measured, in May, twice\n\nfrequency,x1\n9,0.5\n11,1.0\n", [9, 11], [0.5, 1.0]),
        ("# measured in May\n# frequency;x1\n9;0,5\n11;1\n", [9, 11], [0.5, 1.0]),
    ],
)
def test_points_of_a_file(data, tmp_path, text, x, y):
    (tmp_path / "points.csv").write_text(text, encoding="utf-8")
    figure = vs.plot(data, units="mm, Hz", points=tmp_path / "points.csv")
    ((at, height),) = marked(figure.axes[0])
    assert np.allclose(at, x, rtol=1e-12) and np.allclose(height, y, rtol=1e-12, equal_nan=True)
    assert "measured" in [text.get_text() for text in figure.axes[0].get_legend().get_texts()]


def test_points_of_columns_widen_the_frame(data):
    figure = vs.plot(data, units="mm, Hz", points={"frequency": np.array([9.0]), "x1": [70.0]})
    assert marked(figure.axes[0]) == [([9.0], [70.0])] and figure.axes[0].get_ylim()[1] > 70


def test_points_in_a_plane_and_along_branches():
    plane = {"frequency": [8.0, 12.0], "b": [1e-3, 2e-3]}
    figure = vs.plot(vs.sweep(SYSTEM, plane, observe=["section"], **SHORT), points={"frequency": [9], "b": [1.5e-3]})
    assert marked(figure.axes[0]) == [([9.0], [1.5e-3])]
    branch = vs.continue_orbit(vs.periodic_orbit(SYSTEM.replace(R=0.3), itinerary="R"), "frequency", (9.5, 10.5))
    figure = vs.plot(branch, variable="v1", points={"omega": [62.0], "v1": [0.1]})
    ((at, height),) = marked(figure.axes[0])
    assert np.allclose((at[0], height[0]), (62 / (2 * np.pi), 0.1), rtol=1e-12)


def test_points_beside_curves():
    ball = vs.Oscillator.named("one_mass", zeta=0.02, F=0.37, omega=0.8, b=1.0, R=0.8, stops="right")
    branch = vs.continue_orbit(vs.periodic_orbit(ball, itinerary="R", periods=2), "F", (0.3, 0.6))
    graze = next(one for one in branch.special if one.type == "graze")
    curve = vs.bifurcation_curve(graze, ("F", "omega"), ((0.3, 0.6), (0.75, 0.85)))
    figure = vs.plot(curve, points={"F": [0.4], "omega": [0.8]})
    assert marked(figure.axes[0]) == [([0.4], [0.8])]
    assert "measured" in [text.get_text() for text in figure.legends[0].get_texts()]
    with pytest.raises(vs.PlotError, match="points and relative exclude each other"):
        vs.plot(curve, points={"F": [0.4], "omega": [0.8]}, relative=True)
    for result, axes in ((curve, "F, omega"), (branch, "F, x1")):
        with pytest.raises(vs.PlotError, match=f"has the columns F, z; axes here are {axes}"):
            vs.plot(result, points={"F": [0.4], "z": [0.8]})


@pytest.mark.parametrize(
    "points, said",
    [
        ({"frequency": [1.0], "depth": [2.0]}, "has the columns frequency, depth; axes here are frequency, x1"),
        ({"frequency": [1.0], "X1": [2.0]}, "axes here are frequency, x1; did you mean `x1` by X1?"),
        ({"freq": [1.0], "x1": [2.0]}, "axes here are frequency, x1; did you mean `frequency` by freq?"),
        ({"frequency": [1.0]}, "must have two columns at least"),
        ({"frequency": [1.0], "x1": [1.0, 2.0]}, "of one length"),
        ({"frequency": [1.0], "x1": ["a"]}, "holds other things than numbers"),
        ({"frequency": [1.0], "x1 [kg]": [1.0]}, "has x1 in kg; it must be in mm, or a multiple of it"),
        (3, "the path of a CSV file, or columns by their names"),
    ],
)
def test_what_are_no_points(data, points, said):
    with pytest.raises(vs.PlotError, match="points: ") as error:
        vs.plot(data, units="mm, Hz", points=points)
    assert said in str(error.value)


@pytest.mark.parametrize(
    "text, said",
    [
        ("frequency,x1\n", "a line for each point"),
        ("frequency,x1\n9,up\n", "line 2: up is not a number"),
        ("frequency,x1\n9,5,-2\n10,5,-2\n", "line 2: 3 entries below 2 names; numbers with decimal commas need ;"),
        ("frequency,x1,x1\n9,5,-2\n", "has two columns x1"),
        ("frequency,omega,x1\n9,5,-2\n", "must have one of the columns omega and frequency"),
        ("frequency,x1\n90,5\n95,1\n", "no point lies within the axis of frequency"),
        (f'frequency,x1\n9,"{"1" * 200000}"\n', "field larger than field limit"),
        ("frequency,x1\n9,inf\n", "no point lies within the axis of frequency"),
    ],
)
def test_files_without_points(data, tmp_path, text, said):
    (tmp_path / "points.csv").write_text(text)
    with pytest.raises(vs.PlotError) as error:
        vs.plot(data, points=tmp_path / "points.csv")
    assert said in str(error.value)


def test_pictures_without_such_axes(tmp_path):
    data = vs.sweep(SYSTEM, {"frequency": [8.0]}, trajectory={"periods": 1, "samples": 9}, observe=["section"], **SHORT)
    with pytest.raises(vs.PlotError, match="points: points has the columns frequency, x1"):
        vs.plot(data, "history", points={"frequency": [8.0], "x1": [1.0]})
