"""M2 alone, while M1 rests on a stop: an oscillator of one degree of freedom, and the pull on M1.

    mu_m x2'' + 2 zeta (1 + mu_k) x2' + (1 + mu_k) x2 = x1 + f2 sin(omega t + tau),      x1 = const      (eq. 3)

Where the cells resolve its rate, a Taylor series reaches over a cell. Where they do not, it takes small steps to look
for the release, but the state at each is the closed form from where the cell, or the rest, began: 10^5 steps that each
begin with the rounded end of the one before would lose five digits. Such an oscillator is never in resonance, so that
its steady response is no larger than its motion.
"""

import math

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER, WIDTH, decaying, evaluate
from vibro_sweep.engine.tables.stiff import rate_of


@jit
def fill_rest(q, mu_m, mu_k, f2):
    """Fill the step of the series of M2 alone, and its closed form."""
    zeta, omega = q.zeta, q.omega
    square = (1.0 + mu_k) / mu_m
    rate = max(omega, rate_of(square, zeta))
    q.rest_step = q.width if rate * q.width <= 1.0001 * WIDTH else q.width / math.ceil(rate * q.width / WIDTH)
    # x2 = static x1 + A sin + B cos, the steady response (7) of this oscillator
    detuning, damping = square - omega * omega, 2.0 * zeta * square * omega
    size = f2 / mu_m / (detuning * detuning + damping * damping)
    q.rest_square, q.rest_static = square, 1.0 / (1.0 + mu_k)
    q.rest_response[0], q.rest_response[1] = size * detuning, -size * damping


@jit
def carry_over_rest(q, w):
    """The matrix by which a rest of the time w within a cell multiplies (dx2, dv2), by rows."""
    if w <= q.rest_step:
        xx, vx = evaluate(q.resting[1, 1], w)
        xv, vv = evaluate(q.resting[1, 2], w)
        return xx, xv, vx, vv
    _, s, xi, rate = decaying(q.zeta * q.rest_square, q.rest_square, w)
    return xi, s, -q.rest_square * s, rate


@jit
def state_after(q, x1, x2, v2, sin, cos, w):
    """x2, v2, sin and cos after a rest of the time w, in closed form."""
    xx, xv, vx, vv = carry_over_rest(q, w)
    a, b, omega = q.rest_response[0], q.rest_response[1], q.omega
    swing, turn = math.sin(omega * w), math.cos(omega * w)
    later, across = sin * turn + cos * swing, cos * turn - sin * swing
    middle = q.rest_static * x1
    x = x2 - (middle + (a * sin + b * cos))
    v = v2 - omega * (a * cos - b * sin)
    x, v = xx * x + xv * v, vx * x + vv * v
    return x + (middle + (a * later + b * across)), v + omega * (a * across - b * later), later, across


@jit
def bound_third_over(c, h):
    """A bound on the third derivative of the polynomial c over [0, h]."""
    total = 0.0
    for n in range(ORDER - 1, 2, -1):
        total = total * h + n * (n - 1.0) * (n - 2.0) * abs(c[n])
    return total
