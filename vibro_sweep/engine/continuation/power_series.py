"""Power series in z and its conjugate z*, to third order: of the critical multiplier's invariant manifold."""

import numpy as np

from vibro_sweep.engine.continuation.workspace import TERMS
from vibro_sweep.engine.simd.jit import small

POWERS = np.array([(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3)])  # j, k of z^j z*^k
_PLACE = {tuple(power): place for place, power in enumerate(POWERS.tolist())}
PRODUCTS = np.array([  # i, j, k: terms i and j make term k
    (i, j, _PLACE[a + c, b + d])
    for i, (a, b) in enumerate(POWERS.tolist())
    for j, (c, d) in enumerate(POWERS.tolist())
    if (a + c, b + d) in _PLACE
])  # fmt: skip
MIRROR = np.array([_PLACE[k, j] for j, k in POWERS.tolist()])  # of the complex conjugate


@small
def times(a, b, out):
    """out = a b, to third order."""
    for i in range(TERMS):
        out[i] = 0.0
    for i in range(len(PRODUCTS)):
        out[PRODUCTS[i, 2]] += a[PRODUCTS[i, 0]] * b[PRODUCTS[i, 1]]


@small
def put_wave(turn, shift, jets):
    """jets[3] and jets[4]: cos and sin of a phase plus a shift, a series; turn: e^{i phase}. jets[0], jets[1]: room."""
    power, other, c, s = jets[0], jets[1], turn.real, turn.imag
    for m in range(TERMS):
        power[m] = 1.0 if m == 0 else 0.0
        jets[3, m] = jets[4, m] = 0.0
    for k in range(4):
        for m in range(TERMS):
            jets[3, m] += c * power[m]
            jets[4, m] += s * power[m]
        times(power, shift, other)
        for m in range(TERMS):
            power[m] = other[m] / (k + 1)
        c, s = -s, c


@small
def steady(Z, cos, sin, m):
    """Coefficient m of Re(Z e^{i phi})."""
    return Z.real * cos[m] - Z.imag * sin[m]


@small
def grow(G, rows, columns, rate, delay, y, term, turned, jets):
    """y (columns, TERMS) becomes exp(G rate delay) y, delay a series; G has so many rows, what is below stays.

    term, turned : room like y; jets: as of `put_wave`
    """
    power, other = jets[0], jets[1]
    for m in range(TERMS):
        power[m] = 1.0 if m == 0 else 0.0
        for r in range(columns):
            term[r, m] = y[r, m]
    for k in range(1, 4):
        times(power, delay, other)
        for m in range(TERMS):
            power[m] = other[m] * rate / k
            for r in range(columns):
                turned[r, m] = 0j
                if r < rows:
                    for q in range(columns):
                        turned[r, m] += G[r, q] * term[q, m]
        for r in range(columns):
            times(power, turned[r], other)
            for m in range(TERMS):
                term[r, m] = turned[r, m]
                y[r, m] += other[m]
