"""Multipliers from the factors of a monodromy matrix, D^1/2 (U Q_0^T Q_1) D^1/2 (multipliers.py), and their errors.

Its small eigenvalues are found as precisely as its large ones (graded.py), in groups that fit the floats. Nothing is
supposed of their moduli: some of them, or all, may be of like size.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.twofold import add
from vibro_sweep.engine.variational.eigenvalues import eigenvalues
from vibro_sweep.engine.variational.orthonormal import CONDITION

RANGE = 350.0  # of the logarithms of growths that one matrix of floats can hold, and products of two of its entries
APART = 37.0  # logarithm of what is beyond rounding
NEAREST = 1e-6  # to 1, that r is taken to be at most: REPEAT distinguishes no slower approach
OF_LAST = 1e-6  # of the last multiplier, that may be rounding
FIRST, AGAIN, BESIDE = range(3)  # the periods


def multipliers_of(count: int) -> np.dtype:
    """The record of so many multipliers of an orbit, by falling modulus."""
    fields = [(name, float, (count,)) for name in ("re", "im", "error", "log", "log_error")]  # log: of the modulus
    # how many were sought; what rounding leaves of all `log` together; and of the one beyond as many as there are
    # states its `log` without the growth of the vector that moves a stop alone
    fields += [("count", np.int64), ("low", float), ("beyond", float)]
    # by how much, as a logarithm, tangent vectors grew more than what contacts do to volumes explains
    fields += [("excess", float)]
    # of the orbit itself while another is followed beside it
    fields += [("impacts_left", np.int64), ("impacts_right", np.int64), ("rest_time", float), ("pressed_time", float)]
    return np.dtype(fields)


@jit
def end_of_group(logs, first):
    """The end of the directions that one matrix holds; none for a lost one.

    Past a gap of `APART` nothing of the one side is left in the other: a period ago they have found their directions.
    """
    last = first
    while last < len(logs) and logs[last] > -np.inf and logs[last] > logs[first] - RANGE:
        last += 1
        if last < len(logs) and logs[last] < logs[last - 1] - APART:
            break
    return last


@jit
def find_multipliers(law, product, logs, low, matrix, graze, off, found, beside, which):
    """Multipliers by falling modulus, of a pair that with Im > 0 first; the logarithms of their moduli, with errors.

    graze: what rounding of the state does to the slowest impact, relative to its speed. off: rounding of the orbit over
    how far it began beside it. logs, low (n,): in two floats. beside (3, n): scratch.
    """
    first, count = 0, len(logs)
    if which != BESIDE:
        found.low = 0.0
    while first < count:
        last = end_of_group(logs, first)
        if last == first:
            break
        if which == BESIDE:
            if not widen_group(product, logs, low, first, last, matrix, found, beside, off):
                return False
        elif not find_group(law, product, logs, low, first, last, matrix, graze, found, beside, which == AGAIN):
            return False
        if law is not None:
            eliminate(product, first, last, count)
        first = last
    if which != BESIDE:
        if law is not None:
            close_product(logs, low, found, first, count)
        lose(found, first)
    return True


@jit
def close_product(logs, low, found, first, count):
    """What rounding has done to the last multiplier, or pair: U, Q_0 and Q_1 have the determinant 1, so that all
    multipliers together are the product of the growths, if none from `first` on is lost. More than rounding stays, and
    what is taken back remains in the errors: rounding may have been in another multiplier."""
    more, rest, last = 0.0, found.low, count - 1
    for j in range(count):
        more, rest = add(more, rest, found.log[j], 0.0)
        more, rest = add(more, rest, -logs[j], -low[j])
    if first == count and abs(more) < OF_LAST:
        pair = 2 if found.im[last] != 0.0 else 1
        share = more / pair
        for j in range(count - pair, count):
            found.log[j], rest = add(found.log[j], 0.0, -share, 0.0)
            found.low += rest
            found.re[j], found.im[j] = found.re[j] * math.exp(-share), found.im[j] * math.exp(-share)
            found.log_error[j] += abs(share)
            found.error[j] += abs(share) * math.hypot(found.re[j], found.im[j])


@jit
def eliminate(product, first, last, count):
    """Take out of later directions what they have of this group: the eigenvalues of a graded matrix, of which each
    group is larger than the next by far, are those of its Schur complements.

    Contacts of low speed, on which rounding acts, turn directions from one period to the next.
    """
    for m in range(first, last):
        pivot = m
        for row in range(m + 1, last):
            if abs(product[row, m]) > abs(product[pivot, m]):
                pivot = row
        if product[pivot, m] == 0.0:
            return
        for j in range(count):
            product[m, j], product[pivot, j] = product[pivot, j], product[m, j]
        for row in range(m + 1, count):
            ratio = product[row, m] / product[m, m]
            for j in range(m, count):
                product[row, j] -= ratio * product[m, j]


@jit
def lose(found, first):
    """The directions from `first` on are lost."""
    for j in range(first, len(found.log)):
        found.re[j] = found.im[j] = found.error[j] = found.log_error[j] = 0.0
        found.log[j] = -np.inf


@jit
def find_group(law, product, logs, low, first, last, matrix, graze, found, beside, again):
    """The multipliers of the directions first .. last - 1."""
    re, im, turned = beside[1], beside[2], found.error[first:last]
    log, error = found.log[first:last], found.log_error[first:last]
    count, scale = last - first, logs[first]
    size = solve_group(product, logs, low, first, count, matrix, re, im)
    if not size < np.inf:
        return False
    for j in range(count):
        before = log[j]
        log[j] = math.log(math.hypot(re[j], im[j])) + scale
        if law is not None:
            if log[j] > -np.inf:
                found.low += math.log(math.hypot(re[j], im[j])) - (log[j] - scale) + low[first]
        error[j] = abs(log[j] - before) if again else 0.0
        turned[j] = turn(re[j], im[j], found.re[first + j], found.im[first + j])
    if again:
        r = min(math.exp(found.log[0]), 1.0 - NEAREST)
        for j in range(count):
            known = (graze + 2.0**-52 * CONDITION * math.sqrt(size)) * condition(re, im, count, j)
            error[j] = error[j] * max(1.0, r / (1.0 - r)) + min(known, math.sqrt(2.0**-52 * CONDITION))
            turned[j] *= max(1.0, r / (1.0 - r))
    for j in range(count):
        x, y = re[j] * math.exp(scale), im[j] * math.exp(scale)
        found.re[first + j], found.im[first + j] = x, y
        turned[j] = (error[j] + turned[j]) * math.hypot(x, y)
    return True


@jit
def turn(x, y, other_x, other_y):
    """The angle, if it is small, between two complex numbers; 0 where one of them is 0."""
    one, other = math.hypot(x, y), math.hypot(other_x, other_y)
    if not (one > 0.0 and other > 0.0):
        return 0.0
    return math.hypot(x / one - other_x / other, y / one - other_y / other)


@jit
def solve_group(product, logs, low, first, count, matrix, re, im):
    """The multipliers of so many directions, in units of exp(logs[first]). Returns the square of the matrix's size."""
    size = 0.0
    for j in range(first, first + count):
        for k in range(first, first + count):
            entry = product[j, k]
            size += entry * entry
            rest = 0.5 * (low[j] + low[k]) - low[first]
            matrix[j - first, k - first] = entry * math.exp(0.5 * (logs[j] + logs[k]) - logs[first] + rest)
    if not (size < np.inf and eigenvalues(matrix, count, re, im)):
        return np.inf
    sort_moduli(re, im, count)
    return size


