"""A machine with any number of contacts and friction elements, as its kernels see it.

    M x'' + C x' + K x = constant + sum over h of (sine_h sin(h phi) + cosine_h cos(h phi)) - sum of row_e force_e

phi = omega t + tau. Each stop of a contact is an element, and so is each friction element; `row` leads from x' to the
velocity into the stop, or of the slip, and the force of the element acts along -row. Order of elements: contacts as
they are listed, of each the right stop before the left one, then friction.

Coordinates are y = P x: the independent rows of the elements first, then single masses (points/contact.py says why).
"""

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.engine.points.exact import accelerations, as_fractions, inverse, product
from vibro_sweep.oscillator.linear import LinearContact

RIGID, COMPLIANT, BY_FORCE, RUBS = range(4)  # BY_FORCE: compliant, with a damper, and left where its force is zero
MOST = 24  # elements, whose modes together make a number of 64 bits
CELLS = 24  # of a forcing period: at their ends the phase of the force is known to the last digit


class Stop(NamedTuple):
    """side (n . x - place) <= 0. Rigid with the restitution R, or (R NaN) compliant: force k delta + c delta' + p."""

    number: int  # of its contact, from 1
    normal: Sequence[float]
    side: int
    place: float
    R: float
    k: float = 0.0
    c: float = 0.0
    p: float = 0.0
    by_force: bool = False


class Friction(NamedTuple):
    """w = direction . x' - belt. Slip: the force is kinetic sign(w); stick: w = 0, and the force at most `static`."""

    number: int
    direction: Sequence[float]
    kinetic: float
    static: float
    belt: float = 0.0


class Machine(NamedTuple):
    """E elements, N coordinates, H harmonics; inputs are (y, y', s of stops that relax, sin and cos of each h, 1)."""

    free: np.ndarray  # (N, inputs): y'' without the elements
    row: np.ndarray  # (E, N)
    push: np.ndarray  # (E, N): y'' by a unit force along the row
    coordinate: np.ndarray  # (E,): the coordinate that its row is, but for a factor; -1: a combination
    kind: np.ndarray  # (E,)
    law: np.ndarray  # (E, 4): side * place, R; side * place, k, c, p; belt, kinetic, static
    relaxing: np.ndarray  # (E,): which s; -1: none
    rates: np.ndarray  # (H,): h omega
    turn: np.ndarray  # (CELLS + 1, 2 H): sin and cos at the ends of cells
    width: np.ndarray  # (1,): of a cell
    P: np.ndarray  # (N, N)
    back: np.ndarray  # (N, N)


def stops_of(contacts: Sequence[LinearContact]) -> list[Stop]:
    """The stops of a list of contacts."""
    found = []
    for number, one in enumerate(contacts, 1):
        for side in (1, -1):
            place, R, law = float(one.stop(side)), float(one.restitution(side)), one.law(side)
            if math.isfinite(place):
                found.append(Stop(number, one.normal, side, place, R, law.k, law.c, law.p, one.by_force))
    return found


def machine_of(
    M, K, C, constant, harmonics: Sequence[tuple], omega: float, tau: float, elements: Sequence[Stop | Friction]
) -> Machine:  # fmt: skip
    """The machine of these matrices (N, N). harmonics: (h, sine, cosine), each of these (N,).

    Raises ArgumentError for more than `MOST` elements.
    """
    if len(elements) > MOST:
        raise ArgumentError(f"elements: there are {len(elements)}; {MOST} at most")
    rows = [[a * e.side for a in e.normal] if isinstance(e, Stop) else [*e.direction] for e in elements]
    P, place = coordinates(as_fractions(np.array(rows, float).reshape(-1, len(M))), np.array(M), np.array(K))
    back = inverse(P)
    forces = [force for _, sine, cosine in harmonics for force in (sine, cosine)] + [constant]
    fast, N, E = rounded(accelerations(M, K, C, np.transpose(forces), P, back)), len(M), len(elements)
    weight = product(product(P, inverse(as_fractions(np.array(M, float)))), [*zip(*P, strict=True)])
    across = [product([as_fractions(np.array(row, float))], back)[0] for row in rows]
    kinds = [kind_of(e) for e in elements]
    where = np.cumsum([kind == BY_FORCE for kind in kinds]) - 1
    relaxing = np.array([int(n) if kind == BY_FORCE else -1 for kind, n in zip(kinds, where, strict=True)], np.int64)
    places = np.zeros((N, kinds.count(BY_FORCE)))
    orders, ends = [h for h, _, _ in harmonics], range(CELLS + 1)
    angles = np.array([[h * tau + 2 * math.pi * ((h * k) % CELLS) / CELLS for h in orders] for k in ends])
    turn = np.stack([np.sin(angles), np.cos(angles)], -1).reshape(CELLS + 1, -1)
    return Machine(
        np.hstack([fast[:, : 2 * N], places, fast[:, 2 * N :]]),
        rounded(across).reshape(E, N), rounded([product(weight, [[a] for a in row]) for row in across]).reshape(E, N),
        np.array(place, np.int64), np.array(kinds, np.int64), np.array([law_of(e) for e in elements]).reshape(E, 4),
        relaxing, np.array(orders, float) * omega, turn, np.array([2 * math.pi / omega / CELLS]),
        rounded(P), rounded(back),
    )  # fmt: skip


def kind_of(element: Stop | Friction) -> int:
    if isinstance(element, Friction):
        return RUBS
    if not math.isnan(element.R):
        return RIGID
    return BY_FORCE if element.by_force and element.c > 0 else COMPLIANT


def law_of(element: Stop | Friction) -> tuple[float, float, float, float]:
    if isinstance(element, Friction):
        return element.belt, element.kinetic, element.static, 0.0
    place = element.side * element.place
    return (place, element.R, 0.0, 0.0) if kind_of(element) == RIGID else (place, element.k, element.c, element.p)


def coordinates(rows: list, M: np.ndarray, K: np.ndarray) -> tuple[list, list[int]]:
    """P, of fractions: the independent rows, and the masses but one for each of these, those that are held least by
    their own springs; and which coordinate each row is, but for a factor, -1 of none."""
    N, chosen, reduced, spare, place = len(M), [], [], [], []
    for row in rows:
        alike = [i for i, one in enumerate(chosen) if is_multiple(row, one)]
        left = list(row)
        for one, at in zip(reduced, spare, strict=True):
            left = [a - left[at] / one[at] * b for a, b in zip(left, one, strict=True)]
        if any(left):
            force = [abs(K[i][i]) / float(left[i] * left[i]) if left[i] else math.inf for i in range(N)]
            spare.append(min(range(N), key=lambda i: force[i]))
            reduced.append(left)
            chosen.append(row)
            alike = [len(chosen) - 1]
        place.append(alike[0] if alike else -1)
    units = [[Fraction(int(i == j)) for j in range(N)] for i in range(N) if i not in spare]
    return [*chosen, *units], place


def is_multiple(row: list, other: list) -> bool:
    at = next(i for i, a in enumerate(other) if a)
    return all(a * other[at] == b * row[at] for a, b in zip(row, other, strict=True))


def rounded(rows) -> np.ndarray:
    return np.array(rows, float)
