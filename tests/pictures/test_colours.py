"""Colours that stand side by side in a legend are distinct to readers with any colour vision."""

import itertools

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from vibro_sweep.model.outcomes import REASONS
from vibro_sweep.plotting import drawn_curves, families, strip, style

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

PERIODS = (style.NO_PERIOD, *style.PERIODS, style.LONGER)

_TYPES = [colour for name, colour in drawn_curves.COLOURS.items() if name != "graze"]

# Pairs of colours, and the least distance of all in CIE Lab (2.3 is just noticeable where areas touch).
LEGENDS = {
    "periods": (itertools.combinations((*PERIODS, style.NOT_COMPUTED), 2), 19),
    "neighbouring periods": (itertools.pairwise(PERIODS), 27),
    "exponents": (itertools.combinations(style.EXPONENTS, 2), 39),
    "kinds of attractors": (itertools.combinations([colour for _, colour in families.KINDS.values()], 2), 32),
    "branches": (itertools.combinations((*style.BRANCHES.values(), style.INK), 2), 45),
    "curves": (itertools.combinations(drawn_curves.COLOURS.values(), 2), 26),
    "curves by period": (itertools.combinations((*drawn_curves.ORBITS, *_TYPES), 2), 18),
    "orbits without a window": (itertools.combinations(strip.REASON_COLOURS.values(), 2), 11),
    "sides": ([(style.RIGHT, style.LEFT)], 82),
    "portrait": (itertools.combinations((style.INK, style.SECTION, style.IMPACT, style.FAINT), 2), 32),
}
LEGENDS = {name: (list(pairs), least) for name, (pairs, least) in LEGENDS.items()}


def lab(colour, vision):
    """CIE Lab of an sRGB colour as an eye of this vision sees it."""
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    seen = XYZ @ np.clip(VISIONS[vision] @ linear, 0, 1) / XYZ.sum(axis=1)
    f = np.where(seen > (6 / 29) ** 3, np.cbrt(seen), seen / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def distance(one, other, vision):
    return np.linalg.norm(lab(one, vision) - lab(other, vision))


def test_lab():
    """White, the red of sRGB; and two colours that periods had once, 4 and 8, which a protanope hardly tells apart."""
    np.testing.assert_allclose(lab("white", "normal"), [100, 0, 0], atol=1e-3)
    np.testing.assert_allclose(lab("#ff0000", "normal"), [53.24, 80.09, 67.20], atol=0.02)
    assert distance("#33a02c", "#ff7f00", "normal") > 80 and distance("#33a02c", "#ff7f00", "protanopia") < 15


@pytest.mark.parametrize("vision", VISIONS)
@pytest.mark.parametrize("legend", LEGENDS)
def test_colours_of_a_legend_are_far_apart(legend, vision):
    pairs, least = LEGENDS[legend]
    assert not [pair for pair in pairs if distance(*pair, vision) < least]


def test_there_is_a_colour_for_each_period():
    assert len(set(style.PERIODS)) == style.LONGEST


def test_there_is_a_colour_for_each_reason_of_no_window():
    assert set(strip.REASON_COLOURS) == set(REASONS) - {"in_a_window"}
