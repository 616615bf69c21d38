"""Pictures of several attractors: the colours are those of the numbers of the data."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from support.figures import entries, golden, image, kinds

import vibro_sweep as vs

PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.734)
SIDES = ("right", "left")
KINDS = {
    "free": "non-impacting",
    "right": "periodic, more impacts on the right",
    "left": "periodic, more impacts on the left",
    "aperiodic": "chaotic or quasi-periodic",
}
NOT_COMPUTED = to_rgb("#f2f2f5")
START = {"x2": 3.2286, "v2": 0.2475}
AXES = {"v1": [1, 0, -0.3], "x1": {"start": -6.7, "stop": 6.7, "num": 8}}


@pytest.fixture(scope="module")
def coexistence():
    """Periodic mirror images, chaos and free motion; falling values, which an axis turns round."""
    axes, start = {"b": [6.8, 6.68, 6.6]}, {"random": 10, "seed": 1}
    return vs.sweep(PAPER, axes, start=start, transient=4000, record=400, observe=["attractors"])


@pytest.fixture(scope="module")
def basins():
    """Of two motions of period 16, which are mirror images, and the free motion."""
    return vs.sweep(PAPER, AXES, start=START, transient=5000, record=100, observe=["attractors"])


def named_colours(fig):
    """The entries of the legend, and the colours of their patches."""
    (legend,) = fig.legends
    patches = {text.get_text(): patch for text, patch in zip(legend.get_texts(), legend.get_patches(), strict=False)}
    return {name: to_rgb(patch.get_facecolor()) for name, patch in patches.items()}


def impacts(data, side):
    return data.average.sel(averaged=f"impacts_{side}").transpose("start_x1", "start_v1").sortby("start_v1").values


def test_stacks_are_the_shares(coexistence):
    data, fig = coexistence, vs.plot(coexistence)
    points, stacks = fig.axes
    parts, seams = stacks.collections
    assert not seams.get_segments()  # no two attractors of one colour here
    colours = named_colours(fig)
    assert [*colours][:4] == [KINDS[kind] for kind in ("free", "right", "left", "aperiodic")]
    free, right, left, aperiodic = [*colours.values()][:4]
    columns = {}
    for path, colour in zip(parts.get_paths(), parts.get_facecolors(), strict=True):
        (begin, low), (end, high) = path.vertices.min(axis=0), path.vertices.max(axis=0)
        columns.setdefault((begin, end), []).append((low, high, tuple(colour[:3])))
    for (begin, end), stack in columns.items():
        (i,) = np.flatnonzero((begin < data.b.values) & (data.b.values < end))
        label = data.attractor.values[i]
        assert sorted(high - low for low, high, _ in stack) == pytest.approx(sorted(np.bincount(label)[1:] / 10))
        assert stack[0][0] == 0 and stack[-1][1] == pytest.approx(1)
        expected = {6.8: [free], 6.68: [aperiodic], 6.6: [right, left]}[data.b.values[i]]
        assert [part[2] for part in stack] == expected
    assert len(columns) == 3
    shown = np.concatenate([line.get_xydata() for line in points.lines if line.get_linestyle() == "None"])
    assert len(shown) == 4 and np.all(np.isin(shown[:, 0], data.b.values))


def test_basins_have_the_colours_of_their_attractors(basins):
    fig = vs.plot(basins)
    shown, colours = np.asarray(image(fig.axes[0]).get_array()), named_colours(fig)
    right, left = (impacts(basins, side) for side in SIDES)
    names = ("period 16, 4 impacts right, 0 left", "period 16, 0 impacts right, 4 left", "non-impacting, period 1")
    for here, name in zip((right > left, left > right, right + left == 0), names, strict=True):
        (colour,) = (colour for entry, colour in colours.items() if entry.split(" (")[0] == name)
        assert here.any() and np.all(shown[here] == colour)
    assert {entry.split(" (")[0] for entry in colours} == {*names}


def test_basins_have_a_mark_at_each_attractor(basins):
    """The mean of its section points, which the data hold; the shape is in the legend."""
    fig, number = vs.plot(basins), basins.attractor_id.values
    marks = [line for line in fig.axes[0].lines if line.get_gid() == "attractor"]
    found = {line.get_marker(): line.get_xydata()[0].tolist() for line in marks}
    expected = {}
    for attractor in np.unique(number):
        v1, x1 = np.argwhere(number == attractor)[0]
        mean = [basins.average.sel(averaged=name).values[v1, x1] for name in ("v1", "x1")]
        expected[(number == attractor).sum()] = mean
    largest_first = [expected[count] for count in sorted(expected, reverse=True)]
    assert [found[marker] for marker in ("o", "s", "^")] == largest_first
    assert "mean of the section points" in fig.get_suptitle()


def test_section_points_mark_the_attractors_where_they_are_stored():
    observe = ["attractors", "section"]
    data = vs.sweep(PAPER, AXES, start=START, transient=3000, record=40, observe=observe)
    fig = vs.plot(data, "basins")
    place = np.argwhere(data.attractor_id.values == 1)[0]
    stored = {tuple(point) for point in np.stack([data.v1.values[*place], data.x1.values[*place]], axis=1).tolist()}
    shown = [{tuple(point) for point in line.get_xydata().tolist()} for line in fig.axes[0].lines]
    assert stored in shown and len(shown) == data.attractor_id.max()
    assert "marks: section points" in fig.get_suptitle()


def test_basins_are_those_that_the_data_number(basins):
    """Whatever the averages are: the picture groups nothing itself."""
    number = 1 + np.arange(24).reshape(3, 8) % 2
    number[0, 0] = 0
    data = basins.assign(attractor_id=(basins.attractor_id.dims, number))
    shown = np.asarray(image(vs.plot(data).axes[0]).get_array())
    number = data.attractor_id.sortby("start_v1").values.T
    colours = {value: {tuple(colour) for colour in shown[number == value].tolist()} for value in (0, 1, 2)}
    assert all(len(found) == 1 for found in colours.values())
    assert len(set.union(*colours.values())) == 3 and colours[0] == {NOT_COMPUTED}


def test_many_basins_share_a_colour(basins):
    """The largest ones are named, the others are together."""
    number = np.concatenate([np.arange(1, 20), np.full(5, 20)]).reshape(3, 8)
    names = entries(vs.plot(basins.assign(attractor_id=(basins.attractor_id.dims, number))))
    assert len(names) == 12 and names[-1] == "others (37.5 %)" and names[0].endswith("(20.8 %)")


def test_basins_without_numbers_are_kinds(basins):
    """And the picture says so."""
    status, attractor = basins.status.copy(deep=True), basins.attractor.copy(deep=True)
    status[0, 0] = attractor[0, 0] = -1
    data = basins.assign(status=status, attractor=attractor, attractor_id=basins.attractor_id * 0 - 1)
    fig = vs.plot(data)
    assert "this file does not number its attractors" in fig.get_suptitle()
    shown, colours = np.asarray(image(fig.axes[0]).get_array()), named_colours(fig)
    right, left = (impacts(data, side) for side in SIDES)
    done = status.sortby("start_v1").values.T == 0
    named = {name.split(" (")[0]: colour for name, colour in colours.items()}
    places = {"free": right + left == 0, "right": right > left, "left": left > right}
    assert named.keys() == {KINDS[kind] for kind in places} and len({*named.values()}) == 3
    for kind, here in places.items():
        assert (here & done).any() and np.all(shown[here & done] == named[KINDS[kind]])
    assert np.all(shown[~done] == NOT_COMPUTED)


def test_everything_ends_in_one_motion():
    axes = {"x1": [0, 1], "v2": [0, 1]}
    options = dict(transient=2000, record=9, observe=["attractors"])
    fig = vs.plot(vs.sweep(PAPER.replace(b=6.8), axes, start={"v1": 1e-3}, **options))
    assert entries(fig) == ["non-impacting, period 1 (100 %)"]
    assert "$v_1(0) = 0.001$, $x_2(0) = 0$" in fig.get_suptitle()


def test_a_plane_has_the_number_of_attractors():
    axes = {"b": [6.6, 6.8], "R": [0.7, 0.8]}
    options = dict(transient=100, record=40, observe=["attractors", "lyapunov"])
    data = vs.sweep(PAPER, axes, start={"random": 3}, **options)
    assert kinds(data) == ["plane"]
    number = vs.plot(data).axes[1]
    assert np.array_equal(image(number).get_array(), data.attractor.max("start").values.T)


@pytest.mark.parametrize(
    "period, averages, words",
    [
        (3, {"impacts_right": 1 / 3}, "period 3, 1 impact right, 0 left"),
        (6, {"impacts_right": 1 / 3, "impacts_left": 1 / 3}, "period 6, 2 impacts right, 2 left"),
        (0, {"impacts_right": 1 / 3, "lyapunov": -0.1}, "chaotic or quasi-periodic, 0.333 + 0 impacts / $T$"),
        (0, None, "not settled"),
    ],
)
def test_words_for_an_attractor(period, averages, words):
    """Of one attractor that all starts reach, with these averages."""
    data = golden()["basins"].copy(deep=True)
    data["attractor_id"][:], data["attractor"][:], data["period"][:] = 1, 1, period
    data["average"][:] = 0 if averages is not None else np.nan
    for name, value in (averages or {}).items():
        data["average"].loc[{"averaged": name}] = value
    assert entries(vs.plot(data)) == [f"{words} (100 %)"]
