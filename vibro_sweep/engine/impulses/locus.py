"""A point of a bifurcation curve in two parameters: its equations and Newton's method.

Besides the equations of the orbit (condensed.py) it satisfies

    fold, flip (pitchfork), Neimark-Sacker: g = 0      graze: D_i = 0
    sticking onset: D_1 = 0, the end of a chatter sequence (chatter.py, with its own elimination: chatter_steps.py)

with mu = 1, -1, e^{i theta}, and g of the bordered matrix, which is zero where M(mu) is singular:

    M w + q g = 0,  r.w = 1        psi^T M + g r^T = 0,  psi.q = 1        dg = -psi^T dM w

g is complex, with theta one unknown more, for Neimark-Sacker. Unknowns are scaled (`Curve.unit`), so that g is too.
"""

import cmath
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.impulses.chatter_series import Tail, new_tail
from vibro_sweep.engine.impulses.chatter_steps import Steps, add_tail, follow, new_steps, solve
from vibro_sweep.engine.impulses.condensed import Room, equations, gradient, new_room
from vibro_sweep.engine.impulses.extremes import PIECES
from vibro_sweep.engine.impulses.factors import factorise, square
from vibro_sweep.engine.impulses.tables import ORDER
from vibro_sweep.engine.impulses.turned import place_of, put_equations, solve_adjoint, turn
from vibro_sweep.engine.impulses.turned import solve as solve_turned
from vibro_sweep.engine.simd.jit import jit

FOLD, FLIP, TORUS, GRAZE, STICK = range(5)
# kinds of curves; FLIP is the pitchfork where sigma = -1; from GRAZE on an impact has no impulse
FIRST, SECOND, THETA = range(3)  # of `Place.p`: both parameters, and theta of Neimark-Sacker


class Curve(NamedTuple):
    """What all points of a curve share."""

    kind: int
    index: int  # of the impact that grazes; 0 of an onset of sticking
    sides: np.ndarray  # (K,)
    sigma: float
    unit: np.ndarray  # (S + 3,): units of dt, dD, xi_1, the parameters and theta; S = 2K + n
    row_unit: np.ndarray  # (S,): of the equations of the orbit
    repeats: bool  # whether the second half of the orbit may repeat the first one
    mirrors: bool  # whether it may be its mirror image


class Place(NamedTuple):
    """A point of the curve."""

    t: np.ndarray  # (K,)
    D: np.ndarray  # (K,)
    h: np.ndarray  # (n,): before the first impact
    p: np.ndarray  # (3,)
    tangent: np.ndarray  # (S + 3,), scaled
    w: np.ndarray  # (S,) complex, scaled
    psi: np.ndarray  # (S,) complex, scaled
    tests: np.ndarray  # (TESTS,): see curve_tests.py
    multipliers: np.ndarray  # (n, 2): real and imaginary parts of those of the test PAIR; NaN where they are not known


class Bench(NamedTuple):
    """Room to work in."""

    room: Room
    J: np.ndarray  # (S + 3, S + 3)
    step: np.ndarray  # (S + 3,)
    B: np.ndarray  # (S + 1, S + 1) complex, turned (turned.py)
    w: np.ndarray  # (S + 1,) complex
    psi: np.ndarray  # (S + 1,) complex
    slope: np.ndarray  # (S + 2,) complex
    order: np.ndarray  # (S + 3,) integers
    matrix: np.ndarray  # (S + 3, S + 3), turned
    line: np.ndarray  # (S + 3,)
    pair: np.ndarray  # (n, n)
    re: np.ndarray  # (n,)
    im: np.ndarray  # (n,)
    cell: np.ndarray  # (ORDER + 1,)
    nearest: np.ndarray  # (3,): of the turning point nearest to its stop: distance, time, side
    waiting: np.ndarray  # (PIECES, 2)
    after: np.ndarray  # (2, n)
    weights: np.ndarray  # (n + 1,): see `curve_certificate.weigh`
    series: np.ndarray  # (S, TERMS) complex: see normal_form.py
    left: np.ndarray  # (S, TERMS) complex
    states: np.ndarray  # (3, n, TERMS) complex
    jets: np.ndarray  # (3, TERMS) complex
    tail: Tail
    steps: Steps


