"""Pictures of several attractors: the colours are those of the file's numbers."""

import shutil

import h5py
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.text import Text
from support import sample, slow_cases
from support.scene_texts import parsed

import vibro_sweep as vs
from vibro_sweep import plotting
from vibro_sweep.plotting.families import KINDS, describe, kind
from vibro_sweep.plotting.style import NOT_COMPUTED

SIDES = ("right", "left")

PAPER = "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.734}"


def run(path, text, system=PAPER):
    vs.run(parsed(f"{system}\n{text}"), path)
    return path


@pytest.fixture(scope="module")
def coexistence(tmp_path_factory):
    """Periodic mirror images, chaos and free motion; falling values, which an axis turns round."""
    text = """
sweep: {b: {values: [6.8, 6.68, 6.6]}}
start: {random: 10, seed: 1}
orbit: {transient: 4000, record: 400}
observe: [attractors]"""
    return run(tmp_path_factory.mktemp("plots") / "coexistence.h5", text)


@pytest.fixture(scope="module")
def basins(tmp_path_factory):
    text = """
sweep: {v1: {values: [1, 0, -0.3]}, x1: {start: -6.7, stop: 6.7, num: 8}}
start: {x2: 3.2286, v2: 0.2475}
orbit: {transient: 5000, record: 100}
observe: [attractors]"""
    return run(tmp_path_factory.mktemp("plots") / "basins.h5", text)


def test_kinds(coexistence, basins, tmp_path):
    assert plotting.kinds(coexistence) == ["coexistence"]
    assert plotting.kinds(basins) == ["basins", "plane"]
    text = """
sweep: {b: {values: [6.6, 6.8]}, R: {values: [0.7, 0.8]}}
start: {random: 3}
orbit: {transient: 100, record: 40}
observe: [attractors, lyapunov]"""
    plane = run(tmp_path / "plane.h5", text)
    assert plotting.kinds(plane) == ["plane"]
    number = plotting.figure(plane).axes[1]
    expected = vs.open(plane).attractor.max("start").values
    assert np.array_equal(number.images[0].get_array(), expected.T)


def test_stacks_are_the_shares(coexistence):
    data, fig = vs.open(coexistence), plotting.figure(coexistence)
    points, stacks = fig.axes
    parts, seams = stacks.collections
    assert not seams.get_segments()  # no two attractors of one colour here
    columns = {}
    for path, colour in zip(parts.get_paths(), parts.get_facecolors(), strict=True):
        (left, low), (right, high) = path.vertices.min(axis=0), path.vertices.max(axis=0)
        columns.setdefault((left, right), []).append((low, high, tuple(colour[:3])))
    for (left, right), stack in columns.items():
        (i,) = np.flatnonzero((left < data.b.values) & (data.b.values < right))
        label = data.attractor.values[i]
        assert sorted(high - low for low, high, _ in stack) == pytest.approx(sorted(np.bincount(label)[1:] / 10))
        assert stack[0][0] == 0 and stack[-1][1] == pytest.approx(1)
        expected = {6.8: ["free"], 6.68: ["aperiodic"], 6.6: ["right", "left"]}[data.b.values[i]]
        assert [part[2] for part in stack] == [to_rgb(KINDS[which][1]) for which in expected]
    assert len(columns) == 3
    shown = np.concatenate([line.get_xydata() for line in points.lines if line.get_linestyle() == "None"])
    assert len(shown) == 4 and np.all(np.isin(shown[:, 0], data.b.values))
    names = [text.get_text() for text in fig.legends[0].get_texts()]
    assert names[:4] == [KINDS[which][0] for which in ("free", "right", "left", "aperiodic")]


def test_basins_have_the_colours_of_their_attractors(basins):
    data, fig = vs.open(basins), plotting.figure(basins)
    (ax,) = fig.axes
    (image,) = ax.images
    shown = np.asarray(image.get_array())
    order = np.argsort(data.start_v1.values)
    right, left = (data.average.sel(averaged=f"impacts_{side}").values[order].T for side in ("right", "left"))
    for here, which in ((right > left, "right"), (left > right, "left"), (right + left == 0, "free")):
        assert here.any() and np.all(shown[here] == to_rgb(KINDS[which][1]))
    assert {text.get_text().split(" (")[0] for text in fig.legends[0].get_texts()} == {
        "period 16, 4 impacts right, 0 left",
        "period 16, 0 impacts right, 4 left",
        "non-impacting, period 1",
    }


