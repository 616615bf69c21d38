"""Where the free motion touches the stops: Theorem 1 (eqs. 15-19), and any number of masses."""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.checks.arguments import names_its_arguments
from vibro_sweep.oscillator.linear import Linear, amplitudes, gap_response, grazing_phase, roots, static_state
from vibro_sweep.oscillator.oscillator import Oscillator, System, checked_system, in_closed_form
from vibro_sweep.oscillator.paper_motion import free_motion, grazing_clearance, steady_response

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
def grazing(system: Oscillator) -> Grazing:
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
    checked_system(system)
    paper = in_closed_form(system) and system.mu_c in (None, system.mu_k)
    touch = _of_the_paper(system) if paper else _of_any(system)
    q = system.linear
    offset = getattr(system, "offset", 0.0)
    rest, normal = static_state(q), q.contact.normal
    middle, size = math.nan, math.nan
    if rest is not None:
        middle, size = float(normal @ rest), float(np.abs(normal * rest).sum())
    if abs(middle - offset) <= ROUNDING * size:  # the same, but for the rounding of the static state
        middle = offset
    right, left = touch.b + (middle - offset), touch.b - (middle - offset)
    b = touch.b if right == left else math.nan
    return touch._replace(b=b, b_right=right, b_left=left, satisfied=touch.satisfied and bool(b > 0))


def _of_the_paper(system: System) -> Grazing:
    """The grazing free motion between stops on both sides at the same distance."""
    (d1, d2), (e1, e2) = steady_response(*free_motion(system.numbers))
    # (18), (19)
    b = float(grazing_clearance(system.numbers))
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


def _of_any(system: Oscillator) -> Grazing:
    """The same as `_of_the_paper`, from the complex response: g = g_s + Re(G e^{i(omega t + tau)})."""
    q = system.linear
    left_over = -np.expm1(roots(q) * system.period)  # 1 - multiplier
    unique = not _free(q) and bool((np.abs(left_over) > ROUNDING).all())
    determinant = float(left_over.prod().real) if unique else 0.0
    response = gap_response(q)
    if response is None:
        nowhere = (math.nan,) * 2 * q.masses
        return Grazing(math.nan, 0.0, nowhere, determinant, False, math.nan, math.nan)
    tau = grazing_phase(q)
    turned = amplitudes(q) * np.exp(1j * tau)
    state = np.stack([static_state(q) + turned.real, -q.omega * turned.imag], -1).reshape(-1)
    return Grazing(abs(response), tau, tuple(state.tolist()), determinant, unique, abs(response), abs(response))


def _free(q: Linear) -> bool:
    """Whether there is a free mode: K is singular, in units in which each mass is 1."""
    size = 1 / np.sqrt(np.diag(q.M))
    return int(np.linalg.matrix_rank(q.K * np.outer(size, size), hermitian=True)) < len(size)
