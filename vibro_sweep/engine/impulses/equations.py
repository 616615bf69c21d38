"""The equations of a periodic orbit with impacts at t_1 .. t_K, as compiled kernels.

    g(t) = g_lin(t) + c + sum_k D_k gamma_sigma(t - t_k)
    g(t_i) = stop_i        D_i + (1 + R_i) g'(t_i -) = 0        sum_k D_k + momentum of the constant force = 0

Unknowns u = (t_1 .. t_K, D_1 .. D_K), and the constant c with the last equation, only where the contact sees a free
mode. Nothing is singular at D = 0, a graze.

Towards the end of a chatter sequence flights and speeds vanish. From one impact to the next, after a short flight from
the same stop, only what changes is summed up, so that rounding shrinks with the flight:

    g(t_i) = g(t_{i-1}) + [g]        g'(t_i -) = g'(t_{i-1} -) + D_{i-1} + [g'],        [f] = f(t_i -) - f(t_{i-1} +)
"""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.elimination import solve_scaled
from vibro_sweep.engine.impulses.tables import ORDER
from vibro_sweep.engine.simd.jit import entry, jit

STOP, GAIN, STOP_SLOPE, GAIN_SLOPE = range(4)  # columns of `contacts`; gain: 1 + R


class Steady(NamedTuple):
    """g_lin = mean + Re(gain e^{i omega t}), and the derivatives by a parameter."""

    omega: float
    mean: float
    real: float
    imag: float
    d_omega: float
    d_mean: float
    d_real: float
    d_imag: float
    free: bool  # whether the contact sees a free mode
    momentum: float  # of the constant force over P in the free mode, as a jump of the gap velocity
    d_momentum: float


@jit
def polynomial(c, u, out):
    """Value and first three derivatives at u of the polynomial with coefficients c (ORDER + 1,)."""
    p, p1, p2, p3 = c[ORDER], 0.0, 0.0, 0.0
    for n in range(ORDER - 1, -1, -1):
        p3 = p3 * u + p2
        p2 = p2 * u + p1
        p1 = p1 * u + p
        p = p * u + c[n]
    out[0], out[1], out[2], out[3] = p, p1, 2.0 * p2, 6.0 * p3


@jit
def response(table, width, s, out):
    """gamma and three derivatives at 0 <= s <= P."""
    k = min(max(int(s / width), 0), len(table) - 1)
    polynomial(table[k], s - k * width, out)


@jit
def delayed(train, t, i, k, out, slope):
    """gamma^(n)(t_i - t_k) before what happens at t_i, n = 0 .. 3; and their derivatives by the parameter, t fixed."""
    s = t[i] - t[k]
    factor = 1.0
    if i < k:
        s += train.P
        factor = train.ratio
    response(train.coefficients, train.width, s, out)
    changed = len(train.slopes) > 0
    for n in range(4):
        slope[n] = 0.0
    if changed:
        response(train.slopes, train.width, s, slope)
        if i < k:
            for n in range(3):
                slope[n] += out[n + 1] * train.P_slope
    for n in range(4):
        if i == k:
            out[n] -= train.jumps[n]
            slope[n] -= train.jump_slopes[n]
        out[n] *= factor
        slope[n] *= factor


SHORT = 1 / 16  # of a cell: a flight within which the polynomial of the cell in which it begins still holds


@jit
def follows(train, contacts, t, i):
    """Whether impact i comes after a short flight from the same stop."""
    return i > 0 and contacts[i, STOP] == contacts[i - 1, STOP] and t[i] - t[i - 1] < SHORT * train.width


@jit
def added(train, t, i, k, out):
    """[gamma(t - t_k)] and [gamma'(t - t_k)] over the flight from t_{i-1} to t_i: by divided differences."""
    y, s, factor = t[i - 1] - t[k], t[i] - t[i - 1], 1.0
    if k >= i:
        y += train.P
        factor = train.ratio
    cell = min(max(int(y / train.width), 0), len(train.coefficients) - 1)
    c, y = train.coefficients[cell], y - cell * train.width
    x = y + s
    p, p1, d, d1 = c[ORDER], 0.0, 0.0, 0.0  # p(x) - p(y) = (x - y) d; d1: the same of the derivative
    for n in range(ORDER - 1, -1, -1):
        d, p = d * x + p, p * y + c[n]
        d1, p1 = d1 * x + p1, p1 * y + (n + 1) * c[n + 1]
    out[0], out[1] = factor * s * d, factor * s * d1


