"""Whether an orbit goes to a periodic one by two modes at once: neither has died out before the other.

Then the differences d_n = x_{n+p} - x_n of section points obey a recurrence with four numbers,

    d_{n+4p} = a_1 d_{n+3p} + a_2 d_{n+2p} + a_3 d_{n+p} + a_4 d_n,

and the roots of z^4 = a_1 z^3 + a_2 z^2 + a_3 z + a_4 are the four multipliers of the two modes.
"""

import math

import numpy as np

from vibro_sweep.engine.simd.jit import jit

NUMBERS = 4  # of the recurrence
PERIODS = 4  # up to which periods are looked at
LOOKED_AT = 2  # differences at the end that have to obey it before all are looked at
LEAST_FITTED = 16  # differences: chaos obeys it for as long as it does not come to a stop
RESIDUAL = 1e-3  # of the differences, up to which they obey it
SURE = 30.0  # by how many residuals |z| is to be below 1
ROUNDING = 1e-9  # residual that rounding may leave unseen
MOST_FITTED = 512  # points, the last ones
UNTOLD = 1e-13  # of the first pivot: a smaller one determines no number
LEAST = 1e-140  # difference, whose square is no subnormal number
HALVINGS = 52  # of the interval in which |z| is looked for


def new_fit() -> np.ndarray:
    """Room for a triangle of the four numbers' equations, one more of them, and the numbers themselves: (5, 6)."""
    return np.zeros((NUMBERS + 1, NUMBERS + 2))


@jit
def difference(section, scale, p, n, i):
    """Coordinate i of d_n, in parts of its size."""
    return (section[n + p, i] - section[n, i]) * scale[i]


@jit
def add_equation(fit):
    """Turn the equation of the last row into the triangle above it by plane rotations, so that no digits are lost where
    the differences are nearly alike. Returns what the triangle cannot take of it."""
    for k in range(NUMBERS):
        if abs(fit[NUMBERS, k]) > LEAST:
            size = math.sqrt(fit[k, k] ** 2 + fit[NUMBERS, k] ** 2)
            c, s = fit[k, k] / size, fit[NUMBERS, k] / size
            for m in range(k, NUMBERS + 1):
                above, below = fit[k, m], fit[NUMBERS, m]
                fit[k, m], fit[NUMBERS, m] = c * above + s * below, c * below - s * above
    return fit[NUMBERS, NUMBERS]


@jit
def solve(fit):
    """The four numbers, into the last column, from the triangle. One that it does not determine is 0."""
    for k in range(NUMBERS - 1, -1, -1):
        rest = fit[k, NUMBERS]
        for m in range(k + 1, NUMBERS):
            rest -= fit[k, m] * fit[m, NUMBERS + 1]
        fit[k, NUMBERS + 1] = rest / fit[k, k] if abs(fit[k, k]) > UNTOLD * abs(fit[0, 0]) else 0.0


@jit
def residual(section, scale, p, first, fit):
    """What the recurrence leaves of the differences from point `first` on. Least squares: it stays in `fit`."""
    fit[:, :] = 0.0
    left = total = 0.0
    for n in range(first, len(section) - (NUMBERS + 1) * p):
        for i in range(section.shape[1]):
            for k in range(NUMBERS):
                fit[NUMBERS, k] = difference(section, scale, p, n + (NUMBERS - 1 - k) * p, i)
            after = fit[NUMBERS, NUMBERS] = difference(section, scale, p, n + NUMBERS * p, i)
            total += after * after
            left += add_equation(fit) ** 2
    solve(fit)
    return math.sqrt(left / total) + ROUNDING if total > 0.0 else 1.0


@jit
def all_within(fit, radius):
    """Whether all four roots have |z| < radius: the Schur-Cohn test of the polynomial in z / radius."""
    power = 1.0
    for k in range(NUMBERS):
        power *= radius
        fit[k, 0] = -fit[k, NUMBERS + 1] / power
    for m in range(NUMBERS - 1, -1, -1):
        last = fit[m, 0]
        if not abs(last) < 1.0:
            return False
        for k in range(m):
            fit[k, 1] = (fit[k, 0] - last * fit[m - 1 - k, 0]) / (1.0 - last * last)
        for k in range(m):
            fit[k, 0] = fit[k, 1]
    return True


@jit
def largest_root(fit):
    """The largest |z| of the four roots, which is below 1."""
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if all_within(fit, middle) else (middle, high)
    return high


@jit
def distance_to_go(section, scale, p, fit):
    """What is left of the way, in parts of the sizes, at any of the last p points: the sum of all differences to come,
    S = sum over k of a_k (S + d_n + d_{n-p} + ... + d_{n-(k-1)p}), where d_n is the last one."""
    rest = 1.0
    for k in range(NUMBERS):
        rest -= fit[k, NUMBERS + 1]
    farthest = 0.0
    for n in range(len(section) - 2 * p, len(section) - p):
        for i in range(section.shape[1]):
            way = last = 0.0
            for k in range(NUMBERS):
                last += difference(section, scale, p, n - k * p, i)
                way += fit[k, NUMBERS + 1] * last
            farthest = max(farthest, abs(way / rest))
    return farthest


@jit
def fade_by_two_modes(section, scale, p, most, fit):
    """Whether differences over p periods obey the recurrence, with a residual of at most so much, and fade away. Its
    numbers stay in `fit`. One mass has one mode."""
    count = len(section) - (NUMBERS + 1) * p
    first = max(count // 2, count - MOST_FITTED)
    if section.shape[1] == 2 or count - first < LEAST_FITTED:
        return False
    if residual(section, scale, p, count - LOOKED_AT, fit) > most:
        return False
    r = residual(section, scale, p, first, fit)
    return r <= most and all_within(fit, 1.0 - SURE * r)


@jit
def approaches_by_two_modes(section, scale, p, most, fit, found):
    """The same; if so, `found` gets the period p, how far it is to there, and by how much that shrinks in a forcing
    period."""
    if not fade_by_two_modes(section, scale, p, most, fit):
        return False
    found.approached_period = p
    found.approached_distance = distance_to_go(section, scale, p, fit)
    found.approached_factor = math.exp(math.log(largest_root(fit)) / p)
    return True


@jit
def look_for_two_modes(section, scale, most, fit, found):
    """The same for the least period with which it is so."""
    most = min(most, RESIDUAL)
    for p in range(1, PERIODS + 1):
        if approaches_by_two_modes(section, scale, p, most, fit, found):
            return True
    return False
