"""Free flight in closed form: over whole cells of a grid on the forcing period, and by Taylor series within a cell.

Between impacts the state X = (x1, v1, x2, v2) obeys a linear system with constant coefficients, so

    X(t_k + u) = E(u) (X(t_k) - r(t_k)) + r(t_k + u),      E(u) = exp(A u),

for any one solution r. Here r is the motion that starts from rest at the section; unlike the steady response (eq. 7)
it exists in resonance without damping too, and is nowhere much larger than the motion itself. The period is cut into
`cells` equal cells; E and r are tabulated at their nodes, once for each set of parameters.
"""

import functools
import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import LANES, SINGLES, number
from vibro_sweep.engine.simd.memory import new_lines, record, row

ORDER = 16  # Taylor coefficients of a cell: with rate * width <= WIDTH the first one left out is below 2^-53 / 1000
WIDTH = 0.5
CHUNK = SINGLES  # control points examined together: two to a cell


# Kernels take the number of masses from the shapes of the records' fields, which belong to the types that numba sees:
# each number of masses has kernels of its own, from one source. N masses have 2 N states. What a flight follows from
# are its inputs: the states, sin and cos of the force, and, where there is a constant force, the number 1.


def inputs_of(masses: int, constant: bool) -> int:
    return 2 * masses + 2 + constant


