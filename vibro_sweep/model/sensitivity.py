"""How the equations of motion, the grazing phase and the grazing point change with the parameters of the oscillator.

Flight is the autonomous linear system dz/ds = A z for z = (x1, v1, x2, v2, sin(s + tau), cos(s + tau)), with the phase
s = omega t in place of time: the section then stays at s = 0 mod 2 pi when omega changes.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.model.parameters import FREE_MOTION


class Linear(NamedTuple):
    """dz/ds = A z, and the derivatives of A by the parameters `FREE_MOTION`."""

    A: np.ndarray  # (6, 6)
    A_p: np.ndarray  # (5, 6, 6)


def flight_equations(p: dict[str, float], follows: bool = True) -> Linear:
    """Eq. (3) between the stops. follows: whether mu_c changes with mu_k."""
    m, above, drag, f2, omega = p["mu_m"], 1 + p["mu_k"], 2 * p["zeta"], p["f2"], p["omega"]
    below = 1 + p["mu_c"]
    A, A_p = np.zeros((6, 6)), np.zeros((5, 6, 6))
    A[0, 1] = A[2, 3] = 1
    A[1] = [-1, -drag, 1, drag, 1 - f2, 0]
    A[3] = np.array([1, drag, -above, -drag * below, f2, 0]) / m
    A_p[0, 3] = -A[3] / m
    A_p[1, 3] = np.array([0, 0, -1, -drag if follows else 0, 0, 0]) / m
    A_p[2, 1] = [0, -2, 0, 2, 0, 0]
    A_p[2, 3] = np.array([0, 2, 0, -2 * below, 0, 0]) / m
    A_p[3, 1, 4], A_p[3, 3, 4] = -1, 1 / m
    A, A_p = A / omega, A_p / omega
    A_p[4] = -A / omega
    A[4, 5], A[5, 4] = 1, -1
    return Linear(A, A_p)


def rest_equations(p: dict[str, float], follows: bool = True) -> Linear:
    """Eq. (3) while a stop holds M1."""
    A, A_p = (array.copy() for array in flight_equations(p, follows))
    A[:2], A_p[:, :2] = 0, 0
    return Linear(A, A_p)


def grazing_derivatives(p: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives by the parameters `FREE_MOTION`: (5,) of tau*, eq. (18), and (4, 5) of the grazing point X*.

    The steady motion is Im(x e^{i (omega t + tau)}) with x = (K - omega^2 M + 2 i omega zeta K)^-1 P, and tau* =
    pi/2 - arg x_1.
    """
    m, k, zeta, f2, omega = (p[name] for name in FREE_MOTION)
    M, K = np.diag([1.0, m]), np.array([[1, -1], [-1, 1 + k]])
    second = np.diag([0.0, 1.0])
    Z = K - omega**2 * M + 2j * omega * zeta * K
    dZ = [
        -(omega**2) * second,
        (1 + 2j * omega * zeta) * second,
        2j * omega * K,
        0 * second,
        -2 * omega * M + 2j * zeta * K,
    ]
    x = np.linalg.solve(Z, [1 - f2, f2])
    pushes = np.array([-matrix @ x for matrix in dZ]).T
    pushes[:, 3] += [-1, 1]
    dx = np.linalg.solve(Z, pushes)
    dtau = -(dx[0] / x[0]).imag
    turn = np.exp(1j * (np.pi / 2 - np.angle(x[0])))
    y, dy = x * turn, (dx + 1j * np.outer(x, dtau)) * turn
    dX = np.stack([dy[0].imag, np.zeros(5), dy[1].imag, omega * dy[1].real])
    dX[3, 4] += y[1].real
    return dtau, dX
