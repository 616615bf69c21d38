"""The motion during an event that lasts, a rest or a contact with a compliant stop, as a linear map.

Z = (z, cos phi, sin phi, 1, stop) holds the motion z = y + S, with d = gap - stop in place of the gap, and the forcing.
The stop takes the acceleration q Z from the gap (lasting.py):

    dZ/dphi = B Z        B = (A_free - e_v q)/omega        Z(phi + s) = E Z(phi)        E = exp(B s)

E, the mean rate m = e_g (E - 1)/s of the gap, and their derivatives by the parameters are summed as Taylor series over
a step that resolves the rates, which is doubled up to s. The series are made anew where B changes: neither the place of
the stop nor the length of the event does that.
"""

import cmath

import numpy as np

from vibro_sweep.engine.continuation.lasting import put_force, rate_of
from vibro_sweep.engine.continuation.moving_flow import OMEGA
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES, alike, bits
from vibro_sweep.engine.simd.memory import eight, put_eight

MOST_HALVINGS = 17  # of the length of an event: a longer one, of a stop with a strong damper, is not computed


@jit
def halvings_of(f, compliant, side, length):
    """How often the length is halved, so that the step times the rates is 0.7 at most. -1: too often."""
    step, count = abs(length) / f.numbers[OMEGA] * (1.0 / f.width + rate_of(f, compliant, side)), 0
    while step > 1.0 and count <= MOST_HALVINGS:
        step, count = 0.5 * step, count + 1
    return count if count <= MOST_HALVINGS else -1


@jit
def put_map(f, compliant, side, length, work):
    """work.lasting: E and its derivatives over a length in phase, which may be negative; work.mean: m and its own.

    Returned is how often it was doubled; -1, and NaN everywhere, where that is too often.
    """
    halvings = halvings_of(f, compliant, side, length)
    step = length / (1 << max(halvings, 0)) if halvings >= 0 else np.nan
    put_step(f, compliant, side, step, work)
    for _ in range(halvings):
        step = 2.0 * step
        double(f, step, work)
    return halvings


@jit
def put_step(f, compliant, side, step, work):
    """The same over a step that resolves the rates."""
    k = 1 if side > 0 else 0
    put_generator(f, compliant, side, work)
    if differ(work.generator, work.generators[k]):
        build_motion(f, work.generator, work.motion_series[k])
    for j in range(f.parameters, -1, -1):  # the last one leaves the derivative of m by s
        work.varies[j] = is_not_zero(work.generator[j])
        if work.varies[j]:
            put_polynomials(f, work.motion_series[k, j], step, work.lasting[j], work.mean[j], work.mean_slope)
        else:
            clear(work.lasting[j])
            clear(work.mean[j : j + 1])
    put_turn(f, step, work.lasting[0])


@jit
def put_generator(f, compliant, side, work):
    """work.generator: B and its derivatives by the parameters; work.force: q and its own."""
    B, n, omega = work.generator, f.A.shape[0], f.numbers[OMEGA]
    put_rates(f, compliant, side, f.values, f.A, B[0], work.force[0])
    for j in range(f.parameters):
        put_rates(f, compliant, side, f.slopes[j], f.A_slopes[j], B[1 + j], work.force[1 + j])
    for place in range(0, n * B.shape[2], LANES):
        value = eight(B[0], place) * (1.0 / omega)
        put_eight(B[0], place, value)
        for j in range(f.parameters):
            put_eight(B[1 + j], place, (eight(B[1 + j], place) - f.number_slopes[j, OMEGA] * value) * (1.0 / omega))
    B[0, n, n + 1], B[0, n + 1, n] = -1.0, 1.0


@jit
def put_rates(f, compliant, side, values, A, rates, force):
    """rates (n, ..): those of z by time, of the numbers themselves or of their slopes."""
    n, N = f.A.shape[0], f.A.shape[0] // 2
    for r in range(n):
        for k in range(n):
            rates[r, k] = A[r, k]
        for i in range(2):
            rates[r, n + i] = values[n * (n + 1) + r - N + i * N] if r >= N else 0.0
        rates[r, n + 2], rates[r, n + 3] = A[r, n], A[r, 0]
    put_force(f, compliant, side, values, rates[N], force)
    for k in range(n + 4):
        rates[N, k] -= force[k]


@jit
def differ(tables, kept):
    """Whether two stacks of tables differ; `kept` becomes the other one."""
    found = 0
    for place in range(0, tables.shape[0] * tables.shape[1] * tables.shape[2], LANES):
        value = eight(tables, place)
        found |= bits(~(abs(value - eight(kept, place)) <= 0.0))  # NaN differs from all
        put_eight(kept, place, value)
    return found != 0