TESTS = 13
TERMS = 10  # of a power series in z and z*, to third order


def new_place(K: int, n: int) -> Place:
    S = 2 * K + n
    real = [np.zeros(shape) for shape in (K, K, n, 3, S + 3)]
    return Place(*real, np.zeros(S, complex), np.zeros(S, complex), np.zeros(TESTS), np.full((n, 2), np.nan))


def new_bench(K: int, n: int) -> Bench:
    S = 2 * K + n
    vectors = [np.zeros(size, complex) for size in (S + 1, S + 1, S + 2)]
    border = np.zeros((S + 1, S + 1), complex)
    order = np.zeros(S + 3, np.int64)
    rest = [
        np.zeros(shape) for shape in ((S + 3, S + 3), S + 3, (n, n), n, n, ORDER + 1, 3, (PIECES, 2), (2, n), n + 1)
    ]
    series = [np.zeros(shape, complex) for shape in ((S, TERMS), (S, TERMS), (3, n, TERMS), (3, TERMS))]
    first = new_room(K, n), np.zeros((S + 3, S + 3)), np.zeros(S + 3), border
    return Bench(*first, *vectors, order, *rest, *series, new_tail(n), new_steps(K, n))


@jit
def size_of(c, place):
    """Number of unknowns."""
    S = len(place.w)
    return S + 3 if c.kind == TORUS else S + 2


@jit
def multiplier(c, place):
    """mu of the curve."""
    if c.kind == TORUS:
        return cmath.exp(1j * place.p[THETA])
    return (1.0 if c.kind == FOLD else -1.0) + 0j


@jit
def null_vectors(c, place, b):
    """w and psi in `b`, bordered by those of `place`; g. NaN where the bordered matrix is singular."""
    S, K = len(place.w), len(place.t)
    B = b.B
    put_equations(B, c, b.room.M, K, multiplier(c, place), -1)
    for i in range(S):
        B[S, place_of(i, K)] = place.psi[i].conjugate()
        B[place_of(i, K), S] = place.w[i].conjugate()
        b.w[i] = b.psi[i] = 0.0
    B[S, S], b.w[S], b.psi[S] = 0.0, 1.0, 1.0
    if square(factorise(B, S + 1, b.order)) == 0.0:
        return complex(np.nan, 0.0)
    solve_turned(B, S + 1, b.order, K, b.w, b.slope)
    solve_adjoint(B, S + 1, b.order, K, b.psi, b.slope)
    return b.w[S]


@jit
def slopes_of_g(f, c, place, b):
    """`b.slope`: the derivatives of g by the scaled unknowns; that by theta is returned."""
    S, K = len(place.w), len(place.t)
    for i in range(S):  # the gradient is of the matrix in physical units
        b.w[i] *= c.unit[i]
        b.psi[i] /= c.row_unit[i]
    gradient(f, c.sides, place.D, place.t, b.room, b.w, b.psi, b.slope)
    turn = 0j
    for i in range(2 * K, S):
        turn -= b.psi[i] * b.w[i]
    for i in range(S):
        b.w[i] /= c.unit[i]
        b.psi[i] *= c.row_unit[i]
    for i in range(S + 2):
        b.slope[i] *= c.unit[i]
    return turn * c.sigma * 1j * multiplier(c, place)


