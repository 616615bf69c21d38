"""How far from its steady motion an oscillator may be and still reach no stop (engine/motion/coast.py)."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.model.contact import Contact, rest_force
from vibro_sweep.model.linear import Linear, amplitudes

SINGULAR = 1e-12  # of the largest eigenvalue of K: a smaller one may be rounding


class Confinement(NamedTuple):
    """A confining motion in contact coordinates; states are interleaved."""

    steady: np.ndarray  # (2 N,): the steady motion at t = 0
    middle: float  # of its gap, and
    swing: float  # by how much that swings about it; infinite where there is none that confines
    form: np.ndarray  # (2 N, 2 N): d^T form d bounds the square of what a distance d can do to the gap


def confinement_of(q: Linear, contact: Contact) -> Confinement:
    n = len(q.M)
    nothing = Confinement(np.zeros(2 * n), 0.0, np.inf, np.zeros((2 * n, 2 * n)))
    stiffness = np.linalg.eigvalsh(q.K)
    if not stiffness[0] > SINGULAR * stiffness[-1]:
        return nothing
    rest = np.linalg.solve(q.K, rest_force(q, contact.origin))  # as seen from x0
    try:
        turning = amplitudes(q) * np.exp(1j * q.tau)
    except np.linalg.LinAlgError:
        return nothing
    swing = abs(q.normal @ turning)
    if not np.isfinite(swing):
        return nothing
    steady, form = np.empty(2 * n), np.zeros((2 * n, 2 * n))
    steady[0::2], steady[1::2] = contact.P @ (turning.real + rest), contact.P @ (1j * q.omega * turning).real
    compliance = q.normal @ np.linalg.solve(q.K, q.normal)
    form[0::2, 0::2] = compliance * contact.back.T @ q.K @ contact.back
    form[1::2, 1::2] = compliance * contact.back.T @ q.M @ contact.back
    return Confinement(steady, float(q.normal @ rest), float(swing), form)
