"""Tables of contacts in closed form: a damped wave beside a short slow series.

With f = (delta, delta') = phi + L q and q = chi + H phi as in slow_manifold.py, and a short series for chi(u),

    delta = e^{-gamma u} (P cos kd u + Q sin kd u) + (L chi(u))_0

and w2, ... the same with smaller P and Q: closed_form.py.
"""

import math

import numpy as np

from vibro_sweep.engine.compliant.slow_manifold import is_set_apart, part_of
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES

SLOW = 16  # terms of a slow series at most, and
SLOW_REACH = 0.6  # rate * time that they serve: the first term left out is below 2e-17; so it is for
SLOW_ROWS = SLOW + 1  # of w2, ...: delta takes the velocity of w2 with its last term
FEWER = ((8, 0.029), (12, 0.2))
TURN = 4.3  # kd u that the formulas of sin and cos serve
DECAY = 3.0  # gamma u that the formula of the exponential serves


def closed_fields(masses: int) -> list:
    """The fields of `passages_of` for contacts in closed form: of the left stop, the right one, and of each orbit its
    own."""
    states = 2 * masses
    slow = states + 1  # entries of chi
    return [
        ("reach", float, (2, LANES)),  # the longest contact that the closed form serves; 0: none
        ("top", float, (2, LANES)),  # the part of its time after which delta is largest, about, and
        ("force_top", float, (2, LANES)),  # the force
        ("slow_rate", float, (2, LANES)),  # about how fast the slow motion is
        ("slow", float, (3 * (masses - 1) * slow, LANES)),  # S, its rows of w2', ...
        ("manifold", float, (3 * 2 * slow, LANES)),  # L
        ("share", float, (3 * 2 * (states - 2), LANES)),  # H, a row for each of w2, w2', ...
        ("fast", float, (3 * 10, LANES)),  # gamma, kd, M = (A - L C + gamma)/kd, J (A - L C + gamma) J^-1
        ("wiggle", float, (3 * 4, LANES)),  # sizes of B H and of B H (A - L C): what phi adds to a and to a'
        ("powers", float, (SLOW, LANES)),  # omega^n/n!
        # of the contact
        ("chi", float, (slow, LANES)),
        ("phi", float, (4, LANES)),  # phi and M phi at the touch
        ("slow_delta", float, (SLOW, LANES)),
        ("slow_others", float, ((masses - 1) * SLOW_ROWS, LANES)),  # of w2, ..., and
        ("slow_speeds", float, ((masses - 1) * SLOW_ROWS, LANES)),  # of w2', ...
        ("slow_end", float, (SLOW, LANES)),  # the slow part of what is zero at the end
        ("slow_force", float, (SLOW, LANES)),  # of F/m_e
        ("slow_drive", float, (SLOW, LANES)),  # of a
        # of the contact, for tangent vectors
        ("closed", float, (LANES,)),  # 1 where it was passed in closed form
        ("block", np.int64),  # of the tables
        ("terms", float, (LANES,)),  # of its slow series, and
        ("most", np.int64),  # the most of any orbit
        ("flight", float, (2, LANES)),  # e^{-gamma u} cos kd u and e^{-gamma u} sin kd u/kd at its end
        ("slow_flight", float, ((states - 2) ** 2, LANES)),  # e^{S u} of w2, w2', ...
        ("slow_term", float, (2 * (states - 2), LANES)),
    ]


@jit
def set_closed_form(passage, n, i, contact, omega):
    """The tables of contacts with stop n of orbit i. The reach is 0 where the two motions cannot be set apart."""
    passage.reach[n, i] = 0.0
    if not (passage.ends[n, i] > 0.0 and is_set_apart(contact, n, 2, omega)):
        return
    part, c, k = part_of(n, 2), passage.damping[n, i], passage.stiffness[n, i]
    S, L, H, F, G, fast = (
        contact.S[part], contact.L[part], contact.H[part], contact.F[part], contact.equations[n], passage.fast[:]
    )  # fmt: skip
    gamma = -0.5 * (F[0, 0] + F[1, 1])
    square = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0] - gamma * gamma
    if not (square > 0.0 and gamma >= 0.0):
        return
    kd, rate = math.sqrt(square), contact.slow_rate[part]
    reach = min(SLOW_REACH / rate, TURN / kd)
    passage.slow_rate[n, i] = rate
    passage.reach[n, i] = min(reach, DECAY / gamma) if gamma > 0.0 else reach
    turn, top = kd * passage.duration[n, i], math.atan2(kd, gamma)
    ahead = math.atan2(c * kd, k - c * gamma)  # of delta the force is
    passage.top[n, i], passage.force_top[n, i] = top / turn, max(top - ahead, 0.0) / turn
    # from here on delta stands before delta'
    first, nw, size = 10 * n, len(contact.y) - 2, len(contact.y) + 1
    p, q, r, s = F[1, 1] + gamma, F[1, 0], F[0, 1], F[0, 0] + gamma
    fast[first, i], fast[first + 1, i] = gamma, kd
    fast[first + 2, i], fast[first + 3, i], fast[first + 4, i], fast[first + 5, i] = p / kd, q / kd, r / kd, s / kd
    set_vector_flight(passage, first + 6, i, L, G, c, gamma)
    B0 = B1 = 0.0
    for j in range(nw):
        passage.share[2 * (n * nw + j), i], passage.share[2 * (n * nw + j) + 1, i] = H[j + 2, 1], H[j + 2, 0]
        B0, B1 = B0 + G[0, j + 2] * H[j + 2, 1], B1 + G[0, j + 2] * H[j + 2, 0]
    passage.wiggle[4 * n, i], passage.wiggle[4 * n + 1, i] = abs(B0), abs(B1)
    passage.wiggle[4 * n + 2, i] = abs(B0 * (p - gamma) + B1 * r)
    passage.wiggle[4 * n + 3, i] = abs(B0 * q + B1 * (s - gamma))
    for j in range(size):
        passage.manifold[2 * n * size + j, i], passage.manifold[(2 * n + 1) * size + j, i] = L[1, j + 2], L[0, j + 2]
        for m in range(len(G) - 1):
            passage.slow[(n * (len(G) - 1) + m) * size + j, i] = S[2 * m + 3, j + 2]


@jit
def set_vector_flight(passage, first, i, L, G, c, gamma):
    """J (A - L C + gamma) J^-1 with J = (1, 0; c, 1); K - c c0 is taken as such."""
    fast, K, c0 = passage.fast[:], -G[0, 0], -G[0, 1] - c
    p = q = r = s = 0.0  # L C
    for m in range(1, len(G)):
        e = 2 * m + 1
        p, q = p + L[1, e] * G[m, 0], q + L[1, e] * G[m, 1]
        r, s = r + L[0, e] * G[m, 0], s + L[0, e] * G[m, 1]
    p, r = p - c * q, r - c * s
    fast[first, i], fast[first + 1, i] = gamma - c - p, 1.0 - q
    fast[first + 2, i], fast[first + 3, i] = c * c0 - K - (r + c * p), gamma - c0 - (s + c * q)
