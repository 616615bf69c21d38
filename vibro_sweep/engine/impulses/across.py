"""Newton's method for the point of a branch on a plane, along a parameter that moves stops and restitutions only.

The response to an impulse is the same all along such a branch, and what stops and restitutions are is linear in the
parameter.
"""

import numpy as np

from vibro_sweep.engine.impulses.elimination import solve_scaled
from vibro_sweep.engine.impulses.equations import GAIN, GAIN_SLOPE, ROUNDING, STOP, STOP_SLOPE, equations
from vibro_sweep.engine.simd.jit import entry

MOST_CORRECTIONS = 12


@entry
def correct(train, q, at_begin, begin, contacts, scale, guess, normal, size, x, J, motion, work, matrix):
    """The point x on the plane through `guess` across `normal`: (corrections, last change); 0 corrections: none found.

    x, guess and normal have 2K + free unknowns and the parameter, in units of `scale` (n + 1,). J (n, n + 1) are the
    equations' derivatives at x in these units; motion (K, 3): gap velocity, acceleration and jerk before each impact.

    at_begin : (K, 4) contacts at the value `begin` of the parameter
    contacts : (K, 4) becomes those at the value of x before the last correction
    size : of the gap
    work : (7, n + 1) or more columns
    matrix : (n + 1, n + 1)
    """
    K, n = len(contacts), len(x) - 1
    u, F, Fp, right, rows, scratch = work[0], work[1], work[2], work[3], work[4], work[5:7]
    before = np.inf
    for i in range(K):
        for j in range(4):
            contacts[i, j] = at_begin[i, j]
    for i in range(n + 1):
        x[i] = guess[i]
    for count in range(1, MOST_CORRECTIONS + 1):
        moved = x[n] * scale[n] - begin
        for i in range(K):
            contacts[i, STOP] = at_begin[i, STOP] + at_begin[i, STOP_SLOPE] * moved
            contacts[i, GAIN] = at_begin[i, GAIN] + at_begin[i, GAIN_SLOPE] * moved
        for i in range(n):
            u[i] = x[i] * scale[i]
        equations(train, q, contacts, u, F, J, Fp, motion, scratch)
        held, last = 0.0, 0.0
        for i in range(K):
            held = max(held, abs(F[i]))
        for i in range(n):
            for j in range(n):
                J[i, j] *= scale[j]
                matrix[i, j] = J[i, j]
            J[i, n] = Fp[i] * scale[n]
            matrix[i, n], right[i] = J[i, n], F[i]
        for j in range(n + 1):
            matrix[n, j] = normal[j]
            last += normal[j] * (x[j] - guess[j])
        right[n] = last
        if not solve_scaled(matrix, right, n + 1, rows):
            return 0, np.nan
        change = 0.0
        for i in range(n + 1):
            change = max(change, abs(right[i]))
            x[i] -= right[i]
        if not change <= 1.0:
            return 0, np.nan
        for i in range(K):
            following = x[i + 1] * scale[i + 1] if i + 1 < K else x[0] * scale[0] + train.P
            if not following > x[i] * scale[i]:
                return 0, np.nan
        most = 1e-7 if held <= ROUNDING * size else 1e-9
        if change <= 1e-15 or (change < most and change >= 0.3 * before):
            return count, change
        before = change
    return 0, np.nan
