"""A linear oscillator with contacts, as the engine sees all of them: any number of masses N.

    M x'' + C x' + K x = constant + sine sin(omega t + tau) + cosine cos(omega t + tau),   low <= n.x <= high

with n, low and high of each contact. An impulse acts along M^-1 n: it changes the velocity of the gap g = n.x, with the
restitution of the stop that is hit. What is computed of an oscillator is so far that of one contact, `Linear.contact`.
"""

import math
import operator
from collections.abc import Callable, Sequence
from functools import lru_cache, reduce, wraps
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from vibro_sweep.oscillator.contact_laws.compliant import LAW as COMPLIANT
from vibro_sweep.oscillator.contact_laws.compliant import StopLaw
from vibro_sweep.oscillator.stacks import least_squares
from vibro_sweep.oscillator.steady import gap_responses, grazing_phases, responses, static_states, steady_amplitudes
from vibro_sweep.oscillator.stops import NUMBERS, stop_of

MATRICES = ("M", "K", "C", "contact.normal", "omega")  # numbers that move free modes,
FORCED = (*MATRICES, "constant", "sine", "cosine")  # the steady motion too,
MOTION = (*FORCED, "tau")  # and the flight from a time on
LEAST = 1e-100  # stiffness of a stop that is a damper alone: no double is that small beside another of a machine
STEP = 1e-100  # of the complex step: its square underflows, so that a derivative has no truncation error


class LinearContact(NamedTuple):
    """The numbers of a contact; of a slope their derivatives.

    normal : (N,) n of the gap n.x
    low, high : positions of the stops; infinite where there is none
    R_low, R_high : their coefficients of restitution
    middle : the offset about which the stops lie
    k_low, c_low, p_low, k_high, c_high, p_high : the `StopLaw` of each; R of compliant stops is NaN
    by_force : whether contact ends where the force of the stop is zero, and not at zero displacement

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> contact = system.linear.contacts[0]
    >>> contact.normal.tolist(), float(contact.stop(-1)), contact.restitution([-1, 1]).tolist()
    ([1.0, 0.0], -4.0, [0.8, 0.8])
    """

    normal: np.ndarray
    low: float
    high: float
    R_low: float
    R_high: float
    middle: float = 0.0
    k_low: float = 0.0
    c_low: float = 0.0
    p_low: float = 0.0
    k_high: float = 0.0
    c_high: float = 0.0
    p_high: float = 0.0
    by_force: bool = False

    @property
    def symmetric(self) -> bool:
        """Whether gap -> -gap maps its stops to its stops."""
        left, right = self.law(-1), self.law(1)
        return self.low == -self.high and left == right and (left.k > 0 or self.R_low == self.R_high)

    @property
    def compliant(self) -> bool:
        """Whether a stop is: then there is motion beyond it."""
        return (self.k_low > 0) | (self.k_high > 0)

    def is_compliant(self, sides) -> np.ndarray:
        """Whether the stops on these sides (+1 high, -1 low) are compliant."""
        return np.where(np.asarray(sides) > 0, self.k_high, self.k_low) > 0

    def stop(self, sides) -> np.ndarray:
        """Positions of the stops on these sides (+1 high, -1 low)."""
        return np.where(np.asarray(sides) > 0, self.high, self.low)

    def restitution(self, sides) -> np.ndarray:
        """Coefficients of restitution of the stops on these sides (+1 high, -1 low)."""
        return np.where(np.asarray(sides) > 0, self.R_high, self.R_low)

    def law(self, side: int) -> StopLaw:
        """The law of the stop on this side (+1 high, -1 low)."""
        end = "high" if side > 0 else "low"
        return StopLaw(*[getattr(self, f"{name}_{end}") for name in StopLaw._fields])


