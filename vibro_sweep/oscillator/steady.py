"""The steady motion of stacks of oscillators (`Linear`, fields (..., N, N), (..., N) and (...))."""

import numpy as np

from vibro_sweep.oscillator.stacks import (
    diagonal,
    dot,
    finite,
    least_squares,
    only,
    solved,
    times,
    transposed,
    well_conditioned,
)

DRIVEN = 1e-14  # part of the force on a mode below which it is rounding
UNBALANCED = 1e-9  # of the constant force: what no state balances


def dynamic_stiffness(q) -> np.ndarray:
    """K - omega^2 M + i omega C, (..., N, N)."""
    omega = np.asarray(q.omega)[..., None, None]
    with np.errstate(all="ignore"):  # beyond the range of the floats it is infinite
        return q.K - omega * omega * q.M + 1j * omega * q.C


def responses(q, force: np.ndarray) -> np.ndarray:
    """X (..., N) of (K - omega^2 M + i omega C) X = force; NaN where it drives an undamped mode at its own frequency.

    Where the force does not drive the mode in resonance, the motion without that mode.
    """
    Z = dynamic_stiffness(q)
    with np.errstate(all="ignore"):  # beyond a bound of a parameter masses may vanish
        scale = 1 / np.sqrt(np.abs(diagonal(q.M)))
        scaled = Z * (scale[..., :, None] * scale[..., None, :])
    known = finite(scaled)
    if well_conditioned(only(known, scaled)).all():  # most are: the singular values take long
        return solved(Z, force)
    left, sizes, right = np.linalg.svd(only(known, scaled))
    regular = sizes > sizes.shape[-1] * np.finfo(float).eps * sizes[..., :1]
    plain = regular.all(-1) | ~known
    X = solved(only(plain, Z), force)
    if plain.all():
        return X
    with np.errstate(all="ignore"):
        parts = times(transposed(left.conj()), force * scale)
        driven = (~regular & (np.abs(parts) > DRIVEN * np.abs(force * scale).max(-1, keepdims=True))).any(-1)
        others = scale * times(transposed(right.conj()), np.where(regular, parts / sizes, 0))
    others[driven] = np.nan
    return np.where(plain[..., None], X, others)


def steady_amplitudes(q) -> np.ndarray:
    """X (..., N) of the steady motion Re(X e^{i(omega t + tau)}); NaN where there is none."""
    return responses(q, q.cosine - 1j * q.sine)


def gap_responses(q, X: np.ndarray) -> np.ndarray:
    """G (...) of the steady gap g_s + Re(G e^{i(omega t + tau)}); NaN where there is no steady motion."""
    G = dot(q.contact.normal + 0j, X)
    return np.where(np.isfinite(G) & finite(static_states(q), 1), G, np.nan)


def grazing_phases(G: np.ndarray) -> np.ndarray:
    """tau (...) for which the steady gap is largest at t = 0; 0 where there is no steady motion (eq. 18 for any n)."""
    return np.where(np.isnan(G), 0.0, 0.0 - np.angle(G))


def static_states(q) -> np.ndarray:
    """Positions (..., N) at which all masses rest without the harmonic force and the stops; NaN where there are none.

    Of several, where there are free modes, the nearest to zero.
    """
    if not np.any(q.constant):
        return np.zeros(q.constant.shape)
    static = least_squares(q.K, q.constant)
    left_over = np.abs(times(q.K, static) - q.constant).max(-1)
    balanced = left_over <= UNBALANCED * np.abs(q.constant).max(-1)
    return np.where(balanced[..., None], static, np.nan)
