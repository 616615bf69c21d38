"""Flights that never end: an orbit that can strike no more.

Above grazing the steady motion (eq. 7) touches no stop. How far a motion is from it, d = X - X*, flies like a free
motion without force: its energy H = v^T M v + x^T K x never grows, and by the inequality of Cauchy and Schwarz in the
metric K it moves the gap n.x by no more than sqrt(H n^T K^-1 n). Once that is less than what the steady motion leaves
of the clearance, no impact will follow, and X after m periods is X* + Phi^m d with the matrix Phi of one period.
"""

import math

from vibro_sweep.engine.simd.jit import jit

SAFETY = 1.0 + 1e-9  # far more than what rounding does to any of it


@jit
def fill_coasting(q, psi, omega_squared, mu_m, mu_k, f2, tau):
    """The steady motion at node 0, and by how much a motion near it may move the gap."""
    a, b = 0.0, 0.0
    for i in range(4):
        q.steady[i] = 0.0
        for j in range(4):
            q.confining[i, j] = 0.0
    for j in range(2):
        force, eta = psi[0, j] * (1.0 - f2) + psi[1, j] * f2, q.zeta * omega_squared[j]
        # (7) with the sign of B_j corrected: A_j sin + B_j cos
        detuning, damping = omega_squared[j] - q.omega * q.omega, 2.0 * eta * q.omega
        size = force / (detuning * detuning + damping * damping)
        A, B = size * detuning, -size * damping
        a += psi[0, j] * A
        b += psi[0, j] * B
        for i in range(2):
            q.steady[2 * i] += psi[i, j] * (A * math.sin(tau) + B * math.cos(tau))
            q.steady[2 * i + 1] += psi[i, j] * q.omega * (A * math.cos(tau) - B * math.sin(tau))
    q.middle, q.swing = 0.0, math.hypot(a, b)  # (17)
    compliance = (1.0 + mu_k) / mu_k  # e1^T K^-1 e1
    q.confining[0, 0], q.confining[1, 1] = compliance, compliance
    q.confining[0, 2] = q.confining[2, 0] = -compliance
    q.confining[2, 2], q.confining[3, 3] = compliance * (1.0 + mu_k), compliance * mu_m


@jit
def is_clear(q, o):
    """Whether the orbit, in free flight at node 0, can strike no more. False where that is not known."""
    states, square = len(q.steady), 0.0
    for i in range(states):
        for j in range(states):
            square += q.confining[i, j] * (o.X[i] - q.steady[i]) * (o.X[j] - q.steady[j])
    reach = (q.swing + math.sqrt(abs(square))) * SAFETY
    return o.stops[0] < q.middle - reach and q.middle + reach < o.stops[1]


@jit
def fly_periods(q, E, o, periods):
    """X after so many periods of free flight from node 0, by repeated squares of the period's matrix E."""
    power, d, states = q.power, q.apart, len(q.steady)
    for i in range(states):
        d[0, i] = o.X[i] - q.steady[i]
        for j in range(states):
            power[0, i, j] = E[j, i]
    while periods > 0:
        if periods & 1:
            for i in range(states):
                d[1, i] = 0.0
                for j in range(states):
                    d[1, i] += power[0, i, j] * d[0, j]
            for i in range(states):
                d[0, i] = d[1, i]
        periods >>= 1
        if periods > 0:
            square(power, states)
    for i in range(states):
        o.X[i] = q.steady[i] + d[0, i]


@jit
def square(power, states):
    """The first of two matrices times itself; the second is scratch."""
    for i in range(states):
        for j in range(states):
            power[1, i, j] = 0.0
            for m in range(states):
                power[1, i, j] += power[0, i, m] * power[0, m, j]
    for i in range(states):
        for j in range(states):
            power[0, i, j] = power[1, i, j]
