"""Diagrams of branches and charts of curves: names of points, what a part of them shows."""

import numpy as np
import pytest
from support.figures import chart, circle, codes, entries, golden, marked, overlaps, ragged

import vibro_sweep as vs


@pytest.mark.parametrize("points", [1, 12, pytest.param(200, marks=pytest.mark.slow)])
def test_names_of_a_chart_stand_alone(points):
    """A curve through random places, each a point of codimension two: no name covers another one, or a point."""
    at = np.random.default_rng(3).uniform(0, 1, (2, points))
    curve = ("graze", at, 1, *(("double_graze", i) for i in range(points)))
    fig = vs.plot(chart(curve))
    fig.canvas.draw()
    (panel,), marks = fig.axes, fig.axes[0].transData.transform(at.T)
    boxes = [text.get_window_extent() for text in panel.texts]
    assert min(points, 8) <= len(boxes) <= points and (points < 200 or len(boxes) < points)
    assert not overlaps(panel.texts)
    for box in boxes:
        assert not any(box.contains(*mark) for mark in marks)
        assert panel.get_window_extent().containsx(box.x0) and panel.get_window_extent().containsx(box.x1)


@pytest.mark.slow
def test_names_cover_neither_each_other_nor_marks():
    """Of 4 random crowds of points, on random pages."""
    rng, named, left_out = np.random.default_rng(0), 0, 0
    for _ in range(4):
        size, count = tuple(rng.uniform(2, 5, 2)), rng.integers(5, 150)
        places = rng.normal(size=(2, count)) * rng.choice([0.1, 1], (2, 1))
        kinds = rng.choice(["resonant_graze", "double_graze", "flip_neimark_sacker"], count)
        fig = vs.plot(chart(("graze", places, 1, *zip(kinds, range(count), strict=True))), size=size)
        fig.draw_without_rendering()
        (ax,), marks = fig.axes, fig.axes[0].transData.transform(places.T)
        texts = [text for text in ax.texts if text.get_gid() == "name"]
        assert not overlaps(texts)
        for box in (text.get_window_extent() for text in texts):
            edge = 1.75 * fig.dpi / 72  # of a mark, of 3.5 points
            inside = (box.min - edge < marks) & (marks < box.max + edge)
            assert not inside.all(axis=1).any()
            assert ax.bbox.x0 - 1 <= box.x0 and box.x1 <= ax.bbox.x1 + 1
        named, left_out = named + len(texts), left_out + count - len(texts)
    assert named > 100 and left_out > 25


def test_curves_of_one_type_are_told_apart_by_the_periods_of_their_orbits():
    grazes = [circle("graze", radius, period) for radius, period in ((1, 8), (2, 8), (3, 1), (4, 13))]
    fig = vs.plot(chart(*grazes, circle("neimark_sacker", 5)))
    colours = [line.get_color() for line in marked(fig.axes[0], "curve")]
    (alone,) = marked(vs.plot(chart(circle("neimark_sacker", 5))).axes[0], "curve")
    assert colours[0] == colours[1] and len({*colours}) == 4 and colours[-1] == alone.get_color()
    assert {*entries(fig)} == {"graze, period 1", "graze, period 8", "graze, period 13", "Neimark-Sacker"}


@pytest.mark.parametrize("size", [(3, 3), (5, 4), (9, 4)])
def test_a_legend_is_no_wider_than_the_page(size):
    t = np.linspace(0, 6, 20)
    curves = [("graze", n * np.array([np.cos(t), np.sin(t)]), n) for n in range(1, 10)]
    fig = vs.plot(chart(*curves), size=size)
    fig.draw_without_rendering()
    (legend,), (ax,) = fig.legends, fig.axes
    assert size[0] < 9 or {text.get_fontsize() for text in legend.get_texts()} == {8.0}  # where it has room
    assert len(entries(fig)) == 9 and legend.get_window_extent().width <= fig.bbox.width
    assert ax.bbox.height > 0.3 * fig.bbox.height


def test_a_part_of_a_diagram_of_branches_has_its_own_axis_and_legend():
    """Two branches, x1 = b and x1 = -b, with the same fold at b = 0; each point is named once, sticking has a line."""
    like, b = golden()["file branches"], np.concatenate([np.linspace(0, 10, 40)] * 2)
    names, points = ("fold", "flip", "sticking", "fold", "graze"), np.array([0, 10, 39, 40, 79])
    kinds = ["none", "none", "none", "none", "nonsmooth_fold"]
    sizes = {"point": 80, "branch": 2, "special": 5, "impact": 0, "section": 0}
    data = ragged(
        "file branches", sizes, b=b, x1=np.where(np.arange(80) < 40, b, -b), branch_period=[1, 1],
        branch_row_size=[40, 40], special_point=points, special_value=b[points], special_branch=[0, 0, 0, 1, 1],
        branch_special=[3, 2], branch_begins=[0, 3], branch_ends=[2, 4], branch_parent=[-1, -1],
        branch_parent_special=[-1, -1], special_type=codes(like.special_type, names),
        special_kind=codes(like.special_kind, kinds), special_impact=np.full(5, -1),
    )  # fmt: skip
    fig = vs.plot(data)
    (ax,) = fig.axes
    assert sorted(text.get_text() for text in ax.texts) == ["GR", "LP", "PD", "ST"]
    (line,) = (line for line in ax.lines if line.get_gid() == "sticking")
    assert {*line.get_xdata()} == {10.0} and len(entries(fig)) == 6
    fig = vs.plot(data, xlim=(-0.1, 3))
    (ax,) = fig.axes
    assert 2.5 < ax.get_ylim()[1] < 3.5 and sorted(text.get_text() for text in ax.texts) == ["LP", "PD"]
    assert entries(fig)[2:] == ["LP fold", "PD flip"]
