"""Which of several orbits of one system end on the same attractor, from what is known of each without the others.

That is its period and seven averages (`averaged` of tables/observables.py), which all orbits of an attractor share
whatever their phase. Mirror images (X -> -X, t -> t + T/2) share period and exponents; their section points, and so the
averages of these, differ.
"""

import numpy as np

from vibro_sweep.tables.exponents import sign_of

BAD, NOT_SETTLED = -1, 0  # of an orbit without attractor
ERRORS = 4  # to each side of an average; where the ranges of two orbits meet, the averages may be the same


def group(period, average, error) -> np.ndarray:
    """The attractor of each orbit: 1, 2, ... by falling number of orbits; or `NOT_SETTLED`.

    Of equally many the one that an earlier orbit reaches comes first. An attractor holds all orbits of one period whose
    averages meet, or are linked by others between them: where chaos changes sides seldom, each orbit has averages of
    its own, and many of them fill the range. (A multiple of the period is the same: what is left of a slow approach can
    repeat itself better after several periods than after one.) An orbit without a period that need not be chaotic and
    has the averages of a periodic one is taken to be on its way there.

    Parameters
    ----------
    period : (..., orbits), 0 where there is none
    average, error : (..., orbits, 2 N + 3), as `averaged` says; NaN of an orbit that has not settled
    """
    low, high = ranges(period, average, error)
    waiting = settled(low)
    unsure = doubtful(period, average, error)
    label, sizes, firsts = np.full(period.shape, NOT_SETTLED), [], []
    while waiting.any():
        first = np.argmax(waiting * (1 + (period > 0)), axis=-1)[..., None]  # a periodic one, if there is any
        found, near = _attractor_of(first, waiting, period, low, high)
        waiting &= ~found & ~(near & unsure & (np.take_along_axis(period, first, axis=-1) > 0))
        sizes.append(np.count_nonzero(found, axis=-1))
        firsts.append(np.argmax(found, axis=-1))
        label[found] = len(sizes)
    if not sizes:
        return label
    order = np.lexsort((np.stack(firsts, axis=-1), -np.stack(sizes, axis=-1)), axis=-1)
    rank = 1 + np.argsort(order, axis=-1)
    return np.where(label > 0, np.take_along_axis(rank, np.maximum(label - 1, 0), axis=-1), label)


def ranges(period, average, error) -> tuple[np.ndarray, np.ndarray]:
    """The range of the averages of an orbit, (..., 2 N + 3): least and greatest."""
    low, high = average - ERRORS * error, average + ERRORS * error
    low[period > 0, -1], high[period > 0, -1] = -np.inf, np.inf  # a periodic orbit is known better by the rest
    return low, high


def settled(low) -> np.ndarray:
    """Whether the averages of an orbit are known."""
    return np.isfinite(low[..., :-1]).all(axis=-1)


def doubtful(period, average, error) -> np.ndarray:
    """Whether an orbit may be on its way to a periodic one."""
    return (period == 0) & (sign_of(average[..., -1], error[..., -1]) <= 0)


def alike(period, base) -> np.ndarray:
    """Whether one period is a multiple of the other."""
    return np.gcd(period, base) == np.minimum(period, base)


def _attractor_of(first, waiting, period, low, high) -> tuple[np.ndarray, np.ndarray]:
    """The waiting orbits on the attractor of orbit `first`, and all that have averages as they do (bool)."""
    base = np.take_along_axis(period, first, axis=-1)
    same = waiting & alike(period, base)
    found = same & (np.arange(period.shape[-1]) == first)
    while True:
        lowest = np.min(low, axis=-2, keepdims=True, initial=np.inf, where=found[..., None])
        highest = np.max(high, axis=-2, keepdims=True, initial=-np.inf, where=found[..., None])
        near = ((low <= highest) & (high >= lowest)).all(axis=-1)
        if not (same & near & ~found).any():
            return found, near
        found |= same & near


def share(label) -> np.ndarray:
    """The part of the orbits (..., orbits) with the label of each, of those that are not `BAD`; NaN for these."""
    count = np.count_nonzero(label != BAD, axis=-1, keepdims=True)
    result = np.full(label.shape, np.nan)
    for one in range(NOT_SETTLED, label.max(initial=0) + 1):
        same = label == one
        np.copyto(result, np.count_nonzero(same, axis=-1, keepdims=True) / np.maximum(count, 1), where=same)
    return result
