"""Where a solution set begins: an orbit, and the condition that it satisfies."""

from dataclasses import dataclass

import numpy as np

from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.problem import FLIP, FOLD, GRAZE, ORBIT, STICK, TORUS
from vibro_sweep.oscillator.family import Family
from vibro_sweep.tables.bifurcations import TYPES

CONDITIONS = {"": ORBIT, "fold": FOLD, "flip": FLIP, "torus": TORUS, "graze": GRAZE, "stick": STICK}
KINDS = {one.name: CONDITIONS[one.condition] for one in TYPES if one.condition}


@dataclass(frozen=True)
class StartingOrbit:
    """An orbit, perhaps at a bifurcation; index: of the impact that grazes; state: of an onset of sticking."""

    type: str
    solution: Solution
    index: int = 0
    theta: float = 0.0
    state: np.ndarray | None = None

    @property
    def kind(self) -> int:
        return KINDS.get(self.type, ORBIT)


def keeps_symmetry(family: Family, name: str) -> bool:
    """Whether orbits with x(t + P) = -x(t) remain so along this parameter."""
    slope = family.derivative(name)
    one = slope.contact
    low, high = ((side * one.stop(side), one.restitution(side), *one.law(side)) for side in (-1, 1))
    return low == high and not np.any(slope.constant)