@jit
def widen_group(product, logs, low, first, last, matrix, found, beside, off):
    """Add what rounding of the orbit does to these multipliers; off: as of `find_multipliers`.

    What happens in a period moves the section point of the periodic orbit by (1 - M)^-1 times as much.
    """
    re, im, count = beside[1], beside[2], last - first
    if not solve_group(product, logs, low, first, count, matrix, re, im) < np.inf:
        return False
    apart = 1.0
    for j in range(len(found.re)):
        apart = min(apart, math.hypot(1.0 - found.re[j], found.im[j]))
    part = off / max(apart, NEAREST)
    for j in range(count):
        n = first + j
        old, modulus = found.log[n], math.hypot(found.re[n], found.im[n])
        if old == -np.inf or re[j] == im[j] == 0.0:
            continue
        unit = math.exp(logs[first] - old)
        found.log_error[n] += part * abs(math.log(unit * math.hypot(re[j], im[j])))
        if modulus > 0.0:
            x, y = found.re[n] / modulus, found.im[n] / modulus
            found.error[n] += part * modulus * math.hypot(unit * re[j] - x, unit * im[j] - y)
    return True


@jit
def sort_moduli(re, im, count):
    """Sort multipliers by falling modulus; conjugates stay together."""
    for i in range(1, count):
        x, y, j = re[i], im[i], i
        while j > 0 and math.hypot(re[j - 1], im[j - 1]) < math.hypot(x, y):
            re[j], im[j] = re[j - 1], im[j - 1]
            j -= 1
        re[j], im[j] = x, y


@jit
def condition(re, im, count, j):
    """The condition number of multiplier j relative to itself, for a matrix whose rows are of like size once its
    grading is taken out."""
    result, own = 1.0, math.hypot(re[j], im[j])
    for k in range(count):
        if k != j:
            larger = max(own, math.hypot(re[k], im[k]))
            apart = math.hypot(re[j] - re[k], im[j] - im[k])
            result *= larger / apart if apart > 0.0 else np.inf
    return result
