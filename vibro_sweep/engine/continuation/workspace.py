"""Points of a solution set, and the arrays in which kernels work on them.

Lengths are in units of the gap's size and times in units of 1/omega of the start, so that all numbers are of size 1.
The unknowns of an event are its state y before it, its phase phi and its velocity jump D: a row (n + 2), n = 2N.
"""

from collections import namedtuple
from functools import cache
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.continuation.chatter_series import tail_of
from vibro_sweep.engine.continuation.flight_tables import columns_of
from vibro_sweep.engine.continuation.problem import width_of
from vibro_sweep.engine.impulses.extremes import PIECES
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.memory import new_lines, record
from vibro_sweep.tables.bifurcations import CODIMENSION_TWO, TYPES

FIRST, SECOND, THETA = range(3)  # of `Place.p`: both parameters, and theta of a Neimark-Sacker curve
TERMS = 10  # of a power series in z and its conjugate, to third order
PARAMETERS = 2  # of the oscillator that may be free
ROWS = 3  # most scalar rows: conditions, and the plane across a tangent

# What is known of each point, by name: tests of bifurcations, as their table names them, and
#     stop_distance, length, residual    distance of the flights from the stops, of the next step, Newton's last change
#     last, before                time from the last impact written out, and from the one before, to the end of the
#                                 chatter, in units of the reach of its series
#     release                     least acceleration away from the stop after an impact with R = 0
#     above, below, pairs         multipliers outside of the unit circle: real > 1, real < -1, complex; above is -1
#                                 where they are not known
#     on_circle, away             multipliers on it; the least |mu|^2 - 1 of those outside
#     reflected, crossing         prod_i (1 + mu_i)/r, r = prod_i (1 + |mu_i|^2)^(1/2), and
#                                 prod_{i<j} (1 - mu_i mu_j)/r^(n - 1), which poles of multipliers leave finite
#     hold                        least acceleration into the stop during rests, and speed before them
#     relaxed, forced             of stops that relax, as of relaxation.py; contacts that end by their force
ALONG_BRANCHES = tuple(dict.fromkeys(one.test for one in TYPES if one.test))
ALONG_CURVES = tuple(
    dict.fromkeys(test for one in CODIMENSION_TWO for _, test in one.tests if test not in ("vanishes", "touches"))
)
OTHERS = "stop_distance length residual last before release above below pairs on_circle away".split()
OTHERS += "reflected crossing hold relaxed forced".split()
NAMES = tuple(dict.fromkeys([*ALONG_CURVES, *ALONG_BRANCHES, *OTHERS]))
TEST = namedtuple("Test", NAMES)(*range(len(NAMES)))  # the index of each
BRANCH_TESTS = tuple(NAMES.index(name) for name in ALONG_BRANCHES)
CURVE_TESTS = tuple(range(len(ALONG_CURVES)))


class Place(NamedTuple):
    """A point; K events."""

    x: np.ndarray  # (K, n + 2): y, phi, D
    p: np.ndarray  # (3,)
    tangent: np.ndarray  # (K, n + 2)
    tangent_p: np.ndarray  # (3,), in units of the parameters
    v: np.ndarray  # (K, n + 2) complex: right null vector of a critical multiplier, (xi, dphi, dD)
    w: np.ndarray  # (K + 1, n + 2) complex: left null vector, rows 1 and 2 of the event and those of the flight after
    # it; last those of xi_1 - xi_1 = 0
    tests: np.ndarray  # as TEST says
    multipliers: np.ndarray  # (n, 2): real and imaginary parts; on a curve but the critical one. NaN: not known

    @property
    def phases(self) -> np.ndarray:
        """(K,) of the events, radians."""
        return self.x[:, -2]

    @property
    def jumps(self) -> np.ndarray:
        """(K,) velocity jumps."""
        return self.x[:, -1]

    @property
    def direction(self) -> np.ndarray:
        """(2 K + 3,) the tangent over what distances are measured by: phases, jumps, parameters in their units, theta;
        of length 1."""
        return np.concatenate([self.tangent[:, -2], self.tangent[:, -1], self.tangent_p])


def new_place(K: int, n: int) -> Place:
    real, vectors = [(K, n + 2), 3, (K, n + 2), 3], [np.zeros((count, n + 2), complex) for count in (K, K + 1)]
    return Place(*map(np.zeros, real), *vectors, np.zeros(len(TEST)), np.full((n, 2), np.nan))


@cache
def event_of(masses: int) -> np.dtype:
    """The record of an event."""
    n = 2 * masses
    return record([
        ("kept", float, (n + 2, width_of(n, PARAMETERS))),  # what was eliminated, a triangle in front
        ("mirrors", float, (n + 2, 2 * n + 2)),  # m of the reflections 1 - s m m^T
        ("scales", float, (n + 2,)),  # s
        ("E", float, (3, n, columns_of(n))),  # the flight after it, and its derivatives by the parameters
        ("rate", float, (n,)),  # y' = dy/dphi before it
        ("after", float, (n + 1,)),  # y after it, and 1
        ("landing", float, (n,)),  # y at the end of the flight
        ("landing_rate", float, (n,)),  # y' there
        ("defect", float, (n,)),  # its difference from the next state
        ("bend", float, (n,)),  # rho: the jump of y' at it
        ("carry", float, (n, n + 2 + PARAMETERS)),  # xi after an event that lasts by xi, dphi, ds and the parameters
        ("pull", float),  # row 2 of it, see lasting_event.py
        ("release", float, (n + 2 + PARAMETERS,)),  # its derivatives, as of `carry`
        ("hold", float),  # what keeps it up, as of `hold_of`
        ("depth", float),  # of the gap behind its stop at its end
        ("gap", float),  # before the event
        ("motion", float, 2),  # and its velocity and acceleration
        ("rows", float, (ROWS, n + 2)),  # entries of the scalar rows, by xi, dphi, dD
        ("factors", float, (ROWS, n + 2)),  # with which `kept` was subtracted from them
        ("changes", float, (2, n + 2)),  # Newton's change, and the tangent: xi, dphi, dD
        ("length", float),  # of the flight
        ("turn", complex),  # e^{i phi}
        ("slopes", complex, (n + 2,)),  # of a condition by xi, dphi, dD
        ("v", complex, (n + 2,)),  # as of `Place`, at this point
        ("w", complex, (n + 2,)),
        ("sides", complex, (n + 2,)),  # right sides of a system with the eliminated matrix
        ("series", complex, (2, TERMS)),  # of dphi and dD, see normal_form.py
        ("left", complex, (2, TERMS)),  # of rows 1 and 2
    ])  # fmt: skip


