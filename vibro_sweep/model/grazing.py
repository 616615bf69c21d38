"""The steady response (eq. 7) and Theorem 1: where it touches the stops (eqs. 15-19)."""

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vibro_sweep.model.modes import modes
from vibro_sweep.model.parameters import FREE_MOTION

if TYPE_CHECKING:
    from vibro_sweep.model.oscillator import System


@np.errstate(all="ignore")
def steady_response(mu_m, mu_k, zeta, f2, omega) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients (d, e) of the steady motion x_i = d_i sin(omega t + tau) + e_i cos(omega t + tau); each (..., 2).

    Eq. (7) with B_j = -2 eta_j omega f_j / D: the paper prints the opposite sign, which does not solve (5). Infinite
    where an undamped mode is in resonance; NaN where numbers leave the range of the floats.
    """
    psi, omega_squared = modes(mu_m, mu_k)
    zeta, f2, omega = (np.asarray(value, float)[..., None] for value in (zeta, f2, omega))
    force = psi[..., 0, :] * (1 - f2) + psi[..., 1, :] * f2
    detuning = (np.sqrt(omega_squared) - omega) * (np.sqrt(omega_squared) + omega)
    damping = 2 * zeta * omega_squared * omega
    size = force / (detuning**2 + damping**2)
    a, b = size * detuning, -size * damping  # (7): A_j and B_j
    return np.einsum("...ij,...j->...i", psi, a), np.einsum("...ij,...j->...i", psi, b)


def grazing_phase(mu_m, mu_k, zeta, f2, omega) -> np.ndarray:
    """tau in radians for which the steady motion is at its right extreme at t = 0: eq. (18), as atan2(d1, d2)."""
    d, e = steady_response(mu_m, mu_k, zeta, f2, omega)
    return np.arctan2(d[..., 0], e[..., 0])  # (18)


def free_motion(numbers: dict) -> list:
    """Those of a system's numbers by name that the non-impacting motion depends on, in order."""
    return [numbers[name] for name in FREE_MOTION]


def with_phase(numbers: dict) -> dict:
    """A system's numbers by name (arrays, too), with tau in radians where it is "grazing"."""
    grazes = isinstance(numbers["tau"], str)
    return numbers | {"tau": grazing_phase(*free_motion(numbers))} if grazes else numbers


def grazing_clearance(numbers: dict) -> np.ndarray:
    """b* of Theorem 1 for a system's numbers by name: the amplitude of x1 in the steady motion, eq. (16)."""
    d, e = steady_response(*free_motion(numbers))
    return np.hypot(d[..., 0], e[..., 0])


def expansion_point(parameters: dict[str, np.ndarray], expand_at: float | None = None) -> np.ndarray:
    """X* at the right stop, (..., 4), for arrays of parameters.

    The exact grazing point, at b* of Theorem 1; or with its x1 replaced by a clearance `expand_at`, as in the paper,
    which expands at 6.7107356 where b* is 6.7057167.
    """
    d, e = steady_response(*free_motion(parameters))
    size = np.hypot(d[..., 0], e[..., 0])
    sin, cos = d[..., 0] / size, e[..., 0] / size
    omega = parameters["omega"]
    x2, v2 = d[..., 1] * sin + e[..., 1] * cos, omega * (d[..., 1] * cos - e[..., 1] * sin)
    return np.stack([size if expand_at is None else np.full_like(size, expand_at), np.zeros_like(size), x2, v2], -1)


class Grazing(NamedTuple):
    """Theorem 1. `satisfied`: a double grazing orbit exists at clearance `b` and phase `tau` (condition 19)."""

    b: float
    tau: float
    state: tuple[float, float, float, float]  # (x1, v1, x2, v2) at the right stop; at the left stop it is its negative
    determinant: float
    satisfied: bool


def grazing(system: "System") -> Grazing:
    """Clearance b* and phase tau* at which the steady motion of period T touches both stops: eqs. (16)-(19).

    The clearance and phase of `system` itself play no part. `determinant` is (15) without its factor omega_d1
    omega_d2, which also vanishes at critical damping, where the orbit is as unique as elsewhere. With the erratum of
    (7) the paper's parameters give b* = 6.70571674097302; the paper prints 6.7107356.
    """
    from vibro_sweep.model.oscillator import checked_system

    checked_system(system)
    (d1, d2), (e1, e2) = steady_response(*free_motion(vars(system)))
    # (18), (19)
    b = float(grazing_clearance(vars(system)))
    tau = math.atan2(d1, e1)
    sin, cos = math.sin(tau), math.cos(tau)
    omega = system.omega
    state = (b, 0.0, float(d2 * sin + e2 * cos), float(omega * (d2 * cos - e2 * sin)))
    psi, omega_squared = system.modes
    determinant = np.linalg.det(psi)  # (15)
    for square, eta in zip(omega_squared, system.eta, strict=True):
        root = np.sqrt(complex(eta**2 - square))
        # 1 - multiplier over T, for both multipliers of the mode; the paper's 1 - e_j c_j is their mean
        left_over = -np.expm1(np.array([-eta + root, -eta - root]) * system.period)
        determinant *= (left_over.prod() / left_over.mean()).real
    exists = bool(np.isfinite(b) and b > 0 and determinant != 0)
    return Grazing(b, tau, state, float(determinant), exists)
