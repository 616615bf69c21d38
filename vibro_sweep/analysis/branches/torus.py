"""Whether the invariant circle that is born at a Neimark-Sacker point attracts: the first Lyapunov coefficient.

For the map f over P with f' = A, A q = e^{i theta} q, p^T A = e^{i theta} p^T, p.q = 1 and the second and third
derivatives B, C (Kuznetsov, Elements of Applied Bifurcation Theory, eq. 5.45 of the 3rd edition):

    a = Re e^{-i theta} [p.C(q, q, q*) + 2 p.B(q, (1 - A)^-1 B(q, q*)) + p.B(q*, (e^{2 i theta} - A)^-1 B(q, q))]/2

a < 0: supercritical. The derivatives are exact: f is applied to power series in two small numbers r and s, to third
order. A series is an array (.., 4, 4) of the coefficients of r^j s^k; those with j + k > 3 mean nothing.
"""

import numpy as np

from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses import flights
from vibro_sweep.engine.impulses.flow import flow

ORDER = 3
RESONANT = 1e-3  # |e^{i k theta} - 1| for k = 1 .. 4 below which a does not decide
ROUNDED = 1e-8  # part of its terms below which a is rounding
ON_CIRCLE = 1e-6  # distance of the computed eigenvalue of A from e^{i theta}, at most


def times(b) -> np.ndarray:
    """(16, 16): what a row of a series' coefficients is multiplied by, for the product with b."""
    out = np.zeros((ORDER + 1,) * 4, complex)
    for j in range(ORDER + 1):
        for k in range(ORDER + 1 - j):
            out[j, k, j:, k:] = b[: ORDER + 1 - j, : ORDER + 1 - k]
    return out.reshape(b.size, b.size)


class Map:
    """The map over P, with the mirror for sigma = -1, from the time of the first impact on, in contact coordinates.

    States at the time of an impact are those of the flight before it, also of motions that have hit already.
    """

    def __init__(self, s: Solution):
        self.s, f = s, flow(s.family.linear)
        self.B, self.n = f.B, f.B.shape[0] - 3
        self.E = np.empty((s.K, self.n, self.n))
        lengths = np.diff(np.append(s.times, s.times[0] + s.P))
        flights.flight_matrices(f, lengths, self.E, flights.new_room(self.n + 3))
        self.R = s.family.linear.restitution(s.sides)

    def __call__(self, change) -> np.ndarray:
        """The change (n, 4, 4) of the image."""
        for i in range(self.s.K):
            change = np.tensordot(self.E[i], self._strike(i, change), 1)
        return self.s.sigma * change

    def _strike(self, i: int, change) -> np.ndarray:
        """Change of the flight after impact i, both at the time of the impact on the orbit."""
        N, states = self.n // 2, self.s.states
        zeta = np.zeros((self.n + 3, ORDER + 1, ORDER + 1), complex)
        zeta[: self.n] = change
        zeta[:, 0, 0] = states[i]
        delay = np.zeros_like(zeta[0])
        for _ in range(ORDER):  # each is right to one order more
            gap = self._moved(zeta, delay)[0]
            gap[0, 0] = 0.0
            delay -= gap / states[i, N]
        there = self._moved(zeta, delay)
        there[N] *= -self.R[i]
        back = self._moved(there, -delay)[: self.n]
        back[:, 0, 0] = 0.0
        return back

    def _moved(self, zeta, delay) -> np.ndarray:
        """exp(B delay) zeta for a delay without a constant term."""
        total = term = zeta.reshape(len(zeta), -1)
        by_delay = times(delay)
        for k in range(1, ORDER + 1):
            term = self.B @ term @ by_delay / k
            total = total + term
        return total.reshape(zeta.shape)


def critical_angle(solution: Solution) -> float:
    """Of the complex multiplier nearest to the unit circle."""
    mu = solution.multipliers
    return float(np.angle(mu[np.argmin(np.where(mu.imag > 0, np.abs(np.abs(mu) - 1), np.inf))]))


def criticality(solution: Solution) -> str | None:
    """ "super" or "sub" of a Neimark-Sacker point; None where the coefficient does not tell, also at a resonance."""
    if solution.rests:
        return None
    theta = critical_angle(solution)
    if min(abs(np.exp(1j * k * theta) - 1) for k in range(1, 5)) < RESONANT:
        return None
    try:
        terms = coefficient(Map(solution), theta)
    except np.linalg.LinAlgError:
        return None
    a, size = float(terms.sum().real), float(np.abs(terms).sum())
    return None if not abs(a) > ROUNDED * size else "super" if a < 0 else "sub"


def quarter(f) -> tuple[complex, complex, np.ndarray]:
    """c and d of z -> i (z + c |z|^2 z + d conj(z)^3) at the resonance 1:4, and q, for the state z q + conj(z q).

    Kuznetsov, 3rd edition, 9.5.4: c is the sum of `coefficient`.
    """
    image, A, q, p = _critical(f, 1j)
    both = image(q, q.conj())
    double = np.linalg.solve(-np.eye(f.n) - A, both[:, 0, 2])
    d = p @ (both[:, 0, 3] + image(q.conj(), double)[:, 1, 1]) / 1j
    return complex(coefficient(f, np.pi / 2).sum()), complex(d), q


def coefficient(f, theta: float) -> np.ndarray:
    """The three terms of a, complex, for |q| = 1; f has `n` and maps series. LinAlgError without such an eigenvalue."""
    turn, eye = np.exp(1j * theta), np.eye(f.n)
    image, A, q, p = _critical(f, turn)
    both = image(q, q.conj())
    mean = np.linalg.lstsq(eye - A, both[:, 1, 1])[0]
    double = np.linalg.lstsq(turn**2 * eye - A, 2 * both[:, 2, 0])[0]
    cubic, by_mean, by_double = 2 * both[:, 2, 1], image(q, mean)[:, 1, 1], image(q.conj(), double)[:, 1, 1]
    return np.array([p @ cubic, 2 * p @ by_mean, p @ by_double]) / turn / 2


def _critical(f, turn: complex):
    """image(x, y), the series of f(r x + s y); f' and its critical vectors q and p, p.q = 1."""

    def image(x, y) -> np.ndarray:
        series = np.zeros((f.n, ORDER + 1, ORDER + 1), complex)
        series[:, 1, 0], series[:, 0, 1] = x, y
        return f(series)

    A = np.array([image(e, 0 * e)[:, 1, 0] for e in np.eye(f.n)]).T.real
    q, p = (_vector(matrix, turn) for matrix in (A, A.T))
    return image, A, q, p / (p @ q)


def _vector(matrix, value) -> np.ndarray:
    """The unit eigenvector of an eigenvalue."""
    values, vectors = np.linalg.eig(matrix)
    k = np.argmin(np.abs(values - value))
    if not abs(values[k] - value) < ON_CIRCLE:
        raise np.linalg.LinAlgError("no such eigenvalue")
    return vectors[:, k]
