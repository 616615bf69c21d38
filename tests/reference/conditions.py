"""Where a closed orbit fulfils conditions, in many digits: bifurcations, by Newton's method for all unknowns together.

Unknowns are those of `ClosedOrbit`, times of turning points that touch a stop, the cosine of the angle of a pair on the
unit circle, and the free numbers of the machine. Conditions, with J(mu) the Jacobian for changes that grow by mu in a
period:

    fold det J(1) = 0    flip, pitchfork det J(-1) = 0    pair det J(mu) = 0 for mu = e^{i theta} and e^{-i theta}
    double 1, -1: the derivative of det J(mu) by mu is 0 as well    cusp: w.F''(v, v) = 0, F' v = 0, w.F' = 0
    third: the cubic coefficient of the normal form of a flip or a pair is 0, by differences of the map
    vanishing, of an event: the row that vanishes there does so without speed
"""

from mpmath import mp, mpf

from reference.closed_orbit import DIGITS, ClosedOrbit
from reference.normal_forms import third_order

WIDE = mpf(10) ** -12  # step of differences
NEAR = mpf(10) ** -8  # a change of the unknowns from which on the Jacobian is kept
SINGLE = mpf(10) ** -14  # where the two of a pair are one, Newton's method begins beside it
THIRD, OF_THIRD = mpf(10) ** -12, 60  # step of third ones, and digits: stiff stops bend the map


class Map:
    """The map over the period of a closed orbit, of changes of the state at the section."""

    def __init__(self, orbit, state, times):
        self.orbit, self.centre, self.times = orbit, list(state), list(times)

    def __call__(self, change):
        end = self.orbit.image([a + b for a, b in zip(self.centre, change, strict=True)], self.times)
        return mp.matrix([a - b for a, b in zip(end, self.centre, strict=True)])


class Condition:
    """machine_at: the machine for changes of the free numbers; events, periods, sigma, begin: as of `ClosedOrbit`.

    conditions : "fold", "flip", "pair", "double_1", "double_-1", "cusp", "third", ("vanishing", number of an event)
    touches : elements, stops that turning points touch
    angle : of a pair, where it is known; None: another unknown
    """

    def __init__(self, machine_at, free, events, periods, sigma=1, begin=0, conditions=(), touches=(), angle=None):
        self.machine_at, self.free, self.of = machine_at, free, (list(events), periods, sigma, begin)
        self.conditions, self.touches, self.angle = conditions, touches, angle
        self.digits = OF_THIRD if "third" in conditions else DIGITS

    def residual(self, u):
        orbit = ClosedOrbit(self.machine_at(list(u[len(u) - self.free :])), *self.of, digits=self.digits)
        n = len(orbit.at)
        self.m = n + len(orbit.legs)
        unknowns = u[: self.m]
        state, times = list(unknowns[:n]), list(unknowns[n:])
        F, J = orbit.residual_and_jacobian(unknowns)
        rows, det = list(F), lambda mu: mp.det(orbit.linearised(J, mu))
        for k, e in enumerate(self.touches):
            rows += orbit.depth_and_speed(state, times, e, u[self.m + k])
        mu = mpf(-1)
        for name in self.conditions:
            if name in ("fold", "flip"):
                rows.append(det(1 if name == "fold" else -1))
            elif name == "pair":
                c = u[self.m + len(self.touches)] if self.angle is None else mp.cos(self.angle)
                root = mp.sqrt(
                    mp.mpc(c * c - 1)
                )  # both values and their divided difference are real, also at c = 1, -1
                mu, other = c + root, c - root
                rows += [mp.re(det(mu) + det(other)), mp.re((det(mu) - det(other)) / root)]
            elif name[0] == "vanishing":
                rows.append(orbit.speed(unknowns, name[1]))
            elif name == "cusp":
                rows.append(self.cusp(orbit, unknowns))
            elif name == "third":
                rows.append(third_order(Map(orbit, state, times), mu, THIRD))
            else:
                double, h = mpf(int(name.split("_")[1])), mpf(10) ** -15
                rows.append((det(double + h) - det(double - h)) / (2 * h))
        return mp.matrix(rows)

    def jacobian(self, u, F):
        J = mp.matrix(len(u))
        for j in range(len(u)):
            ahead = u.copy()
            ahead[j] += WIDE
            J[:, j] = (self.residual(ahead) - F) / WIDE
        return J

    @staticmethod
    def cusp(orbit, u):
        F = lambda u: orbit.residual_and_jacobian(u)[0]  # noqa: E731
        m, J = len(u), mp.matrix(len(u) + 1)
        J[:m, :m] = orbit.residual_and_jacobian(u)[1]
        for j in range(m):  # bordered by rows that are not special
            J[m, j], J[j, m] = mpf(1) / (j + 1), mpf(1) / (m - j)
        side = mp.matrix([*[0] * m, 1])
        v, w = mp.lu_solve(J, side)[:m], mp.lu_solve(J.T, side)[:m]
        second = F(u + WIDE * v) - 2 * F(u) + F(u - WIDE * v)
        return (w.T * second)[0] / WIDE**2

    def solve(self, state, times, touching=(), theta=None, steps=10):
        """By how much the free numbers change, and the last change of all unknowns.

        state, times : of the orbit, nearly; touching : times of the touches; theta : of a pair
        """
        with mp.workdps(self.digits):
            angle = []
            if "pair" in self.conditions and self.angle is None:
                c = mp.cos(theta)
                angle = [c * (1 - SINGLE) if abs(c * c - 1) < SINGLE else c]
            u = mp.matrix([*map(mpf, [*state, *times, *touching]), *angle, *[mpf(0)] * self.free])
            F, change = self.residual(u), mp.inf
            for _ in range(steps):
                if change > NEAR:
                    J = self.jacobian(u, F)
                step = mp.lu_solve(J, F)
                u -= step
                F, change = self.residual(u), mp.norm(step)
            return [float(a) for a in u[len(u) - self.free :]], float(change)
