"""Whether the invariant circle that is born at a Neimark-Sacker point attracts: the first Lyapunov coefficient.

For the map f over P with f' = A, A q = e^{i theta} q, p^T A = e^{i theta} p^T, p.q = 1 and the second and third
derivatives B, C (Kuznetsov, Elements of Applied Bifurcation Theory, eq. 5.45 of the 3rd edition):

    a = Re e^{-i theta} [p.C(q, q, q*) + 2 p.B(q, (1 - A)^-1 B(q, q*)) + p.B(q*, (e^{2 i theta} - A)^-1 B(q, q))]/2

a < 0: supercritical. The derivatives are differences of f, in which the impacts keep their order.
"""

import numpy as np

from vibro_sweep.analysis.periodic.impulse_equations import flow
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses import flights

STEPS = (3e-3, 1e-3, 3e-4, 1e-4)  # of differences, as a part of the distance over which impact times move by 1/omega
RESONANT = 1e-3  # |e^{i k theta} - 1| for k = 1 .. 4 below which a does not decide
AGREED = 0.1  # relative difference of two values


class _Map:
    """The map over P, with the mirror for sigma = -1, from the middle of the longest flight; in contact coordinates."""

    def __init__(self, s: Solution):
        self.s, self.f = s, flow(s.family.linear)
        self.n = self.f.B.shape[0] - 3
        ends = np.append(s.times[1:], s.times[0] + s.equations.P)
        k = int(np.argmax(ends - s.times))
        self.begin = (s.times[k] + ends[k]) / 2
        later = [(s.times[i], s.sides[i]) for i in range(k + 1, s.K)]
        self.impacts = later + [(s.times[i] + s.equations.P, s.sigma * s.sides[i]) for i in range(k + 1)]
        after = np.zeros(len(self.f.B))
        after[: self.n] = s.states[k, : self.n]
        after[self.n // 2] += s.jumps[k]
        self.centre = self._fly(after, s.times[k], self.begin)

    def _fly(self, zeta, begin: float, end: float) -> np.ndarray:
        m = len(zeta)
        out, which = np.empty((1, m)), np.zeros(1, int)
        flights.sample_flights(self.f, zeta[None], np.array([begin]), which, np.array([end]), out, np.empty((2, m)))
        return out[0]

    def __call__(self, change) -> np.ndarray:
        """The change of the image. ArithmeticError where an impact is lost."""
        P, N, q = self.s.equations.P, self.n // 2, self.s.family.linear
        zeta, t = self.centre.copy(), self.begin
        zeta[: self.n] += change
        for aim, side in self.impacts:
            stop, R = float(q.stop([side])[0]), float(q.restitution([side])[0])
            for _ in range(20):
                there = self._fly(zeta, t, aim)
                step = (there[0] - stop) / there[N]
                aim -= step
                if abs(step) <= 1e-15 * P:
                    break
            else:
                raise ArithmeticError("an impact is lost")
            zeta, t = self._fly(zeta, t, aim), aim
            zeta[N] *= -R
        zeta = self._fly(zeta, t, self.begin + P)
        return self.s.sigma * zeta[: self.n] - self.centre[: self.n]


def criticality(solution: Solution) -> str | None:
    """ "super" or "sub" of a Neimark-Sacker point; None where the coefficient does not tell, also at a resonance."""
    if solution.rests:
        return None
    f = _Map(solution)
    mu = solution.multipliers
    theta = float(np.angle(mu[np.argmin(np.where(mu.imag > 0, np.abs(np.abs(mu) - 1), np.inf))]))
    if min(abs(np.exp(1j * k * theta) - 1) for k in range(1, 5)) < RESONANT:
        return None
    q = solution.family.linear
    speeds = np.abs(solution.motion[:, 0])
    reach = float(speeds.min()) / q.omega
    unit = np.repeat([1.0, q.omega], f.n // 2) * reach
    before = None
    for step in STEPS:
        try:
            value = _coefficient(f, theta, unit, step)
        except (ArithmeticError, np.linalg.LinAlgError):
            continue
        if before is not None and abs(value - before) < AGREED * abs(value):
            return "super" if value < 0 else "sub"
        before = value
    return None


def _coefficient(f: _Map, theta: float, unit, h: float) -> float:
    """a, with coordinates in `unit` and differences over h."""
    known: dict = {}

    def at(direction, times) -> np.ndarray:
        key = (direction.tobytes(), times)
        if key not in known:
            known[key] = f(unit * direction * (times * h)) / unit
        return known[key]

    def second(x, y) -> np.ndarray:
        """B(x, y) for complex x and y."""
        if np.iscomplexobj(x) or np.iscomplexobj(y):
            a, b, c, d = x.real, x.imag, y.real, y.imag
            return second(a, c) - second(b, d) + 1j * (second(a, d) + second(b, c))
        sizes = np.linalg.norm(x), np.linalg.norm(y)
        if min(sizes) == 0:
            return np.zeros(len(x))
        x, y = x / sizes[0], y / sizes[1]
        both = [at(x + sign * y, 1) + at(x + sign * y, -1) for sign in (1, -1)]
        return (both[0] - both[1]) / (4 * h**2) * sizes[0] * sizes[1]

    def third(x) -> np.ndarray:
        """C(x, x, x) for a real x."""
        return (at(x, 2) - 2 * at(x, 1) + 2 * at(x, -1) - at(x, -2)) / (2 * h**3)

    eye = np.eye(f.n)
    A = np.array([(8 * (at(e, 1) - at(e, -1)) - at(e, 2) + at(e, -2)) / (12 * h) for e in eye]).T
    turn = np.exp(1j * theta)
    values, vectors = np.linalg.eig(A)
    q = vectors[:, np.argmin(np.abs(values - turn))]
    values, vectors = np.linalg.eig(A.T)
    p = vectors[:, np.argmin(np.abs(values - turn))]
    p = p / (p @ q)
    u, v = q.real, q.imag
    plus, minus, cu, cv = third(u + v), third(u - v), third(u), third(v)
    uuv, uvv = (plus - minus) / 6 - cv / 3, (plus + minus) / 6 - cu / 3
    cubic = cu + uvv + 1j * (uuv + cv)
    mean = np.linalg.solve(eye - A, second(q, q.conj()).real.astype(complex))
    double = np.linalg.solve(turn**2 * eye - A, second(q, q))
    total = p @ cubic + 2 * p @ second(q, mean) + p @ second(q.conj(), double)
    return float((total / turn).real) / 2
