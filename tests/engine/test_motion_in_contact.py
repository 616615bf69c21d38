"""Motion in contact: its tables in pieces, against matrix exponentials in longer floats; and its fast and slow parts,
set apart, against the equations of both together. Python runs the kernels."""

import numpy as np
import pytest

from vibro_sweep.engine.compliant.contact_pieces import (
    FORCE,
    FORCE_SLOPE,
    GUARD,
    PIECES,
    PLACE,
    POINTS,
    SLOPE,
    TERMS,
    WIDER,
    set_pieces,
)
from vibro_sweep.engine.compliant.law import law_of
from vibro_sweep.engine.compliant.passage_tables import passages_of
from vibro_sweep.engine.compliant.slow_manifold import is_set_apart, part_of
from vibro_sweep.engine.compliant.stop_laws import AT_PLACE, BREAKS, RELAXES
from vibro_sweep.engine.compliant.tangent_in_contact import jump_at_release

ORBIT, STOP, PRELOAD = 3, 1, 0.3


def random_contact(masses, k, seed):
    """The equations of a contact, (delta'', w2'', ...) by (delta, delta', w2, ..., sin, cos, 1); c, and omega."""
    rng = np.random.default_rng([masses, seed])
    G = rng.normal(size=(masses, 2 * masses + 3))
    for m in range(1, masses):
        G[m, 2 * m], G[m, 2 * m + 1] = -1.0 - abs(G[m, 2 * m]), -0.1 * abs(G[m, 2 * m + 1])
    c = 0.2 * np.sqrt(k) * rng.uniform()
    G[0, :2] = -k - rng.uniform(), -c - 0.1 * rng.uniform()
    return G, c, rng.uniform(0.3, 2.0)


def whole(G, omega):
    """The matrix of (delta, delta', w2, w2', ..., sin, cos, 1)."""
    masses = len(G)
    A = np.zeros((2 * masses + 3, 2 * masses + 3))
    for m in range(masses):
        A[2 * m, 2 * m + 1], A[2 * m + 1] = 1.0, G[m]
    A[-3, -2], A[-2, -3] = omega, -omega
    return A


def expm(A):
    """By the series of a part of the time, and squares. The columns of the states are scaled for it, so that a stiff
    stop does not drown the rest."""
    scale = np.ones(len(A), np.longdouble)
    scale[1] = np.sqrt(max(1.0, -A[1, 0] / max(A[0, 1], 1e-300)))
    A = A.astype(np.longdouble) * scale / scale[:, None]
    halvings = max(0, int(np.ceil(np.log2(np.abs(A).sum(1).max() + 1e-300))) + 4)
    part, D = A / 2**halvings, np.zeros(A.shape, np.longdouble)
    for n in range(20, 0, -1):
        D = part @ (np.eye(len(A)) + D) / n
    for _ in range(halvings):
        D = 2 * D + D @ D
    return ((np.eye(len(A)) + D) * scale[:, None] / scale).astype(float)


class Tables:
    """Those of one orbit's contacts with the right stop. z is of (delta', w2, w2', ..., sin, cos, 1) at the touch."""

    def __init__(self, masses, k, seed, by_force=False, z=None):
        self.G, self.c, omega = random_contact(masses, k, seed)
        if z is not None:
            self.c = 2 * z * np.sqrt(k)
            self.G[0, 1] = -self.c
        self.k, self.A, self.by_force = k, whole(self.G, omega), by_force
        self.passage = np.zeros(1, passages_of(masses, True)).view(np.recarray)[0]
        contact = np.zeros(1, law_of(masses)).view(np.recarray)[0]
        contact.equations[STOP], contact.compliant[STOP] = self.G, 1
        for name, value in (("stiffness", k), ("damping", self.c), ("preload", PRELOAD), ("by_force", by_force)):
            self.passage[name][STOP, ORBIT] = value
        rates = np.full(2, max(omega, np.abs(np.linalg.eigvals(self.A)).max()))
        set_pieces(self.passage, ORBIT, contact, rates, omega)
        self.h, self.inputs = self.passage.length[STOP, ORBIT], 2 * masses + 2
        flights = [np.abs(expm(self.A * (0.25 * n * self.h))) for n in range(20)]
        self.sizes = np.max(flights, axis=0)  # of what each number may make of each in all pieces

    def rows(self, name, shape):
        return self.passage[name][:, ORBIT].reshape(shape)

    def state(self, u, z):
        return expm(self.A * u) @ np.append(0.0, z)


def touches(rng, masses):
    """Random inputs at a touch, with speeds small and large."""
    z = rng.normal(size=(6, 2 * masses + 2))
    z[:, 0], z[:, -1] = 10.0 ** rng.uniform(-3, 2, 6), 1.0
    return z


