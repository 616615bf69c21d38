"""Contact coordinates of linear oscillators with one contact: q = P (x - x0), of which the first is the gap.

Of a single oscillator, or of each of a stack (stacks.py). The others are the positions of the masses themselves but
one, which follows from the gap. Left out is the mass that is held least, so that a stiffly held mass keeps all digits
of its small displacement beside a large gap: combinations of both, such as those in which the mass matrix is diagonal,
would lose as many digits as their stiffnesses lie apart. An impulse on the gap then moves the other masses too,

    q1' -> q1' + D,    qj' -> qj' + p_j D,    p = P M^-1 n/(n.M^-1 n),    p_1 = 1.

For n = e1 the coordinates are those of the masses; if M is diagonal as well, p is e1.

x0 is 0, or where the stops lie on one side of 0 a state whose gap is in the middle of the stops: the state of an orbit
is rounded as a distance from there, and not as one from a far origin.
"""

from fractions import Fraction
from typing import NamedTuple

import numpy as np

from vibro_sweep.oscillator.linear import Linear, bordered, selected
from vibro_sweep.oscillator.stacks import diagonal, dot, finite, least_squares, only, times, transposed


class Natural(NamedTuple):
    """The oscillators w'' + damping w' + stiffness w = ... in coordinates w in which the mass matrix is diagonal."""

    masses: np.ndarray  # (..., N): diagonal of the mass matrix
    stiffness: np.ndarray  # (..., N, N)
    damping: np.ndarray  # (..., N, N)
    normal: np.ndarray  # (..., N): the gap is normal . w
    to_contact: np.ndarray  # (..., N, N): q of w
    of_masses: np.ndarray  # (..., N, N): L^-1 of M = L L^T; the unit matrix where M is diagonal and w = x


class ContactCoordinates(NamedTuple):
    """q'' + damping q' + stiffness q = force (sin, cos, 1), of each oscillator of a stack."""

    P: np.ndarray  # (..., N, N)
    back: np.ndarray  # (..., N, N): its inverse
    origin: np.ndarray  # (..., N): x0
    push: np.ndarray  # (..., N): p
    stiffness: np.ndarray  # (..., N, N)
    damping: np.ndarray  # (..., N, N)
    force: np.ndarray  # (..., N, 3)
    constrained: np.ndarray  # (..., N, 2 N + 3): q'' as a function of (q, q', sin, cos, 1) while a stop holds the gap

    @property
    def turned(self) -> np.ndarray:
        """Whether states are others than those of the masses, (...)."""
        return (self.P != np.eye(self.P.shape[-1])).any((-2, -1)) | self.origin.any(-1)


def contact_coordinates(q: Linear) -> ContactCoordinates:
    """The oscillators in contact coordinates."""
    n, origin = q.masses, origin_of(q)
    P, back = coordinates(q.contact.normal, least_restrained(q))
    push = push_of(q, P)
    forces = np.stack([q.sine, q.cosine, rest_force(q, origin)], -1)
    constrained, others = np.zeros((*P.shape[:-1], 2 * n + 3)), transposed(back[..., 1:])
    with np.errstate(all="ignore"):  # beyond the range of the floats: such an oscillator is too stiff
        stiffness, damping = (P @ by_mass(q.M, matrix @ back) for matrix in (q.K, q.C))
        free = np.concatenate([-q.K @ back, -q.C @ back, forces], -1)
        constrained[..., 1:, :] = by_mass(others @ q.M @ transposed(others), others @ free)
        force = P @ by_mass(q.M, forces)
    return ContactCoordinates(P, back, origin, push, stiffness, damping, force, constrained)


def is_own(q: Linear) -> np.ndarray:
    """Whether these are the masses' own coordinates, of which an impulse moves the first alone, (...)."""
    first = (q.contact.normal == np.eye(q.masses)[0]).all(-1)
    return first & is_diagonal(q.M) & ~origin_of(q).any(-1)