class Linear(NamedTuple):
    """The oscillator's numbers; and, with the same fields, their derivatives by one parameter.

    M, K, C : (N, N) matrices of masses, stiffnesses and dampers
    constant, sine, cosine : (N,) constant force, amplitudes of sin(omega t + tau) and cos(omega t + tau)
    omega, tau : frequency, and phase in radians; tau None: the steady gap is largest at t = 0
    contacts : `LinearContact` of each

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> matrices = system.linear
    >>> matrices.K
    array([[ 1., -1.],
           [-1.,  6.]])
    >>> float(matrices.contacts[0].low), float(matrices.contacts[0].high), bool(matrices.symmetric)
    (-4.0, 4.0, True)
    """

    M: np.ndarray
    K: np.ndarray
    C: np.ndarray
    constant: np.ndarray
    sine: np.ndarray
    cosine: np.ndarray
    omega: float
    tau: float | None
    contacts: Sequence[LinearContact]

    @property
    def masses(self) -> int:
        """N."""
        return np.shape(self.M)[-1]

    @property
    def contact(self) -> LinearContact:
        """The only contact."""
        (only,) = self.contacts
        return only

    @property
    def symmetric(self) -> bool:
        """Whether x -> -x, t -> t + T/2 maps motions to motions."""
        return all(one.symmetric for one in self.contacts) and not np.any(self.constant)

    @property
    def compliant(self) -> bool:
        """Whether a stop is: then there is motion beyond it."""
        return reduce(operator.or_, (one.compliant for one in self.contacts))

    def with_contact(self, **numbers) -> "Linear":
        """The same with other numbers of its only contact."""
        return self._replace(contacts=(self.contact._replace(**numbers),))


def mapped(function: Callable, *oscillators: Linear) -> Linear:
    """The oscillator whose numbers are `function(name, ...)` of those of these; names are M, ..., contact.low, ..."""
    *fields, contacts = zip(*oscillators, strict=True)
    each = [
        LinearContact(*(function(f"contact.{name}", *x) for name, *x in zip(LinearContact._fields, *same, strict=True)))
        for same in zip(*contacts, strict=True)
    ]
    return Linear(*(function(name, *x) for name, x in zip(Linear._fields, fields, strict=False)), tuple(each))


def stepped(q: Linear, slope: Linear) -> Linear:
    """q + i STEP slope: what a function makes of it has STEP times its derivative as imaginary part."""
    return mapped(lambda name, value, change: value + 1j * STEP * np.asarray(change), q, slope)


def selected(q: Linear, which) -> Linear:
    """These oscillators of a stack, by an index or a mask; one of them by a number."""
    return mapped(lambda name, x: None if x is None else np.asarray(x)[which], q)


def stacked(each: Sequence[Linear]) -> Linear:
    """A stack of oscillators, of each field (n, ...)."""
    return mapped(lambda name, *values: np.stack(values), *each)


class KeyOfFields:
    """An oscillator as a key of what depends on the values of some fields alone: equal where all of them are."""

    def __init__(self, q: Linear, values: tuple):
        self.q = q
        self.key = tuple([value.tobytes() if isinstance(value, np.ndarray) else value for value in values])

    def __hash__(self):
        return hash(self.key)

    def __eq__(self, other):
        return self.key == other.key


def memoised(*names: str, most: int = 64):
    """A function of an oscillator and other arguments, whose last results are kept for equal fields `names`."""

    values = attrgetter(*names)

    def keeping(function):
        @lru_cache(most)
        def known(key: KeyOfFields, *others):
            return function(key.q, *others)

        @wraps(function)
        def of(q: Linear, *others):
            return known(KeyOfFields(q, values(q)), *others)

        return of

    return keeping


@memoised(*FORCED, most=1024)  # as many as a curve has points
def amplitudes(q: Linear) -> np.ndarray:
    """Complex amplitudes X (N,) of the steady motion Re(X e^{i(omega t + tau)}). LinAlgError in undamped resonance.

    Where the force does not drive the mode in resonance, the steady motion without that mode.
    """
    result = _existing(steady_amplitudes(q))
    result.flags.writeable = False  # it is shared
    return result


def _existing(amplitudes: np.ndarray) -> np.ndarray:
    if np.isnan(amplitudes).any():
        raise np.linalg.LinAlgError("the force drives an undamped mode at its own frequency")
    return amplitudes


def amplitude_slopes(q: Linear, slope: Linear) -> np.ndarray:
    """Derivatives (N,) of `amplitudes` where q changes by `slope`."""
    dz = (
        slope.K
        - 2 * q.omega * slope.omega * q.M
        - q.omega * q.omega * slope.M
        + 1j * (slope.omega * q.C + q.omega * slope.C)
    )
    return _existing(responses(q, slope.cosine - 1j * slope.sine - dz @ amplitudes(q)))


def grazing_phase(q: Linear) -> float:
    """tau for which the steady gap is largest at t = 0; 0 where there is no steady motion (eq. 18 for any n)."""
    response = gap_response(q)
    return float(grazing_phases(np.nan if response is None else response))


@memoised(*FORCED, most=1024)
def gap_response(q: Linear) -> complex | None:
    """G of the steady gap g_s + Re(G e^{i(omega t + tau)}); None where there is no steady motion."""
    response = complex(gap_responses(q, steady_amplitudes(q)))
    return response if np.isfinite(response) else None


