"""Stated errors of the points at which doubled and asymmetric orbits are born: the same point located several times.

Once on the branch of the simpler orbit, and from the orbit that `switch` gives, within narrow bounds of two widths:
other starts, other units, other steps, and for some other equations.
"""

from itertools import combinations
from typing import NamedTuple

import numpy as np

import vibro_sweep as vs
from support.drawn_branches import drawn_oscillator
from support.random_switching import attractor
from support.searching import Report, new_report, size

MODELS = ("two_mass", "one_mass", "linear", "chain", "ball_in_cavity")
NUMBERS = ("b", "b", "omega", "R")
WIDTHS = (20.0, 54.0)  # of the bounds, in distances of the born orbit from its birth
MOST_IMPACTS = 100
LONG = 8  # impacts
SHARES = (0.1, 0.5, 1)  # of the error that is stated
GENERATIONS, MOST_ORBITS = 3, 2


class LocatedTwice(NamedTuple):
    """Two locations of one point."""

    where: str
    impacts: int  # of the simpler orbit
    apart: float
    error: float  # both together
    points: tuple

    @property
    def ratio(self) -> float:
        return self.apart / self.error


def study(seed: int) -> Report:
    """How many pairs were compared, and those that are apart by more than both errors."""
    report = new_report(drawn=1)
    for pair in births(seed):
        report.counted.update({"pairs": 1, "long": pair.impacts >= LONG, size("errors", pair.ratio, SHARES): 1})
        if pair.ratio > 1:
            report.wrong.append(f"{pair.where}: {pair.apart:.1e} apart, errors {pair.error:.1e}")
    return report


def births(seed: int) -> list[LocatedTwice]:
    """Of an attractor of a random oscillator, and of the orbits that are born from its branch."""
    rng = np.random.default_rng([5, seed])
    model = str(rng.choice(MODELS))
    system = drawn_oscillator(model, rng)
    started = attractor(system, rng, tries=3)
    orbit = vs.periodic_orbit(system, state=started[0], periods=started[1]) if started else None
    if orbit is None or not orbit.ok or not orbit.impacts.size or orbit.sticking.size:
        return []
    name, result, orbits = str(rng.choice(NUMBERS)), [], [orbit]
    for _ in range(GENERATIONS):
        born = []
        for one in orbits[:MOST_ORBITS]:
            branch = vs.continue_orbit(one, name, _bounds(name, getattr(one.system, name), 0.15))
            for special in branch.special[1:-1]:
                if special.type in ("flip", "pitchfork"):
                    children = [child for child in vs.switch(special)[:1] if child._solution.K <= 2 * MOST_IMPACTS]
                    born += children
                    for child in children:
                        result += _again(f"{seed}: {model}, {special.type} in {name}", special, child, name)
        orbits = born
    return result


def _bounds(name: str, value: float, share: float) -> tuple[float, float]:
    return (1 - share) * value, min((1 + share) * value, 1.0) if name == "R" else (1 + share) * value


def _again(where: str, special, child, name: str) -> list[LocatedTwice]:
    at, value = special.parameters[name], getattr(child.system, name)
    K, found = special.orbit._solution.K, [special]
    for width in WIDTHS:
        share = max(width * abs(value - at) / abs(value), 1e-3 * width / WIDTHS[0])
        for one in vs.continue_orbit(child, name, _bounds(name, value, share)).special:
            near = abs(one.parameters[name] - at) < 1e-7 * abs(at)
            if near and one.type == special.type and one.orbit._solution.K == K:
                found.append(one)
    where = f"{where} = {at!r}, {K} impacts"
    return [
        LocatedTwice(where, K, abs(a.parameters[name] - b.parameters[name]), a.error + b.error, (a, b))
        for a, b in combinations(found, 2)
    ]
