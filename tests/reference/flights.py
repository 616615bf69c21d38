"""The oscillator flight by flight, in the working precision of mpmath: closed forms, first contacts, rests, chatter.

It shares no formula with the package. With r_j = 1 - omega_j^2 the modes are (1, r_j) (the first row of (K - omega_j^2
M) psi = 0), x1 = q_1 + q_2, x2 = r_1 q_1 + r_2 q_2, and q_j is a sum of exponentials.
"""

from mpmath import mp, mpc, mpf

from reference.exponentials import Exponentials

NAMES = ("mu_m", "mu_k", "zeta", "f2", "omega", "tau")
SIDES = {"both": (1, -1), "right": (1,), "left": (-1,)}


class Oscillator:
    """Modes, their roots and their complex response; `force` is the amplitude of the force, 1."""

    def __init__(self, params, force=1):
        self.mu_m, self.mu_k, self.zeta, self.f2, self.omega, self.tau = (mpf(params[name]) for name in NAMES)
        self.force = mpf(force)
        trace, determinant = 1 + (1 + self.mu_k) / self.mu_m, self.mu_k / self.mu_m
        larger = (trace + mp.sqrt(trace**2 - 4 * determinant)) / 2
        self.modes = []  # (r_j, mu_m r_j, norm, roots, response)
        for square in (determinant / larger, larger):
            r = 1 - square
            norm = 1 + self.mu_m * r**2
            push = self.force * (1 - self.f2 + r * self.f2) / norm
            self.modes.append((r, norm, *self.response(self.zeta * square, square, push)))
        self.constrained = self.response(
            self.zeta * (1 + self.mu_k) / self.mu_m, (1 + self.mu_k) / self.mu_m, self.force * self.f2 / self.mu_m
        )

    def response(self, eta, square, push):
        """Roots of s^2 + 2 eta s + square (one of a complex pair) and complex amplitude under push e^{i omega t}."""
        beyond = eta**2 - square
        root = mp.sqrt(abs(beyond))
        roots = (mpc(-eta, root),) if beyond < 0 else (-square / (eta + root), -(eta + root))
        return roots, push / mpc(square - self.omega**2, 2 * eta * self.omega)

    def largest(self, x1, v1, x2, v2):
        """Bounds on (x1, v1, x2, v2) at any time of a free motion without force that begins with these sizes.

        From xi and xi' a mode moves at most xi + xi'/omega_j at the speed omega_j xi + xi': its energy falls. If it is
        overdamped, its faster root takes the place of the first omega_j, its slower one that of the second.
        """
        bounds = [mpf(0)] * 4
        for r, norm, roots, _ in self.modes:
            xi, rate = ((x + self.mu_m * abs(r) * y) / norm for x, y in ((x1, x2), (v1, v2)))
            moved, speed = xi + rate / abs(roots[-1]), abs(roots[0]) * xi + rate
            for i, part in enumerate((moved, speed, abs(r) * moved, abs(r) * speed)):
                bounds[i] += part
        return bounds

    def turn(self, t):
        """e^{i (omega t + tau)}"""
        return mp.expj(self.omega * t + self.tau)


def free(roots, x, v):
    """Amplitudes of the free motion from (x, v)."""
    if len(roots) == 1:
        (root,) = roots
        return [mpc(x, -(v - root.real * x) / root.imag)]
    slow, fast = roots
    a = (v - fast * x) / (slow - fast)
    return [a, x - a]


class Flight:
    """Free flight from (x1, v1, x2, v2) at the time t."""

    def __init__(self, o, t, state):
        x1, v1, x2, v2 = state
        turn = o.turn(t)
        self.rates, first, second, forced = [], [], [], [mpc(0), mpc(0)]
        for r, norm, roots, H in o.modes:
            steady = H * turn
            q = (x1 + o.mu_m * r * x2) / norm - steady.imag
            p = (v1 + o.mu_m * r * v2) / norm - o.omega * steady.real
            amplitudes = free(roots, q, p)
            self.rates += roots
            first += amplitudes
            second += [r * a for a in amplitudes]
            forced[0] += -1j * steady
            forced[1] += -1j * r * steady
        self.rates.append(mpc(0, o.omega))
        self.x1 = Exponentials([*first, forced[0]], self.rates)
        self.x2 = Exponentials([*second, forced[1]], self.rates)

    def gap(self, side, b):
        """b - side x1"""
        return Exponentials([b, *(-side * a for a in self.x1.amplitudes)], [mpf(0), *self.rates])

    def at(self, u):
        """x1, v1, x1'', x2, v2, x2''"""
        return [*self.x1.derivatives(u, 3), *self.x2.derivatives(u, 3)]


