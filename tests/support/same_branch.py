"""The same branch followed from several of its orbits, with shorter and longer steps: what is different."""

from typing import NamedTuple

import numpy as np

import vibro_sweep as vs
from support.drawn_branches import Case
from vibro_sweep.types import PeriodicOrbit

CLOSE = 1e-9  # relative to the parameter or its range: values of one special point differ by less
MOST_POINTS = 4000
ATTRIBUTES = ("stop", "kind", "direction", "criticality")


class TooLongError(Exception):
    """A branch with more points than MOST_POINTS, each way."""


def follow(case: Case, factor: float = 1.0):
    def look(points, value):
        if points > MOST_POINTS:
            raise TooLongError(str(case))

    return vs.continue_orbit(case.orbit, case.name, case.bounds, look, step=factor)


class Listed(NamedTuple):
    type: str
    value: float
    error: float
    attributes: tuple


def listed(branch) -> list[Listed]:
    """Its special points. A closed branch has no ends."""
    return [
        Listed(one.type, one.parameters[branch.parameter], one.error, tuple(getattr(one, name) for name in ATTRIBUTES))
        for one in branch.special
        if one.type != "closed"
    ]


def rows(branch, case: Case, k: int) -> PeriodicOrbit:
    """The orbit at a point of a branch, by Newton's method from its impacts."""
    point = branch.points.isel(point=k)
    system = case.orbit.system.replace(**{case.name: float(point[case.name])})
    guess = list(
        zip(
            point.impact_t.values.tolist(),
            point.impact_side.values.tolist(),
            point.impact_v.values.tolist(),
            strict=True,
        )
    )
    if not guess:
        return vs.periodic_orbit(system, itinerary="")
    return vs.periodic_orbit(system, guess=guess, periods=case.orbit.period)


def other_starts(branch, case: Case, rng, most: int = 5):
    """(words, orbit) of this branch: at its special points, beside them, at its ends and in between."""
    count = branch.points.sizes["point"]
    values = branch.points[case.name].values
    found = []
    for i, special in enumerate(branch.special):
        if special.type in ("sticking", "closed", "failed"):
            continue
        birth = special in (branch.begins, branch.ends) and special.type in ("flip", "pitchfork")
        if not birth and special.orbit.ok:
            found.append((f"at special point {i}, {special.type}", special.orbit))
        k = int(np.argmin(np.abs(values - special.parameters[case.name])))
        found += [(f"point {j}, beside special point {i}, {special.type}", j) for j in (k - 1, k + 1) if 0 <= j < count]
    found += [(f"point {j}", j) for j in (1, count - 2, *rng.integers(0, count, 2).tolist()) if 0 <= j < count]
    for k in rng.permutation(len(found))[:most].tolist():
        words, start = found[k]
        yield words, start if isinstance(start, PeriodicOrbit) else rows(branch, case, start)


def differences(one: list[Listed], other: list[Listed], size: float, closed: bool = False) -> list[tuple[str, str]]:
    """(class, words) of what is not the same in two lists of special points, in the better of both directions."""
    if closed:
        orders = [other[k:] + other[:k] for k in range(max(len(other), 1))]
        orders += [order[::-1] for order in orders]
    else:
        orders = [other, other[::-1]]
    return min((_differences(one, order, size) for order in orders), key=len)


def _differences(one, other, size) -> list[tuple[str, str]]:
    if [a.type for a in one] != [b.type for b in other]:
        return _missing(one, other, size)
    found = []
    for a, b in zip(one, other, strict=True):
        apart = abs(a.value - b.value)
        if a.type == "failed":
            continue
        if not apart <= CLOSE * max(size, abs(a.value)):
            found.append((f"value of {a.type}", f"{a.value!r} and {b.value!r}"))
        elif not apart <= 10 * (a.error + b.error) and a.type != "boundary":
            found.append((f"error of {a.type}", f"{apart:.1e} apart, errors {a.error:.1e} and {b.error:.1e}"))
        for name, x, y in zip(ATTRIBUTES, a.attributes, b.attributes, strict=True):
            if x != y and not (name == "stop" or None in (x, y)):
                found.append((f"{name} of {a.type}", f"at {a.value!r}: {x} and {y}"))
    return found


def _missing(one, other, size) -> list[tuple[str, str]]:
    """Points of each list that the other one has not."""
    left, right = list(one), list(other)
    for a in one:
        same = [b for b in right if b.type == a.type and abs(a.value - b.value) <= 1e-6 * max(size, abs(a.value))]
        if same:
            right.remove(same[0])
            left.remove(a)
    words = [f"{a.type} {a.value:.12g}" for a in left], [f"{a.type} {a.value:.12g}" for a in right]
    kinds = sorted({a.type for a in left + right})
    return [(f"list: {', '.join(kinds) or 'order'}", f"only here {words[0]}; only there {words[1]}")] * (
        1 + len(left) + len(right)
    )
