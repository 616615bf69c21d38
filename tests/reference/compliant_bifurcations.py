"""Bifurcations of periodic orbits with contacts in thirty digits: slow and obvious, no formula of the package.

The unknowns are those of `ContactOrbit`, times of turning points that touch a stop, angles of pairs on the unit circle,
and the free numbers of the oscillator. Conditions on the matrix M of the orbit:

    fold det(M - 1) = 0    flip, pitchfork det(M + 1) = 0    pair det(M - e^{i theta}) = 0
    double 1, -1: the derivative of det(M - mu) by mu is 0 as well    cusp: w.F''(v, v) = 0, F v = 0, w.F = 0
    third: the cubic coefficient of the normal form of a flip or a pair is 0, by differences of the map
"""

from types import SimpleNamespace

import numpy as np
from mpmath import mp, mpf

from reference.compliant_orbits import DIGITS, ContactMap, ContactOrbit
from reference.normal_forms import third_order

STEP = mpf(10) ** -20  # of first differences
WIDE = mpf(10) ** -12  # of second ones
THIRD, OF_THIRD = mpf(10) ** -12, 60  # step of third ones, and digits: stiff stops bend the map


def moved(q, slopes, dp):
    """The oscillator q, a `Linear`, moved by dp along its derivatives: exact to (dp)^2."""
    found = {}
    for name, value in q._asdict().items():
        if isinstance(value, bool) or name == "by_force":
            found[name] = bool(value)
            continue
        change = [getattr(slope, name) for slope in slopes]
        if isinstance(value, np.ndarray):
            value = value.astype(object) + sum(d * one.astype(object) for d, one in zip(dp, change, strict=True))
        else:
            value = mpf(value) + sum((d * mpf(float(one)) for d, one in zip(dp, change, strict=True) if one), mpf(0))
        found[name] = value
    return SimpleNamespace(**found)


class Bifurcation:
    """q, slopes: the oscillator where the package says that it is, and its derivatives by the free numbers.

    conditions : "fold", "flip", "pair", "double_1", "double_-1", "cusp", "third"
    touches : the stops (+1, -1) of turning points
    angles : of pairs, where these are known; None: another unknown each
    pulled : as of `ContactOrbit`
    """

    def __init__(self, q, slopes, sides, periods, sigma, conditions=(), touches=(), angle=None, pulled=False):
        self.q, self.slopes, self.of = q, slopes, (list(sides), periods, sigma, pulled)
        self.conditions, self.touches, self.angle = conditions, touches, angle
        self.m = 2 * len(q.normal) + 2 * len(sides)

    def _residual(self, u):
        count = len(self.slopes)
        orbit = ContactOrbit(moved(self.q, self.slopes, list(u[len(u) - count :])), *self.of)
        own = u[: self.m]
        rows = list(orbit.residual(own))
        for k, side in enumerate(self.touches):
            gap, speed = self._gap(orbit, own, u[self.m + k])
            rows += [gap - (orbit.q.high if side > 0 else orbit.q.low), speed]
        M = orbit.closure(own)
        one, mu = mp.eye(M.rows), mpf(-1)
        for name in self.conditions:
            if name in ("fold", "flip"):
                rows.append(mp.det(M - one if name == "fold" else M + one))
            elif name == "pair":
                theta = u[self.m + len(self.touches)] if self.angle is None else self.angle
                mu = mp.expjpi(theta / mp.pi)
                value = mp.det(M - mu * one)
                rows += [value.real, value.imag]
            elif name == "cusp":
                rows.append(self._cusp(orbit, own))
            elif name == "third":
                rows.append(third_order(ContactMap(orbit, own[: 2 * orbit.N], own[2 * orbit.N :]), mu, THIRD))
            else:
                double, h = mpf(int(name.split("_")[1])), mpf(10) ** -15
                rows.append((mp.det(M - (double + h) * one) - mp.det(M - (double - h) * one)) / (2 * h))
        return mp.matrix(rows)

    @staticmethod
    def _gap(orbit, own, time):
        """The gap and its speed at a time of a flight."""
        y, before = orbit._begin(own), mpf(0)
        for A, length, _, _ in orbit._pieces(own):
            if time <= before + length:
                y = mp.expm(A * (time - before)) * y
                break
            y, before = mp.expm(A * length) * y, before + length
        n = orbit.N
        return (orbit.gap * y)[0], sum(orbit.gap[i] * y[n + i] for i in range(n))

    def _cusp(self, orbit, own):
        m, F = self.m, orbit.residual(own)
        J = mp.matrix(m + 1)
        for j in range(m):
            ahead = own.copy()
            ahead[j] += STEP
            J[:m, j] = (orbit.residual(ahead) - F) / STEP
        for j in range(m):
            J[m, j], J[j, m] = mpf(1) / (j + 1), mpf(1) / (m - j)
        side = mp.matrix([*[0] * m, 1])
        v, w = mp.lu_solve(J, side)[:m], mp.lu_solve(J.T, side)[:m]
        second = orbit.residual(own + WIDE * v) - 2 * F + orbit.residual(own - WIDE * v)
        return (w.T * second)[0] / WIDE**2

    def solve(self, state, times, touching=(), theta=None, steps=6):
        """How far the free numbers move from where the package has them, the last change, and the orbit's multipliers.

        state, times : as of `ContactOrbit.solve`; touching: times of the touches; theta: of a pair
        """
        with mp.workdps(OF_THIRD if "third" in self.conditions else DIGITS):
            angle = [mpf(theta)] if "pair" in self.conditions and self.angle is None else []
            known = [*state[::2], *state[1::2], *times, *touching]
            u = mp.matrix([*map(mpf, known), *angle, *[mpf(0)] * len(self.slopes)])
            F, J = self._residual(u), mp.matrix(len(u))
            for j in range(len(u)):
                ahead = u.copy()
                ahead[j] += WIDE
                J[:, j] = (self._residual(ahead) - F) / WIDE
            for _ in range(steps):
                change = mp.lu_solve(J, F)
                u -= change
                F = self._residual(u)
            count = len(self.slopes)
            return [float(one) for one in u[len(u) - count :]], float(mp.norm(change))
