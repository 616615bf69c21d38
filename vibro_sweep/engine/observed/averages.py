"""Averages that every orbit on an attractor has, by which it is recognised, and their errors."""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import jit

COARSEST, FINEST = 5, 20  # parts of the record; the longer ones show correlations that the shorter ones miss


@jit
def keep_averages(section, T, repeat, right, left, o, result):
    """Keep the averages of an orbit that has settled, and their errors.

    (2 N + 3,): x1, v1, ... of the section points, impacts and contacts in a forcing period on the right and on the
    left, lambda_1. Of a periodic orbit over one period; the error is how far it can be from where it converges to, if
    its points change by no more than the part `repeat` in a period. Else over the record, with the standard error.

    right, left : impacts and contacts in this time
    """
    mean, error, period = result.average, result.average_error, result.period
    length = period if period > 0 else len(section)
    largest, memory, omega = 0.0, 1.0, 2.0 * math.pi / T
    states = section.shape[1]
    for i in range(states):
        unit = omega if i % 2 == 1 else 1.0  # of velocities, in that of places
        mean[i], square = 0.0, 0.0
        for n in range(len(section) - length, len(section)):
            mean[i] += section[n, i] / length
            square += section[n, i] ** 2 / length
            largest = max(largest, abs(section[n, i]) / unit)
        error[i] = standard_error(section, i, mean[i])
        spread = square - mean[i] ** 2
        if spread > error[i] ** 2:
            memory = max(memory, error[i] ** 2 * length / spread)
    mean[states], mean[states + 1] = right / length, left / length
    mean[states + 2], error[states + 2] = result.lyapunov[0], result.lyapunov_error[0]
    # as if impacts came in bunches, one in each time in which the orbit forgets itself
    error[states] = math.sqrt(max(right, 1) * memory) / length
    error[states + 1] = math.sqrt(max(left, 1) * memory) / length
    if period > 0:
        error[states] = error[states + 1] = o.chatters / length  # rounding may end a listed sequence one impact earlier
        for i in range(states):  # steps that shrink by the greatest multiplier, summed up
            size = largest * omega if i % 2 == 1 else largest
            error[i] = repeat * size / max(-math.expm1(mean[states + 2] * period * T), repeat)


@jit
def standard_error(section, i, mean):
    """The standard error of the mean of coordinate i, from the scatter of parts of several lengths; NaN: a short
    record."""
    largest, parts = np.nan, COARSEST
    while parts <= min(FINEST, len(section)):
        size, scatter = len(section) // parts, 0.0
        for m in range(parts):
            part = 0.0
            for n in range(m * size, (m + 1) * size):
                part += section[n, i] / size
            scatter += (part - mean) ** 2
        error = math.sqrt(scatter / (parts * (parts - 1.0)))
        largest = error if not largest >= error else largest
        parts *= 2
    return largest
