"""Tests and certificate of a point of a branch; what happens between two points."""

import math

import numpy as np

from vibro_sweep.engine.impulses.elimination import sign_of_determinant, solve
from vibro_sweep.engine.impulses.extremes import OVERLAP, extremes_of_cell, turns_near
from vibro_sweep.engine.impulses.medium import GAIN_HIGH, GAIN_LOW, HIGH, LOW, PERIOD, combined, set_phase
from vibro_sweep.engine.impulses.pairs import ON_PAIR, ON_SQUARE, exchanged
from vibro_sweep.engine.impulses.places import (
    ABOVE,
    AWAY,
    BELOW,
    CROSSING,
    DEFECT_HERE,
    FLIP,
    LENGTH,
    MARGIN,
    ON_CIRCLE,
    PAIRS,
    REFLECTION,
    TANGENT,
    TORUS,
    P,
)
from vibro_sweep.engine.impulses.tables import ORDER
from vibro_sweep.engine.simd.jit import aside, jit
from vibro_sweep.engine.simd.lanes import number
from vibro_sweep.engine.simd.memory import put
from vibro_sweep.engine.variational.eigenvalues import eigenvalues

FARTHER = 2.0  # times: a number that is so much nearer to zero than at the points beside changes too fast between them
ZERO = ON_SQUARE**2, ON_PAIR**2  # of |1 + mu|^2 and |1 - mu_i mu_j|^2: what no point of a branch comes to by chance
FAR_OUTSIDE = 0.5  # of |mu|^2 - 1: multipliers from there on do not reach the circle within a step and go back


@jit
def may_turn(f, zeta, low, high, nearest):
    """`turns_near` of the cell that begins with zeta."""
    middle, rest = combined(zeta, f.middle, 0), 0.0
    for j in range(len(zeta)):
        rest += abs(zeta[j]) * f.rest[j]
    value, slope, curve, jerk = number(middle, 0), number(middle, 1), number(middle, 2), number(middle, 3)
    return turns_near(value, slope, curve, jerk, rest, low, high, nearest)


@jit
def certify(f, sides, sigma, place, room, strikes):
    """The least distance of a turning point from its stop, the largest jump between flights, motion before impacts."""
    K, n, m = len(sides), room.E.shape[0], room.E.shape[1]
    N = n // 2
    low, high = f.numbers[LOW], f.numbers[HIGH]
    nearest, c, zeta = room.nearest, room.cell, room.zeta[0]
    nearest[0], largest = np.inf, 0.0
    for i in range(K):
        for j in range(n):
            zeta[j] = place.z[i, j]
        gain = f.numbers[GAIN_HIGH if sides[i] > 0 else GAIN_LOW]
        zeta[N] = zeta[N] + place.D[i] if gain > 1.0 else 0.0  # not even rounding is left of it
        set_phase(f, zeta, place.t[i])
        a = -f.B[N, N] * place.D[i]
        for j in range(m):
            a += f.B[N, j] * zeta[j]
        strikes[i].motion[0], strikes[i].motion[1] = place.z[i, N], a
        length = (place.t[i + 1] if i + 1 < K else place.t[0] + f.numbers[PERIOD]) - place.t[i]
        cells = int(length / f.width)
        for k in range(cells + 1):
            turns = may_turn(f, zeta, low, high, nearest[0])
            if turns or k == cells:
                put(room.cell, 0, combined(zeta, f.gap_rows, 0))
            width = min(f.width * OVERLAP, length - k * f.width)
            if turns and width > 0.0:
                extremes_of_cell(c, width, low, high, nearest, room.waiting)
            if k < cells:
                put(room.zeta, 0, combined(zeta, f.step, 0))
        last, power = 0.0, 1.0
        u = max(length - cells * f.width, 0.0)
        for q in range(ORDER + 1):  # of the last cell
            last += c[q] * power
            power *= u
        aim = place.z[i + 1, 0] if i + 1 < K else sigma * place.z[0, 0]
        largest = max(largest, abs(last - aim))
    place.numbers[MARGIN], place.numbers[DEFECT_HERE] = nearest[0], largest


