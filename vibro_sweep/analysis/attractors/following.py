"""The same attractor at neighbouring points of a sweep: numbers that follow attractors along a curve of points.

Attractors of neighbouring points are matched as in the continuation of Attractors.jl: those with the least distance
between what is known of them first, and none with two others. What finds no partner at the neighbour is compared with
attractors that were lost before; an attractor that is not one of these either gets the next number.

Periodic attractors can be the same only with the same impacts in a forcing period on each stop, so a number goes on
through period doublings and ends at a graze or in chaos. What that means for splits and births is said in
docs/reference/files_and_limits.md.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.attractors.grouping import ERRORS

NEAR = 0.1  # of the size of the motion: the same attractor changes less from point to point, beyond its errors
EQUAL = 1e-9  # rates of periodic attractors
PAIRS = 10**6  # of attractors that are compared at once
REMEMBERED = 256  # lost attractors; the one that was lost first is forgotten first


class Attractors(NamedTuple):
    """Known attractors, (..., attractors): those of a point along the last axis, in any order."""

    period: np.ndarray  # forcing periods; 0: none; -1: there is no attractor
    # (..., attractors, 2 N + 2): x1, v1/omega, ... at the section, impacts right and left
    mean: np.ndarray
    error: np.ndarray  # of the mean
    size: np.ndarray  # of the motion: the greatest of b and the mean's coordinates
    first: np.ndarray  # the first orbit that reaches it

    def at(self, index) -> "Attractors":
        """A part."""
        return Attractors(*(values[index] for values in self))


def known(first, period, average, error, omega, b) -> Attractors:
    """Attractors of points (points, attractors), each known by the first orbit that reaches it.

    Parameters
    ----------
    first : (points, attractors), its place among the point's orbits; -1: there is no attractor
    period : (points, orbits)
    average, error : (points, orbits, 2 N + 3), as `attractors.group` has them
    omega, b : (points,)
    """
    there = first >= 0
    unit = np.ones((len(first), 1, average.shape[-1] - 1))
    unit[:, 0, 1:-2:2] = 1 / omega[:, None]
    mean, spread = (
        np.where(there[..., None], unit * np.take_along_axis(values[..., :-1], first[..., None], axis=1), 0.0)
        for values in (average, error)
    )
    size = np.maximum(np.abs(mean[..., :-2]).max(axis=-1), b[:, None])
    return Attractors(np.where(there, np.take_along_axis(period, first, axis=1), -1), mean, spread, size, first)


def none(points: int, most: int, means: int = 6) -> Attractors:
    """Room for so many attractors with so many means, with none there."""
    shape = (points, most)
    return Attractors(
        np.full(shape, -1), np.zeros((*shape, means)), np.zeros((*shape, means)), np.ones(shape), np.full(shape, -1)
    )


def distance(one: Attractors, other: Attractors) -> np.ndarray:
    """The distance of each attractor (..., m) from each other (..., n) of the same point: (..., m, n).

    The greatest change of a mean beyond its errors, relative to the size of the motion, or to the greatest rate of
    impacts; infinite where the two cannot be the same.
    """
    farthest = np.zeros((*one.period.shape, other.period.shape[-1]))
    size = np.maximum(one.size[..., :, None], other.size[..., None, :])
    rates = [known.mean[..., -2:].max(axis=-1) for known in (one, other)]
    rate = np.maximum(np.maximum(rates[0][..., :, None], rates[1][..., None, :]), EQUAL)
    periods = one.period[..., :, None], other.period[..., None, :]
    same = (periods[0] >= 0) & (periods[1] >= 0) & ((periods[0] > 0) == (periods[1] > 0))
    means = one.mean.shape[-1]
    for i in range(means):
        change = np.abs(one.mean[..., :, None, i] - other.mean[..., None, :, i])
        change -= ERRORS * (one.error[..., :, None, i] + other.error[..., None, :, i])
        if i >= means - 2:
            same &= (periods[0] == 0) | (change <= EQUAL)
        farthest = np.maximum(farthest, change / (size if i < means - 2 else rate))
    return np.where(same & (farthest <= NEAR), farthest, np.inf)


def partners(apart: np.ndarray) -> np.ndarray:
    """The partner among m of each of n by distances (points, m, n), nearest pairs first: (points, n); -1: none."""
    apart = apart.copy()
    points, m, n = apart.shape
    result = np.full((points, n), -1)
    left = np.arange(points)
    for _ in range(min(m, n)):
        best = apart[left].reshape(len(left), -1).argmin(axis=1)
        row, column = best // n, best % n
        near = np.isfinite(apart[left, row, column])
        left, row, column = left[near], row[near], column[near]
        if not len(left):
            break
        result[left, column] = row
        apart[left, row, :] = apart[left, :, column] = np.inf
    return result


class Follower:
    """Numbers 1, 2, ... for the attractors along a curve of points, in the order in which they are met."""

    def __init__(self, masses: int = 2):
        means = 2 * masses + 2
        self._last, self._before = none(1, 0, means), []  # the attractors of the last point, and their numbers
        self._lost, self._numbers = none(1, REMEMBERED, means), [0] * REMEMBERED
        self._next, self._slot = 1, 0

    def number(self, found: Attractors) -> np.ndarray:
        """The numbers (points, attractors) of the attractors of the next points; 0 where there is none."""
        points, most = found.period.shape
        step = max(1, PAIRS // max(1, most**2))
        parts = [self._number(found.at(slice(at, at + step))) for at in range(0, points, step)]
        return np.concatenate([np.zeros((0, most), np.int32), *parts])

    def _number(self, found: Attractors) -> np.ndarray:
        points, most = found.period.shape
        width = max(most, self._last.period.shape[1])
        path = Attractors(*(
            np.concatenate([_wide(old, width, fill), _wide(new, width, fill)])
            for old, new, fill in zip(self._last, found, (-1, 0, 0, 1, -1), strict=True)
        ))  # fmt: skip
        partner = partners(distance(path.at(slice(None, -1)), path.at(slice(1, None))))
        there = path.period >= 0
        born = (there[1:] & (partner < 0)).any(axis=1)
        lost = (partner >= 0).sum(axis=1) < there[:-1].sum(axis=1)
        numbers = np.zeros((points, width), np.int32)
        before = self._before + [0] * (width - len(self._before))
        for n, row in enumerate(partner.tolist()):
            here = [before[i] if i >= 0 else 0 for i in row]
            if lost[n]:
                self._lose(path.at(n), [0 if number in here else number for number in before])
            if born[n]:
                self._name(path.at(n + 1), here)
            numbers[n] = before = here
        self._last, self._before = path.at(slice(-1, None)), before
        return numbers[:, :most]

    def _lose(self, known: Attractors, numbers: list[int]) -> None:
        """Remember the attractors that have a number here."""
        for i in np.flatnonzero(numbers):
            for kept, values in zip(self._lost, known, strict=True):
                kept[0, self._slot] = values[i]
            self._numbers[self._slot] = numbers[i]
            self._slot = (self._slot + 1) % REMEMBERED

    def _name(self, known: Attractors, here: list[int]) -> None:
        """Give numbers to the attractors that have none yet: those of lost ones, or new ones."""
        nameless = [i for i in np.flatnonzero(known.period >= 0) if not here[i]]
        nameless.sort(key=lambda i: known.first[i])
        old = partners(distance(self._lost, known.at([nameless])))[0]
        for i, slot in zip(nameless, old, strict=True):
            if slot >= 0:
                here[i] = self._numbers[slot]
                self._lost.period[0, slot] = -1
            else:
                here[i] = self._next
                self._next += 1


def _wide(values: np.ndarray, width: int, fill: int) -> np.ndarray:
    """Room for `width` attractors at each point."""
    beyond = [(0, 0), (0, width - values.shape[1]), *[(0, 0)] * (values.ndim - 2)]
    return np.pad(values, beyond, constant_values=fill)
