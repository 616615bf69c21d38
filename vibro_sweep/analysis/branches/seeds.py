"""Orbits as plain numbers, with which a search goes on: as tuples, and as arrays that travel between processes."""

from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.flat import Flat
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.model.linear import family_of

SCALARS = ("sigma", "halves", "special")
LISTS = {"sides": int, "u": float, "rests": int}
SHAPES = {  # of `packed`
    "q p": "beyond_place",
    "q": "beyond_sigma beyond_halves beyond_special beyond_sides_count beyond_u_count beyond_rests_count",
    # of all seeds, one after the other
    "sides": "beyond_sides",
    "u": "beyond_u",
    "rests": "beyond_rests",
}


class Seed(NamedTuple):
    """An orbit, and where it was found: on the branch or curve `parent`, at its special point `special`."""

    system: Any
    sigma: int
    halves: int
    sides: tuple[int, ...]
    u: tuple[float, ...]
    rests: tuple[int, ...]
    parent: int = -1
    special: int = -1

    @property
    def solution(self) -> Solution:
        return Solution(family_of(self.system), self.sigma, self.halves, self.sides, np.array(self.u), 0.0, self.rests)

    def orbit(self) -> PeriodicOrbit:
        return orbit_of(self.system, self.solution)

    def place(self, names: tuple[str, ...]) -> np.ndarray:
        """The values of these parameters."""
        numbers = family_of(self.system).numbers
        return np.array([numbers[name] for name in names], float)


def seed_of(orbit: PeriodicOrbit) -> Seed:
    s = orbit._solution
    return Seed(
        orbit.system, s.sigma, s.halves, tuple(map(int, s.sides)), tuple(s.u.tolist()), tuple(map(int, s.rests))
    )


def packed(seeds: list[Seed], names: tuple[str, ...]) -> Flat:
    """Arrays `SHAPES` of q seeds that differ from one oscillator in the p parameters `names` alone."""
    flat = {"place": np.array([seed.place(names) for seed in seeds]).reshape(-1, len(names))}
    flat |= {name: np.array([getattr(seed, name) for seed in seeds], int) for name in SCALARS}
    for name, kind in LISTS.items():
        lists = [getattr(seed, name) for seed in seeds]
        flat[name] = np.array([one for values in lists for one in values], kind)
        flat[f"{name}_count"] = np.array([len(values) for values in lists], int)
    return {f"beyond_{name}": values for name, values in flat.items()}


def fit_together(flat: Flat) -> bool:
    """Whether arrays of these shapes hold as many numbers as they say."""
    counts = {name: flat[f"beyond_{name}_count"] for name in LISTS}
    return all(np.all(count >= 0) and count.sum() == len(flat[f"beyond_{name}"]) for name, count in counts.items())


def unpacked(flat: Flat, names: tuple[str, ...], system, parent: int = -1) -> list[Seed]:
    """The seeds of `packed`. system : one of their oscillators"""
    scalars = zip(*(flat[f"beyond_{name}"].tolist() for name in SCALARS), strict=True)
    ends = {name: np.cumsum(flat[f"beyond_{name}_count"]) for name in LISTS}
    lists = {name: np.split(flat[f"beyond_{name}"], ends[name][:-1]) for name in LISTS}
    seeds = []
    for i, (sigma, halves, special) in enumerate(scalars):
        there = system.replace(**dict(zip(names, flat["beyond_place"][i].tolist(), strict=True)))
        sides, u, rests = (tuple(lists[name][i].tolist()) for name in LISTS)
        seeds.append(Seed(there, sigma, halves, sides, u, rests, parent, special))
    return seeds