@jit
def assemble(f, c, place, b):
    """Equations and their derivatives by the scaled unknowns: `b.step` and `b.J` but the last row. False: singular.

    Of an onset of sticking: the motion and its tail alone.
    """
    K, S = len(place.t), len(place.w)
    n = S - 2 * K
    size = size_of(c, place)
    room, J = b.room, b.J
    for r in range(n):
        room.h[0, r] = place.h[r]
    if c.kind == STICK:
        follow(f, c.sides, c.sigma, place.t, place.D, room)
        add_tail(f, c.sides, c.sigma, place.t, room, b.tail)
        return True
    equations(f, c.sides, c.sigma, place.t, place.D, room)
    for i in range(S):
        b.step[i] = room.F[i] / c.row_unit[i]
        for j in range(S):
            J[i, j] = room.M[i, j] * c.unit[j] / c.row_unit[i]
        for j in range(2):
            J[i, S + j] = room.Fp[i, j] * c.unit[S + j] / c.row_unit[i]
        J[i, S + 2] = 0.0
    for i in range(2 * K, S):
        J[i, i] += c.sigma * c.unit[i] / c.row_unit[i]
    if c.kind == GRAZE:
        for j in range(size):
            J[S, j] = 1.0 if j == K + c.index else 0.0
        b.step[S] = place.D[c.index] / c.unit[K + c.index]
        return True
    g = null_vectors(c, place, b)
    if not square(g) < np.inf:
        return False
    turn = slopes_of_g(f, c, place, b)
    b.step[S] = g.real
    for j in range(S + 2):
        J[S, j] = b.slope[j].real
    if c.kind == TORUS:
        b.step[S + 1] = g.imag
        for j in range(S + 2):
            J[S + 1, j] = b.slope[j].imag
        J[S, S + 2], J[S + 1, S + 2] = turn.real, turn.imag
    return True


@jit
def solve_on_plane(row, b, size, K, tangent):
    """`b.step` becomes Newton's step on the plane across `row`; False: singular."""
    T = b.matrix
    turn(b.J, size, K, T)
    for j in range(size):
        T[place_of(j, K), size - 1], tangent[j] = row[j], 0.0
    b.step[size - 1], tangent[size - 1] = 0.0, 1.0
    if factorise(T, size, b.order) == 0.0:
        return False
    solve_turned(T, size, b.order, K, b.step, b.line)
    solve_turned(T, size, b.order, K, tangent, b.line)
    return True


@jit
def newton_step(f, c, place, row, b, tangent):
    """One correction of `place` on the plane across `row`, at the parameters to which f was moved. Its size, or NaN.

    `tangent` receives the tangent of the curve, row.tangent = 1.
    """
    K, S = len(place.t), len(place.w)
    size = size_of(c, place)
    if not assemble(f, c, place, b):
        return np.nan
    if c.kind == STICK:
        if not solve(f, c, place, row, b, tangent):
            return np.nan
    elif not solve_on_plane(row, b, size, K, tangent):
        return np.nan
    change = 0.0
    for j in range(size):
        if j < 2 * K or j >= S:
            change = max(change, abs(b.step[j]))
    if not change <= 1.0:
        return np.nan
    move(c, place, b.step, -1.0, b.room.rate)
    return change


@jit
def move(c, place, change, length, rate):
    """Add `length` times a scaled change; rate: h' before the first impact, (.., n)."""
    K, S = len(place.t), len(place.w)
    for i in range(K):
        place.t[i] += length * c.unit[i] * change[i]
        place.D[i] += length * c.unit[K + i] * change[K + i]
    for r in range(S - 2 * K):
        place.h[r] += length * (c.unit[2 * K + r] * change[2 * K + r] + rate[0, r] * c.unit[0] * change[0])
    for j in range(size_of(c, place) - S):
        place.p[j] += length * c.unit[S + j] * change[S + j]


@jit
def in_order(f_period, place):
    """Whether the impacts follow one another."""
    K = len(place.t)
    for i in range(K):
        if not (place.t[i + 1] if i + 1 < K else place.t[0] + f_period) > place.t[i]:
            return False
    return True