def width_of(masses: int, constant: bool = False) -> int:
    """Numbers in a row for a state with the other inputs, padded to whole vectors."""
    return LANES * (-(-inputs_of(masses, constant) // LANES))


@functools.cache
def oscillator_of(masses: int, constant: bool = False) -> np.dtype:
    """The record of one oscillator. Structured arrays go to kernels by one pointer, and need no reference counts."""
    states, inputs = 2 * masses, inputs_of(masses, constant)
    fields = [
        # rows of whole cache lines come first
        ("series", float, (masses, inputs, ORDER)),  # Taylor coefficients of x1, x2, ... of the inputs
        ("impulse", float, (masses, ORDER)),  # Taylor coefficients of x1, x2, ... after a unit impulse on M1
        ("reach", float, (ORDER,)),  # weights of |c_n| in a bound on |x1 - c_0| over a cell
        ("third", float, (ORDER,)),  # weights of |c_n| in a bound on the third derivative over a cell, and
        ("fourth", float, (ORDER,)),  # on the fourth
        ("frame_series", float, (ORDER, states)),  # of tangent.py
        ("cells", np.int64),
        ("width", float),  # of a cell
        ("step", float),  # width of a series: a cell, or where stiff a part of one
        ("omega", float),
        ("tau", float),
        (
            "kappa",
            float,
            (masses,),
        ),  # what a step of x1 by 1 at once moves v1 (nothing), v2 (by 2 zeta/mu_m), ... by dampers
        (
            "push",
            float,
            (masses,),
        ),  # what a unit impulse on M1 does at once to v1 (1), v2, .. (points/contact.py)
        ("drag", float),  # and to the acceleration of M1
        ("graze", float, (states,)),  # the point at which the discontinuity mapping is expanded
        ("remainder", float, (states + 1,)),  # bound on |x1 - cubic| in any cell, for unit X - r and for r
        ("slow", float, (states,)),  # part of the slow modes in x1; of a stiff system
        ("force", float, (inputs,)),  # acceleration of M1 as a function of them
        # (x1'', x2'', ..) by (x1, v1, x2, .., sin, cos, 1) while M1 rests, without the first row; and
        ("held", float, (masses, states + 3)),
        ("rest_step", float),  # how far a series reaches then
        ("impulse_third", float),  # bound on |d3 x1/du3| over a cell after a unit impulse on M1
        ("vanishing", np.int64),  # of tangent.py: directions that a flight over a cell takes below the others' rounding
        ("most_cells_mixed", np.int64),  # cells that tangent vectors may fly between orthonormalisations, and
        ("most_cells_in_planes", np.int64),  # the same while each lies in the plane of one mode
        ("frame_scale", float, (masses,)),  # g_j
        ("frame_square", float, (masses,)),  # omega_dj^2
        ("to_frame", float, (states, states)),
        ("from_frame", float, (states, states)),
        ("stiff", np.bool_),  # cells do not resolve every rate
        ("largest", float),  # |x1| of the motion r
        ("steady", float, (states,)),  # of coast.py, like all that follow: the steady motion at node 0
        ("middle", float),  # of the gap of the steady motion, and
        ("swing", float),  # by how much it swings about that
        ("confining", float, (states, states)),  # quadratic form of X - steady: bound on the gap's motion, squared
        ("power", float, (2, states, states)),  # scratch, and
        ("apart", float, (2, states)),  # scratch
    ]
    return record(fields)


@functools.cache
def node_of(masses: int, constant: bool = False) -> np.dtype:
    """The record of one node of the grid."""
    states, width, inputs = 2 * masses, width_of(masses, constant), inputs_of(masses, constant)
    fields = [
        # r, a motion under the force (forced.py); then sin and cos of omega t + tau, and perhaps 1
        ("z", float, (width,)),
        # flight from node 0: row j is X here of the unit state j there, the others that of the force's sin and cos
        ("E", float, (inputs + inputs % 2, width)),  # there, and of the constant force, from rest; padded
        ("turn", float, 2),  # sin and cos of omega t
        ("frame", float, (states,)),  # c_1, s_1, c_2, s_2, ... of a flight from node 0
    ]
    return record(fields)


class Flight(NamedTuple):
    """The tables of one oscillator over one forcing period."""

    oscillator: np.ndarray  # (1,) `oscillator_of`
    nodes: np.ndarray  # (cells + 1,) `node_of`
    # (2 N + 1, 2 cells + CHUNK), in single precision: control points, two to a cell, as a function of X - r at node 0;
    # those of r
    scan: np.ndarray


def new_flight(count: int, cells: int, masses: int, constant: bool = False) -> Flight:
    """Space for the tables of so many oscillators with at most so many cells."""
    return Flight(
        new_lines((count, 1), oscillator_of(masses, constant)),
        new_lines((count, cells + 1), node_of(masses, constant)),
        new_lines((count, 2 * masses + 1, 2 * cells + CHUNK), np.float32),
    )


@jit
def decaying(eta, omega_squared, u):
    """e^{-eta u} times (c, s, c + eta s, c - eta s): c and s are entire functions of omega_d^2 (physics of eq. 6).

    c = cos(omega_d u) and s = sin(omega_d u)/omega_d; cosh and sinh/|omega_d| when overdamped, where the exponentials
    are joined before they can overflow and c - eta s is formed without cancellation.
    """
    square = omega_squared - eta * eta
    if square >= 0.0:
        root = math.sqrt(square)
        decay, cos, sin = math.exp(-eta * u), math.cos(root * u), math.sin(root * u)  # side by side they are one call
        c = decay * cos
        s = decay * (sin / root if root > 0.0 else u)
        return c, s, c + eta * s, c - eta * s
    root = math.sqrt(-square)
    slow = math.exp(-omega_squared / (eta + root) * u)
    fast = math.exp(-(eta + root) * u)
    c = 0.5 * (slow + fast)
    s = -slow * math.expm1(-2.0 * root * u) / (2.0 * root)
    return c, s, c + eta * s, fast - omega_squared / (eta + root) * s


@jit
def load(series, X, sin, cos, c):
    """Taylor coefficients c (N, ORDER) of the flight of all masses from the state X (lanes) at the phase (sin, cos)."""
    masses, states, inputs = len(c), 2 * len(c), series.shape[1]
    for i in range(masses):
        for n in range(ORDER):
            total = series[i, 0, n] * number(X, 0) + series[i, 1, n] * number(X, 1)
            for j in range(2, states, 2):
                total += series[i, j, n] * number(X, j) + series[i, j + 1, n] * number(X, j + 1)
            total += series[i, states, n] * sin + series[i, states + 1, n] * cos
            c[i, n] = total + series[i, states + 2, n] if inputs > states + 2 else total


@jit
def evaluate(c, u):
    """Polynomial with coefficients c at u, and its derivative; even and odd terms go side by side."""
    v = u * u
    odd, slope_odd, even, slope_even = c[ORDER - 1], 0.0, c[ORDER - 2], 0.0
    for n in range(ORDER - 4, -1, -2):
        slope_odd = slope_odd * v + odd
        odd = odd * v + c[n + 1]
        slope_even = slope_even * v + even
        even = even * v + c[n]
    return even + u * odd, odd + 2.0 * u * (slope_even + u * slope_odd)


@inline
def evaluate_rows(c, first, terms, u):
    """`evaluate` of eight polynomials, whose coefficients are so many rows from `first` on."""
    v, last = u * u, first + terms - 1
    slope_odd, slope_even = row(c, last), row(c, last - 1)
    odd, even = slope_odd * v + row(c, last - 2), slope_even * v + row(c, last - 3)
    for n in range(last - 5, first - 1, -2):
        slope_odd = slope_odd * v + odd
        odd = odd * v + row(c, n + 1)
        slope_even = slope_even * v + even
        even = even * v + row(c, n)
    return even + u * odd, odd + 2.0 * u * (slope_even + u * slope_odd)


@jit
def bounds(q, c):
    """Over a cell: how far x can move, and a bound on its third derivative. Summed by fours, for the vector unit."""
    reach, third = q.reach, q.third
    r0, r1, r2, r3, t0, t1, t2, t3 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for n in range(0, ORDER, 4):
        a0, a1, a2, a3 = abs(c[n]), abs(c[n + 1]), abs(c[n + 2]), abs(c[n + 3])
        r0 += reach[n] * a0
        r1 += reach[n + 1] * a1
        r2 += reach[n + 2] * a2
        r3 += reach[n + 3] * a3
        t0 += third[n] * a0
        t1 += third[n + 1] * a1
        t2 += third[n + 2] * a2
        t3 += third[n + 3] * a3
    return (r0 + r1) + (r2 + r3), (t0 + t1) + (t2 + t3)


@jit
def bound_third_over(c, h):
    """A bound on the third derivative of the polynomial c over [0, h]."""
    total = 0.0
    for n in range(ORDER - 1, 2, -1):
        total = total * h + n * (n - 1.0) * (n - 2.0) * abs(c[n])
    return total
