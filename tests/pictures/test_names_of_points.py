"""Charts: names of points of codimension two cover neither each other nor any point."""

import numpy as np
import pytest

from vibro_sweep.plotting.drawn_curves import Drawn, plot_curves


def chart(points):
    """A curve through random places, each a point of codimension two."""
    at = np.random.default_rng(3).uniform(0, 1, (points, 2))
    special = [("double_graze", *place) for place in at.tolist()]
    fig = plot_curves([Drawn("graze", *at.T, np.zeros(points, bool), special)], ("b", "omega"))
    fig.canvas.draw()
    (panel,) = fig.axes
    marks = panel.transData.transform(at)
    return panel, marks, [text.get_window_extent() for text in panel.texts]


@pytest.mark.parametrize("points", [1, 12, pytest.param(200, marks=pytest.mark.slow)])
def test_names_stand_alone(points):
    panel, marks, boxes = chart(points)
    assert min(points, 8) <= len(boxes) <= points and (points < 200 or len(boxes) < points)
    for i, box in enumerate(boxes):
        assert not any(box.contains(*mark) for mark in marks)
        assert not any(box.overlaps(other) for other in boxes[:i])
        assert panel.get_window_extent().containsx(box.x0) and panel.get_window_extent().containsx(box.x1)
