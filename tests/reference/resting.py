"""Periodic orbits with rests after impacts with R = 0, in mpmath: from one impact to the next by matrix exponentials.

M x'' + C x' + K x = constant + sine sin(omega t + tau) + cosine cos(omega t + tau)

in the coordinates of the masses, z = (x, x', cos, sin, 1). The unknowns are z before the first impact, the times of the
impacts and the ends of the rests; the equations that each gap is its stop, that the gap's free acceleration vanishes at
the end of a rest, and that the motion repeats itself with the sign sigma. All derivatives are differences.
"""

import numpy as np
from mpmath import eig, expm, eye, lu_solve, matrix, mp, mpf

STEP = mpf(10) ** -18  # of differences; the callers work with 50 digits
FIELDS = ("M", "K", "C", "normal", "constant", "sine", "cosine", "omega", "tau", "low", "high")


class Resting:
    """Orbits of q + h slope with impacts on `sides`, R = 0, and rests after the impacts `rests`."""

    def __init__(self, q, sigma, half_periods, sides, rests, slope=None, h=0):
        self.sigma, self.half_periods, self.sides, self.rests = sigma, half_periods, sides, list(rests)
        M, K, C, n, *forces, self.omega, self.tau, low, high = (
            _exact(getattr(q, name), getattr(slope, name) if slope is not None else None, h) for name in FIELDS
        )
        self.N = len(n)
        size, inverse = 2 * self.N + 3, M**-1
        B = matrix(size, size)
        for i in range(self.N):
            B[i, self.N + i] = 1
            for j in range(self.N):
                B[self.N + i, j], B[self.N + i, self.N + j] = -(inverse * K)[i, j], -(inverse * C)[i, j]
            for column, force in zip((2, 1, 0), forces, strict=True):
                B[self.N + i, 2 * self.N + column] = (inverse * force)[i]
        B[2 * self.N, 2 * self.N + 1], B[2 * self.N + 1, 2 * self.N] = -self.omega, self.omega
        self.speed = matrix(1, size)
        self.gap, self.push = matrix(1, size), matrix(size, 1)
        for i in range(self.N):
            self.gap[i] = self.speed[self.N + i] = n[i]
            self.push[self.N + i] = (inverse * n)[i] / (n.T * inverse * n)[0]
        self.B, self.H = B, B - self.push * self.speed * B
        self.stops, self.P = {1: high, -1: low}, mp.pi / self.omega * half_periods

    def residual(self, w):
        """w: (2N) state before the first impact, (K) times, ends of the rests."""
        n, K = 2 * self.N, len(self.sides)
        times, ends = w[n : n + K], dict(zip(self.rests, w[n + K :], strict=True))
        angle = self.omega * times[0] + self.tau
        z = matrix([*w[:n], mp.cos(angle), mp.sin(angle), 1])
        gaps, pulls = [], []
        for k, (t, following) in enumerate(zip(times, [*times[1:], times[0] + self.P], strict=True)):
            gaps.append((self.gap * z)[0] - self.stops[self.sides[k]])
            z = z - self.push * (self.speed * z)
            if k in ends:
                z = expm(self.H * (ends[k] - t)) * z
                pulls.append((self.speed * self.B * z)[0])
            z = expm(self.B * (following - ends.get(k, t))) * z
        return matrix([*gaps, *pulls, *(z[i] - self.sigma * w[i] for i in range(n))])

    def jacobian(self, w):
        columns = []
        for i in range(len(w)):
            ends = [self.residual([x + (sign * STEP if j == i else 0) for j, x in enumerate(w)]) for sign in (1, -1)]
            columns.append((ends[0] - ends[1]) / (2 * STEP))
        return matrix([[column[r] for column in columns] for r in range(len(w))])

    def solve(self, w):
        """Newton's method."""
        w = [mpf(x) for x in w]
        for _ in range(6):
            change = lu_solve(self.jacobian(w), self.residual(w))
            w = [x - dx for x, dx in zip(w, change, strict=True)]
        assert max(abs(dx) for dx in change) < mpf(10) ** -25
        return w

    def multipliers(self, w):
        """Of the map over P with the sign sigma, of changes of the state at a fixed time before the first impact."""
        n, J, fixed = 2 * self.N, self.jacobian(w), eye(len(w))
        angle = self.omega * w[n] + self.tau
        rate = self.B * matrix([*w[:n], mp.cos(angle), mp.sin(angle), 1])
        for i in range(n):  # the state moves with the first impact, both where the period begins and where it ends
            fixed[i, n] = rate[i]
        J = J * fixed
        events, closing = J[: len(w) - n, :], J[len(w) - n :, :]
        through = closing[:, :n] - closing[:, n:] * events[:, n:] ** -1 * events[:, :n] + self.sigma * eye(n)
        return [self.sigma * mu for mu in eig(through, left=False, right=False)]


def _exact(value, slope, h):
    """A number, vector or matrix of a Linear in mpmath, moved by h times its slope."""
    if np.ndim(value) == 0:
        return mpf(float(value)) + (h * mpf(float(slope)) if slope is not None else 0)
    moved = matrix(np.asarray(value).tolist())
    return moved if slope is None else moved + h * matrix(np.asarray(slope).tolist())
