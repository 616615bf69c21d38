"""Contact coordinates of a linear oscillator with one contact: q = P (x - x0), of which the first is the gap.

The others are the positions of the masses themselves but one, which follows from the gap. Left out is the mass that is
held least, so that a stiffly held mass keeps all digits of its small displacement beside a large gap: combinations of
both, such as those in which the mass matrix is diagonal, would lose as many digits as their stiffnesses lie apart. An
impulse on the gap then moves the other masses too,

    q1' -> q1' + D,    qj' -> qj' + p_j D,    p = P M^-1 n/(n.M^-1 n),    p_1 = 1.

For n = e1 the coordinates are those of the masses; if M is diagonal as well, p is e1.

x0 is 0, or where the stops lie on one side of 0 a state whose gap is in the middle of the stops: the state of an orbit
is rounded as a distance from there, and not as one from a far origin.
"""

from fractions import Fraction
from typing import NamedTuple

import numpy as np

from vibro_sweep.model.linear import Linear


class Natural(NamedTuple):
    """The oscillator w'' + damping w' + stiffness w = ... in coordinates w in which the mass matrix is diagonal."""

    masses: np.ndarray  # (N,): diagonal of the mass matrix
    stiffness: np.ndarray  # (N, N)
    damping: np.ndarray  # (N, N)
    normal: np.ndarray  # (N,): the gap is normal . w
    to_contact: np.ndarray | None  # (N, N): q of w; None if they are the same
    of_masses: np.ndarray | None  # (N, N): L^-1 of M = L L^T; None where M is diagonal and w = x


class Contact(NamedTuple):
    """q'' + damping q' + stiffness q = force (sin, cos, 1)."""

    P: np.ndarray  # (N, N)
    back: np.ndarray  # (N, N): its inverse
    origin: np.ndarray  # (N,): x0
    push: np.ndarray  # (N,): p
    stiffness: np.ndarray  # (N, N)
    damping: np.ndarray  # (N, N)
    force: np.ndarray  # (N, 3)
    constrained: np.ndarray  # (N, 2 N + 3): q'' as a function of (q, q', sin, cos, 1) while a stop holds the gap

    @property
    def turned(self) -> bool:
        """Whether states are others than those of the masses."""
        return not np.array_equal(self.P, np.eye(len(self.P))) or bool(np.any(self.origin))


def contact_coordinates(q: Linear) -> Contact:
    """The oscillator in contact coordinates."""
    n, origin = len(q.normal), origin_of(q)
    if _same(q):
        eye, masses = np.eye(n), q.M.diagonal()[:, None]
        stiffness, damping = q.K / masses, q.C / masses
        force = np.stack([q.sine, q.cosine, rest_force(q, origin)], -1) / masses
        constrained = np.concatenate([-stiffness, -damping, force], -1)
        constrained[0] = 0.0
        return Contact(eye, eye, origin, eye[0], stiffness, damping, force, constrained)
    P, back = coordinates(q.normal, least_restrained(q))
    push = push_of(q, P)
    stiffness, damping = (P @ by_mass(q.M, matrix @ back) for matrix in (q.K, q.C))
    forces = np.stack([q.sine, q.cosine, rest_force(q, origin)], -1)
    constrained = np.zeros((len(P), 2 * len(P) + 3))
    others = back[:, 1:].T
    constrained[1:] = by_mass(others @ q.M @ others.T, others @ np.hstack([-q.K @ back, -q.C @ back, forces]))
    return Contact(P, back, origin, push, stiffness, damping, P @ by_mass(q.M, forces), constrained)


def is_own(q: Linear) -> bool:
    """Whether these are the masses' own coordinates, of which an impulse moves the first alone."""
    return _same(q) and not origin_of(q).any()


def _same(q: Linear) -> bool:
    return bool(q.normal[0] == 1) and np.count_nonzero(q.normal) == 1 and is_diagonal(q.M)


