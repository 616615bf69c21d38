"""A certified reference for contacts: the sign of polynomials on intervals, with rounding bounded outward.

It shares no formula with the package. A flight is a polynomial on each cell of its own grid; whether it stays on one
side of a stop is decided by bisection, with the exact minimum of its quadratic part about the middle of an interval
and a bound on the rest. Coefficients come from 40-digit matrix exponentials, arithmetic is numpy's longdouble, and
many flights are judged at once.
"""

import math

import numpy as np
from mpmath import mp, mpf

from reference.flow import matrix_of
from reference.gmp import context, expm, to_gmp
from reference.machine import machine_of
from reference.naive import linear_of

REAL = np.longdouble
UNIT = float(np.finfo(REAL).eps) / 2  # 2^-64 where longdouble is the x87 format
MOST_HALVINGS = 64
POSITIVE, NEGATIVE, OPEN = 1, -1, 0
BLOCK = 1 << 15


def value(c, u):
    """Polynomial with coefficients c (n, N) at u (N,), and a bound on the error of its evaluation."""
    p, size = np.zeros_like(u), np.zeros_like(u)
    for a in c[::-1]:
        p, size = p * u + a, size * np.abs(u) + np.abs(a)
    return p, 2 * len(c) * UNIT * size


def recentred(c, centre):
    """Coefficients in powers of u - centre."""
    d = c.copy()
    for i in range(len(d) - 1):
        for j in range(len(d) - 2, i - 1, -1):
            d[j] += centre * d[j + 1]
    return d


def least_quadratic(d, r):
    """Minimum of d0 + d1 x + d2 x^2 over |x| <= r."""
    ends = d[0] + d[2] * r * r - np.abs(d[1]) * r
    inner = (d[2] > 0) & (np.abs(d[1]) < 2 * d[2] * r)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(inner, d[0] - d[1] * d[1] / (4 * d[2]), ends)


def sign(c, low, high, error=0.0):
    """For each polynomial, POSITIVE on all of [low, high], NEGATIVE somewhere, or OPEN: too near zero to say.

    c (n, N) in powers of u; 0 <= low <= high (N,); error (N,): by how much the true function may differ from it.
    Every answer but OPEN is certain.
    """
    count = c.shape[1]
    verdict = np.full(count, POSITIVE, np.int8)
    error = np.broadcast_to(np.asarray(error, REAL), count)
    for begin in range(0, count, BLOCK):
        part = slice(begin, min(begin + BLOCK, count))
        verdict[part] = _sign(c[:, part], low[part], high[part], error[part])
    return verdict


def _sign(c, low, high, error):
    verdict = np.full(c.shape[1], POSITIVE, np.int8)
    which = np.flatnonzero(low <= high)
    low, high = np.asarray(low, REAL)[which], np.asarray(high, REAL)[which]
    for _ in range(MOST_HALVINGS):
        if not len(which):
            return verdict
        centre, r = (low + high) / 2, (high - low) / 2
        _, slack = value(c[:, which], np.abs(centre) + r)  # covers the recentring as well: twice its bound
        slack = 3 * slack + error[which]
        r = r * (1 + 4 * UNIT) + 4 * UNIT * np.abs(centre)
        d = recentred(c[:, which], centre)
        rest, power = np.zeros_like(r), r * r
        for a in d[3:]:
            power = power * r
            rest += np.abs(a) * power
        least = least_quadratic(d, r) - rest * (1 + 1e-15)
        verdict[which[d[0] < -slack]] = NEGATIVE
        open_ = (least <= slack) & (verdict[which] != NEGATIVE)
        which, low, high, centre = which[open_], low[open_], high[open_], centre[open_]
        which = np.concatenate([which, which])
        low, high = np.concatenate([low, centre]), np.concatenate([centre, high])
    verdict[which[verdict[which] == POSITIVE]] = OPEN
    return verdict


