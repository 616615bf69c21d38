"""The continuous motion of an orbit as arrays: the gap and its velocity, impacts, stops and their forces."""

from dataclasses import dataclass, field

import numpy as np

from vibro_sweep.oscillator.linear import Linear
from vibro_sweep.oscillator.stop_force import force_of


@dataclass(frozen=True)
class Motion:
    """The motion of an orbit of the oscillator q, sampled.

    t, gap, rate : (m,); at the time of an impact the velocity before it
    impacts : rows (t, side, velocity before, after), (k, 4)
    positions : x1, x2, ... -> (m,), where they are asked for
    """

    q: Linear
    t: np.ndarray
    gap: np.ndarray
    rate: np.ndarray
    impacts: np.ndarray = field(default_factory=lambda: np.zeros((0, 4)))
    positions: dict[str, np.ndarray] = field(default_factory=dict)

    @property
    def stops(self) -> dict[int, float]:
        """Side (+1 right, -1 left) -> where the stop stands, of those that there are."""
        return {side: stop for side, stop in ((1, self.q.high), (-1, self.q.low)) if np.isfinite(stop)}

    @property
    def soft(self) -> dict[int, float]:
        """The same of compliant stops."""
        return {side: stop for side, stop in self.stops.items() if self.q.is_compliant(side)}

    def force(self, side: int) -> tuple[np.ndarray, np.ndarray]:
        """The force of the stop on this side, and by how much it is pressed in, (m,); of a rigid one 0."""
        q = self.q
        law = (q.k_high, q.c_high, q.p_high) if side > 0 else (q.k_low, q.c_low, q.p_low)
        delta, speed = side * (self.gap - self.stops[side]), side * self.rate
        return force_of(self.t, delta, speed, law if side in self.soft else None, q.by_force)

    @property
    def pressed(self) -> np.ndarray:
        """Whether a compliant stop is pressed, bool (m,)."""
        return np.any([np.zeros(len(self.t), bool), *(self.force(side)[0] != 0 for side in self.soft)], axis=0)
