"""The steady motion of a plain oscillator (plain_points.py); how far from it no stop is reached (confinement.py)."""

import math

from vibro_sweep.engine.points.plain_coordinates import in_contact
from vibro_sweep.engine.points.symmetric import factorise, solve
from vibro_sweep.engine.simd.jit import jit

IN_RESONANCE = 1e-10  # of omega_j^2 + omega^2: a dynamic stiffness below which it is not


@jit
def set_steady(q, p, w):
    """How far from its steady motion the oscillator may be and reach no stop (confinement.py); not at all where springs
    leave a mode free. Returns whether no mode is in resonance."""
    n, omega, sin, cos = len(q.M), q.omega, math.sin(q.tau), math.cos(q.tau)
    p.middle, p.swing, free = 0.0, math.inf, False
    for i in range(2 * n):
        p.steady[i] = 0.0
        for j in range(2 * n):
            p.confining[i, j] = 0.0
    for i in range(n):
        w.rest[i], w.compliance[i], w.steady[0, i], w.steady[1, i] = q.constant[i], q.normal[i], 0.0, 0.0
        free = free or w.square[i] == 0.0
        for j in range(n):
            w.A[i, j] = q.K[i, j]
    if is_resonant(q, w):
        return False
    if free or not factorise(w.A, n):
        return free
    solve(w.A, n, w.rest)
    solve(w.A, n, w.compliance)
    for _ in range(2):  # once more for what rounding has left
        add_steady(q, w)
    for i in range(n):  # x = Re(turning e^{i omega t})
        a, b = w.steady[0, i], w.steady[1, i]
        w.turning[0, i], w.turning[1, i] = a * sin + b * cos, b * sin - a * cos
    real = imaginary = compliance = 0.0
    for i in range(n):
        real += q.normal[i] * w.turning[0, i]
        imaginary += q.normal[i] * w.turning[1, i]
        compliance += q.normal[i] * w.compliance[i]
        p.middle += q.normal[i] * w.rest[i]
    p.swing = math.hypot(real, imaginary)
    for i in range(n):
        for k in range(n):
            p.steady[2 * i] += p.P[i, k] * (w.turning[0, k] + w.rest[k])
            p.steady[2 * i + 1] -= p.P[i, k] * omega * w.turning[1, k]
        for j in range(n):
            p.confining[2 * i, 2 * j] = compliance * in_contact(p, q.K, i, j)
            p.confining[2 * i + 1, 2 * j + 1] = compliance * in_contact(p, q.M, i, j)
    return True


@jit
def is_resonant(q, w):
    """Whether the force has the frequency of a mode that nothing damps, or nearly."""
    for j in range(len(w.square)):
        stiffness = math.hypot(w.square[j] - q.omega * q.omega, w.damping[j] * q.omega)
        if stiffness <= IN_RESONANCE * (w.square[j] + q.omega * q.omega):
            return True
    return False


@jit
def add_steady(q, w):
    """Add to the steady motion a sin + b cos what balances the force that is left beside it."""
    n, omega, a, b = len(q.M), q.omega, w.steady[0], w.steady[1]
    for i in range(n):
        w.left[0, i], w.left[1, i] = q.sine[i], q.cosine[i]
        for k in range(n):
            w.left[0, i] += omega * omega * q.M[i, k] * a[k] - (q.K[i, k] * a[k] - omega * q.C[i, k] * b[k])
            w.left[1, i] += omega * omega * q.M[i, k] * b[k] - (q.K[i, k] * b[k] + omega * q.C[i, k] * a[k])
    for j in range(n):
        # (7): xi = A_j sin + B_j cos, for a force of sine and of cosine
        detuning, damping = w.square[j] - omega * omega, w.damping[j] * omega
        size = detuning * detuning + damping * damping
        sine = cosine = 0.0
        for i in range(n):
            sine += w.shape[i, j] * w.left[0, i]
            cosine += w.shape[i, j] * w.left[1, i]
        A, B = (detuning * sine + damping * cosine) / size, (detuning * cosine - damping * sine) / size
        for i in range(n):
            a[i] += w.shape[i, j] * A
            b[i] += w.shape[i, j] * B
