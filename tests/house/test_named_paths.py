"""Every file that a page names is there."""

import re

import pytest
from support import ROOT

PAGES = [*sorted((ROOT / "docs").rglob("*.md")), *(ROOT / name for name in ("README.md", "CONTRIBUTING.md"))]
ROOMS = "tables|model|engine|analysis|scene|results|files|driver|plotting|live|cli"
PATH = re.compile(rf"`((?:tests|tools|benchmarks|docs|configs|vibro_sweep|{ROOMS})/[\w./*-]*)`")


def missing(text: str) -> list[str]:
    """Paths of a text that are neither in the checkout nor in the package; they may have a *."""
    named = PATH.findall(text)
    return [path for path in named if not any(any(home.glob(path)) for home in (ROOT, ROOT / "vibro_sweep"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_files_that_a_page_names_are_there(page):
    assert missing(page.read_text()) == []


def test_a_file_that_is_not_there_is_seen():
    assert len(PAGES) > 30
    assert missing("`tests/conftest.py`, `engine/simd/jit.py`, `tests/nothing.py`") == ["tests/nothing.py"]