@pytest.mark.parametrize("masses", [1, 2, 3])
@pytest.mark.parametrize("k, damping", [(0.7, None), (100.0, None), (1e8, None), (100.0, 0.8), (100.0, 1.7)])
def test_polynomials_are_the_flight(masses, k, damping):
    """In every piece and a little beyond, of delta and of the other masses."""
    rng = np.random.default_rng(masses)
    tables = Tables(masses, k, masses, z=damping)
    size = tables.inputs + 1
    course = tables.rows("course", (2, PIECES, size, TERMS))[STOP]
    others = tables.rows("others", (2, PIECES, masses - 1, size, TERMS))[STOP]
    for p in range(PIECES):
        for v in np.linspace(-0.5 * WIDER if p > 0 else 0.1, 0.5 * WIDER, 5) * tables.h:
            u, powers = p * tables.h + v, v ** np.arange(TERMS)
            E = expm(tables.A * u)
            for z in touches(rng, masses):
                x, scale = E @ np.append(0.0, z), tables.sizes @ np.abs(np.append(0.0, z))
                delta = z @ (course[p, :-1] @ powers) * (u if p == 0 else 1.0)
                assert abs(delta - x[0]) <= 2e-14 * scale[0]
                for m in range(1, masses):
                    beside = z @ (others[p, m - 1, :-1] @ powers)
                    expected = x[2 * m] - (z[2 * m - 1] + z[2 * m] * u)
                    assert abs(beside - expected) <= 2e-14 * scale[2 * m]
            # of a unit delta at the touch
            assert abs(course[p, -1] @ powers - E[0, 0]) <= 2e-14 * max(1.0, abs(E[0, 0]))


@pytest.mark.parametrize("by_force", [False, True])
@pytest.mark.parametrize("masses", [1, 2])
def test_what_pieces_end_with(masses, by_force):
    rng, tables = np.random.default_rng(5), Tables(masses, 100.0, 2, by_force)
    ends = tables.rows("ends", (3, 2, PIECES, tables.inputs))[:, STOP]
    for p in range(PIECES):
        for z in touches(rng, masses):
            u = (p + 0.5) * tables.h
            x = tables.state(u, z)
            rate = tables.A @ x
            scale = tables.k * tables.sizes[0, 1:] @ np.abs(z) + tables.c * tables.sizes[1, 1:] @ np.abs(z) + 1
            guard = tables.k * x[0] + tables.c * x[1] + PRELOAD if by_force else x[0]
            assert abs(ends[GUARD, p] @ z - guard) <= 1e-13 * scale
            assert abs(ends[SLOPE, p] @ z - x[1]) <= 1e-13 * scale
            force_slope = tables.k * x[1] + tables.c * rate[1]
            assert abs(ends[FORCE_SLOPE, p] @ z - force_slope) <= 1e-12 * scale / tables.h


@pytest.mark.parametrize("by_force", [False, True])
@pytest.mark.parametrize("masses", [1, 2])
def test_control_points_are_bounds(masses, by_force):
    """Up to each piece the guard is nowhere below the least control point less what they leave out; and a sum that is
    positive is below all of it."""
    rng, tables, kind = np.random.default_rng(7), Tables(masses, 100.0, 1, by_force), FORCE if by_force else PLACE
    points = tables.rows("before", (2, 2, PIECES, tables.inputs, POINTS + 1))[kind, STOP]
    least = tables.rows("least", (2, 2, PIECES, tables.inputs))[kind, STOP]
    tight, surely = 0, 0
    for p in range(1, PIECES):
        times = np.linspace(1e-3, 1, 40) * (p - 0.5) * tables.h
        flights = [expm(tables.A * u) for u in times]
        for z in touches(rng, masses):
            motion = np.array([E @ np.append(0.0, z) for E in flights])
            place, force = motion[:, 0] / times, tables.k * motion[:, 0] + tables.c * motion[:, 1] + PRELOAD
            lowest = (force if by_force else place).min()
            bound = (z @ points[p, :, :-1]).min() - np.abs(z) @ points[p, :, -1]
            assert bound <= lowest
            assert least[p] @ np.abs(z) <= lowest
            tight += bound > lowest - 0.3 * (abs(lowest) + tables.k * abs(z[0]) * tables.h)
            surely += least[p] @ np.abs(z) > 0
    assert tight > 12 and surely > 1


def test_mirror_images_share_their_tables():
    G, c, omega = random_contact(2, 100.0, 1)
    mirrored = G * np.where(np.arange(7) % 6 < 2, 1.0, -1.0)
    mirrored[1] *= -1.0
    contact = np.zeros(1, law_of(2)).view(np.recarray)[0]
    contact.compliant[:] = 1
    for left, same in ((mirrored, 1.0), (mirrored * (1 + 2.0**-52), 0.0)):
        contact.equations[0], contact.equations[1] = left, G
        passage = np.zeros(1, passages_of(2, True)).view(np.recarray)[0]
        passage.stiffness[:], passage.damping[:] = 100.0, c
        set_pieces(passage, ORBIT, contact, np.array([12.0, 12.0]), omega)
        assert passage.mirrored[ORBIT] == same


