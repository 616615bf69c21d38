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
