"""The motion of all masses while free and while the gap is held, with its derivatives by a parameter.

zeta = (x, x', cos(omega t + tau), sin(omega t + tau), 1).
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.green import space, space_slopes
from vibro_sweep.model.linear import Linear


class Motion(NamedTuple):
    """zeta' = B zeta while free, zeta' = H zeta while the gap is held; and the vectors of the contact."""

    B: np.ndarray  # (m, m)
    H: np.ndarray  # (m, m)
    e_g: np.ndarray  # (m,): the gap
    e_s: np.ndarray  # (m,): its velocity
    pull: np.ndarray  # (m,): its free acceleration
    push: np.ndarray  # (m,): what a unit impulse adds
    shift: np.ndarray  # (m,): the same of the positions


def motion_of(q: Linear) -> Motion:
    N, s, inverse = len(q.along), space(q), np.linalg.inv(q.M)
    forces = inverse @ np.column_stack([q.cosine, q.sine, q.constant])
    n, m = 2 * N, 2 * N + 3
    B = np.zeros((m, m))
    B[:n, :n], B[N:n, n:] = s.A, forces
    B[n, n + 1], B[n + 1, n] = -q.omega, q.omega
    return _with_contact(B, *_contact(s.e_g, s.e_v, N))


def motion_slopes(q: Linear, slope: Linear) -> Motion:
    """Derivatives of `motion_of`."""
    N, now, ds, inverse = len(q.along), motion_of(q), space_slopes(q, slope), np.linalg.inv(q.M)
    forces = np.column_stack([q.cosine, q.sine, q.constant])
    d_forces = np.column_stack([slope.cosine, slope.sine, slope.constant])
    n, m = 2 * N, 2 * N + 3
    B = np.zeros((m, m))
    B[:n, :n], B[N:n, n:] = ds.A, inverse @ (d_forces - slope.M @ inverse @ forces)
    B[n, n + 1], B[n + 1, n] = -slope.omega, slope.omega
    e_g, e_s, push, shift = _contact(ds.e_g, ds.e_v, N)
    pull = e_s @ now.B + now.e_s @ B
    H = B - np.outer(push, now.pull) - np.outer(now.push, pull)
    return Motion(B, H, e_g, e_s, pull, push, shift)


def _contact(e_g, e_v, N: int):
    wide = np.zeros((4, 2 * N + 3))
    wide[0, : 2 * N], wide[1, N : 2 * N], wide[2, : 2 * N], wide[3, :N] = e_g, e_g[:N], e_v, e_v[N:]
    return wide


def _with_contact(B, e_g, e_s, push, shift) -> Motion:
    pull = e_s @ B
    return Motion(B, B - np.outer(push, pull), e_g, e_s, pull, push, shift)
