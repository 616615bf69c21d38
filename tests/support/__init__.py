"""What several tests share: scenes, oscillators, damaged files."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]  # the checkout; the package that is tested may be installed elsewhere


def slow_cases(*cases):
    """Cases of a parametrised test that are run with `-m slow` only. A tuple has the values of several arguments."""
    return [pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.slow) for case in cases]


def path_with(folder: Path) -> str:
    """PYTHONPATH of a program that imports from this folder and from tests/, and the package from where it is here."""
    return os.pathsep.join([str(folder), str(ROOT / "tests"), *filter(None, [os.environ.get("PYTHONPATH")])])
