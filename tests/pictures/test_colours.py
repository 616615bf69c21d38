"""Colours that stand side by side in a legend are distinct to readers with any colour vision."""

import itertools
from functools import cache

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from support.figures import bouncing, chart, circle, golden, image, made, marked, plane, swept

import vibro_sweep as vs

# Machado, Oliveira, Fernandes, IEEE Trans. Vis. Comput. Graph. 15 (2009) 1291, table 1: severity 1.0, on linear sRGB
VISIONS = {
    "normal": np.eye(3),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "tritanopia": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}
# sRGB to XYZ (D65), IEC 61966-2-1
XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)

# The least distance in CIE Lab of all pairs (2.3 is just noticeable where areas touch).
LEAST = {
    "periods": 19, "neighbouring periods": 27, "exponents": 39, "kinds of attractors": 32, "both ways": 45,
    "curves": 26, "curves by period": 18, "orbits without a window": 11, "sides": 82, "portrait": 32,
}  # fmt: skip


def colours_of_periods(fig):
    picture = image(fig.axes[1])
    return [to_rgb(picture.cmap(picture.norm(n))) for n in range(14)]


def by_label(ax):
    return {line.get_label(): line.get_color() for line in ax.lines}


def kinds_of_attractors():
    """Basins of a part of a run have the colours of kinds of attractors: of each there are some here."""
    data = golden()["basins"].copy(deep=True)
    data["attractor_id"][:], data["status"][:], data["attractor"][:], data["period"][:] = -1, 0, 1, 1
    data["average"][:] = 0
    data["status"][5, 0] = data["attractor"][5, 0] = -1
    unsettled = (np.nan, np.nan, 1)
    for row, (right, left, period) in enumerate([(0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1, 1), (1, 1, 0), unsettled]):
        data["average"].loc[{"averaged": "impacts_right"}][row] = right
        data["average"].loc[{"averaged": "impacts_left"}][row] = left
        data["period"][row] = period
    return {tuple(colour) for colour in np.asarray(image(vs.plot(data).axes[0]).get_array()).reshape(-1, 3)}


def reasons():
    """Of orbits in no window, four at a time, as the sweep of the record has four orbits."""
    windows, found = golden()["file windows"], set()
    assert len(windows.orbit_reason.attrs["flag_meanings"].split()) == 1 + NUMBERS["orbits without a window"]
    for first in (1, 5, 6):
        changed = windows.assign(
            orbit_reason=("orbit", np.arange(first, first + 4, dtype="int8"), windows.orbit_reason.attrs)
        )
        fig = vs.plot(golden()["file sweep"], windows=changed)
        found |= {to_rgb(area.get_facecolor()[0]) for ax in fig.axes for area in ax.collections if spans(area)}
    return found


def spans(area):
    """Whether this is a bar below the diagram, of orbits in no window."""
    return (
        type(area).__name__ == "PolyCollection"
        and area.get_paths()
        and area.get_paths()[0].vertices[:, 1].max() <= -0.7
    )


@cache
def colours(legend) -> list:
    """Colours of a picture that stand side by side."""
    if legend in ("periods", "neighbouring periods"):
        fig = vs.plot(plane())
        return [*colours_of_periods(fig), *([fig.axes[0].patch.get_facecolor()] if legend == "periods" else [])]
    if legend == "exponents":
        lines = by_label(vs.plot(swept(), "lyapunov").axes[0])
        return [lines[rf"$\lambda_{i}$"] for i in (1, 2, 3, 4)]
    if legend == "kinds of attractors":
        return [*kinds_of_attractors()]
    if legend == "both ways":
        x1, axes = np.zeros((40, 2, 40)), {"b": np.linspace(1, 2, 40), "start": ["up", "down"]}
        x1[:20, 0] = 1
        ax = vs.plot(made(axes, {"x1": x1, "period": np.ones((40, 2), int)})).axes[0]
        return [line.get_color() for line in marked(ax, "periodic")]
    if legend == "curves":
        return curve_colours(*(circle(kind, n + 1) for n, kind in enumerate(TYPES)))
    if legend == "curves by period":
        by_period = curve_colours(*(circle("graze", n, n) for n in range(1, 31)))
        return [*by_period, *curve_colours(*(circle(kind, n + 1) for n, kind in enumerate(TYPES[:-1])))]
    if legend == "orbits without a window":
        return [*reasons()]
    if legend == "sides":
        lines = by_label(vs.plot(swept(), "impacts").axes[0])
        return [lines["right"], lines["left"]]
    lines = by_label(ax := vs.plot(bouncing()).axes[0])
    return [ax.lines[0].get_color(), lines[r"$t = 0$ mod $T$"], lines["impact"], lines["right stop, $x_1 = b$"]]


TYPES = ("fold", "flip", "pitchfork", "neimark_sacker", "graze")
NUMBERS = {
    "periods": 15, "neighbouring periods": 14, "exponents": 4, "kinds of attractors": 6, "both ways": 3, "curves": 5,
    "curves by period": 13, "orbits without a window": 9, "sides": 2, "portrait": 4,
}  # fmt: skip


def curve_colours(*curves):
    lines = marked(vs.plot(chart(*curves)).axes[0], "curve")
    return [*dict.fromkeys(line.get_color() for line in lines)]


def lab(colour, vision):
    """CIE Lab of an sRGB colour as an eye of this vision sees it."""
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    seen = XYZ @ np.clip(VISIONS[vision] @ linear, 0, 1) / XYZ.sum(axis=1)
    f = np.where(seen > (6 / 29) ** 3, np.cbrt(seen), seen / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def distance(colour, other, vision):
    return np.linalg.norm(lab(colour, vision) - lab(other, vision))


def test_lab():
    """White, the red of sRGB; and two colours that periods had once, 4 and 8, which a protanope hardly tells apart."""
    np.testing.assert_allclose(lab("white", "normal"), [100, 0, 0], atol=1e-3)
    np.testing.assert_allclose(lab("#ff0000", "normal"), [53.24, 80.09, 67.20], atol=0.02)
    assert distance("#33a02c", "#ff7f00", "normal") > 80 and distance("#33a02c", "#ff7f00", "protanopia") < 15


@pytest.mark.parametrize("legend", LEAST)
def test_colours_of_a_legend_are_far_apart(legend):
    """With each kind of vision; and there are as many as a picture tells apart."""
    side_by_side = [to_rgb(colour) for colour in colours(legend)]
    assert len({*side_by_side}) == NUMBERS[legend]
    pairs = itertools.pairwise(side_by_side) if "neighbour" in legend else itertools.combinations(side_by_side, 2)
    distances = {(vision, pair): distance(*pair, vision) for pair in pairs for vision in VISIONS}
    assert distances and [pair for pair, apart in distances.items() if apart < LEAST[legend]] == []
