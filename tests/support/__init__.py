"""What several tests share: scenes, oscillators, damaged files."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]  # the checkout; the package that is tested may be installed elsewhere


def sample(n: int, cases) -> list:
    """Cases of a parametrised test of which n, spread over all, are fast, and the others run with `-m slow` only.

    A tuple has the values of several arguments.
    """
    cases = [case if isinstance(case, tuple) else (case,) for case in cases]
    fast = spread(n, len(cases))
    return [pytest.param(*case, marks=[] if k in fast else pytest.mark.slow) for k, case in enumerate(cases)]


def slow_cases(*cases) -> list:
    """Cases of a parametrised test that are all slow."""
    return sample(0, cases)


def spread(n: int, count: int) -> set[int]:
    """n places of `count`, at equal distances, the first among them."""
    return {k * count // n for k in range(n)}


def path_with(folder: Path) -> str:
    """PYTHONPATH of a program that imports from this folder and from tests/, and the package from where it is here."""
    return os.pathsep.join([str(folder), str(ROOT / "tests"), *filter(None, [os.environ.get("PYTHONPATH")])])
