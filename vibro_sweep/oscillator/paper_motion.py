"""The free motion of the paper's oscillator in closed form, eqs. (7), (16) to (18); its numbers may be arrays."""

import numpy as np

from vibro_sweep.oscillator.models.declaration import CONTACT
from vibro_sweep.oscillator.models.two_mass import FREE_MOTION, NAMES
from vibro_sweep.oscillator.modes import modes
from vibro_sweep.oscillator.stops import followers

KNOWN = {*NAMES, "mu_c", *(parameter.name for parameter in CONTACT)}  # numbers that these formulas know
ROUNDED = 4 * np.finfo(float).eps  # of a force on a mode, relative to its parts


@np.errstate(all="ignore")
def steady_response(mu_m, mu_k, zeta, f2, omega, mu_c=None) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients (d, e) of the steady motion x_i = d_i sin(omega t + tau) + e_i cos(omega t + tau); each (..., 2).

    Eq. (7) with B_j = -2 eta_j omega f_j / D: the paper prints the opposite sign, which does not solve (5). Infinite
    where an undamped mode is in resonance; NaN where numbers leave the range of the floats. mu_c: None is mu_k.
    """
    psi, omega_squared = modes(mu_m, mu_k)
    free_numbers = mu_m, mu_k, zeta, f2, omega, mu_c
    zeta, f2, omega = (np.asarray(value, float)[..., None] for value in (zeta, f2, omega))
    parts = psi[..., 0, :] * (1 - f2), psi[..., 1, :] * f2
    force = parts[0] + parts[1]
    undriven = np.abs(force) <= ROUNDED * (np.abs(parts[0]) + np.abs(parts[1]))  # also where that mode is in resonance
    detuning = (np.sqrt(omega_squared) - omega) * (np.sqrt(omega_squared) + omega)
    damping = 2 * zeta * omega_squared * omega
    size = np.where(undriven, 0.0, force / (detuning**2 + damping**2))
    a, b = size * detuning, -size * damping  # (7): A_j and B_j
    d, e = np.einsum("...ij,...j->...i", psi, a), np.einsum("...ij,...j->...i", psi, b)
    if mu_c is None:
        return d, e
    proportional = (np.asarray(mu_c) == np.asarray(mu_k))[..., None]
    other_d, other_e = _without_modes(*free_numbers)
    return np.where(proportional, d, other_d), np.where(proportional, e, other_e)


def _without_modes(mu_m, mu_k, zeta, f2, omega, mu_c) -> tuple[np.ndarray, np.ndarray]:
    """The same as `steady_response`, by Cramer's rule: x = Im(X e^{i(omega t + tau)}), (K - omega^2 M + i omega C) X =
    P."""
    mu_m, mu_k, zeta, f2, omega, mu_c = (np.asarray(value, float) for value in (mu_m, mu_k, zeta, f2, omega, mu_c))
    between = 1 + 2j * zeta * omega
    upper, lower = between - omega**2, between + mu_k + 2j * zeta * mu_c * omega - omega**2 * mu_m
    determinant = upper * lower - between**2
    x1, x2 = (lower * (1 - f2) + between * f2) / determinant, (upper * f2 + between * (1 - f2)) / determinant
    response = np.stack(np.broadcast_arrays(x1, x2), -1)
    return response.real, response.imag


def steady_gap(numbers: dict) -> tuple[np.ndarray, np.ndarray]:
    """d_1 and e_1 of eqs. (16), (17) for a system's numbers by name."""
    d, e = steady_response(*free_motion(numbers), numbers.get("mu_c"))
    return d[..., 0], e[..., 0]


def free_motion(numbers: dict) -> list:
    """The numbers of a system, by name, on which the non-impacting motion depends, in order."""
    return [numbers[name] for name in FREE_MOTION]


def with_phase(numbers: dict) -> dict:
    """A system's numbers by name (arrays, too), with tau in radians where it is "grazing".

    The phase for which the steady motion is at its right extreme at t = 0: eq. (18), as atan2(d1, d2); 0 where no
    steady motion exists, since an undamped mode is in resonance.
    """
    if not isinstance(numbers["tau"], str):
        return numbers
    d, e = steady_gap(numbers)
    return numbers | {"tau": np.where(np.isfinite(d) & np.isfinite(e), np.arctan2(d, e), 0.0)}  # (18)


def resolved(numbers: dict) -> dict:
    """A system's numbers by name, with tau in radians, and those that follow others in numbers."""
    numbers = with_phase(numbers)
    follow = followers(numbers) | ({"mu_c": numbers["mu_k"]} if numbers["mu_c"] is None else {})
    tau = numbers["tau"]
    everything = numbers | follow | {"tau": float(tau) if np.ndim(tau) == 0 else tau}
    return {name: value for name, value in everything.items() if value is not None}


def grazing_clearance(numbers: dict) -> np.ndarray:
    """b* of Theorem 1 for a system's numbers by name: the amplitude of x1 in the steady motion, eq. (16)."""
    return np.hypot(*steady_gap(numbers))
