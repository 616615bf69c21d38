"""Pictures as wide as one column: all type has 8 points, and nothing is cut off or stands on something else."""

import itertools

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text
from support.figures import kinds as kinds_of
from support.kinds_of_files import KINDS
from support.programs import main

import vibro_sweep as vs

pytestmark = pytest.mark.slow  # one file of each kind is made

MM, WIDTH = 25.4, 85
RAGGED = ("branches", "curves")


def pictures(path, name):
    if name in RAGGED:
        return [vs.plot(path, width=WIDTH)]
    return [vs.plot(path, kind, width=WIDTH) for kind in kinds_of(path)]


def texts_of(fig):
    """What is written and seen, with its box in pixels; not labels of ticks beyond the axes."""
    FigureCanvasAgg(fig).draw()
    found = [one for one in fig.findobj(Text) if one.get_visible() and one.get_text().strip()]
    hidden = set()
    for ax in fig.axes:
        for i, axis in enumerate((ax.xaxis, ax.yaxis)):
            low, high = axis.get_view_interval()
            labels = {tick.label1 for tick in (*axis.majorTicks, *axis.minorTicks)}
            there = {tick.label1 for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks())}
            hidden |= labels - {one for one in there if ax.axison and low <= one.get_position()[i] <= high}
    return [(one, one.get_window_extent()) for one in found if one not in hidden]


@pytest.mark.parametrize("name", [name for name in KINDS if name != "windows"])
def test_all_type_is_read_and_on_the_page(kinds, name):
    for fig in pictures(kinds(name), name):
        assert fig.get_figwidth() == pytest.approx(WIDTH / MM)
        found = texts_of(fig)
        assert len(found) > 5 and {text.get_fontsize() for text, _ in found} == {8.0}
        for text, box in found:
            assert -1 <= box.x0 and box.x1 <= fig.bbox.width + 1, text
            assert -1 <= box.y0 and box.y1 <= fig.bbox.height + 1, text
        names = {ax.yaxis.label for ax in fig.axes}
        boxes = [box for text, box in found if text in names]
        assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))


def test_a_strip_of_windows(kinds):
    fig = vs.plot(kinds("sweep"), width=WIDTH, windows=kinds("windows"))
    assert {text.get_fontsize() for text, _ in texts_of(fig)} == {8.0}


def test_one_option_of_python_and_the_command_line(kinds, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert vs.plot(kinds("sweep"), width=85).get_figwidth() == pytest.approx(85 / MM)
    assert vs.plot(kinds("curves"), width=120.0).get_figwidth() == pytest.approx(120 / MM)
    assert main(["plot", str(kinds("orbit")), "--width", "85", "--dpi", "100"]) == 0
    content = (tmp_path / "orbit.png").read_bytes()
    assert int.from_bytes(content[16:20]) == round(85 / MM * 100 - 0.5)


def test_wide_pictures_stay_as_they_are(kinds):
    fig = vs.plot(kinds("sweep"))
    assert fig.get_figwidth() == 7.0 and {text.get_fontsize() for text, _ in texts_of(fig)} != {8.0}
