"""The gap of an oscillator as a sum of exponentials: what the exclusion test of a stiff one needs.

Flights obey z' = A z with z = (y1, v1, ..., yN, vN, sin, cos, 1) in contact coordinates. With the eigenvectors V of A
the gap of the flight from z(0) is the sum over its roots l_k of V_1k (V^-1 z(0))_k e^{l_k t}.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.points.contact import ContactCoordinates, flight_matrix


class Exponentials(NamedTuple):
    """Roots with their parts in the gap; all parts zero where A has too few eigenvectors."""

    roots: np.ndarray  # (2 N + 3,) complex
    parts: np.ndarray  # (2 N + 1, 2 N + 3) complex: of unit states, and of the motion that begins with `begin`
    begin: np.ndarray  # (2 N,): the state at t = 0 from which the force excites no fast root
    valid: bool  # False: A has too few eigenvectors


def gap_exponentials(contact: ContactCoordinates, omega: float, tau: float, fast: float) -> Exponentials:
    """fast: modulus from which on a root is fast."""
    n = len(contact.stiffness)
    states = 2 * n
    A = np.zeros((states + 3, states + 3))
    A[:states, :states] = flight_matrix(contact.stiffness, contact.damping)
    A[1:states:2, states:] = contact.force
    A[states, states + 1], A[states + 1, states] = omega, -omega
    nothing = Exponentials(
        np.zeros(states + 3, complex), np.zeros((states + 1, states + 3), complex), np.zeros(states), False
    )
    roots, V = np.linalg.eig(A)
    force = np.array([*np.zeros(states), np.sin(tau), np.cos(tau), 1.0])
    try:
        W = np.linalg.inv(V)
    except np.linalg.LinAlgError:
        return nothing
    excited = np.where(np.abs(roots) > fast, W @ force, 0)
    begin = -(V[:states] @ excited).real
    parts = V[0] * np.concatenate([W[:, :states].T, (W @ (force + np.append(begin, np.zeros(3))))[None]])
    if not np.isfinite(parts).all():
        return nothing
    return Exponentials(roots, parts, begin, True)