@jit
def is_not_zero(table):
    """Whether a number of a table is not zero: along b and along numbers of the stop alone B does not change."""
    found = 0
    for place in range(0, table.shape[0] * table.shape[1], LANES):
        found |= bits(~(abs(eight(table, place)) <= 0.0))
    return found != 0


@jit
def clear(table):
    for place in range(0, table.shape[0] * table.shape[1], LANES):
        put_eight(table, place, alike(0.0))  # times 0, NaN would stay


@jit
def build_motion(f, B, series):
    """series (3, ORDER + 1, n, ..): Taylor coefficients of E, and their derivatives."""
    n, wide = f.A.shape[0], B.shape[2]
    for r in range(n):
        series[0, 0, r, r] = 1.0
    for order in range(1, ORDER + 1):
        for r in range(n):
            for place in range(0, wide, LANES):
                value = combined(B[0], series[0, order - 1, r], n + 2, place) * (1.0 / order)
                put_eight(series[0, order], r * wide + place, value)
                for j in range(1, f.parameters + 1):
                    slope = combined(B[0], series[j, order - 1, r], n + 2, place)
                    slope = slope + combined(B[j], series[0, order - 1, r], n + 2, place)
                    put_eight(series[j, order], r * wide + place, slope * (1.0 / order))


@jit
def combined(table, row, count, place):
    """Eight numbers of the row times the table, so many rows of it."""
    wide = table.shape[1]
    total = eight(table, place) * row[0]
    for i in range(1, count):
        total = total + eight(table, i * wide + place) * row[i]
    return total


@jit
def put_polynomials(f, series, step, total, mean, mean_slope):
    """total (n, ..): sum_k series_k step^k; mean: of its first row (total - 1)/step, from k = 1 on; its derivative."""
    wide = total.shape[1]
    size = f.A.shape[0] * wide
    for i in range(0, size, LANES):
        value = eight(series, ORDER * size + i)
        slope = value * 0.0
        for k in range(ORDER - 1, 0, -1):
            if i < wide:
                slope = slope * step + value
            value = value * step + eight(series, k * size + i)
        if i < wide:
            put_eight(mean, i, value)
            put_eight(mean_slope, i, slope)
        put_eight(total, i, value * step + eight(series, i))


@jit
def put_turn(f, angle, E):
    """The rows of cos phi, sin phi, 1 and stop."""
    n, turn = f.A.shape[0], cmath.exp(1j * angle)
    E[n, n] = E[n + 1, n + 1] = turn.real
    E[n, n + 1], E[n + 1, n] = -turn.imag, turn.imag
    E[n + 2, n + 2] = E[n + 3, n + 3] = 1.0


@jit
def double(f, length, work):
    """Double E and m up to this length: E E and m (E + 1)/2."""
    n, E, mean, twice, wide = f.A.shape[0], work.lasting, work.mean, work.twice, work.lasting.shape[2]
    for j in range(f.parameters, -1, -1):
        if not work.varies[j]:
            continue
        for place in range(0, wide, LANES):
            value = eight(mean[j], place) + combined(E[0], mean[j], n + 4, place)
            if j > 0:
                value = value + combined(E[j], mean[0], n, place)
            put_eight(twice[j], n * wide + place, value * 0.5)
            for r in range(n):
                value = combined(E[0], E[j, r], n + 4, place)
                if j > 0:
                    value = value + combined(E[j], E[0, r], n, place)
                put_eight(twice[j], r * wide + place, value)
    for j in range(f.parameters + 1):
        if not work.varies[j]:
            continue
        for place in range(0, n * wide, LANES):
            put_eight(E[j], place, eight(twice[j], place))
        for place in range(0, wide, LANES):
            put_eight(mean[j], place, eight(twice[j], n * wide + place))
    put_turn(f, length, E[0])


@jit
def put_gap_course(f, side, Z, work):
    """work.cell: Taylor coefficients of d by phase, from Z on."""
    series, cell = work.motion_series[1 if side > 0 else 0, 0], work.cell
    for order in range(ORDER + 1):
        cell[order] = series[order, 0, 0] * Z[0]
        for k in range(1, f.A.shape[0] + 4):
            cell[order] += series[order, 0, k] * Z[k]


@jit
def put_force_course(f, side, Z, work):
    """work.cell: the same of q Z."""
    n, series, cell, row = f.A.shape[0], work.motion_series[1 if side > 0 else 0, 0], work.cell, work.force[0]
    wave, constant = complex(row[n], -row[n + 1]) * complex(Z[n], Z[n + 1]), row[n + 2] + row[n + 3] * Z[n + 3]
    for order in range(ORDER + 1):
        cell[order] = wave.real + constant
        for r in range(n):
            for k in range(n + 4):
                cell[order] += row[r] * series[order, r, k] * Z[k]
        wave *= 1j / (order + 1)
        constant = 0.0