class Rest:
    """M1 held at x1, M2 from (x2, v2) at the time t; `pull` is the free acceleration of M1."""

    def __init__(self, o, t, x1, x2, v2):
        roots, H = o.constrained
        steady, still = H * o.turn(t), x1 / (1 + o.mu_k)
        amplitudes = free(roots, x2 - still - steady.imag, v2 - o.omega * steady.real)
        rates = [mpf(0), *roots, mpc(0, o.omega)]
        motion = [still, *amplitudes, -1j * steady]
        self.x2 = Exponentials(motion, rates)
        pull = [a * (1 + 2 * o.zeta * rate) for a, rate in zip(motion, rates, strict=True)]
        pull[0] -= x1
        pull[-1] += -1j * (1 - o.f2) * o.force * o.turn(t)
        self.pull = Exponentials(pull, rates)


def clear_until(gap, order):
    """A time up to which a gap whose first `order` derivatives are zero at 0 does not come back to 0; its sign."""
    leading = gap.derivatives(mpf(0), order + 1)[order]
    limit = gap.bound(order + 1, 0)
    return leading, mpf("0.99") * (order + 1) * abs(leading) / limit


def taylor(o, t, state, count):
    """Taylor coefficients of x1 and x2 at the time t, from the differential equations."""
    x1, v1, x2, v2 = state
    turn = o.turn(t)
    a, c = [x1, v1], [x2, v2]
    push = [turn.imag * o.force]
    for n in range(1, count):
        power = (1j * o.omega) ** n * turn
        push.append(power.imag * o.force / mp.factorial(n))
    for n in range(count - 2):
        link = a[n] - c[n] + 2 * o.zeta * (n + 1) * (a[n + 1] - c[n + 1])
        ground = o.mu_k * (c[n] + 2 * o.zeta * (n + 1) * c[n + 1])
        scale = (n + 1) * (n + 2)
        a.append(((1 - o.f2) * push[n] - link) / scale)
        c.append((o.f2 * push[n] + link - ground) / o.mu_m / scale)
    return a, c


def polynomial(c, u):
    value = slope = mpf(0)
    for a in reversed(c):
        slope = slope * u + value
        value = value * u + a
    return value, slope


class NoChatterError(ArithmeticError):
    """The impacts do not accumulate."""


def chatter(o, R, side, t, state, accuracy, most=30_000):
    """Follow impacts from just after one on until they accumulate -> (time, x2, v2) at the onset of rest.

    Impact by impact, until what is left of the sequence can be summed up with an error in time below `accuracy`.
    """
    start, count = t, 12
    for _ in range(most):
        a, c = taylor(o, t, state, count)
        speed, pull, jerk = -side * a[1], 2 * side * a[2], 6 * abs(a[3])
        if pull <= 0:
            raise NoChatterError("the acceleration points away from the stop")
        w = 2 * speed / (pull * (1 - R)) if R < 1 else mp.inf
        if w * w * jerk / pull < accuracy and w * jerk < mpf("1e-3") * pull:
            x2, v2 = polynomial(c, w)
            return t + w, x2, v2
        quotient = a[1:]  # of x1 - wall by u
        u = 2 * speed / pull
        for _ in range(60):
            value, slope = polynomial(quotient, u)
            step = value / slope
            u -= step
            if abs(step) < mp.eps * 16 * u:
                break
        if abs(a[-1]) * u ** (count - 1) > mpf("1e-32") * speed * u:
            raise NoChatterError("flights too long for a series")
        _, v1 = polynomial(a, u)
        x2, v2 = polynomial(c, u)
        t += u
        state = (state[0], -R * v1, x2, v2)
    raise NoChatterError(f"not after {most} impacts from {mp.nstr(start, 20)}")