def test_basins_have_a_mark_at_each_attractor(basins):
    """The mean of its section points, which the file holds; the shape is in the legend."""
    data, fig = vs.open(basins), plotting.figure(basins)
    (ax,) = fig.axes
    marks = [line for line in ax.lines if line.get_gid() == "attractor"]
    number = data.attractor_id.values
    found = {line.get_marker(): line.get_xydata()[0].tolist() for line in marks}
    expected = {}
    for one in np.unique(number):
        v1, x1 = np.argwhere(number == one)[0]
        expected[(number == one).sum()] = [data.average.sel(averaged=name).values[v1, x1] for name in ("v1", "x1")]
    largest_first = [expected[count] for count in sorted(expected, reverse=True)]
    assert [found[marker] for marker in ("o", "s", "^")] == largest_first
    assert "mean of the section points" in fig.get_suptitle()


def test_section_points_mark_the_attractors_where_they_are_stored(tmp_path):
    text = """
sweep: {v1: {values: [1, 0, -0.3]}, x1: {start: -6.7, stop: 6.7, num: 8}}
start: {x2: 3.2286, v2: 0.2475}
orbit: {transient: 3000, record: 40}
observe: [attractors, section]"""
    path = run(tmp_path / "basins.h5", text)
    data, fig = vs.open(path), plotting.figure(path, "basins")
    place = np.argwhere(data.attractor_id.values == 1)[0]
    stored = {tuple(point) for point in np.stack([data.v1.values[*place], data.x1.values[*place]], axis=1).tolist()}
    shown = [{tuple(point) for point in line.get_xydata().tolist()} for line in fig.axes[0].lines]
    assert stored in shown and len(shown) == data.attractor_id.max()
    assert "marks: section points" in fig.get_suptitle()


def test_basins_are_those_that_the_file_numbers(basins, tmp_path):
    """Whatever the averages are: the picture groups nothing itself."""
    path = shutil.copy(basins, tmp_path)
    with h5py.File(path, "r+") as file:
        shape = file["attractor_id"].shape
        file["attractor_id"][...] = 1 + np.arange(24).reshape(shape) % 2
        file["attractor_id"][0, 0] = 0
    (ax,) = plotting.figure(path).axes
    order = np.argsort(vs.open(path).start_v1.values)
    shown = np.asarray(ax.images[0].get_array())
    number = vs.open(path).attractor_id.values[order].T
    colours = {one: {tuple(colour) for colour in shown[number == one].tolist()} for one in (0, 1, 2)}
    assert all(len(found) == 1 for found in colours.values())
    assert len(set.union(*colours.values())) == 3 and colours[0] == {to_rgb(NOT_COMPUTED)}


def test_many_basins_share_a_colour(basins, tmp_path):
    """The largest ones are named, the others are together."""
    path = shutil.copy(basins, tmp_path)
    with h5py.File(path, "r+") as file:
        file["attractor_id"][...] = np.concatenate([np.arange(1, 20), np.full(5, 20)]).reshape(3, 8)
    names = [text.get_text() for text in plotting.figure(path).legends[0].get_texts()]
    assert len(names) == 12 and names[-1] == "others (37.5 %)" and names[0].endswith("(20.8 %)")


def test_basins_of_a_file_without_numbers_are_kinds(basins, tmp_path):
    """And the picture says so."""
    path = shutil.copy(basins, tmp_path)
    with h5py.File(path, "r+") as file:
        file["attractor_id"][...] = -1
        file["status"][0, 0] = file["attractor"][0, 0] = -1
    fig = plotting.figure(path)
    assert "this file does not number its attractors" in fig.get_suptitle()
    names = {text.get_text().split(" (")[0] for text in fig.legends[0].get_texts()}
    assert names == {KINDS[which][0] for which in ("free", "right", "left")}
    data = vs.open(path)
    columns, rows = (np.argsort(data[key].values) for key in data.status.dims)
    right, left = (data.average.sel(averaged=f"impacts_{one}").values[np.ix_(columns, rows)].T for one in SIDES)
    shown = np.asarray(fig.axes[0].images[0].get_array())
    done = data.status.values[np.ix_(columns, rows)].T == 0
    for here, which in ((right > left, "right"), (left > right, "left"), (right + left == 0, "free")):
        assert (here & done).any() and np.all(shown[here & done] == to_rgb(KINDS[which][1]))
    assert np.all(shown[~done] == to_rgb(NOT_COMPUTED))


