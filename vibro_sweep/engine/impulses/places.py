"""What the compiled steps along a branch work on: points with their tests, how to step, what is recorded."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.blocks import room_of, strike_of


class Place(NamedTuple):
    """A point of the branch, with its tests."""

    t: np.ndarray  # (K,)
    D: np.ndarray  # (K,)
    z: np.ndarray  # (K, n): states before the impacts
    tangent_t: np.ndarray  # (K,), physical units; |tangent| = 1 in units of the scale
    tangent_jump: np.ndarray
    tangent_z: np.ndarray  # (K, n)
    releases: np.ndarray  # (K,): acceleration away from the stop after an impact with R = 0, else inf
    multipliers: np.ndarray  # (n, 2): real and imaginary parts; NaN where they are not known
    numbers: np.ndarray  # (NUMBERS,): see below


# Of `numbers`. LENGTH: of the step to it. Multipliers, apart from the ON_CIRCLE: ABOVE 1, BELOW -1, complex PAIRS
# outside of the unit circle; ABOVE is -1 where they are not known. AWAY: the least |mu|^2 - 1 of those outside. FLIP,
# CROSSING: prod_i (1 + mu_i) over r = prod_i (1 + |mu_i|^2)^(1/2), prod_{i<j} (1 - mu_i mu_j) over r^(n - 1), which
# poles of multipliers leave finite
(
    P, TANGENT, REFLECTION, TORUS, MARGIN, DEFECT_HERE, LENGTH, ABOVE, BELOW, PAIRS, ON_CIRCLE, AWAY, FLIP, CROSSING,
    NUMBERS,
) = range(15)  # fmt: skip


class Steps(NamedTuple):
    """How to step, in units of the scale."""

    scale_t: float
    scale_jump: float
    scale_p: float
    longest: float
    shortest: float
    straight: float  # radians between neighbouring tangents
    low: float  # bounds of the parameter
    high: float


class Record(NamedTuple):
    """Points, in order."""

    t: np.ndarray  # (most, K)
    D: np.ndarray  # (most, K)
    motion: np.ndarray  # (most, K, 2)
    numbers: np.ndarray  # (most, NUMBERS)
    state: np.ndarray  # (most, n): at the time `origin`, in contact coordinates


class Work(NamedTuple):
    room: np.ndarray  # (1,) `room_of`
    strikes: np.ndarray  # (K,) `strike_of`
    change_t: np.ndarray  # (2, K)
    change_jump: np.ndarray  # (2, K)
    change_z: np.ndarray  # (2, K, n)
    change_p: np.ndarray  # (2,)
    row_t: np.ndarray  # (K,)
    row_jump: np.ndarray  # (K,)
    past: np.ndarray  # (NUMBERS,) of the point before a; LENGTH: from there to a, 0 where it is not known
    past_multipliers: np.ndarray  # (n, 2)


def new_place(K: int, n: int) -> Place:
    return Place(*map(np.zeros, [K, K, (K, n), K, K, (K, n), K, (n, 2), NUMBERS]))


def new_record(most: int, K: int, n: int) -> Record:
    return Record(*map(np.zeros, [(most, K), (most, K), (most, K, 2), (most, NUMBERS), (most, n)]))


def new_work(K: int, n: int) -> Work:
    rooms = np.zeros(1, room_of(n // 2)), np.zeros(K, strike_of(n // 2))
    return Work(*rooms, *map(np.zeros, [(2, K), (2, K), (2, K, n), 2, K, K, NUMBERS, (n, 2)]))
