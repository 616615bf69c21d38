"""How the equations of motion, the impulse and the grazing point change with the parameters of an oscillator.

Flight is the autonomous linear system dz/ds = A z for z = (x1, v1, ..., xN, vN, sin(s + tau), cos(s + tau), 1), with
the phase s = omega t in place of time: the section then stays at s = 0 mod 2 pi when omega changes.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.oscillator.linear import Linear, amplitude_slopes, amplitudes


class Motion(NamedTuple):
    """One oscillator in the coordinates of its masses; or, with the same fields, its derivatives by a parameter."""

    A: np.ndarray  # (2 N + 3, 2 N + 3), in flight
    constrained: np.ndarray  # the same while a stop holds the gap
    push: np.ndarray  # (N,): what an impulse that changes the gap's velocity by 1 does to the masses, p


def motion(q: Linear) -> Motion:
    """M x'' = ..., between the stops and on one: x'' less p n.x'' there, with p = M^-1 n/(n.M^-1 n)."""
    acceleration = np.linalg.solve(q.M, _forces(q))
    push = _push(q)
    return Motion(
        _by_phase(q, acceleration), _by_phase(q, acceleration - np.outer(push, q.normal @ acceleration)), push
    )


def motion_slopes(q: Linear, slope: Linear) -> Motion:
    """Derivatives of `motion` where q changes by `slope`. No parameter of a model moves `along`."""
    acceleration, push = np.linalg.solve(q.M, _forces(q)), _push(q)
    moved = np.linalg.solve(q.M, _forces(slope) - slope.M @ acceleration)
    across = np.linalg.solve(q.M, slope.M @ push)
    d_push = push * (q.normal @ across) - across
    constrained = acceleration - np.outer(push, q.normal @ acceleration)
    d_constrained = moved - np.outer(push, q.normal @ moved) - np.outer(d_push, q.normal @ acceleration)
    return Motion(
        _by_phase_slope(q, slope, acceleration, moved), _by_phase_slope(q, slope, constrained, d_constrained), d_push
    )


def _forces(q: Linear) -> np.ndarray:
    """M x'' as a function of z, (N, 2 N + 3)."""
    n = len(q.normal)
    result = np.empty((n, 2 * n + 3))
    result[:, 0 : 2 * n : 2], result[:, 1 : 2 * n : 2] = -q.K, -q.C
    result[:, 2 * n :] = np.stack([q.sine, q.cosine, q.constant], -1)
    return result


def _push(q: Linear) -> np.ndarray:
    push = np.linalg.solve(q.M, q.normal)
    return push / (q.normal @ push)


def _by_phase(q: Linear, acceleration: np.ndarray) -> np.ndarray:
    n = len(q.normal)
    A = np.zeros((2 * n + 3, 2 * n + 3))
    A[np.arange(0, 2 * n, 2), np.arange(1, 2 * n, 2)] = 1 / q.omega
    A[1 : 2 * n : 2] = acceleration / q.omega
    A[2 * n, 2 * n + 1], A[2 * n + 1, 2 * n] = 1, -1
    return A


def _by_phase_slope(q: Linear, slope: Linear, acceleration: np.ndarray, moved: np.ndarray) -> np.ndarray:
    n = len(q.normal)
    A = -slope.omega / q.omega * _by_phase(q, acceleration)
    A[2 * n :] = 0
    A[1 : 2 * n : 2] += moved / q.omega
    return A


def grazing_state(q: Linear) -> np.ndarray:
    """X* (2 N,): the steady motion without a constant force where its gap is largest, which is at rest there.

    Infinite or NaN where there is no steady motion.
    """
    x, n = amplitudes(q), q.normal
    x = x * np.exp(-1j * np.angle(n @ x))
    state = np.stack([x.real, -q.omega * x.imag], -1)
    state[:, 1] -= _push(q) * (n @ state[:, 1])  # but for rounding it is zero
    return state.reshape(-1)


def grazing_state_slopes(q: Linear, slope: Linear) -> np.ndarray:
    """Derivatives (2 N,) of `grazing_state` where q changes by `slope`."""
    x, dx = amplitudes(q), amplitude_slopes(q, slope)
    response = q.normal @ x
    turn = np.exp(-1j * np.angle(response))
    dy = (dx - 1j * x * ((q.normal @ dx) / response).imag) * turn
    return np.stack([dy.real, -slope.omega * (x * turn).imag - q.omega * dy.imag], -1).reshape(-1)
