"""The gallery: short scripts, and every kind of picture and every model among them. The build of the site runs them."""

import ast
import re

import pytest
from support import ROOT

from vibro_sweep.model.models import DEFAULT, MODELS
from vibro_sweep.plotting import KINDS

SCRIPTS = sorted((ROOT / "docs" / "gallery").rglob("plot_*.py"))
MOST_LINES = 30


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_title_what_is_seen_and_short_code(path):
    text = path.read_text()
    title, underline, empty, *seen = ast.get_docstring(ast.parse(text)).splitlines()
    assert title and underline == "=" * len(title) and not empty and seen
    code = text.split('"""', 2)[2].strip().splitlines()
    assert 0 < len([line for line in code if line.strip()]) <= MOST_LINES
    assert "plot" in code[-1] or code[-1] == "plt.show()"


def test_each_kind_of_picture_and_each_model():
    """A kind that is the default of its data is found by what the data must have."""
    text = "".join(path.read_text() for path in SCRIPTS)
    by_default = {
        "bifurcation": '"b": {',
        "plane": '"omega": {"start": 0.5, "stop": 1.1',
        "basins": '"v1": {',
    }
    for kind in KINDS:
        assert f'"{kind}"' in text or by_default.get(kind, "\0") in text, kind
    for model in set(MODELS) - {DEFAULT, "linear"}:
        assert f'"{model}"' in text, model
    assert "vs.System(" in text and re.search(r"vs\.Oscillator\(\s*M=", text)
    assert len(SCRIPTS) >= 25