def by_mass(M: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """M^-1 rows."""
    return rows / M.diagonal()[:, None] if is_diagonal(M) else np.linalg.solve(M, rows)


def is_diagonal(M: np.ndarray) -> bool:
    return np.count_nonzero(M) == np.count_nonzero(M.diagonal())


def least_restrained(q: Linear) -> int:
    """The mass that the gap moves with the least force, by its own spring, damper and mass alone."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        size = np.abs(np.diag(q.K)) + q.omega * np.abs(np.diag(q.C)) + q.omega * q.omega * np.abs(np.diag(q.M))
        return int(np.nanargmin(np.where(q.normal != 0, size / q.normal / q.normal, np.inf)))


def coordinates(along: np.ndarray, spare: int) -> tuple[np.ndarray, np.ndarray]:
    """P (N, N) and its inverse: the gap, and the masses but `spare` in their order."""
    n = len(along)
    others = [i for i in range(n) if i != spare]
    P, back = np.zeros((2, n, n), np.result_type(along, float))
    P[0] = along
    back[spare, 0] = 1 / along[spare]
    for row, i in enumerate(others, 1):
        P[row, i] = back[i, row] = 1.0
        back[spare, row] = 0.0 - along[i] / along[spare]
    return P, back


def push_of(q: Linear, P: np.ndarray) -> np.ndarray:
    """p (N,): what an impulse that changes the velocity of the gap by 1 does to q'."""
    push = by_mass(q.M, q.normal[:, None])[:, 0]
    push = P @ push / (q.normal @ push)
    push[0] = 1.0
    return push


def origin_of(q: Linear) -> np.ndarray:
    """x0: at rest with the gap in the middle of the stops, as nearly as rounding lets it be; 0 if that lies between."""
    n, b = len(q.normal), min(abs(q.middle - q.low), abs(q.high - q.middle))
    if not is_far(q.middle, b):
        return np.zeros(n)
    bordered = np.block([[q.K, q.normal[:, None]], [q.normal[None], np.zeros((1, 1))]])
    scale = 1 / np.sqrt(np.append(np.maximum(np.abs(np.diag(q.K)), q.omega * q.omega * np.diag(q.M)), 1.0))
    scale[-1] = 1 / max(np.abs(q.normal * scale[:-1]).max(), 1e-300)
    found = np.linalg.lstsq(bordered * np.outer(scale, scale), np.append(q.constant, q.middle) * scale, rcond=None)[0]
    return (found * scale)[:n]


def is_far(offset, b):
    """Whether the stops, which are b from the offset, lie on one side of 0. Also of arrays."""
    return np.abs(offset) > np.abs(b)


def rest_force(q: Linear, origin: np.ndarray) -> np.ndarray:
    """constant - K x0 (N,), of which no digit is lost."""
    if not origin.any():
        return q.constant
    return np.array([exact_sum([f, *(-q.K[i])], [1.0, *origin]) for i, f in enumerate(q.constant)])


def distance(q: Linear, origin: np.ndarray, gap: float) -> float:
    """`gap` as seen from x0, rounded once."""
    if not (origin.any() and np.isfinite(gap)):
        return gap
    return exact_sum([gap, *(-q.normal)], [1.0, *origin])


def exact_sum(a, b) -> float:
    """a . b, rounded once."""
    return float(sum(Fraction(float(x)) * Fraction(float(y)) for x, y in zip(a, b, strict=True)))


def natural_coordinates(q: Linear, contact: Contact) -> Natural:
    """The coordinates of the masses where M is diagonal; else w = L^T x, with M = L L^T."""
    if is_diagonal(q.M):
        masses = np.diag(q.M).astype(float)
        to_contact = None if np.array_equal(contact.P, np.eye(len(masses))) else contact.P
        return Natural(masses, by_mass(q.M, q.K), by_mass(q.M, q.C), q.normal.astype(float), to_contact, None)
    inverse = np.linalg.inv(np.linalg.cholesky(q.M))
    stiffness, damping = (inverse @ matrix @ inverse.T for matrix in (q.K, q.C))
    return Natural(np.ones(len(inverse)), stiffness, damping, inverse @ q.normal, contact.P @ inverse.T, inverse)


def flight_matrix(stiffness: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """A (2 N, 2 N) of (q1, q1', q2, q2', ...)' = A (q1, q1', ...) without forces."""
    n = len(stiffness)
    A = np.zeros((2 * n, 2 * n))
    A[0::2, 1::2] = np.eye(n)
    A[1::2, 0::2], A[1::2, 1::2] = -stiffness, -damping
    return A


def fastest_rate(stiffness: np.ndarray, damping: np.ndarray) -> float:
    """The largest modulus of a root; infinite beyond the range of the floats."""
    A = flight_matrix(stiffness, damping)
    if not (len(A) and np.isfinite(A).all()):
        return np.inf if len(A) else 0.0
    return float(np.abs(np.linalg.eigvals(A)).max())