def grazing_phase_slope(q: Linear, slope: Linear) -> float:
    if not any(np.any(values) for values in attrgetter(*FORCED)(slope)):
        return 0.0
    response = gap_response(q)
    if response is None:
        return 0.0
    moved = slope.contact.normal @ amplitudes(q) + q.contact.normal @ amplitude_slopes(q, slope)
    return -float(np.imag(moved / response))


def static_state(q: Linear) -> np.ndarray | None:
    """Positions (N,) at which all masses rest without the harmonic force and the stops; None where there are none.

    Of several, where there are free modes, the nearest to zero.
    """
    state = static_states(q)
    return state if np.isfinite(state).all() else None


def rest_state(q: Linear) -> np.ndarray:
    """Positions (..., N) from which to start at rest: zero, or the static equilibrium held on the nearer stop.

    Held: the gap is zero's where that is between the stops; else that of the stop, and no other force acts along n.
    """
    gap = np.minimum(np.maximum(0.0, q.contact.low), q.contact.high)
    result, held = np.zeros(q.contact.normal.shape), gap != 0.0
    if held.any():
        q = selected(q, held)
        size = np.abs(q.K).max((-2, -1))[..., None]
        scale = np.exp2(
            np.round(np.log2(np.where(size > 0, size, 1.0)))
        )  # else the gap is rounding beside stiff springs
        forces = np.append(q.constant, scale * gap[held][..., None], -1)
        result[held] = least_squares(bordered(q.K, scale * q.contact.normal), forces)[..., :-1]
    return result


def bordered(K: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """(..., N + 1, N + 1): K, and the gap n . x as one more row and column."""
    n = K.shape[-1]
    result = np.zeros((*K.shape[:-2], n + 1, n + 1))
    result[..., :n, :n], result[..., :n, n], result[..., n, :n] = K, normal, normal
    return result


def contact(normal, *, b, offset=0.0, stops="both", release="displacement", **numbers) -> LinearContact:
    """A contact from the numbers that describe it; also from complex ones.

    numbers : those of the stops, by name
    """
    if unknown := numbers.keys() - {*NUMBERS}:
        raise TypeError(f"stops have no {', '.join(sorted(unknown))}")
    low, high = stop_of(numbers, "left"), stop_of(numbers, "right")
    fields = {"R": ("R", np.nan)}
    fields |= {field: (key, 0.0) for field, key in zip(StopLaw._fields[1:], COMPLIANT.names["right"][1:], strict=True)}
    return LinearContact(
        normal=normal,
        low=offset - b if stops != "right" else -np.inf,
        high=offset + b if stops != "left" else np.inf,
        middle=offset,
        by_force=release == "force" and COMPLIANT in (low.law, high.law),
        **{f"{field}_low": low.number(*number) for field, number in fields.items()},
        **{f"{field}_high": high.number(*number) for field, number in fields.items()},
        **{f"k_{name}": stop.number("k_stop", -LEAST) + LEAST for name, stop in (("low", low), ("high", high))},
    )


def forcing_period(q: Linear) -> float:
    """T = 2 pi/omega."""
    return 2 * math.pi / q.omega


def roots(q: Linear) -> np.ndarray:
    """The 2N roots lambda of det(lambda^2 M + lambda C + K) = 0; NaN beyond the range of the floats."""
    n = q.masses
    inverse = np.linalg.inv(q.M)
    with np.errstate(all="ignore"):
        matrix = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ q.K, -inverse @ q.C]])
    return np.linalg.eigvals(matrix) if np.isfinite(matrix).all() else np.full(2 * n, np.nan)


def push_of(q: Linear) -> np.ndarray:
    """(N,): what an impulse that changes the gap's velocity by 1 does to the masses, p = M^-1 n/(n.M^-1 n)."""
    push = np.linalg.solve(q.M, q.contact.normal)
    return push / (q.contact.normal @ push)


def grazing_state(q: Linear) -> np.ndarray:
    """X* (2 N,): the steady motion without a constant force where its gap is largest, which is at rest there.

    Infinite or NaN where there is no steady motion.
    """
    x, n = amplitudes(q), q.contact.normal
    x = x * np.exp(-1j * np.angle(n @ x))
    state = np.stack([x.real, -q.omega * x.imag], -1)
    state[:, 1] -= push_of(q) * (n @ state[:, 1])  # but for rounding it is zero
    return state.reshape(-1)