def by_mass(M: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """M^-1 rows."""
    simple = is_diagonal(M)
    if np.all(simple):
        return rows / diagonal(M)[..., None]
    with np.errstate(all="ignore"):
        return np.where(simple[..., None, None], rows / diagonal(M)[..., None], np.linalg.solve(M, rows))


def is_diagonal(M: np.ndarray) -> np.ndarray:
    """Whether each is, (...)."""
    return ~np.where(np.eye(M.shape[-1], dtype=bool), 0, M).any((-2, -1))


def least_restrained(q: Linear) -> np.ndarray:
    """The mass that the gap moves with the least force, by its own spring, damper and mass alone, (...)."""
    K, C, M = (np.abs(diagonal(one)) for one in (q.K, q.C, q.M))
    omega = np.asarray(q.omega)[..., None]
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        force = (K + omega * C + omega * omega * M) / q.contact.normal / q.contact.normal
    return np.where((q.contact.normal != 0) & ~np.isnan(force), force, np.inf).argmin(-1)


def coordinates(along: np.ndarray, spare: np.ndarray | int) -> tuple[np.ndarray, np.ndarray]:
    """P (..., N, N) and its inverse: the gap, and the masses but `spare` in their order."""
    n, spare = along.shape[-1], np.asarray(spare)[..., None]
    others = (np.arange(n) == spare).argsort(-1, kind="stable")[..., : n - 1]
    rows = np.eye(n)[others]
    P = np.concatenate([along[..., None, :], rows], -2)
    # x_spare = (q1 - sum of n_i x_i)/n_spare
    largest = np.take_along_axis(along, spare, -1)
    last = np.concatenate([1 / largest, 0.0 - np.take_along_axis(along, others, -1) / largest], -1)
    back = np.concatenate([np.zeros((*rows.shape[:-2], n, 1), last.dtype), transposed(rows)], -1)
    np.put_along_axis(back, spare[..., None], last[..., None, :], -2)
    return P, back


def push_of(q: Linear, P: np.ndarray) -> np.ndarray:
    """p (..., N): what an impulse that changes the velocity of the gap by 1 does to q'."""
    push = by_mass(q.M, q.contact.normal[..., None])[..., 0]
    push = times(P, push) / dot(q.contact.normal, push)[..., None]
    push[..., 0] = 1.0
    return push


def origin_of(q: Linear) -> np.ndarray:
    """x0 (..., N): at rest with the gap in the middle of the stops, as nearly as rounding lets it be; 0 if that lies
    between."""
    one = q.contact
    far = is_far(one.middle, np.minimum(np.abs(one.middle - one.low), np.abs(one.high - one.middle)))
    if not far.any():
        return np.broadcast_to(0.0, q.contact.normal.shape)
    result = np.zeros(q.contact.normal.shape)
    result[far] = _held_in_the_middle(selected(q, far))
    return result


def _held_in_the_middle(q: Linear) -> np.ndarray:
    """(..., N)"""
    omega, ones = q.omega[..., None], np.ones((*q.omega.shape, 1))
    size = np.maximum(np.abs(diagonal(q.K)), omega * omega * diagonal(q.M))
    scale = 1 / np.sqrt(np.append(size, ones, -1))
    scale[..., -1] = 1 / np.maximum(np.abs(q.contact.normal * scale[..., :-1]).max(-1), 1e-300)
    scaled = bordered(q.K, q.contact.normal) * (scale[..., :, None] * scale[..., None, :])
    found = least_squares(scaled, np.append(q.constant, q.contact.middle[..., None], -1) * scale)
    return (found * scale)[..., :-1]


def is_far(offset, b) -> np.ndarray:
    """Whether the stops, which are b from the offset, lie on one side of 0. Also of arrays."""
    return np.abs(offset) > np.abs(b)


def rest_force(q: Linear, origin: np.ndarray) -> np.ndarray:
    """constant - K x0 (..., N), of which no digit is lost."""
    result = np.array(q.constant)
    for place in zip(*np.nonzero(np.broadcast_to(origin.any(-1, keepdims=True), result.shape)), strict=True):
        at = place[:-1]
        result[place] = exact_sum([result[place], *(-q.K[place])], [1.0, *origin[at]])
    return result


def distance(q: Linear, origin: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """`gap` (...) as seen from x0, rounded once."""
    result, moved = np.array(gap), origin.any(-1)
    for place in map(tuple, np.argwhere(moved & np.isfinite(gap)) if moved.any() else ()):
        result[place] = exact_sum([gap[place], *(-q.contact.normal[place])], [1.0, *origin[place]])
    return result


def exact_sum(a, b) -> float:
    """a . b, rounded once."""
    return float(sum(Fraction(float(x)) * Fraction(float(y)) for x, y in zip(a, b, strict=True)))


def natural_coordinates(q: Linear, contact: ContactCoordinates) -> Natural:
    """The coordinates of the masses where M is diagonal; else w = L^T x, with M = L L^T."""
    simple, eye = is_diagonal(q.M), np.eye(q.M.shape[-1])
    one, many = simple[..., None], simple[..., None, None]
    of_masses = np.where(many, eye, np.linalg.inv(np.linalg.cholesky(q.M)))
    stiffness, damping = (
        np.where(many, by_mass(q.M, matrix), of_masses @ matrix @ transposed(of_masses)) for matrix in (q.K, q.C)
    )
    return Natural(
        np.where(one, diagonal(q.M), 1.0), stiffness, damping, times(of_masses, q.contact.normal),
        contact.P @ transposed(of_masses), of_masses,
    )  # fmt: skip


def flight_matrix(stiffness: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """A (..., 2 N, 2 N) of (q1, q1', q2, q2', ...)' = A (q1, q1', ...) without forces."""
    n = stiffness.shape[-1]
    A = np.zeros((*stiffness.shape[:-2], 2 * n, 2 * n))
    A[..., 0::2, 1::2] = np.eye(n)
    A[..., 1::2, 0::2], A[..., 1::2, 1::2] = -stiffness, -damping
    return A


def fastest_rate(stiffness: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """The largest modulus of a root, (...); infinite beyond the range of the floats."""
    A = flight_matrix(stiffness, damping)
    if not A.shape[-1]:
        return np.zeros(A.shape[:-2])
    known = finite(A)
    return np.where(known, np.abs(np.linalg.eigvals(only(known, A))).max(-1), np.inf)