def parts_of(contact, fast):
    """L, F, S, as they stand: delta' before delta."""
    part, size = part_of(STOP, fast), len(contact.whole)
    return contact.L[part][:fast, fast:], contact.F[part][:fast, :fast], contact.S[part][fast:size, fast:size]


@pytest.mark.parametrize("masses", [1, 2, 3, 4])
@pytest.mark.parametrize(
    "z, k, fast", [(0.1, 1e4, 2), (0.5, 1e8, 2), (1.5, 1e8, 2), (10, 1e6, 2), (10, 1e6, 1), (20, 50.0, 1)]
)
def test_equations_set_apart(masses, z, k, fast):
    """f - L q flies by F alone, and where it is zero q by S; z: the damping ratio."""
    for seed in range(10):
        G, _, omega = random_contact(masses, k, seed)
        c = 2 * z * np.sqrt(k)
        G[0, 1] = -c
        contact = np.zeros(1, law_of(masses)).view(np.recarray)[0]
        contact.equations[STOP] = G
        assert is_set_apart(contact, STOP, fast, omega)
        L, F, S = parts_of(contact, fast)
        size = len(S)
        order = [1, 0, *range(2, fast + size)]
        scale = np.array([np.sqrt(k) if fast == 2 else c, 1.0, *[1.0] * (fast + size - 2)])
        A = whole(G, omega)[np.ix_(order, order)] * scale / scale[:, None]
        L = L * scale[fast:] / scale[:fast, None]
        F, S = F * scale[:fast] / scale[:fast, None], S * scale[fast:] / scale[fast:, None]
        rate, slow, across = np.abs(np.linalg.eigvals(F)).max(), np.vstack([L, np.eye(size)]), np.eye(fast)
        assert np.abs(A @ slow - slow @ S).max() < 1e-13 * rate
        assert np.abs(np.hstack([across, -L]) @ A - F @ np.hstack([across, -L])).max() < 1e-13 * rate


def test_a_soft_stop_has_no_slow_motion_beside_it():
    """There the iteration does not converge."""
    G, _, omega = random_contact(2, 0.5, 2)
    contact = np.zeros(1, law_of(2)).view(np.recarray)[0]
    contact.equations[STOP] = G
    with np.errstate(all="ignore"):
        assert not is_set_apart(contact, STOP, 2, omega)


@pytest.mark.parametrize("c", [0.0, 3.0])
@pytest.mark.parametrize("then, form", [(AT_PLACE, (1, 0, 0)), (RELAXES, "force"), (BREAKS, "held")])
def test_the_jump_at_a_release_is_the_saltation(c, then, form):
    """delta'' grows by F where the force ceases: S = 1 + F e n^T/g', of (delta, delta'), for any guard g."""
    k, p, hold = 50.0, 0.3, 0.4
    form = {"force": (k, c, p), "held": (k, c, p + hold)}.get(form, form)
    contact = np.zeros(1, law_of(1)).view(np.recarray)[0]
    contact.damping[STOP], contact.force[STOP] = c, (k, c, p)
    contact.guard[STOP, 0], contact.then[STOP, 0] = form, then
    delta, speed, acceleration = -(form[2] - c * 0.7 * (form[1] != 0)) / form[0], -0.7, -1.9
    contact.y[0], contact.y[1], contact.acceleration = delta, speed, acceleration
    force, slope = k * delta + c * speed + p, form[0] * speed + form[1] * acceleration
    S = np.eye(2) + np.outer([0, 1], np.multiply(force / slope, form[:2]))
    by_delta, by_pi = jump_at_release(contact, STOP)
    of_pi = np.array([[1, 0], [by_delta, 1 + by_pi]]) @ np.array([[1, 0], [c, 1]])  # pi = delta' + c delta
    assert of_pi == pytest.approx(S, abs=1e-13)
    assert (np.linalg.det(S) == pytest.approx(1, abs=1e-13)) == (then != BREAKS or c == 0)


def test_pieces_leave_contacts_alone_that_end_otherwise():
    tables = Tables(1, 100.0, 2)
    contact = np.zeros(1, law_of(1)).view(np.recarray)[0]
    contact.equations[STOP], contact.compliant[STOP] = tables.G, 1
    for then, passed in ((AT_PLACE, True), (BREAKS, False)):
        contact.guards[STOP], contact.then[STOP, 0] = 1, then
        set_pieces(tables.passage, ORBIT, contact, np.full(2, 0.5 * np.pi / tables.h), 1.0)
        ends = tables.rows("ends", (3, 2, PIECES, tables.inputs))[:, STOP]
        assert (ends[GUARD, :, 0].min() < 0) == passed
