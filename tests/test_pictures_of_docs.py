"""docs/pictures.py makes every picture that the documentation shows."""

import importlib.util
import re

import pytest
from support import ROOT

spec = importlib.util.spec_from_file_location("pictures", ROOT / "docs" / "pictures.py")
pictures = importlib.util.module_from_spec(spec)
spec.loader.exec_module(pictures)


def shown() -> set[str]:
    """Pictures of docs/ to which its pages and README.md link."""
    found = set()
    for page in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md")):
        text = page.read_text()
        linked = re.findall(r"!\[[^]]*\]\(([^)]+)\)", text) + re.findall(r'<img src="([^"]+)"', text)
        found |= {(page.parent / one).resolve() for one in linked}
    assert {path.parent for path in found} == {ROOT / "docs"}
    return {path.name for path in found}


def test_it_makes_all_that_are_shown_and_no_others():
    assert shown() == set(pictures.PICTURES)
    assert {path.name for path in (ROOT / "docs").iterdir() if path.suffix in (".png", ".svg")} == shown()


def test_what_it_needs_is_there():
    for words in pictures.PLOTS.values():
        named = [word for word in words.split() if word.endswith(".h5")]
        assert named and set(named) <= set(pictures.FILES)
    for made, (what, needs) in pictures.FILES.items():
        assert set(needs) <= set(pictures.FILES) - {made}
        verb, name = what.split()
        assert (ROOT / name).exists() if verb == "run" else name in needs
    for script, *_ in pictures.SCRIPTS.values():
        assert (ROOT / script).exists()
    for page, drawn in pictures.PAGES.values():
        first = (pictures.DOCS / page).read_text().partition("```python\n")[2].partition("```")[0]
        assert f'savefig("{drawn}")' in first


@pytest.mark.slow
def test_it_computes_what_is_missing_and_draws(tmp_path, monkeypatch):
    (tmp_path / "docs").mkdir()
    scene = (ROOT / "configs" / "quickstart.yaml").read_text().replace("step: 0.002", "step: 0.2")
    (tmp_path / "few.yaml").write_text(scene)
    monkeypatch.setattr(pictures, "DOCS", tmp_path / "docs")
    monkeypatch.setattr(pictures, "ROOT", tmp_path)
    monkeypatch.setitem(pictures.FILES, "quickstart.h5", ("run few.yaml", ()))
    folder = tmp_path / "files"
    folder.mkdir()
    for _ in range(2):  # the second time nothing is computed
        pictures.make("quickstart.png", folder)
        assert (tmp_path / "docs" / "quickstart.png").stat().st_size > 1000
        (tmp_path / "few.yaml").unlink(missing_ok=True)