@cache
def work_of(masses: int) -> np.dtype:
    """Arrays of one elimination."""
    n = 2 * masses
    wide = width_of(n, PARAMETERS)
    return record([
        ("panel", float, (2 * n + 2, wide)),
        ("line", float, (wide,)),
        ("last", float, (n, wide)),  # what is left: columns of xi_{K+1} (XI), xi_1, parameters, residual
        ("ends", float, (n + ROWS, n + ROWS + 2)),  # the last equations: xi_1, parameters | residual, 1 of the plane
        ("system", float, (n + ROWS, n + ROWS)),
        ("sign", float),  # of the determinant of what was eliminated
        ("step_p", float, (2, ROWS)),  # Newton's change of the parameters, and the tangent, in their units
        ("null", float, (n + ROWS,)),  # xi_1 and parameters of a vector that is taken apart
        ("row_p", float, (ROWS, ROWS)),  # scalar rows by the parameters
        ("row_left", float, (ROWS,)),  # and their residuals
        ("E", float, (3, n, columns_of(n))),  # of a flight, and room for one
        ("other", float, (3, n, columns_of(n))),
        ("image", float, (n, columns_of(2 * n - 1))),
        ("matrix", float, (n, n)),
        ("generator", float, (1 + PARAMETERS, n + 2, columns_of(n + 3))),  # see lasting_map.py
        ("generators", float, (2, 1 + PARAMETERS, n + 2, columns_of(n + 3))),  # of which there are series
        ("motion_series", float, (2, 1 + PARAMETERS, ORDER + 1, n, columns_of(n + 3))),
        ("lasting", float, (1 + PARAMETERS, n + 4, columns_of(n + 3))),
        ("twice", float, (1 + PARAMETERS, n + 1, columns_of(n + 3))),
        ("mean", float, (1 + PARAMETERS, columns_of(n + 3))),
        ("varies", np.int64, (1 + PARAMETERS,)),  # whether these and `lasting` are not zero
        ("mean_slope", float, (columns_of(n + 3),)),
        ("force", float, (1 + PARAMETERS, columns_of(n + 3))),
        ("start", float, (1 + PARAMETERS, n + 4)),  # see lasting_event.py
        ("end", float, (1 + PARAMETERS, n + 4)),
        ("start_rate", float, (n + 4,)),
        ("moving", float, (n,)),
        ("row", float, (n + 4,)),
        ("varied", complex, (n + 4,)),  # see lasting_derivative.py
        ("rows", complex, (6, n + 4)),
        ("re", float, (n,)),
        ("im", float, (n,)),
        ("cell", float, (ORDER + 1,)),
        ("nearest", float, 3),  # turning point nearest to its stop: distance, phase, side
        ("turning", float, 3),  # the same of the free acceleration during a rest
        ("waiting", float, (PIECES, 2)),
        ("flying", float, (2, n)),
        ("order", np.int64, (n + ROWS,)),
        ("border", complex, (n + 1, n + 1)),
        ("left", complex, (n,)),  # of the last equations: border, then null vector
        ("right", complex, (n,)),
        ("side", complex, (n + 1,)),
        ("column", complex, (2 * n + 2,)),
        ("closure", float, (n,)),  # xi_{K+1}
        ("rate", float, (n,)),  # y' before the first event, by time
        ("along", complex, (5, n)),  # of a flight: v at its begin, at its end, w A, w A E, -w E (second_derivative.py)
        ("slopes_p", complex, (ROWS,)),  # of a condition by the parameters
        ("defect", complex),  # see second_derivative.py
        ("first", complex, (n, TERMS)),  # power series of y_1, see normal_form.py
        ("closing", complex, (n, TERMS)),  # and of the last rows
        ("states", complex, (3, n + 4, TERMS)),
        ("jets", complex, (5, TERMS)),
    ])  # fmt: skip


class Workspace(NamedTuple):
    """Arrays in which kernels work: few, since each is unpacked at every call from Python."""

    work: np.ndarray  # (1,) `work_of`
    events: np.ndarray  # (K,) `event_of`
    tail: np.ndarray  # (1,) `tail_of`
    trial: np.ndarray  # (K + 1, n + 2) complex: a vector over all rows, as `Place.w`, that is not kept yet


def new_workspace(K: int, n: int) -> Workspace:
    N = n // 2
    room = new_lines(1, work_of(N)), new_lines(K, event_of(N)), new_lines(1, tail_of(N))
    return Workspace(*room, np.zeros((K + 1, n + 2), complex))