@jit
def steady_gap(q, t, out, slope):
    """g_lin and three derivatives at t, and the parameter's."""
    c, s = math.cos(q.omega * t), math.sin(q.omega * t)
    power, d_power = 1.0, 0.0  # omega^n
    for n in range(4):
        out[n] = power * (q.real * c - q.imag * s)
        turned = -q.real * s - q.imag * c
        slope[n] = power * (q.d_real * c - q.d_imag * s + q.d_omega * t * turned) + d_power * (q.real * c - q.imag * s)
        d_power = d_power * q.omega + power * q.d_omega
        power *= q.omega
        c, s = -s, c
    out[0] += q.mean
    slope[0] += q.d_mean


@jit
def steady_added(q, t, i, out):
    """[g_lin] and [g_lin'] over the flight from t_{i-1} to t_i."""
    middle, turned = 0.5 * q.omega * (t[i - 1] + t[i]), 2.0 * math.sin(0.5 * q.omega * (t[i] - t[i - 1]))
    d_cos, d_sin = -math.sin(middle) * turned, math.cos(middle) * turned
    out[0], out[1] = q.real * d_cos - q.imag * d_sin, -q.omega * (q.real * d_sin + q.imag * d_cos)


@jit
def equations(train, q, contacts, u, F, J, Fp, motion, scratch):
    """Residual F, Jacobian J = dF/du, Fp = dF/dp, and g', g'', g''' before each impact: motion (K, 3).

    F and Fp: (2K + free,). scratch: (2, 4). A J of shape (0, 0) is not wanted.
    """
    K, dense = len(contacts), len(J) > 0
    t, D = u[:K], u[K : 2 * K]
    out, slope = scratch[0], scratch[1]
    size = 2 * K + (1 if q.free else 0)
    for i in range(K):
        gain, d_gain = contacts[i, GAIN], contacts[i, GAIN_SLOPE]
        steady_gap(q, t[i], out, slope)
        gap, v, a, jerk = out[0], out[1], out[2], out[3]
        d_gap, d_v = slope[0], slope[1]
        for k in range(K):
            delayed(train, t, i, k, out, slope)
            gap += D[k] * out[0]
            v += D[k] * out[1]
            a += D[k] * out[2]
            jerk += D[k] * out[3]
            d_gap += D[k] * slope[0]
            d_v += D[k] * slope[1]
            if dense:
                J[i, k] = -D[k] * out[1]
                J[i, K + k] = out[0]
                J[K + i, k] = -gain * D[k] * out[2]
                J[K + i, K + k] = gain * out[1]
        if q.free:
            gap += u[2 * K]
            if dense:
                J[i, 2 * K] = 1.0
                J[K + i, 2 * K] = 0.0
        F[i] = gap - contacts[i, STOP]
        if follows(train, contacts, t, i):
            steady_added(q, t, i, out)
            rise, faster = out[0], out[1]
            for k in range(K):
                added(train, t, i, k, out)
                rise += D[k] * out[0]
                faster += D[k] * out[1]
            F[i] = F[i - 1] + rise
            v = motion[i - 1, 0] + D[i - 1] + faster
        F[K + i] = D[i] + gain * v
        Fp[i] = d_gap - contacts[i, STOP_SLOPE]
        Fp[K + i] = gain * d_v + d_gain * v
        if dense:
            J[i, i] += v
            J[K + i, i] += gain * a
            J[K + i, K + i] += 1.0
        motion[i, 0], motion[i, 1], motion[i, 2] = v, a, jerk
    if q.free:
        last = size - 1
        F[last], Fp[last] = q.momentum, q.d_momentum
        for k in range(K):
            F[last] += D[k]
            if dense:
                J[last, k], J[last, K + k] = 0.0, 1.0
        if dense:
            J[last, last] = 0.0


