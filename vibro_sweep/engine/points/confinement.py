"""How far from its steady motion an oscillator may be and still reach no stop (engine/motion/coast.py)."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.points.contact import ContactCoordinates, rest_force
from vibro_sweep.oscillator.linear import Linear
from vibro_sweep.oscillator.stacks import dot, modulus, only, solved, times, transposed
from vibro_sweep.oscillator.steady import steady_amplitudes

SINGULAR = 1e-12  # of the largest eigenvalue of K: a smaller one may be rounding


class Confinement(NamedTuple):
    """Confining motions in contact coordinates; states are interleaved. Zero and infinite where there is none."""

    steady: np.ndarray  # (..., 2 N): the steady motion at t = 0
    middle: np.ndarray  # (...): of its gap, and
    swing: np.ndarray  # (...): by how much that swings about it; infinite where there is none that confines
    form: np.ndarray  # (..., 2 N, 2 N): d^T form d bounds the square of what a distance d can do to the gap


def confinement_of(q: Linear, contact: ContactCoordinates) -> Confinement:
    """Of each oscillator of a stack."""
    n = q.masses
    stiffness = np.linalg.eigvalsh(q.K)
    turning = steady_amplitudes(q) * np.exp(1j * np.asarray(q.tau))[..., None]
    swing = modulus(dot(q.contact.normal + 0j, turning))
    there = (stiffness[..., 0] > SINGULAR * stiffness[..., -1]) & np.isfinite(swing)
    K = only(there, q.K)
    rest = solved(K, rest_force(q, contact.origin))  # as seen from x0
    steady, form = np.empty((*there.shape, 2 * n)), np.zeros((*there.shape, 2 * n, 2 * n))
    steady[..., 0::2] = times(contact.P, turning.real + rest)
    steady[..., 1::2] = times(contact.P + 0j, 1j * np.asarray(q.omega)[..., None] * turning).real
    compliance = dot(q.contact.normal, solved(K, q.contact.normal))[..., None, None]
    form[..., 0::2, 0::2] = compliance * transposed(contact.back) @ q.K @ contact.back
    form[..., 1::2, 1::2] = compliance * transposed(contact.back) @ q.M @ contact.back
    one, many = there[..., None], there[..., None, None]
    return Confinement(
        np.where(one, steady, 0.0), np.where(there, dot(q.contact.normal, rest), 0.0), np.where(there, swing, np.inf),
        np.where(many, form, 0.0),
    )  # fmt: skip