class Reference:
    """Free flights of one oscillator from the section t = 0, over one forcing period.

    z = (x1, v1, ..., xN, vN, sin, cos), or with 1 at its end, obeys z' = A z, and the gap is `along` z. `shift[k]`
    takes z(0) to the Taylor coefficients of the gap about the node k of a grid of `cells` cells. digits: of the
    exponentials behind it, the same as of A. Made by `of_paper` and `of_masses`.
    """

    ORDER = 20

    def __init__(self, A, along, omega, tau, digits):
        with mp.workdps(digits), context():
            self.A, self.digits, size = A, digits, A.rows
            self.states = size - 2 - size % 2
            self.force = [mp.sin(tau), mp.cos(tau), mpf(1)][: size - self.states]
            self.period = 2 * mp.pi / omega
            norm = mp.mnorm(A, mp.inf)
            self.cells = max(int(mp.ceil(2 * norm * self.period)), 32)
            self.h = self.period / self.cells
            self.width = REAL(mp.nstr(self.h, 25))
            rates, E = numbers(A), np.array([[to_gmp(mpf(i == j)) for j in range(size)] for i in range(size)])
            step, rows = numbers(expm(A * self.h)), [np.array([to_gmp(a) for a in along])]
            for n in range(self.ORDER):
                rows.append(rows[-1] @ rates / (n + 1))
            rows = np.array(rows)
            self.acceleration = np.array([real(a) for a in 2 * rows[2]])
            self.shift = np.empty((self.cells, self.ORDER + 1, size), REAL)
            self.norms = np.empty((self.cells, size))  # |first row left out| at the node, over all of the cell
            # |A^m| h^m/m! for all m > ORDER, with |A| h <= 1/2, is below this times |E z|
            left_out = mp.ldexp(1, -self.ORDER) / mp.factorial(self.ORDER + 1) * sum(map(abs, along))
            for k in range(self.cells):
                self.shift[k] = np.vectorize(real, otypes=[REAL])(rows @ E)
                self.norms[k] = float(left_out) * np.abs(E.astype(float)).max(0)
                E = step @ E

    def before(self, u):
        """Matrix that takes z(u) back to z(0), longdouble."""
        with mp.workdps(self.digits):
            E = expm(-self.A * mpf(u))
            return np.array([[longdouble(a) for a in row] for row in E.tolist()])

    def phase(self, u):
        """sin and cos of the force at the time u, and perhaps 1."""
        with mp.workdps(self.digits):
            turned = expm(self.A * mpf(u))[self.states :, self.states :] * mp.matrix(self.force)
            return [longdouble(a) for a in turned]

    def forced(self, states):
        """z(0) of states (N, 2 masses) at the section."""
        z = np.empty((len(states), self.A.rows), REAL)
        z[:, : self.states] = states
        z[:, self.states :] = [longdouble(x) for x in self.force]
        return z

    def coefficients(self, k, z):
        """Coefficients (n, N) of the gap about node k, and a bound on the error of the polynomial over the cell."""
        c = self.shift[k] @ z.T
        powers = self.width ** np.arange(self.ORDER + 1)
        rounding = (2 + len(self.norms[k])) * UNIT * (powers @ np.abs(self.shift[k])) @ np.abs(z.T)
        return c, rounding + self.norms[k] @ np.abs(z.T)

    def gap(self, z, t):
        """The gap (N,) at times t (N,) of the period, and a bound on its error."""
        k = np.minimum((t / self.width).astype(int), self.cells - 1)
        x, error = np.empty_like(t), np.empty_like(t)
        for cell in np.unique(k):
            chosen = k == cell
            c, bound = self.coefficients(cell, z[chosen])
            x[chosen], rounding = value(c, t[chosen] - cell * self.width)
            error[chosen] = bound + rounding + 4 * UNIT * t[chosen] * np.abs(c[1])
        return x, error

    def inside(self, z, b, end, stop_distance):
        """Whether |gap| < b + stop_distance up to the time `end` (N,): POSITIVE, NEGATIVE or OPEN for each flight."""
        verdict = np.full(len(z), POSITIVE, np.int8)
        for k in range(self.cells):
            begin = k * self.width
            alive = np.flatnonzero((end > begin) & (verdict != NEGATIVE))
            if not len(alive):
                break
            c, error = self.coefficients(k, z[alive])
            powers = (self.width * (1 + REAL(1e-17))) ** np.arange(1, self.ORDER + 1)
            wall = b + stop_distance[alive]
            near = np.abs(c[0]) + powers @ np.abs(c[1:]) + error >= wall
            for side in (1, -1):
                close = near & (side * c[0] + powers @ np.abs(c[1:]) + error >= wall)
                if not close.any():
                    continue
                g = -side * c[:, close]
                g[0] += wall[close]
                who = alive[close]
                last = np.minimum(end[who] - begin, self.width)
                verdict[who] = np.minimum(verdict[who], sign(g, np.zeros_like(last), last, error[close]))
        return verdict


def longdouble(x):
    """An mpf to the nearest longdouble or next to it."""
    high = float(x)
    if not math.isfinite(high):
        return REAL(high)
    return REAL(high) + REAL(float(x - mpf(high)))


def numbers(matrix):
    """A matrix of mpmath as an array of gmpy2's numbers."""
    return np.array([[to_gmp(a) for a in row] for row in matrix.tolist()])


def real(x):
    """A number of gmpy2 to the nearest longdouble or next to it."""
    high = float(x)
    return REAL(high) + REAL(float(x - high))


def of_paper(params, digits=40):
    """The paper's oscillator; x1 is the gap."""
    with mp.workdps(digits):
        A = matrix_of(machine_of(linear_of(params)))[:6, :6]  # without the constant force
        return Reference(A, [mpf(j == 0) for j in range(6)], mpf(params["omega"]), mpf(params["tau"]), digits)


def of_masses(q, digits=40):
    """Any oscillator (`Linear`), in the coordinates of its masses."""
    with mp.workdps(digits):
        size = 2 * q.masses + 3  # without the places of stops, which do not move the masses
        A = matrix_of(machine_of(q))[:size, :size]
        along = [mpf(0)] * A.rows
        along[0 : 2 * q.masses : 2] = map(mpf, q.contact.normal)
        return Reference(A, along, mpf(q.omega), mpf(q.tau), digits)
