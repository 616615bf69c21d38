"""A linear oscillator with one contact, as the equations of periodic orbits need it: any number of masses N.

    M x'' + C x' + K x = constant + sine sin(omega t + tau) + cosine cos(omega t + tau),   low <= n.x <= high

An impulse acts along M^-1 n: it changes the velocity of the gap g = n.x, with the restitution of the stop that is hit.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from vibro_sweep.model.oscillator import System

STEP = 1e-100  # of the complex step: its square underflows, so that a derivative has no truncation error


class Linear(NamedTuple):
    """The oscillator's numbers; and, with the same fields, their derivatives by one parameter."""

    M: np.ndarray  # (N, N)
    K: np.ndarray  # (N, N)
    C: np.ndarray  # (N, N)
    along: np.ndarray  # (N,): n of the gap n.x
    constant: np.ndarray  # (N,)
    sine: np.ndarray  # (N,)
    cosine: np.ndarray  # (N,)
    omega: float
    tau: float | None  # None: the phase at which the steady gap is largest at t = 0
    low: float
    high: float
    R_low: float
    R_high: float

    @property
    def symmetric(self) -> bool:
        """Whether x -> -x, t -> t + T/2 maps motions to motions."""
        return self.low == -self.high and self.R_low == self.R_high and not np.any(self.constant)

    def stop(self, sides) -> np.ndarray:
        """Positions of the stops on these sides (+1 high, -1 low)."""
        return np.where(np.asarray(sides) > 0, self.high, self.low)

    def restitution(self, sides) -> np.ndarray:
        return np.where(np.asarray(sides) > 0, self.R_high, self.R_low)


@dataclass(frozen=True)
class Family:
    """Oscillators with parameters that have names: `build(**numbers)` gives a `Linear`.

    `build` must accept complex numbers and be analytic in them: derivatives are taken by a complex step.
    """

    build: Callable[..., Linear]
    numbers: dict

    def replace(self, **changes) -> "Family":
        return Family(self.build, self.numbers | changes)

    @property
    def linear(self) -> Linear:
        """The oscillator, its phase resolved."""
        built = self.build(**self.numbers)
        return built._replace(tau=grazing_phase(built)) if built.tau is None else built

    def stops(self, name: str, linear: Linear) -> tuple[Linear, Linear]:
        """`linear` with this one's stops and restitution, and their derivatives by `name`, which moves nothing else."""
        step = self.build(**(self.numbers | {name: self.numbers[name] + 1j * STEP}))
        contact = {field: getattr(step, field) for field in ("low", "high", "R_low", "R_high")}
        at_rest = {field: np.zeros(np.shape(value)) for field, value in linear._asdict().items()}
        slope = at_rest | {field: float(np.imag(value)) / STEP for field, value in contact.items()}
        return linear._replace(**{field: float(np.real(value)) for field, value in contact.items()}), Linear(**slope)

    def derivative(self, name: str, linear: Linear | None = None) -> Linear:
        """Derivatives of all fields by the parameter `name`, exact to rounding. linear: this one's, if it is known."""
        step = self.build(**(self.numbers | {name: self.numbers[name] + 1j * STEP}))
        parts = {}
        for field, value in step._asdict().items():
            if field != "tau":
                parts[field] = np.imag(value) / STEP if np.iscomplexobj(value) else np.zeros(np.shape(value))
        slope = Linear(**parts, tau=0.0 if step.tau is None else float(np.imag(step.tau)) / STEP)
        if step.tau is None:
            slope = slope._replace(tau=grazing_phase_slope(linear or self.linear, slope))
        return slope


def dynamic_stiffness(q: Linear) -> np.ndarray:
    """K - omega^2 M + i omega C, (N, N)."""
    return q.K - q.omega**2 * q.M + 1j * q.omega * q.C


def amplitudes(q: Linear) -> np.ndarray:
    """Complex amplitudes X (N,) of the steady motion Re(X e^{i(omega t + tau)}). LinAlgError in undamped resonance."""
    return np.linalg.solve(dynamic_stiffness(q), q.cosine - 1j * q.sine)


def amplitude_slopes(q: Linear, slope: Linear) -> np.ndarray:
    """Derivatives (N,) of `amplitudes` where q changes by `slope`."""
    dz = slope.K - 2 * q.omega * slope.omega * q.M - q.omega**2 * slope.M + 1j * (slope.omega * q.C + q.omega * slope.C)
    return np.linalg.solve(dynamic_stiffness(q), slope.cosine - 1j * slope.sine - dz @ amplitudes(q))


def grazing_phase(q: Linear) -> float:
    """tau for which the steady gap is largest at t = 0; 0 where there is no steady motion (eq. 18 for any n)."""
    try:
        gain = q.along @ amplitudes(q)
    except np.linalg.LinAlgError:
        return 0.0
    return -float(np.angle(gain)) if np.isfinite(gain) else 0.0


def grazing_phase_slope(q: Linear, slope: Linear) -> float:
    gain = q.along @ amplitudes(q)
    return -float(np.imag((slope.along @ amplitudes(q) + q.along @ amplitude_slopes(q, slope)) / gain))


def two_mass(*, mu_m, mu_k, zeta, f2, omega, R, b, tau, stops) -> Linear:
    """The paper's oscillator (eqs. 3, 4); also for complex numbers."""
    K = np.array([[1, -1], [-1, 1 + mu_k]])
    return Linear(
        M=np.array([[1, 0], [0, mu_m]]),
        K=K,
        C=2 * zeta * K,
        along=np.array([1.0, 0.0]),
        constant=np.zeros(2),
        sine=np.array([1 - f2, f2]),
        cosine=np.zeros(2),
        omega=omega,
        tau=None if tau == "grazing" else tau,
        low=-b if stops != "right" else -np.inf,
        high=b if stops != "left" else np.inf,
        R_low=R,
        R_high=R,
    )


def family_of(system) -> Family:
    """The oscillators that `system` is one of, by the names of its numbers. TypeError for anything else."""
    if isinstance(system, Family):
        return system
    if isinstance(system, System):
        return Family(two_mass, {field.name: getattr(system, field.name) for field in fields(system)})
    raise TypeError(f"system: {system!r} is not allowed; it must be a System")


def forcing_period(q: Linear) -> float:
    """T = 2 pi/omega."""
    return 2 * math.pi / q.omega