def test_one_basin(tmp_path):
    """Everything ends in the free motion; a number that YAML takes for text is a number."""
    text = "sweep: {x1: {values: [0, 1]}, v2: {values: [0, 1]}}\nstart: {v1: 1e-3}\norbit: {transient: 2000, record: 9}"
    path = run(tmp_path / "one.h5", f"{text}\nobserve: [attractors]", PAPER.replace("6.734", "6.8"))
    fig = plotting.figure(path)
    assert [text.get_text() for text in fig.legends[0].get_texts()] == ["non-impacting, period 1 (100 %)"]
    assert "$v_1(0) = 0.001$, $x_2(0) = 0$" in fig.get_suptitle()


def test_words():
    average = np.array([0, 0, 0, 0, 1 / 3, 0, -0.1])
    assert describe(3, average) == "period 3, 1 impact right, 0 left"
    assert describe(0, average) == "chaotic or quasi-periodic, 0.333 + 0 impacts / $T$"
    assert describe(0, np.full(7, np.nan)) == "not settled"
    average[5] = 1 / 3
    assert kind(6, average) == "even" and describe(6, average) == "period 6, 2 impacts right, 2 left"


@pytest.mark.parametrize(
    "text",
    [
        "sweep: {b: {values: [5, 6]}}\nobserve: [section, lyapunov, impacts]",
        *slow_cases(
            "sweep: {x1: {values: [0, 1]}, v1: {values: [0, 1]}}\nobserve: [attractors]",
            "sweep: {b: {values: [5, 6]}}\nstart: {random: 2}\nobserve: [attractors]",
            "sweep: {b: {values: [5, 6]}, R: {values: [0.5, 0.6]}}\nobserve: [section, lyapunov, impacts]",
        ),
    ],
)
@pytest.mark.filterwarnings("error", "ignore::DeprecationWarning")  # of the lowest matplotlib
def test_empty_axes_say_why(tmp_path, text):
    scene = f"{PAPER}\norbit: {{transient: 5, record: 5}}\n{text}".replace("0.05", "1.0e+6")
    path = tmp_path / "failed.h5"
    vs.run(parsed(scene), path)
    for one in plotting.kinds(path):
        fig = plotting.figure(path, one)
        panels = [ax for ax in fig.axes if ax.get_label() != "<colorbar>"]
        assert all(any("all points failed" in text.get_text() for text in ax.texts) for ax in panels), one


@pytest.mark.parametrize("law, words", sample(1, [
    ("k_stop: 10", {"period 1, 1 contact right, 1 left", "without contact, period 1"}),
    ("k_stop: 10, R_left: 0.7", {"period 1, 1 impact right, 1 left", "non-impacting, period 1"}),
]))  # fmt: skip
def test_what_meets_a_compliant_stop_is_called_a_contact(tmp_path, law, words):
    """Beside a rigid one both are called impacts, as they are counted together."""
    system = f"system: {{type: one_mass, zeta: 0.02, F: 0.8, omega: 1.6, b: 1, tau: 0, {law}}}"
    text = """
sweep: {x1: {start: -0.9, stop: 0.9, num: 9}, v1: {start: -2, stop: 2, num: 9}}
orbit: {transient: 600, record: 60}
observe: [attractors]"""
    fig = plotting.figure(run(tmp_path / "basins.h5", text, system))
    assert {one.get_text().split(" (")[0] for one in fig.legends[0].get_texts()} == words


@pytest.mark.parametrize("law, missed", [("k_stop: 10", False), *slow_cases(("R: 0.7", True))])
def test_a_diagram_of_compliant_stops_does_not_miss_impacts(tmp_path, law, missed):
    """Of rigid stops beyond the motion it says that there are none."""
    system = f"system: {{type: one_mass, zeta: 0.02, F: 0.8, omega: 1.6, b: 30, tau: 0, {law}}}"
    text = """
sweep: {b: {values: [29, 30, 31]}}
orbit: {transient: 300, record: 60}
observe: [section, impacts]"""
    fig = plotting.figure(run(tmp_path / "diagram.h5", text, system), "bifurcation")
    assert any("no impacts" in one.get_text() for one in fig.findobj(Text)) == missed
