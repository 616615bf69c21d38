"""Tangent vectors along eight orbits, and from them the Lyapunov spectra.

As many vectors of each orbit as it has states are kept as the columns of Z, in the frame z = (g_1 xi_1, xi_1' + eta_1
xi_1, g_2 xi_2, xi_2' + eta_2 xi_2, ...) with g_j = |omega_dj|, in which the flight of mode j is e^{-eta_j u} times a
rotation: in this metric the exponents of a non-impacting orbit are exact after any time, where those of (x, v) would
only converge like 1/t. (Overdamped: times a symmetric matrix, and exact as soon as its eigenvectors are found.)

Their flight is in tangent_flight.py. `who` is the mask of the orbits to which something happens; i is one of them.
"""

import functools

import numpy as np

from vibro_sweep.engine.simd.jit import exported, inline, jit, noinline
from vibro_sweep.engine.simd.lanes import LANES, select
from vibro_sweep.engine.simd.memory import put, record, row
from vibro_sweep.engine.tables.flight import ORDER
from vibro_sweep.engine.variational.growth import log_growth, start_record
from vibro_sweep.engine.variational.orthonormal import watch
from vibro_sweep.engine.variational.tangent_flight import apply_flight, catch_up, fly_to, only

ALIKE = 10.0  # difference of the logarithms of two growths that need not be distinguished


@functools.cache
def tangents_of(masses: int, compliant: bool = False) -> np.dtype:
    """The record of the tangent vectors of eight orbits, one column each; n vectors of n numbers, n = 2 N.

    compliant : with stops that may relax, whose places are numbers of a vector, too
    """
    n = 2 * masses
    pairs, apart = n * (n - 1) // 2, n if compliant else 0
    fields = [
        # of the oscillator
        ("series", float, (n * ORDER, LANES)),
        ("scale", float, (masses, LANES)),  # g_j
        ("square", float, (masses, LANES)),  # omega_dj^2
        ("to_frame", float, (n * n, LANES)),
        ("from_frame", float, (n * n, LANES)),
        ("kick", float, (n, LANES)),  # to_frame of a step of x1 by 1, and of what it does to x2, ... and v2, ...
        ("push", float, (n, LANES)),  # to_frame of a unit impulse on M1
        # of the orbit
        ("lost", float, (LANES,)),  # dimensions: two by sticking, one by an impact without restitution
        ("cell", np.int64, (LANES,)),  # the cell, counted from the section, and
        ("offset", float, (LANES,)),  # the offset in it, up to which `flight` reaches
        ("leap", float, (n, LANES)),  # c_1, s_1, c_2, s_2, ... of a flight over whole cells
        ("part", float, (LANES,)),  # of a cell, to fly after it
        ("flight", float, (n, LANES)),  # c_1, s_1, c_2, s_2, ... of the flight since Z was last touched
        ("flown", np.int64, (LANES,)),  # whole cells of that flight
        ("mixed", float, (LANES,)),  # 0: each vector lies in the plane of one mode, where free flight turns it
        ("Z", float, (n * n, LANES)),  # columns of Z (n, n) are vectors
        # what a rest multiplies (x1, v1, x2, ...) of vectors by; and one of them before it and after
        ("constrained", float, (n, n)),
        ("before", float, (n,)),
        ("after", float, (n,)),
        ("volume", float, (LANES,)),  # |det Z|, from the identity det S = R^2
        ("growth", float, (n, LANES)),  # products of the diagonals of R in Z = Q R
        ("logs", float, (n, LANES)),  # their logarithms, taken before they leave the range of the floats
        ("square_length", float, (n, LANES)),  # squares of the diagonal of R in the last Z = Q R, and
        ("normal", float, (pairs, LANES)),  # what stands beside it, over it, row by row: 01, 02, 03, 12, 13, 23;
        # the same of the product of all R, where they are `collected`; and beside each row what the vector `alone` adds
        ("shear", float, (pairs + apart, LANES)),
        # what each vector does to the place of a stop that was left, on the left and on the right; one row, of which
        # the compiler knows that it is not used, where no stop relaxes
        ("places", float, (2 * n if compliant else 1, LANES)),
        # of the vector that moves a stop alone (section_vectors.py) the places of both,
        ("alone", float, (2 if compliant else 1, LANES)),
        ("alone_log", float, (LANES,)),  # the logarithm of its growth in D, and
        ("alone_by_itself", float, (LANES,)),  # without that by which others make it orthonormal
        # and what rounding leaves of `logs`; of the volume, as a logarithm in two floats, what contacts multiply it by
        ("low", float, (n if compliant else 1, LANES)),
        ("log_volume", float, (2 if compliant else 1, LANES)),
        # by how much, as a logarithm, vectors would grow more at most if stops that are at rest to rounding still moved
        ("forgotten", float, (n if compliant else 1, LANES)),
        ("wanted", np.bool_),  # else nothing is computed
        ("collected", np.bool_),
        ("both", np.bool_),  # whether both numbers of some mode move the gap
    ]
    return record(fields)


