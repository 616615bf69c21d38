"""Monodromy matrices of periodic orbits of any linear oscillator, from the times and speeds of their impacts alone.

    M x'' + C x' + K x = constant + sine sin(omega t + tau) + cosine cos(omega t + tau),   low <= n.x <= high

in the coordinates of the masses: no modes, no Green function, no contact coordinates. z = (x, x', sin, cos, 1) flies by
exp(A t), summed here as a Taylor series. The impulses are known from the speeds, so that the state before the first
impact is the solution of linear equations: after the period the motion is itself (sigma times itself), at each impact
the gap is the stop and moves with the given speed. By how much they are not met says whether this is an orbit at
all. An impact multiplies disturbances by DG + (F+ - DG F-) n^T/(n.x'-), F the vector field before and after it.
"""

from typing import NamedTuple

import numpy as np

TERMS = 20  # of the series of exp for a norm of 1/2: the next one is below 1e-25


def expm(A):
    """(..., n, n) exponentials of matrices, by series and squaring, all alike."""
    norm = np.abs(A).sum(-1).max(initial=0.0)
    halvings = max(0, int(np.ceil(np.log2(norm))) + 1) if norm else 0
    step = A / 2.0**halvings
    result = term = np.broadcast_to(np.eye(A.shape[-1]), A.shape)
    for order in range(1, TERMS):
        term = term @ step / order
        result = result + term
    for _ in range(halvings):
        result = result @ result
    return result


def field(machine):
    """A (2N + 3, 2N + 3) of z' = A z."""
    N, (harmonic,) = machine.masses, machine.harmonics
    A = np.zeros((2 * N + 3, 2 * N + 3))
    inverse = np.linalg.inv(machine.M)
    A[:N, N : 2 * N] = np.eye(N)
    A[N : 2 * N, :N], A[N : 2 * N, N : 2 * N] = -inverse @ machine.K, -inverse @ machine.C
    for column, force in enumerate((harmonic.sine, harmonic.cosine, machine.constant)):
        A[N : 2 * N, 2 * N + column] = inverse @ force
    A[2 * N, 2 * N + 1], A[2 * N + 1, 2 * N] = machine.omega, -machine.omega
    return A


def normal_and_push(machine):
    """n, and the change of the velocities by an impact that changes that of the gap by 1."""
    normal = np.array(machine.contacts[0].normal)
    push = np.linalg.solve(machine.M, normal)
    return normal, push / (normal @ push)


class MapOverPeriod(NamedTuple):
    """Of m orbits.

    matrix : (m, 2N, 2N) derivative of the map over P, with the sign sigma, from just before the first impact on
    states : (m, K, 2N) x, x' before each impact
    off : (m,) by how much the equations of an orbit are not met, relative to the sizes of the gap and of its speed
    """

    matrix: np.ndarray
    states: np.ndarray
    off: np.ndarray


def monodromy(machines, sigma, periods, t, sides, v):
    """`MapOverPeriod` of m orbits with impacts at times t (m, K), on sides (K,), with the gap's speeds v (m, K) before.

    machines : m of one harmonic and one contact
    periods : (m,) P, after which the motion is sigma times itself
    """
    N, K, m = machines[0].masses, len(sides), len(machines)
    A = np.array([field(machine) for machine in machines])
    along, push = np.swapaxes([normal_and_push(machine) for machine in machines], 0, 1)
    laws = [{stop.side: stop for stop in machine.contacts[0].stops} for machine in machines]
    one_plus_R = np.array([[1 + law[side].R for side in sides] for law in laws]).reshape(m, K)
    stop = np.array([[law[side].place for side in sides] for law in laws]).reshape(m, K)
    omega, tau = (np.array([getattr(machine, name) for machine in machines], float) for name in ("omega", "tau"))
    if K == 0:
        t = np.zeros((m, 1))
    lengths = np.concatenate([np.diff(t, axis=1), (t[:, 0] + periods - t[:, -1])[:, None]], axis=1)
    flights = expm(A[:, None] * lengths[:, :, None, None])
    phase = omega[:, None] * t + tau[:, None]
    forced = np.stack([np.sin(phase), np.cos(phase), np.ones_like(phase)], axis=-1)  # (m, K, 3)
    flown, drive = flights[:, :, : 2 * N, : 2 * N], flights[:, :, : 2 * N, 2 * N :] @ forced[..., None]
    # the state before each impact as L x_0 + c
    L, c = np.broadcast_to(np.eye(2 * N), (m, 2 * N, 2 * N)), np.zeros((m, 2 * N))
    rows, sums, before = [], [], []
    impulse = np.zeros((m, 2 * N))
    for k in range(K):
        before.append((L, c))
        for offset, value, size in ((0, stop[:, k], 1.0), (N, v[:, k], omega)):
            n = np.zeros((m, 2 * N))
            n[:, offset : offset + N] = along / np.broadcast_to(size, m)[:, None]
            rows.append((n[:, None] @ L)[:, 0])
            sums.append(value / size - np.sum(n * c, axis=1))
        impulse[:, N:] = -(one_plus_R[:, k] * v[:, k])[:, None] * push
        L = flown[:, k] @ L
        c = (flown[:, k] @ (c + impulse)[..., None] + drive[:, k])[..., 0]
    if K == 0:
        L, c = flown[:, 0], drive[:, 0, :, 0]
    scale = np.concatenate([np.ones((m, N)), np.broadcast_to(1 / omega[:, None], (m, N))], axis=1)
    rows = np.concatenate(
        [np.array(rows).reshape(2 * K, m, 2 * N).transpose(1, 0, 2), scale[..., None] * (L - sigma * np.eye(2 * N))],
        axis=1,
    )
    sums = np.concatenate([np.array(sums).reshape(2 * K, m).T, -scale * c], axis=1)
    x = np.array([np.linalg.lstsq(a, b, rcond=1e-13)[0] for a, b in zip(rows, sums, strict=True)])
    left = np.abs((rows @ x[..., None])[..., 0] - sums).max(axis=1)
    states = np.stack([(L @ x[..., None])[..., 0] + c for L, c in before], axis=1) if K else x[:, None]
    size = np.maximum(np.abs(states[..., :N]).max((1, 2)), np.abs(states[..., N:]).max((1, 2)) / omega)
    total = np.broadcast_to(np.eye(2 * N), (m, 2 * N, 2 * N))
    for k in range(K):
        z = np.concatenate([states[:, k], forced[:, k]], axis=1)
        after = z.copy()
        after[:, N : 2 * N] -= (one_plus_R[:, k] * v[:, k])[:, None] * push
        DG = np.broadcast_to(np.eye(2 * N), (m, 2 * N, 2 * N)).copy()
        DG[:, N:, N:] -= one_plus_R[:, k, None, None] * push[:, :, None] * along[:, None, :]
        ahead, behind = ((A @ state[..., None])[:, : 2 * N, 0] for state in (z, after))
        S = DG
        S[:, :, :N] += ((behind - (DG @ ahead[..., None])[..., 0]) / v[:, k, None])[:, :, None] * along[:, None, :]
        total = flown[:, k] @ S @ total
    if K == 0:
        total = flown[:, 0]
    return MapOverPeriod(sigma * total, states, left / np.maximum(size, 1e-300))