@jit
def test(f, sides, sigma, place, room, strikes):
    """The tests at a corrected point: reflection (flip, pitchfork), torus, releases."""
    K, n = len(sides), room.E.shape[0]
    for r in range(n):
        for j in range(n):
            room.matrix[r, j] = room.behind[r, j] - sigma * room.ahead[r, j]
    place.numbers[REFLECTION] *= sign_of_determinant(room.matrix)
    for i in range(K):
        gain = f.numbers[GAIN_HIGH if sides[i] > 0 else GAIN_LOW]
        after = strikes[i].motion[1] + place.D[i] * f.B[n // 2, n // 2]
        place.releases[i] = -sides[i] * after if gain == 1.0 else np.inf
    x = place.numbers
    x[TORUS], x[ABOVE], x[ON_CIRCLE], x[FLIP], x[CROSSING] = 1.0, -1.0, 0.0, 1.0, 1.0
    for i in range(n):
        place.multipliers[i, 0] = place.multipliers[i, 1] = np.nan
    # multipliers: eigenvalues of -sigma ahead^-1 behind
    a = room.pair
    for r in range(n):
        for j in range(n):
            a[r, j], a[r, n + j] = room.ahead[r, j], -sigma * room.behind[r, j]
    if not solve(a):
        return
    for r in range(n):
        for j in range(n):
            room.matrix[r, j] = a[r, n + j]
    if not eigenvalues(room.matrix, n, room.re, room.im):
        return
    above, below, pairs, on, away, squares = 0.0, 0.0, 0.0, 0.0, np.inf, 1.0
    for i in range(n):
        re, im = room.re[i], room.im[i]
        place.multipliers[i, 0], place.multipliers[i, 1] = re, im
        size = re * re + im * im
        squares *= 1.0 + size
        if abs(size - 1.0) < (ON_SQUARE if im == 0.0 else ON_PAIR):
            on += 1.0
        elif size > 1.0:
            away = min(away, size - 1.0)
            if im != 0.0:
                pairs += 0.5
            elif re > 0.0:
                above += 1.0
            else:
                below += 1.0
    x[ABOVE], x[BELOW], x[PAIRS], x[ON_CIRCLE], x[AWAY] = above, below, pairs, on, away
    root = math.sqrt(squares)
    if on > 0.0:
        without_zeros(room.re, room.im, root, x)
        return
    p, q = 1.0 + room.re[0], room.im[0]
    for i in range(1, n):
        p, q = p + p * room.re[i] - q * room.im[i], q + p * room.im[i] + q * room.re[i]
    x[FLIP] = p / root
    if n > 2:
        x[TORUS] = torus(room.re, room.im)
        x[CROSSING] = x[TORUS] / root ** (n - 1)


@jit
def torus(re, im):
    """prod_{i<j} (1 - mu_i mu_j): zero at a Neimark-Sacker point, and at a neutral saddle. 1 without losses."""
    x, y, u, v = 1.0, 0.0, 1.0, 0.0
    for i in range(len(re)):
        u, v = u * re[i] - v * im[i], u * im[i] + v * re[i]
        for j in range(i):
            p, q = 1.0 - re[i] * re[j] + im[i] * im[j], -re[i] * im[j] - im[i] * re[j]
            x, y = x * p - y * q, x * q + y * p
    return x if abs(math.hypot(u, v) - 1.0) > 1e-9 else 1.0


@aside
def without_zeros(re, im, root, numbers):
    """FLIP, TORUS and CROSSING where multipliers are on the circle: without factors that are zero, at all points."""
    x, y, p, q, u, v = 1.0, 0.0, 1.0, 0.0, 1.0, 0.0
    n = len(re)
    for i in range(n):
        u, v = u * re[i] - v * im[i], u * im[i] + v * re[i]
        r, s = 1.0 + re[i], im[i]
        if r * r + s * s > ZERO[0]:
            p, q = p * r - q * s, p * s + q * r
        for j in range(i):
            r, s = 1.0 - re[i] * re[j] + im[i] * im[j], -re[i] * im[j] - im[i] * re[j]
            if r * r + s * s > ZERO[1]:
                x, y = x * r - y * s, x * s + y * r
    numbers[FLIP] = p / root
    if n > 2 and abs(math.hypot(u, v) - 1.0) > 1e-9:
        numbers[TORUS], numbers[CROSSING] = x, x / root ** (n - 1)


@jit
def counts_differ(x, y):
    """Whether multipliers cross the unit circle between two points, as far as counts tell.

    Two real ones of one sign that become a pair, or the reverse, do so outside of it where all are far from it.
    """
    if x[ABOVE] < 0.0 or y[ABOVE] < 0.0:
        return False
    above, below, pairs = y[ABOVE] - x[ABOVE], y[BELOW] - x[BELOW], y[PAIRS] - x[PAIRS]
    if x[ON_CIRCLE] != y[ON_CIRCLE]:
        return True
    if above == 0.0 and below == 0.0 and pairs == 0.0:
        return False
    collide = above + below + 2.0 * pairs == 0.0 and above % 2.0 == 0.0 and below % 2.0 == 0.0
    return not (collide and min(x[AWAY], y[AWAY]) > FAR_OUTSIDE)


@jit
def dips(x, y, z, before, behind):
    """Whether a number with these values at three points, at the distances `before` and `behind` from the middle one,
    may vanish twice near the middle one: the parabola has an extremum nearer to zero by a quarter or more, or steps are
    too long for it to tell: the outer points are farther from zero by FARTHER."""
    if y < 0.0:
        x, y, z = -x, -y, -z
    if not (y <= x and y <= z and x + z < np.inf):
        return False
    left, right = (y - x) / before, (z - y) / behind
    slope, curve = left * behind + right * before, right - left  # both times the distance of the outer points
    return slope * slope > curve * y * (before + behind) or min(x, z) > FARTHER * y


@jit
def turns_back(x, slope, y, later, length):
    """Whether a number that is positive at two points may be negative between them: where its tangents meet it is."""
    return slope < 0.0 < later and x * (slope - later) + slope * (y - x - later * length) > 0.0


@jit
def happens(sides, steps, a, b, length, passed):
    """Whether a test changes its sign between two points, multipliers cross the unit circle, or b is out of the stops;
    or whether something may do so twice.

    past: numbers of the point before a
    length: of the step
    passed: distance beyond a stop that rounding does not explain
    """
    x, y = a.numbers, b.numbers
    if not steps.low < y[P] < steps.high:
        return True
    pushing = True
    for i in range(len(a.t)):
        pushing = pushing and sides[i] * b.D[i] < 0.0
        if a.releases[i] > 0.0 >= b.releases[i]:
            return True
        rate, later = -sides[i] * a.tangent_jump[i], -sides[i] * b.tangent_jump[i]
        if turns_back(-sides[i] * a.D[i], rate, -sides[i] * b.D[i], later, length):
            return True
    if not pushing or x[MARGIN] > 0.0 >= y[MARGIN] or y[MARGIN] < -passed or x[TANGENT] * y[TANGENT] < 0.0:
        return True
    if counts_differ(x, y) or exchanged(a.multipliers, b.multipliers):
        return True
    return x[REFLECTION] * y[REFLECTION] < 0.0 or x[TORUS] * y[TORUS] < 0.0


@jit
def touches(past, a, b, length):
    """Whether what is watched may vanish twice beside a; past: numbers of the point before it, length: from a to b."""
    before = past[LENGTH]
    if before == 0.0:
        return False
    x, y = a.numbers, b.numbers
    return (
        dips(past[TANGENT], x[TANGENT], y[TANGENT], before, length)
        or dips(past[MARGIN], x[MARGIN], y[MARGIN], before, length)
        or dips(past[FLIP], x[FLIP], y[FLIP], before, length)
        or dips(past[CROSSING], x[CROSSING], y[CROSSING], before, length)
    )


@jit
def comes_back(steps, a, first, length):
    """Whether the step from a passes the first point; times count modulo the forcing period."""
    K = len(a.t)
    shift = 0.0
    for i in range(K):
        shift += (first.t[i] - a.t[i]) / steps.scale_t / K
    turn = 2.0 * math.pi
    shift = steps.scale_t * turn * math.floor(shift / turn + 0.5)
    offset = (first.numbers[P] - a.numbers[P]) / steps.scale_p
    along, size = offset * a.numbers[TANGENT] / steps.scale_p, offset * offset
    for i in range(K):
        x, y = (first.t[i] - a.t[i] - shift) / steps.scale_t, (first.D[i] - a.D[i]) / steps.scale_jump
        along += x * a.tangent_t[i] / steps.scale_t + y * a.tangent_jump[i] / steps.scale_jump
        size += x * x + y * y
    return 0.0 <= along <= length and size - along * along < 0.01 * length * length