@entry
def evaluate(train, q, contacts, u, F, J, Fp, motion, scratch):
    """`equations`, for Python."""
    equations(train, q, contacts, u, F, J, Fp, motion, scratch)


@entry
def linearised(train, contacts, u, motion, J, scratch):
    """J(mu), (2K, 2K): the equations linearised with gamma of ratio sigma/mu about an orbit with this `motion`.

    det J(mu) = prod_i g'(t_i -) prod_j (mu - mu_j)/(mu - sigma e^{l_j P}): zero at the multipliers mu_j (orbits.md).
    """
    K = len(contacts)
    t, D = u[:K], u[K : 2 * K]
    for i in range(K):
        gain = contacts[i, GAIN]
        for k in range(K):
            delayed(train, t, i, k, scratch[0], scratch[1])
            J[i, k] = -D[k] * scratch[0, 1]
            J[i, K + k] = scratch[0, 0]
            J[K + i, k] = -gain * D[k] * scratch[0, 2]
            J[K + i, K + k] = gain * scratch[0, 1]
        J[i, i] += motion[i, 0]
        J[K + i, i] += gain * motion[i, 1]
        J[K + i, K + i] += 1.0


MOST_STEPS = 30
LAST = 5  # of them
ROUNDING = 1e-13  # of the gap's size


@jit
def newton(train, q, contacts, u, size, F, J, Fp, motion, scratch, rows):
    """Newton's method on u, in place. Returns the size of the last step relative to u, or NaN without convergence.

    Steps longer than a quarter of the least distance between impacts are shortened. It has converged where steps grow
    no smaller; steps up to 1e-7, as slow impacts leave them, count if the equations hold to rounding. Near a fold each
    step is half of the one before: that is no end yet. Of many impacts rounding leaves more, beside a fold most: where
    the last steps of all are small and shrink no more, the largest of them says how much.
    """
    K, earlier, last = len(contacts), 0.0, 0.0
    before, gap = np.inf, math.hypot(q.real, q.imag)
    for i in range(K):
        gap = max(gap, abs(contacts[i, STOP]))
    for count in range(MOST_STEPS):
        equations(train, q, contacts, u, F, J, Fp, motion, scratch)
        left = 0.0
        for i in range(K):
            left = max(left, abs(F[i]), abs(F[K + i]) / q.omega)
        most = 1e-7 if left <= ROUNDING * gap else 1e-9
        if not solve_scaled(J, F, size, rows):
            return np.nan
        longest, reach = 0.0, train.P
        speed = max(q.omega * math.hypot(q.real, q.imag), abs(q.momentum))  # D itself may vanish
        for i in range(K):
            longest = max(longest, abs(F[i]))
            speed = max(speed, abs(u[K + i]))
            following = u[i + 1] if i + 1 < K else u[0] + train.P
            reach = min(reach, following - u[i])
        change = longest / train.P
        for i in range(K, 2 * K):
            change = max(change, abs(F[i]) / (speed + abs(F[i])))
        if not change < np.inf:
            return np.nan
        damping = min(1.0, 0.25 * reach / longest) if longest > 0.0 else 1.0
        for i in range(size):
            u[i] -= damping * F[i]
        for i in range(K):
            following = u[i + 1] if i + 1 < K else u[0] + train.P
            if not following > u[i]:
                return np.nan
        if damping == 1.0 and (
            change <= 4e-16 or (change < most and change >= (0.5 if change < 1e-12 else 0.8) * before)
        ):
            return change
        before = change if damping == 1.0 else np.inf
        if count >= MOST_STEPS - LAST:
            last = max(last, before)
        elif count >= MOST_STEPS - 2 * LAST:
            earlier = max(earlier, before)
    return max(earlier, last) if max(earlier, last) < 1e-7 and last > 0.25 * earlier else np.nan


@entry
def newton_batch(train, q, contacts, starts, ends, change, F, J, Fp, motion, scratch, rows):
    """`newton` from many guesses: starts and ends (m, 2K + free), contacts (m, K, 4), change (m,)."""
    size = starts.shape[1]
    for m in range(len(starts)):
        for i in range(size):
            ends[m, i] = starts[m, i]
        change[m] = newton(train, q, contacts[m], ends[m], size, F, J, Fp, motion, scratch, rows)
