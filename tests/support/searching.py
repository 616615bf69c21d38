"""Random searches: the study of a seed says what it has counted and what is wrong, and a search adds up those of many.

All studies are named in tools/search.py.
"""

from collections import Counter
from collections.abc import Callable, Iterable
from typing import NamedTuple


class Report(NamedTuple):
    """What a study has counted, and a line for each thing that is wrong."""

    counted: Counter
    wrong: list[str]


Study = Callable[[int], tuple[Counter, list[str]]]


def new_report(**counted: int) -> Report:
    return Report(Counter(counted), [])


def searched(study: Study, seeds: Iterable[int]) -> Report:
    """All that the studies of these seeds have counted and found wrong."""
    total = new_report()
    for seed in seeds:
        counted, wrong = study(seed)
        total.counted.update(counted)
        total.wrong.extend(wrong)
    return total


def size(name: str, value: float, bounds=(1, 2, 5, 10)) -> str:
    """What a size is counted as, so that counts of many tell how large they are: the first bound that holds it."""
    return next((f"{name} up to {bound:g}" for bound in bounds if value <= bound), f"{name} beyond {bounds[-1]:g}")
