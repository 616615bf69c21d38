"""The oscillator: its parameters, its modes, its steady response and Theorem 1.

Everything is nondimensional (eqs. 3, 4): time t = T sqrt(K1/M1), displacement x = X K1/(P1 + P2). The formulas
broadcast over arrays, so that a sweep evaluates them once for all of its points.
"""

import math
from dataclasses import dataclass, fields
from dataclasses import replace as dataclass_replace
from typing import NamedTuple

import numpy as np

NAMES = ("mu_m", "mu_k", "zeta", "f2", "omega", "R", "b", "tau")
STOPS = ("both", "right", "left")

_POSITIVE = (lambda value: value > 0, "a number > 0")
_FRACTION = (lambda value: (value >= 0) & (value <= 1), "a number from 0 to 1")
_ALLOWED = {
    "mu_m": _POSITIVE,
    "mu_k": _POSITIVE,
    "zeta": (lambda value: value >= 0, "a number >= 0"),
    "f2": _FRACTION,
    "omega": _POSITIVE,
    "R": _FRACTION,
    "b": _POSITIVE,
    "tau": (lambda value: value == value, "a number (radians) or 'grazing'"),
}


class ParameterError(ValueError):
    """A parameter outside its range; carries `key`, `value` and `allowed`."""

    def __init__(self, key: str, value: object, allowed: str):
        super().__init__(f"{key}: {value!r} is not allowed; it must be {allowed}")
        self.key, self.value, self.allowed = key, value, allowed


def check_value(key: str, value: object) -> None:
    """Raise `ParameterError` unless `value` (a number or an array of numbers) is allowed for the parameter `key`."""
    holds, allowed = _ALLOWED[key]
    numbers = np.asarray(value)
    if numbers.dtype.kind not in "fiu":
        raise ParameterError(key, value, allowed)
    good = np.isfinite(numbers) & holds(numbers)
    if not np.all(good):
        raise ParameterError(key, numbers[~good].flat[0].item(), f"finite, {allowed}")


class Modes(NamedTuple):
    """Psi^T M Psi = 1 and Psi^T K Psi = diag(omega_j^2), the slower mode first; arrays broadcast over systems."""

    psi: np.ndarray  # (..., 2, 2): rows are masses, columns are modes
    omega_squared: np.ndarray  # (..., 2)


def modes(mu_m, mu_k) -> Modes:
    """Modes of K psi = omega_j^2 M psi (eq. 5) by one Jacobi rotation of M^-1/2 K M^-1/2.

    The smaller eigenvalue is det/(the larger), which keeps its digits where a general eigensolver loses them (mu_m =
    1e-6 costs it nine).
    """
    mu_m, mu_k = np.broadcast_arrays(np.asarray(mu_m, float), np.asarray(mu_k, float))
    coupling = 1 / np.sqrt(mu_m)
    second = (1 + mu_k) / mu_m
    larger = (1 + second) / 2 + np.hypot((second - 1) / 2, coupling)
    smaller = mu_k / mu_m / larger
    angle = np.arctan2(2 * coupling, np.abs(second - 1)) / 2  # to the nearer axis: near pi/2 the cosine loses digits
    near, far = np.cos(angle), np.sin(angle)
    c, s = np.where(second >= 1, (near, far), (far, near))
    psi = np.stack([np.stack([c, -s], -1), np.stack([coupling * s, coupling * c], -1)], -2)
    return Modes(psi, np.stack([smaller, larger], -1))


