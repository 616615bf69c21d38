"""Floquet multipliers of periodic orbits: eigenvalues of the monodromy matrix, from its factors.

Over one period tangent vectors Q_0 (orthonormal) become Z = Q_1 D U, with D the growths (diagonal, falling as far as
the vectors have found their directions) and U upper triangular with ones on its diagonal: products of well-conditioned
factors, in which nothing large hides anything small. The monodromy matrix has the eigenvalues of

    Q_0^T Q_1 D U,    and so of    D^1/2 (U Q_0^T Q_1) D^1/2,

a graded matrix, whose small eigenvalues are found as precisely as its large ones (graded.py). Nothing is supposed of
their moduli: some of them, or all, may be of like size.

Their error has two parts: rounding, also that of an impact at a low speed v, on which rounding of the state acts like
1/v^2, times the condition of each; and what the second of two periods changes, times r/(1 - r) with r the largest
modulus, since the orbit itself still comes nearer to the periodic one by r a period.
"""

import math

import numpy as np

from vibro_sweep.engine.motion.orbits import reset_counts
from vibro_sweep.engine.simd.jit import aside, jit
from vibro_sweep.engine.variational import tangent
from vibro_sweep.engine.variational.eigenvalues import eigenvalues
from vibro_sweep.engine.variational.orthonormal import CONDITION, orthonormalise, place_of
from vibro_sweep.engine.variational.tangent_flight import only
from vibro_sweep.model import status

RANGE = 350.0  # of the logarithms of growths that one matrix of floats can hold, and products of two of its entries
APART = 37.0  # logarithm of what is beyond rounding
NEAREST = 1e-6  # to 1, that r is taken to be at most: REPEAT tells no slower approach apart


@jit
def begin_period(e, w, results):
    """Set periodic orbits out for exactly one more period of each."""
    t = e.tangent[0]
    t.collected = True
    for i in range(len(results)):
        o, result = e.orbits[i], results[i]
        o.periods = result.period if o.status == status.OK and result.period > 0 else 0
        if o.periods > 0:
            for _ in range(2):  # where rounding alone was left of a vector, it is not at right angles to the others yet
                orthonormalise(t, only(i))
            tangent.sort_vectors(t, i)
            for m in range(len(t.Z)):
                w.axes[i, m] = t.Z[m, i]
            for n in range(len(t.shear)):
                t.shear[n, i] = 0.0
            reset_counts(o)
            tangent.start_record(t, i)


@aside
def read_period(e, w, results, again):
    """The multipliers over the period that has just passed; `again`: with what has changed since the one before."""
    t = e.tangent[0]
    t.collected = False
    for i in range(len(results)):
        o, result = e.orbits[i], results[i]
        if o.periods > 0 and o.status == status.OK:
            omega, largest = e.flights.oscillator[o.table, 0].omega, o.largest[0]
            for j in range(2, len(t.growth), 2):
                largest = max(largest, o.largest[j])
            graze = 2.0**-52 * (omega * largest / o.slowest) ** 2
            if not find_multipliers(t, i, w.growth[i, 0], w.axes[i], w.matrix, graze, result, again):
                o.status = status.NOT_FINITE


@jit
def product(t, i, axes, row, column):
    """An entry of U Q_0^T Q_1. axes: columns of Q_0, flat."""
    total, size = 0.0, len(t.growth)
    for k in range(row, size):
        weight = 1.0 if k == row else t.shear[place_of(size, row, k), i]
        for m in range(size):
            total += weight * axes[size * m + k] * t.Z[size * m + column, i]
    return total


@jit
def end_of_group(logs, first):
    """Where the directions end that one matrix holds; none for a lost one.

    Past a gap of `APART` nothing of the one side is left in the other: a period ago they have found their directions.
    """
    last = first
    while last < len(logs) and logs[last] > -np.inf and logs[last] > logs[first] - RANGE:
        last += 1
        if last < len(logs) and logs[last] < logs[last - 1] - APART:
            break
    return last


@jit
def find_multipliers(t, i, logs, axes, matrix, graze, result, again):
    """Multipliers by falling modulus, of a pair that with Im > 0 first; the logarithms of their moduli, with errors.

    graze: what rounding of the state does to the slowest impact, relative to its speed.
    """
    first = 0
    while first < len(logs):
        last = end_of_group(logs, first)
        if last == first:
            last = len(logs)
            lose(result, first)
        elif not find_group(t, i, logs, first, last, axes, matrix, graze, result, again):
            return False
        first = last
    return True


@jit
def lose(result, first):
    """The directions from `first` on are lost."""
    for j in range(first, len(result.log_multiplier)):
        result.multiplier_re[j] = result.multiplier_im[j] = result.multiplier_error[j] = 0.0
        result.log_multiplier[j], result.log_error[j] = -np.inf, 0.0


@jit
def find_group(t, i, logs, first, last, axes, matrix, graze, result, again):
    """The multipliers of the directions first .. last - 1."""
    re, im = result.multiplier_re[first:last], result.multiplier_im[first:last]
    log, error = result.log_multiplier[first:last], result.log_error[first:last]
    count, size, scale = last - first, 0.0, logs[first]
    for j in range(count):
        for k in range(count):
            entry = product(t, i, axes, first + j, first + k)
            size += entry * entry
            matrix[j, k] = entry * math.exp(0.5 * (logs[first + j] + logs[first + k]) - scale)
    if not (size < np.inf and eigenvalues(matrix, count, re, im)):
        return False
    sort_moduli(re, im, count)
    for j in range(count):
        before = log[j]
        log[j] = math.log(math.hypot(re[j], im[j])) + scale
        error[j] = abs(log[j] - before) if again else 0.0
    if again:
        r = min(math.exp(result.log_multiplier[0]), 1.0 - NEAREST)
        for j in range(count):
            known = (graze + 2.0**-52 * CONDITION * math.sqrt(size)) * condition(re, im, count, j)
            error[j] = error[j] * max(1.0, r / (1.0 - r)) + min(known, math.sqrt(2.0**-52 * CONDITION))
    for j in range(count):
        re[j] *= math.exp(scale)
        im[j] *= math.exp(scale)
        result.multiplier_error[first + j] = error[j] * math.hypot(re[j], im[j])
    return True


@jit
def sort_moduli(re, im, count):
    """By falling modulus; conjugates stay together."""
    for i in range(1, count):
        x, y, j = re[i], im[i], i
        while j > 0 and math.hypot(re[j - 1], im[j - 1]) < math.hypot(x, y):
            re[j], im[j] = re[j - 1], im[j - 1]
            j -= 1
        re[j], im[j] = x, y


@jit
def condition(re, im, count, j):
    """Of multiplier j relative to itself, for a matrix whose rows are of like size once its grading is taken out."""
    result, own = 1.0, math.hypot(re[j], im[j])
    for k in range(count):
        if k != j:
            larger = max(own, math.hypot(re[k], im[k]))
            apart = math.hypot(re[j] - re[k], im[j] - im[k])
            result *= larger / apart if apart > 0.0 else np.inf
    return result
