"""docs/pictures.py makes the pictures that README.md shows; all others are made by the build of the site."""

import importlib.util
import re

import pytest
from support import ROOT

spec = importlib.util.spec_from_file_location("pictures", ROOT / "docs" / "pictures.py")
pictures = importlib.util.module_from_spec(spec)
spec.loader.exec_module(pictures)


def test_it_makes_all_that_are_shown_and_no_others():
    text = (ROOT / "README.md").read_text()
    shown = re.findall(r"!\[[^]]*\]\(docs/([^)]+)\)", text) + re.findall(r'<img src="docs/([^"]+)"', text)
    assert set(shown) == set(pictures.PICTURES)
    drawn = (path for path in (ROOT / "docs").iterdir() if path.suffix in (".png", ".svg", ".gif"))
    assert {path.name for path in drawn} == set(pictures.PICTURES)


@pytest.mark.slow
def test_it_computes_and_draws(tmp_path, monkeypatch):
    few = tmp_path / "quickstart.yaml"
    few.write_text(pictures.SCENE.read_text().replace("step: 0.002", "step: 0.2"))
    monkeypatch.setattr(pictures, "SCENE", few)
    pictures.quickstart(tmp_path / "quickstart.png")
    assert (tmp_path / "quickstart.png").stat().st_size > 1000
