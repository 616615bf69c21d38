"""The gap's steady motion, mean + Re(swing e^{i (omega t + tau)}), and what a constant force does to a free mode."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.flow import contact_coordinates
from vibro_sweep.engine.impulses.free_modes import ResonanceError, free_modes, has_free_gap
from vibro_sweep.oscillator.linear import Linear, amplitudes


class SteadyGap(NamedTuple):
    mean: float  # 0 where the contact sees a free mode: it is then what impacts make it
    swing: complex


def steady_gap(q: Linear) -> SteadyGap:
    """Raises ResonanceError where an undamped mode is driven at its own frequency."""
    try:
        swing = complex(q.contact.normal @ amplitudes(q))
    except np.linalg.LinAlgError:
        swing = np.inf
    if not np.isfinite(swing):
        raise ResonanceError("the force drives an undamped mode at its own frequency")
    return SteadyGap(0.0 if has_free_gap(q) else float(q.contact.normal @ _static(q, q.constant)), swing)


def _static(q: Linear, force: np.ndarray) -> np.ndarray:
    """Displacement under a constant force, without free modes."""
    return np.linalg.lstsq(q.K, force)[0] if np.any(force) else np.zeros(len(force))


def push_of_free_mode(q: Linear) -> float:
    """Acceleration of the gap by a constant force in the free mode that the contact sees; 0 without one.

    Raises ResonanceError where it acts on another free mode, which nothing holds.
    """
    shapes, seen = free_modes(q)
    free = int(has_free_gap(q))
    if np.any(np.abs(q.constant @ shapes[:, free:]) > 1e-13 * np.abs(q.constant).max(initial=0)):
        raise ResonanceError("a constant force acts on a free mode that the contact does not hold")
    mobility = contact_coordinates(q).by_force[0] @ q.contact.normal
    return float(shapes[:, 0] @ q.constant * mobility / seen[0]) if free else 0.0