def steady_response(mu_m, mu_k, zeta, f2, omega) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients (d, e) of the steady motion x_i = d_i sin(omega t + tau) + e_i cos(omega t + tau); each (..., 2).

    Eq. (7) with B_j = -2 eta_j omega f_j / D: the paper prints the opposite sign, which does not solve (5). Infinite
    where an undamped mode is in resonance.
    """
    psi, omega_squared = modes(mu_m, mu_k)
    zeta, f2, omega = (np.asarray(value, float)[..., None] for value in (zeta, f2, omega))
    force = psi[..., 0, :] * (1 - f2) + psi[..., 1, :] * f2
    detuning = (np.sqrt(omega_squared) - omega) * (np.sqrt(omega_squared) + omega)
    damping = 2 * zeta * omega_squared * omega
    with np.errstate(divide="ignore", invalid="ignore"):
        size = force / (detuning**2 + damping**2)
        a, b = size * detuning, -size * damping
    return np.einsum("...ij,...j->...i", psi, a), np.einsum("...ij,...j->...i", psi, b)


def grazing_phase(mu_m, mu_k, zeta, f2, omega) -> np.ndarray:
    """tau in radians for which the steady motion is at its right extreme at t = 0: eq. (18), as atan2(d1, d2)."""
    d, e = steady_response(mu_m, mu_k, zeta, f2, omega)
    return np.arctan2(d[..., 0], e[..., 0])


@dataclass(frozen=True)
class System:
    """The impact oscillator (3), (4).

    Parameters
    ----------
    mu_m, mu_k : mass ratio M2/M1 and stiffness ratio K2/K1, > 0
    zeta : damping ratio C1/(2 sqrt(K1 M1)), >= 0; proportional damping, so C2/C1 = mu_k
    f2 : share of the force on the second mass, P2/(P1 + P2), 0 .. 1
    omega : forcing frequency, > 0
    R : coefficient of restitution, 0 .. 1
    b : clearance on each side, > 0
    tau : phase of the force at t = 0 in radians, or "grazing": the phase at which the non-impacting steady motion
        is at its right extreme (eq. 18)
    stops : "both", "right" or "left"

    Raises
    ------
    ParameterError : a parameter is outside its range
    """

    mu_m: float
    mu_k: float
    zeta: float
    f2: float
    omega: float
    R: float
    b: float
    tau: float | str = "grazing"
    stops: str = "both"

    def __post_init__(self):
        for name in NAMES:
            value = getattr(self, name)
            if name == "tau" and value == "grazing":
                if not math.isfinite(self.phase):
                    raise ParameterError(
                        "tau", value, "a number: an undamped mode is in resonance, no steady motion exists"
                    )
                continue
            if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating)):
                raise ParameterError(name, value, _ALLOWED[name][1])
            check_value(name, value)
            object.__setattr__(self, name, float(value))
        if self.stops not in STOPS:
            raise ParameterError("stops", self.stops, "both, right or left")

    @classmethod
    def physical(
        cls, *, M1, M2, K1, K2, C1, C2, P1, P2, Omega, R, B, tau: float | str = "grazing", stops="both"
    ) -> "System":
        """From physical quantities in any consistent units (section 2 of the paper; mu_c = C2/C1 there).

        Raises `ParameterError` also where C1/K1 differs from C2/K2: the damping must be proportional.
        """
        given = {"M1": M1, "M2": M2, "K1": K1, "K2": K2, "C1": C1, "C2": C2, "P1": P1, "P2": P2, "Omega": Omega, "B": B}
        for name, value in given.items():
            may_vanish = name in ("C1", "C2", "P1", "P2")
            allowed = "a finite number >= 0" if may_vanish else "a finite number > 0"
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
                raise ParameterError(name, value, allowed)
            if value < 0 or (value == 0 and not may_vanish):
                raise ParameterError(name, value, allowed)
        if P1 + P2 == 0:
            raise ParameterError("P1", P1, "such that P1 + P2 > 0: lengths are measured in (P1 + P2)/K1")
        if not math.isclose(C1 * K2, C2 * K1, rel_tol=1e-9):
            raise ParameterError(
                "C2",
                C2,
                f"{C1 * K2 / K1!r}: C1/K1 = {C1 / K1!r} and C2/K2 = {C2 / K2!r} differ, damping must be proportional",
            )
        return cls(
            mu_m=M2 / M1,
            mu_k=K2 / K1,
            zeta=C1 / (2 * math.sqrt(K1 * M1)),
            f2=P2 / (P1 + P2),
            omega=Omega * math.sqrt(M1 / K1),
            R=R,
            b=B * K1 / (P1 + P2),
            tau=tau,
            stops=stops,
        )

    def replace(self, **changes) -> "System":
        """A copy with other parameters."""
        return dataclass_replace(self, **changes)

    @property
    def phase(self) -> float:
        """tau in radians, `grazing` resolved."""
        if self.tau != "grazing":
            return self.tau
        return float(grazing_phase(self.mu_m, self.mu_k, self.zeta, self.f2, self.omega))

    @property
    def period(self) -> float:
        """The forcing period T = 2 pi/omega."""
        return 2 * math.pi / self.omega

    @property
    def modes(self) -> Modes:
        return modes(self.mu_m, self.mu_k)

    @property
    def eta(self) -> np.ndarray:
        """Modal damping eta_j = zeta omega_j^2, (2,). Non-impacting exponents: -eta_1, -eta_1, -eta_2, -eta_2."""
        return self.zeta * self.modes.omega_squared

    @property
    def divergence(self) -> float:
        """-tr(M^-1 C): the sum of the Lyapunov exponents of a non-impacting orbit."""
        return -2 * self.zeta * (1 + (1 + self.mu_k) / self.mu_m)

    def parameters(self) -> dict[str, float]:
        """The numbers by name, `tau` resolved."""
        values = {field.name: getattr(self, field.name) for field in fields(self) if field.name in NAMES}
        return values | {"tau": self.phase}


class Grazing(NamedTuple):
    """Theorem 1. `satisfied`: a double grazing orbit exists at clearance `b` and phase `tau` (condition 19)."""

    b: float
    tau: float
    state: tuple[float, float, float, float]  # (x1, v1, x2, v2) at the right stop; at the left stop it is its negative
    determinant: float
    satisfied: bool


def grazing(system: System) -> Grazing:
    """Clearance b* and phase tau* at which the steady motion of period T touches both stops: eqs. (16)-(19).

    The clearance and phase of `system` itself play no part. `determinant` is (15) without its factor omega_d1
    omega_d2, which also vanishes at critical damping, where the orbit is as unique as elsewhere. With the erratum of
    (7) the paper's parameters give b* = 6.70571674097302; the paper prints 6.7107356.
    """
    (d1, d2), (e1, e2) = steady_response(system.mu_m, system.mu_k, system.zeta, system.f2, system.omega)
    b = math.hypot(d1, e1)
    tau = math.atan2(d1, e1)
    sin, cos = math.sin(tau), math.cos(tau)
    omega = system.omega
    state = (b, 0.0, float(d2 * sin + e2 * cos), float(omega * (d2 * cos - e2 * sin)))
    psi, omega_squared = system.modes
    determinant = np.linalg.det(psi)
    for square, eta in zip(omega_squared, system.eta, strict=True):
        root = np.sqrt(complex(eta**2 - square))
        # 1 - multiplier over T, for both multipliers of the mode; the paper's 1 - e_j c_j is their mean
        left_over = -np.expm1(np.array([-eta + root, -eta - root]) * system.period)
        determinant *= (left_over.prod() / left_over.mean()).real
    exists = bool(np.isfinite(b) and b > 0 and determinant != 0)
    return Grazing(b, tau, state, float(determinant), exists)
