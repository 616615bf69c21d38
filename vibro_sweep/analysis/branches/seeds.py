"""Orbits as plain numbers, with which a search goes on: as tuples, and as arrays that travel between processes."""

from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import Arrays
from vibro_sweep.analysis.continuation.starting_orbit import KINDS, StartingOrbit
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.oscillator.family import family_of

TYPES = ("orbit", *KINDS)
SCALARS = {"sigma": int, "half_periods": int, "index": int, "theta": float, "special": int}
SHAPES = {  # of `packed`
    # values of the p parameters; which of them are those of a seed's special point
    "q p": "beyond_place beyond_own",
    "q": f"beyond_type beyond_impacts {' '.join(f'beyond_{name}' for name in SCALARS)}",
    "k 4": "beyond_impact",  # side, t, D and the end of the rest or NaN, of all seeds one after the other
}


class Seed(NamedTuple):
    """An orbit, perhaps at a bifurcation, and where it was found: on the branch or curve `parent`, at its special point
    `special`."""

    system: Any
    sigma: int
    half_periods: int
    impacts: np.ndarray  # (K, 4): side, t, D and the end of the rest or NaN
    type: str = "orbit"
    index: int = 0  # of the impact that grazes
    theta: float = 0.0
    parameters: tuple[str, ...] = ()  # those of its special point: one of a branch's, two of a curve's
    parent: int = -1
    special: int = -1

    @property
    def start(self) -> StartingOrbit:
        return StartingOrbit(self.type, self.solution, self.index, self.theta)

    @property
    def solution(self) -> Solution:
        side, t, D, ends = self.impacts.T
        rests = np.flatnonzero(np.isfinite(ends))
        sides, u = tuple(side.astype(int).tolist()), np.concatenate([t, D, ends[rests]])
        return Solution(family_of(self.system), self.sigma, self.half_periods, sides, u, 0.0, tuple(rests.tolist()))

    def orbit(self) -> PeriodicOrbit:
        return orbit_of(self.system, self.solution)

    def place(self, names: tuple[str, ...]) -> np.ndarray:
        """The values of these parameters."""
        numbers = family_of(self.system).free
        return np.array([numbers[name] for name in names], float)


def seed_of(system, start: StartingOrbit, parameters=(), special: int = -1) -> Seed:
    s = start.solution
    ends = np.full(s.K, np.nan)
    ends[list(s.rests)] = s.ends
    impacts = np.column_stack([s.sides, s.times, s.jumps, ends])
    return Seed(
        system,
        s.sigma,
        s.half_periods,
        impacts,
        start.type,
        start.index,
        start.theta,
        tuple(parameters),
        special=special,
    )


def packed(seeds: list[Seed], names: tuple[str, ...]) -> Arrays:
    """Arrays `SHAPES` of q seeds that differ from one oscillator in the p parameters `names` alone."""
    arrays = {name: np.array([getattr(seed, name) for seed in seeds], kind) for name, kind in SCALARS.items()} | {
        "type": np.array([TYPES.index(seed.type) for seed in seeds], int),
        "place": np.array([seed.place(names) for seed in seeds]).reshape(-1, len(names)),
        "own": np.array([[n in seed.parameters for n in names] for seed in seeds], bool).reshape(-1, len(names)),
        "impacts": np.array([len(seed.impacts) for seed in seeds], int),
        "impact": np.concatenate([np.empty((0, 4)), *(seed.impacts for seed in seeds)]),
    }
    return {f"beyond_{name}": values for name, values in arrays.items()}


def fit_together(arrays: Arrays) -> bool:
    """Whether arrays of these shapes are of seeds."""
    types, counts = arrays["beyond_type"], arrays["beyond_impacts"]
    known = np.all((types >= 0) & (types < len(TYPES)))
    return bool(known and np.all(counts >= 0) and counts.sum() == len(arrays["beyond_impact"]))


def unpacked(arrays: Arrays, names: tuple[str, ...], system, parent: int = -1) -> list[Seed]:
    """The seeds of `packed`. system : one of their oscillators"""
    seeds, ends = [], np.cumsum(arrays["beyond_impacts"])
    for i, end in enumerate(ends):
        there = system.replace(**dict(zip(names, arrays["beyond_place"][i].tolist(), strict=True)))
        impacts = arrays["beyond_impact"][end - arrays["beyond_impacts"][i] : end]
        own = tuple(name for name, one in zip(names, arrays["beyond_own"][i], strict=True) if one)
        scalars = {name: arrays[f"beyond_{name}"][i].item() for name in SCALARS}
        kind = TYPES[arrays["beyond_type"][i]]
        seeds.append(Seed(there, impacts=impacts, type=kind, parameters=own, parent=parent, **scalars))
    return seeds
