"""Families of windows: one itinerary, and a period that grows by the same step from window to window."""

from collections import defaultdict
from itertools import pairwise
from typing import NamedTuple

LEAST = 3  # windows of a family


class WindowFamily(NamedTuple):
    """itinerary and symmetry that its windows share; their indices by rising period, the least period, the step.

    Examples
    --------
    Windows near the grazing clearance, whose period grows by the same step from window to window.

    >>> import numpy as np
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> data = vs.sweep(system, {"b": np.linspace(6.4, 6.65, 51)}, observe=["section"], transient=800, record=200)
    >>> windows = vs.windows(data)
    >>> [(one.itinerary, one.period, one.step) for one in windows.families]
    [('LLLLLLLLRRRRRRRR', 47, 2), ('RRRR', 11, 1), ('LLLLRRRR', 23, 2)]
    """

    itinerary: str
    symmetric: bool
    windows: tuple[int, ...]
    period: int
    step: int


def families(itineraries: list[str], symmetric: list[bool], periods: list[int], lo: list[float]) -> list[WindowFamily]:
    """The families among windows, by falling size: runs of one step in the period, along which `lo` rises or falls.

    Of windows with the same itinerary and period the first counts.
    """
    groups: dict[tuple[str, bool], dict[int, int]] = defaultdict(dict)
    for w, (word, kind, period) in enumerate(zip(itineraries, symmetric, periods, strict=True)):
        if word:
            groups[word, bool(kind)].setdefault(int(period), w)
    result = []
    for (word, kind), by_period in groups.items():
        for run in _runs([(period, lo[w], w) for period, w in sorted(by_period.items())]):
            if len(run) >= LEAST:
                step = run[1][0] - run[0][0]
                result.append(WindowFamily(word, kind, tuple(w for _, _, w in run), run[0][0], step))
    return sorted(result, key=lambda family: (-len(family.windows), family.period))


def _runs(rows: list[tuple[int, float, int]]) -> list[list[tuple[int, float, int]]]:
    """Longest stretches of neighbours with one step of the period and one direction of `lo`."""
    runs, steps = [], [(b[0] - a[0], b[1] > a[1]) for a, b in pairwise(rows)]
    begin = 0
    for i in range(1, len(rows)):
        if i == len(rows) - 1 or steps[i] != steps[begin]:
            runs.append(rows[begin : i + 1])
            begin = i
    return runs
