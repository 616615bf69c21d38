"""The steady response (eq. 7) and where it touches the stops: Theorem 1 (eqs. 15-19), and any number of masses.

The functions of `numbers`, those of the paper's oscillator by name, take arrays too.
"""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.checks.arguments import names_its_arguments
from vibro_sweep.model.any_oscillator import AnyOscillator
from vibro_sweep.model.linear import Linear, amplitudes, gap_response, grazing_phase, static_state
from vibro_sweep.model.models.two_mass import FREE_MOTION
from vibro_sweep.model.modes import modes
from vibro_sweep.model.stops import followers

ROUNDED = 4 * np.finfo(float).eps  # of a force on a mode, relative to its parts


@np.errstate(all="ignore")
def steady_response(mu_m, mu_k, zeta, f2, omega, mu_c=None) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients (d, e) of the steady motion x_i = d_i sin(omega t + tau) + e_i cos(omega t + tau); each (..., 2).

    Eq. (7) with B_j = -2 eta_j omega f_j / D: the paper prints the opposite sign, which does not solve (5). Infinite
    where an undamped mode is in resonance; NaN where numbers leave the range of the floats. mu_c: None is mu_k.
    """
    psi, omega_squared = modes(mu_m, mu_k)
    given = mu_m, mu_k, zeta, f2, omega, mu_c
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
    other_d, other_e = _without_modes(*given)
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
    found = numbers | follow | {"tau": float(tau) if np.ndim(tau) == 0 else tau}
    return {name: value for name, value in found.items() if value is not None}


def grazing_clearance(numbers: dict) -> np.ndarray:
    """b* of Theorem 1 for a system's numbers by name: the amplitude of x1 in the steady motion, eq. (16)."""
    return np.hypot(*steady_gap(numbers))


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


ROUNDING = 1e-13  # of a static state, relative to it; of 1 - multiplier


class Grazing(NamedTuple):
    """The touch of the free motion of period T at the stops.

    b, tau : clearance and phase (radians) of the touch, (16) and (18)
    state : (2N,) state at t = 0, on the right stop
    determinant : of (15); zero where the motion is not the only one
    satisfied : it exists and is the only one, so that at `b` and `tau` there is a double grazing orbit (condition 19)
    b_right, b_left : clearances at which it touches that stop; NaN where there is no such motion

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> touch = vs.grazing(system)
    >>> touch.b_right == touch.b_left == touch.b, [round(one, 6) for one in touch.state]
    (True, [6.705717, 0.0, 3.228562, 0.247513])
    """

    b: float  # where both are equal, else NaN
    tau: float
    state: tuple[float, ...]  # (x1, v1, ..., xN, vN) at the right stop, at t = 0
    determinant: float
    satisfied: bool
    b_right: float
    b_left: float


@names_its_arguments
def grazing(system: AnyOscillator) -> Grazing:
    """Clearance and phase at which the steady motion of period T touches the stops, by (16)-(19).

    The clearance and phase of `system` itself play no part. For the paper's oscillator `determinant` is (15) without
    its factor omega_d1 omega_d2, which also vanishes at critical damping, where the orbit is as unique as elsewhere;
    for others, det(1 - Phi_T). With the erratum of (7) the paper's parameters give b* = 6.70571674097302; the paper
    prints 6.7107356.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> touch = vs.grazing(system)
    >>> round(touch.b, 12), round(touch.tau, 12), touch.satisfied
    (6.705716740973, 2.229306509033, True)
    """
    from vibro_sweep.model.oscillator import System, checked_system

    checked_system(system)
    paper = isinstance(system, System) and system.mu_c in (None, system.mu_k)
    touch = _of_the_paper(system) if paper else _of_any(system)
    q = system.linear
    offset = getattr(system, "offset", 0.0)
    rest = static_state(q)
    middle, size = (
        (float(q.normal @ rest), float(np.abs(q.normal * rest).sum())) if rest is not None else (math.nan,) * 2
    )
    if abs(middle - offset) <= ROUNDING * size:  # the same, but for the rounding of the static state
        middle = offset
    right, left = touch.b + (middle - offset), touch.b - (middle - offset)
    b = touch.b if right == left else math.nan
    return touch._replace(b=b, b_right=right, b_left=left, satisfied=touch.satisfied and bool(b > 0))


def _of_the_paper(system) -> Grazing:
    """The grazing free motion between stops on both sides at the same distance."""
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
        repeats = not square or np.abs(left_over).min() <= ROUNDING  # of a free mode both multipliers are 1
        determinant *= 0.0 if repeats else (left_over.prod() / left_over.mean()).real
    return Grazing(b, tau, state, float(determinant), bool(np.isfinite(b) and determinant != 0), b, b)


def _of_any(system: AnyOscillator) -> Grazing:
    """The same as `_of_the_paper`, from the complex response: g = g_s + Re(G e^{i(omega t + tau)})."""
    q = system.linear
    left_over = -np.expm1(rates(q) * system.period)  # 1 - multiplier
    unique = not _free(q) and bool((np.abs(left_over) > ROUNDING).all())
    determinant = float(left_over.prod().real) if unique else 0.0
    response = gap_response(q)
    if response is None:
        nowhere = (math.nan,) * 2 * len(q.normal)
        return Grazing(math.nan, 0.0, nowhere, determinant, False, math.nan, math.nan)
    tau = grazing_phase(q)
    turned = amplitudes(q) * np.exp(1j * tau)
    state = np.stack([static_state(q) + turned.real, -q.omega * turned.imag], -1).reshape(-1)
    return Grazing(abs(response), tau, tuple(state.tolist()), determinant, unique, abs(response), abs(response))


def _free(q: Linear) -> bool:
    """Whether there is a free mode: K is singular, in units in which each mass is 1."""
    size = 1 / np.sqrt(np.diag(q.M))
    return int(np.linalg.matrix_rank(q.K * np.outer(size, size), hermitian=True)) < len(size)


def rates(q: Linear) -> np.ndarray:
    """The 2N roots lambda of det(lambda^2 M + lambda C + K) = 0."""
    n = len(q.normal)
    inverse = np.linalg.inv(q.M)
    return np.linalg.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ q.K, -inverse @ q.C]]))
