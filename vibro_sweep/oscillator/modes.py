"""Modes of the oscillator (eq. 5).

Everything is nondimensional (eqs. 3, 4): time t = T sqrt(K1/M1), displacement x = X K1/(P1 + P2). The formulas
broadcast over arrays, so that a sweep evaluates them once for all of its points.
"""

from typing import NamedTuple

import numpy as np


class Modes(NamedTuple):
    """Psi^T M Psi = 1 and Psi^T K Psi = diag(omega_j^2), the slower mode first; arrays broadcast over systems.

    psi : (N, N) mode shapes, one in each column
    omega_squared : (N,) squares of the natural frequencies

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> system.modes.omega_squared.round(6)
    array([0.425834, 1.174166])
    """

    psi: np.ndarray  # (..., 2, 2): rows are masses, columns are modes
    omega_squared: np.ndarray  # (..., 2)


@np.errstate(all="ignore")  # numbers beyond the range of the floats give no modes, which is seen where they are used
def modes(mu_m, mu_k) -> Modes:
    """Modes of K psi = omega_j^2 M psi (eq. 5) by one Jacobi rotation of M^-1/2 K M^-1/2.

    The smaller eigenvalue is det/(the larger), which keeps its digits where a general eigensolver loses them (mu_m =
    1e-6 costs it nine).
    """
    mu_m, mu_k = np.broadcast_arrays(np.asarray(mu_m, float), np.asarray(mu_k, float))
    coupling = 1 / np.sqrt(mu_m)
    second = (1 + mu_k) / mu_m
    # K psi = omega_j^2 M psi: M^-1/2 K M^-1/2 = ((1, -coupling), (-coupling, second))
    apart = ((mu_k - mu_m) + 1) / mu_m  # second - 1, with all its digits where the two are nearly the same
    larger = (1 + second) / 2 + np.hypot(apart / 2, coupling)
    smaller = mu_k / mu_m / larger
    angle = np.arctan2(2 * coupling, np.abs(apart)) / 2  # to the nearer axis: near pi/2 the cosine loses digits
    near, far = np.cos(angle), np.sin(angle)
    c, s = np.where(apart >= 0, (near, far), (far, near))
    psi = np.stack([np.stack([c, -s], -1), np.stack([coupling * s, coupling * c], -1)], -2)
    return Modes(psi, np.stack([smaller, larger], -1))
