"""Itineraries: the stops that an orbit hits, in order, as a word of R and L."""

import numpy as np

LETTERS = {1: "R", -1: "L"}
SIDES = {"R": 1, "L": -1}
SAME = 1e-7  # of a forcing period: times that differ by less are the same


def word(sides) -> str:
    return "".join(LETTERS[int(side)] for side in sides)


def canonical_start(sides, times, period: float, length: float) -> int:
    """Index of the impact with which the least rotation begins, L < R.

    Ties by the time modulo the forcing period; where that is the same, too, by the flights that follow, the shortest
    first. length: of the whole period, in which the impacts come again.
    """
    sides = [int(side) for side in sides]
    if not sides:
        return 0
    letters = word(sides)
    rotations = [letters[k:] + letters[:k] for k in range(len(letters))]
    least = min(rotations)
    ties = [k for k, rotation in enumerate(rotations) if rotation == least]
    phases = np.array([times[k] % period for k in ties])
    ties = [k for k, phase in zip(ties, phases, strict=True) if phase - phases.min() <= SAME * period]
    flights = np.diff(np.append(times, times[0] + length))
    rounded = np.round(flights / (SAME * period))
    return min(ties, key=lambda k: tuple(np.roll(rounded, -k)))


def is_mirrored(sides) -> bool:
    """Whether the second half hits the other stops in the order of the first."""
    half, odd = divmod(len(sides), 2)
    return not odd and all(a == -b for a, b in zip(sides[:half], sides[half:], strict=True))


def repetitions(sides) -> list[int]:
    """Numbers d > 1, largest first, for which the word is d times a shorter one."""
    K = len(sides)
    return [d for d in range(K, 1, -1) if K % d == 0 and np.array_equal(sides, np.tile(sides[: K // d], d))]
