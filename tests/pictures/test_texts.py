"""A search: no text of a picture covers another one, and numbers in a plane lie in the regions that have them."""

import numpy as np
import pytest
from support.figures import bars, golden, made, overlaps, panels

import vibro_sweep as vs


def random_plane(rng, relative):
    """Regions of random periods, a few or many, over (b, omega)."""
    shape, regions = rng.integers(20, 160, 2), rng.integers(5, 120)
    seeds, place = rng.uniform(0, 1, (regions, 2)), np.indices(shape).transpose(1, 2, 0) / shape
    nearest = np.linalg.norm(place[:, :, None] - seeds, axis=-1).argmin(axis=-1)
    period = rng.choice([*range(1, 20), *range(100, 120)], regions)[nearest]
    spectrum = np.full((*shape, 4), -0.1)
    spectrum[..., 0] = rng.choice([-0.0371, 0.0191], shape) * rng.uniform(0, 1, shape)
    axes = {"b": np.linspace(3, 9, shape[0]), "omega": np.linspace(0.58, 0.68, shape[1])}
    along = {"b_star": ("omega", np.sort(rng.uniform(5, 8, shape[1])))} if relative else None
    return made(axes, {"lyapunov": spectrum, "period": period}, along=along)


def borders(values):
    middle = (values[1:] + values[:-1]) / 2
    return np.r_[2 * values[0] - middle[0], middle, 2 * values[-1] - middle[-1]]


def period_at(data, points, relative):
    """What the plane has at points of its picture, by the nearest of its points."""
    b, omega = data.b.values, data.omega.values
    star = data.b_star.values if relative else np.ones(len(omega))
    x, y = points.T
    column = np.abs(omega[:, None] - y).argmin(axis=0)
    row = np.abs(b[:, None] - x * np.interp(y, borders(omega), borders(star))).argmin(axis=0)  # cells have four corners
    return data.period.values[row, column]


def searched(rng, cases):
    """Draw random planes on random pages; how many numbers were written in them."""
    written = 0
    for case in range(cases):
        relative = case % 3 == 2
        data = random_plane(rng, relative)
        fig = vs.plot(data, size=tuple(rng.uniform((4, 3), (9, 6))), relative=relative)
        fig.draw_without_rendering()
        assert not any(overlaps(bar.get_xticklabels()) for bar in bars(fig))
        ax = next(ax for ax in fig.axes if any(text.get_gid() == "period" for text in ax.texts))
        texts = [text for text in ax.texts if text.get_gid() == "period"]
        assert not overlaps(texts)
        written += len(texts)
        for text in texts:
            digits = text.get_window_extent()
            high = 0.5 * text.get_fontsize() * fig.dpi / 72  # of the ink
            x = np.linspace(digits.x0, digits.x1, 9)
            y = (digits.y0 + digits.y1) / 2 + np.linspace(-high / 2, high / 2, 5)
            points = ax.transData.inverted().transform(np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2))
            assert {*period_at(data, points, relative)} == {int(text.get_text())}
    return written


@pytest.mark.slow
def test_numbers_lie_in_their_regions():
    """On 4 random planes, one of them relative to a random b*."""
    assert searched(np.random.default_rng(0), 4) > 10


@pytest.mark.slow
@pytest.mark.parametrize("width", [55, 85, 178])
def test_no_text_covers_another_one(width):
    """Of pictures of the record on three widths: labels of ticks, names, and what is written inside."""
    searched, covered = 0, {}
    for name, data in ((name, golden()[name]) for name in ("sweep", "plane", "basins", "one orbit", "convergence")):
        fig = vs.plot(data, width=width)
        fig.draw_without_rendering()
        for ax in fig.axes:
            for i, axis in enumerate((ax.xaxis, ax.yaxis)):
                low, high = sorted(axis.get_view_interval())
                ticks = [text for text in axis.get_ticklabels() if low <= text.get_position()[i] <= high]
                written = [*ticks, axis.label, *([] if i else [ax.title])]
                covered |= {(name, pair): width for pair in overlaps(written)}
                searched += len(written)
            covered |= {(name, pair): width for pair in overlaps(ax.texts)}
    assert covered == {} and searched > 50


def test_a_text_upon_another_one_is_seen():
    fig = vs.plot(golden()["sweep"])
    (ax, *_) = panels(fig)
    for name in ("a text", "another"):
        ax.text(6, 0, name)
    fig.draw_without_rendering()
    assert overlaps(ax.texts) == [("a text", "another")]


@pytest.mark.slow
def test_ticks_of_a_colour_bar():
    """Of bars with arrows at their ends, which take a part of their place: 0 is kept, and what else has room."""
    thinned = 0
    largest = np.random.default_rng(0).uniform(-0.035, 0.035, (20, 20))
    spectrum = np.stack([largest, *[np.full((20, 20), -0.1)] * 3], axis=-1)
    data = made({"b": np.arange(20.0), "R": np.linspace(0, 1, 20)}, {"lyapunov": spectrum})
    for width in np.linspace(2, 7, 8):
        fig = vs.plot(data, size=(width, 3))
        fig.draw_without_rendering()
        labels = bars(fig)[0].get_xticklabels()
        told = [label.get_text() for label in labels]
        assert not overlaps(labels) and 3 <= len(told) <= 9 and {"0.00", "0.000"} & {*told}
        thinned += len(told) < 9
    assert 2 < thinned < 7


@pytest.mark.parametrize("power", ["chain", "plane"])
def test_small_numbers_have_room_and_a_power_of_ten(power):
    """Of 0.00012 m zeros would be most of a label."""
    if power == "chain":
        numbers = dict(m=[2, 8], k=[0, 2000, 10_000], c=[0, 5, 25], force=[0.3, 0], omega=26.0, R=0.7, b=0.00012)
        fig = vs.simulate(vs.Oscillator.named("chain", **numbers, units="SI"), np.zeros(4), 20).plot(width=85)
        axis, offset = fig.axes[0].xaxis, "1e\u22124"
    else:
        spectrum = np.stack([np.linspace(-3.5e-6, 3.5e-6, 25).reshape(5, 5), *[np.full((5, 5), -0.1)] * 3], axis=-1)
        fig = vs.plot(made({"b": np.arange(5.0), "R": np.linspace(0, 1, 5)}, {"lyapunov": spectrum}), size=(3, 3))
        axis, offset = bars(fig)[0].xaxis, "1e\u22126"
    fig.draw_without_rendering()
    assert not any(overlaps(ax.get_xticklabels()) for ax in fig.axes) and len(axis.get_ticklocs()) < 15
    assert axis.get_offset_text().get_text() == offset