@jit
def set_frame(t, i, q):
    """Give orbit i its oscillator."""
    size = len(t.growth)
    for n in range(ORDER):
        for j in range(size):
            t.series[size * n + j, i] = q.frame_series[n, j]
    for m in range(size):
        for j in range(size):
            t.to_frame[size * m + j, i], t.from_frame[size * m + j, i] = q.to_frame[m, j], q.from_frame[m, j]
    for j in range(len(t.scale)):
        t.scale[j, i], t.square[j, i] = q.frame_scale[j], q.frame_square[j]
    for m in range(size):
        t.kick[m, i], t.push[m, i] = q.to_frame[m, 0], q.to_frame[m, 1]
        for j in range(1, len(t.scale)):
            t.kick[m, i] += q.kappa[j] * q.to_frame[m, 2 * j + 1]
            if q.push[j] != 0.0:
                t.kick[m, i] += q.push[j] * q.to_frame[m, 2 * j]
                t.push[m, i] += q.push[j] * q.to_frame[m, 2 * j + 1]
        if m % 2 == 1 and q.from_frame[0, m] != 0.0:
            t.both = True


@exported
def begin(t, i):
    """Orthonormal vectors at the section."""
    size = len(t.growth)
    for m in range(size):
        for j in range(size):
            t.Z[size * m + j, i] = 1.0 if m == j else 0.0
        t.flight[m, i] = 1.0 - m % 2
    for m in range(len(t.places)):
        t.places[m, i] = 0.0
    for m in range(len(t.alone)):
        t.alone[m, i] = 0.0
    t.alone_log[i] = t.alone_by_itself[i] = 0.0
    t.lost[i], t.volume[i], t.offset[i], t.mixed[i] = 0.0, 1.0, 0.0, 0.0
    t.cell[i] = t.flown[i] = 0
    start_record(t, i)


@jit
def sort_vectors(t, i):
    """Vectors by falling growth, where Z is orthonormal: those of modes that no impact joins find no order themselves.

    Vectors that grow alike stay where they are.
    """
    size = len(t.growth)
    for last in range(1, size):
        for j in range(last, 0, -1):
            if not log_growth(t, j, i) > log_growth(t, j - 1, i) + ALIKE:
                break
            for m in range(size):
                swap(t.Z, size * m + j, size * m + j - 1, i)
            for m in range(len(t.places) // size):
                swap(t.places, size * m + j, size * m + j - 1, i)
            swap(t.growth, j, j - 1, i)
            swap(t.logs, j, j - 1, i)


@jit
def swap(rows, m, n, i):
    """Exchange two numbers of orbit i."""
    rows[m, i], rows[n, i] = rows[n, i], rows[m, i]


@inline
def motion_of(t, mass, j):
    """Displacement and speed of a mass in tangent vector j; each mode moves the mass by its first number alone."""
    Z, back, size = t.Z, t.from_frame, len(t.growth)
    x_row, v_row = 2 * mass * size, (2 * mass + 1) * size
    dx = row(back, x_row) * row(Z, j)
    dv = row(back, v_row) * row(Z, j) + row(back, v_row + 1) * row(Z, size + j)
    for m in range(2, size, 2):
        first, second = row(Z, m * size + j), row(Z, (m + 1) * size + j)
        dx = dx + row(back, x_row + m) * first
        dv = dv + (row(back, v_row + m) * first + row(back, v_row + m + 1) * second)
    return dx, dv


@inline
def strike_vector(t, who, j, dx, dv, steepness, R):
    """Tangent vector j, which moves the mass that hits by dx and dv, across an impact."""
    Z, size = t.Z, len(t.growth)
    to_x1 = -(1.0 + R) * dx
    to_v1 = steepness * dx - (1.0 + R) * dv
    for m in range(size):
        z = row(Z, size * m + j)
        after = z + row(t.kick, m) * to_x1 + row(t.push, m) * to_v1
        put(Z, size * m + j, select(who, after, z))


@noinline
def saltate_by_both(t, who, steepness, R):
    """Apply the saltation matrix of an impact where both numbers of a mode move the gap."""
    Z, back, size = t.Z, t.from_frame, len(t.growth)
    for j in range(size):
        dx, dv = motion_of(t, 0, j)
        for m in range(1, size, 2):
            dx = dx + row(back, m) * row(Z, m * size + j)
        strike_vector(t, who, j, dx, dv, steepness, R)


@jit
def saltate(t, who, steepness, R):
    """Z across an impact, by the saltation matrix S = DG + (F+ - DG F-) n^T/(n . F-).

    In (x1, v1, x2, v2), with steepness = (a1+ + R a1-)/v1-, R of the stop that is hit, and kappa = 2 zeta/mu_m: dx1 ->
    -R dx1, dv1 -> steepness dx1 - R dv1, dv2 -> dv2 - kappa (1 + R) dx1. det S = R^2.
    """
    apply_flight(t, who)
    if t.both:
        saltate_by_both(t, who, steepness, R)
    else:
        for j in range(len(t.growth)):
            dx, dv = motion_of(t, 0, j)
            strike_vector(t, who, j, dx, dv, steepness, R)
    put(t.mixed, 0, select(who, 1.0, row(t.mixed, 0)))
    watch(t, who, R * R)


@noinline
def read_growth(t, i, q, nodes, out):
    """Logarithms of the growth of the vectors up to this section, -inf for dimensions lost by sticking."""
    fly_to(t, i, q, nodes, 0, 0.0)
    catch_up(t, only(i))
    for j in range(len(t.growth)):
        out[j] = log_growth(t, j, i)
