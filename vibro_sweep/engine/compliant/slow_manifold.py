"""The two motions of a contact: delta and delta', which are fast, and what changes slowly beside them.

With f = (delta, delta') and q = (w2, w2', ..., sin, cos, 1), a contact is f' = A f + B q, q' = C f + D q, and Chang's
transformation sets the two apart:

    f = phi + L q          A L + B = L S            S = D + C L
    q = chi + H phi        C + S H = H (A - L C)
    phi' = (A - L C) phi   chi' = S chi

L and H follow from these by iteration where f is faster than q; nothing large is subtracted, and small entries keep
their digits. So, in contact, with a short series for chi(u),

    delta = e^{-gamma u} (P cos kd u + Q sin kd u) + L_0 chi(u)

and w2, ... the same with smaller P and Q: closed_form.py.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES

SLOW = 16  # terms of a slow series at most, and
SLOW_REACH = 0.6  # rate * time that they serve: the first term left out is below 2e-17; so it is for
SLOW_ROWS = SLOW + 1  # of w2, ...: delta takes the velocity of w2 with its last term
FEWER = ((8, 0.029), (12, 0.2))
ROUNDS = 40  # of an iteration
SAME = 2.0**-50  # between two rounds, of the size: the next one is as exact as it gets
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
        # of one orbit's stop, while the two are set apart
        ("C", float, (slow, 2)),
        ("D", float, (slow, slow)),
        ("S", float, (slow, slow)),
        ("F", float, (2, 2)),  # A - L C
        ("L", float, (2, slow)),
        ("H", float, (slow, 2)),
        ("old", float, (2, slow)),  # what is replaced
    ]


@jit
def set_apart(passage, n, i, G, c, omega):
    """Set the two motions of contacts with stop n of orbit i apart; G: their equations. The reach is 0 where they are
    not apart.
    """
    S, F, L, H = passage.S, passage.F, passage.L, passage.H
    nw, size, fast = 2 * len(G) - 2, len(S), passage.fast[:]
    passage.reach[n, i] = 0.0
    if not passage.ends[n, i] > 0.0:
        return
    rate = passage.slow_rate[n, i] = set_coupling(passage, G, omega)
    if not (set_manifold(passage, G) and set_share(passage, G, nw)):
        return
    gamma = -0.5 * (F[0, 0] + F[1, 1])
    square = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0] - gamma * gamma
    if not (square > 0.0 and gamma >= 0.0):
        return
    kd = math.sqrt(square)
    reach = min(SLOW_REACH / rate, TURN / kd)
    passage.reach[n, i] = min(reach, DECAY / gamma) if gamma > 0.0 else reach
    turn, top = kd * passage.duration[n, i], math.atan2(kd, gamma)
    ahead = math.atan2(c * kd, passage.stiffness[n, i] - c * gamma)  # of delta the force is
    passage.top[n, i], passage.force_top[n, i] = top / turn, max(top - ahead, 0.0) / turn
    F[0, 0], F[1, 1] = F[0, 0] + gamma, F[1, 1] + gamma
    first = 10 * n
    fast[first, i], fast[first + 1, i] = gamma, kd
    for a in range(2):
        for b in range(2):
            fast[first + 2 + 2 * a + b, i] = F[a, b] / kd
    set_vector_flight(passage, first + 6, i, G, c, gamma)
    B0 = B1 = 0.0
    for j in range(nw):
        passage.share[2 * (n * nw + j), i], passage.share[2 * (n * nw + j) + 1, i] = H[j, 0], H[j, 1]
        B0, B1 = B0 + G[0, j + 2] * H[j, 0], B1 + G[0, j + 2] * H[j, 1]
    passage.wiggle[4 * n, i], passage.wiggle[4 * n + 1, i] = abs(B0), abs(B1)
    passage.wiggle[4 * n + 2, i] = abs(B0 * (F[0, 0] - gamma) + B1 * F[1, 0])
    passage.wiggle[4 * n + 3, i] = abs(B0 * F[0, 1] + B1 * (F[1, 1] - gamma))
    for j in range(size):
        passage.manifold[2 * n * size + j, i], passage.manifold[(2 * n + 1) * size + j, i] = L[0, j], L[1, j]
        for m in range(len(G) - 1):
            passage.slow[(n * (len(G) - 1) + m) * size + j, i] = S[2 * m + 1, j]


@jit
def set_coupling(passage, G, omega):
    """C and D. Returns about how fast the slow motion is."""
    C, D = passage.C, passage.D
    size, nw, rate = len(D), 2 * len(G) - 2, omega
    for i in range(size):
        C[i, 0] = C[i, 1] = 0.0
        for j in range(size):
            D[i, j] = 0.0
    for m in range(1, len(G)):
        r, stiff, damped = 2 * m - 2, 0.0, 0.0
        D[r, r + 1] = 1.0
        C[r + 1, 0], C[r + 1, 1] = G[m, 0], G[m, 1]
        for j in range(size):
            D[r + 1, j] = G[m, j + 2]
        for j in range(0, nw, 2):
            stiff, damped = stiff + abs(G[m, j + 2]), damped + abs(G[m, j + 3])
        rate = max(rate, math.sqrt(stiff) + damped)
    D[nw, nw + 1], D[nw + 1, nw] = omega, -omega
    return rate


@jit
def set_manifold(passage, G):
    """L = A^-1 (L S - B) and S = D + C L. Returns whether they converge."""
    C, D, S, L, old = passage.C, passage.D, passage.S, passage.L, passage.old
    size, last = len(S), False
    for j in range(size):
        L[0, j] = L[1, j] = 0.0
    for _ in range(ROUNDS):
        for i in range(size):
            for j in range(size):
                S[i, j] = D[i, j] + C[i, 0] * L[0, j] + C[i, 1] * L[1, j]
        if last:
            return True
        moved, place, turned, slope = 0.0, 0.0, 0.0, 0.0
        for j in range(size):
            old[0, j], old[1, j] = L[0, j], L[1, j]
        for j in range(size):
            x, v = 0.0, -G[0, j + 2]
            for e in range(size):
                x, v = x + old[0, e] * S[e, j], v + old[1, e] * S[e, j]
            L[0, j], L[1, j] = (v - G[0, 1] * x) / G[0, 0], x
            moved, place = moved + abs(L[0, j] - old[0, j]), place + abs(L[0, j])
            turned, slope = turned + abs(L[1, j] - old[1, j]), slope + abs(L[1, j])
        last = moved <= SAME * place and turned <= SAME * slope
    return False


@jit
def set_share(passage, G, nw):
    """F = A - L C, and H = (C + S H) F^-1, of w2, w2', ... alone. Returns whether it converges."""
    C, S, F, L, H, old = passage.C, passage.S, passage.F, passage.L, passage.H, passage.old
    F[0, 0], F[0, 1], F[1, 0], F[1, 1] = 0.0, 1.0, G[0, 0], G[0, 1]
    for e in range(nw):
        for a in range(2):
            F[a, 0], F[a, 1] = F[a, 0] - L[a, e] * C[e, 0], F[a, 1] - L[a, e] * C[e, 1]
    inverse, last = 1.0 / (F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]), nw == 0
    for i in range(len(H)):
        H[i, 0] = H[i, 1] = 0.0
    for _ in range(ROUNDS):
        if last:
            return True
        moved, size = 0.0, 0.0
        for i in range(nw):
            old[0, i], old[1, i] = H[i, 0], H[i, 1]
        for i in range(nw):
            x, v = C[i, 0], C[i, 1]
            for e in range(nw):
                x, v = x + S[i, e] * old[0, e], v + S[i, e] * old[1, e]
            H[i, 0] = (x * F[1, 1] - v * F[1, 0]) * inverse
            H[i, 1] = (v * F[0, 0] - x * F[0, 1]) * inverse
            moved += abs(H[i, 0] - old[0, i]) + abs(H[i, 1] - old[1, i])
            size += abs(H[i, 0]) + abs(H[i, 1])
        last = moved <= SAME * size
    return False


@jit
def set_vector_flight(passage, first, i, G, c, gamma):
    """J (A - L C + gamma) J^-1 with J = (1, 0; c, 1); K - c c0 is taken as such."""
    C, L, fast = passage.C, passage.L, passage.fast[:]
    K, c0 = -G[0, 0], -G[0, 1] - c
    p = q = r = s = 0.0  # L C
    for e in range(len(C)):
        p, q = p + L[0, e] * C[e, 0], q + L[0, e] * C[e, 1]
        r, s = r + L[1, e] * C[e, 0], s + L[1, e] * C[e, 1]
    p, r = p - c * q, r - c * s
    fast[first, i], fast[first + 1, i] = gamma - c - p, 1.0 - q
    fast[first + 2, i], fast[first + 3, i] = c * c0 - K - (r + c * p), gamma - c0 - (s + c * q)
