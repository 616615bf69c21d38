"""A rest as an event: after an impact with R = 0 the gap stays at its stop until its free acceleration vanishes.

The second unknown of the event is the length s of the rest in phase. With z = y + S the whole motion, once the velocity
of its gap is lost, and A_h, F the free rates but those of the gap, which are zero,

    dz/dphi = (A_h (z, 1) + Re(F e^{i phi}))/omega        y+ = z(phi + s) - S(phi + s)

so that no steady motion of the held masses is needed. E_h is the derivative of z(phi + s) by z. At fixed phases

    xi+ = E_h (xi + A e_v v/omega dphi) - e_v (a/omega) (dphi + ds) + ..        gap and velocity left out of (..)

where v is the gap's velocity before the impact and a, its free acceleration at the end, is row 2. Both rows and this
map are regular at s = 0. z, E_h and the derivatives by parameters are summed as Taylor series from cell to cell.
"""

import cmath

import numpy as np

from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA
from vibro_sweep.engine.impulses.extremes import OVERLAP, extremes_of_cell
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import small


@small
def rest(f, side, x, e, room):
    """`after`, `carry`, `pull` and `release` of a rest, after `approach`."""
    n, N, omega, v = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA], e.motion[0]
    constrain_gap(f, side, x, x[n + 1], e, room)
    state, turn = room[0], e.turn * cmath.exp(1j * x[n + 1])
    for r in range(n):
        e.after[r] = state[r, n] - (f.Z[r] * turn).real
    e.after[n] = 1.0
    e.pull = free_acceleration(f, state, turn)
    for r in range(n):
        e.carry[r, n] = e.carry[r, n + 1] = -e.pull / omega if r == N else 0.0
        for k in range(n):
            e.carry[r, k] = state[r, k]
            if k != 0 and k != N:
                e.carry[r, n] += state[r, k] * f.A[k, N] * v / omega
        for j in range(f.parameters):
            e.carry[r, n + 2 + j] = state[r, n + 1 + j] - (f.Z_slopes[j, r] * turn).real
    put_release(f, e, turn)


@small
def begin_rest(f, side, x, e, state):
    """Derivatives of z by xi (n), z, and derivatives by the parameters, once the gap's velocity is lost.

    The gap is that of the stop, which is what row 1 of the event demands.
    """
    n, N, stop = f.A.shape[0], f.A.shape[0] // 2, HIGH if side > 0 else LOW
    for r in range(n):
        moves = r != 0 and r != N
        for k in range(n):
            state[r, k] = 1.0 if moves and r == k else 0.0
        state[r, n] = x[r] + (f.Z[r] * e.turn).real if moves else f.numbers[stop] if r == 0 else 0.0
        for j in range(f.parameters):
            state[r, n + 1 + j] = (f.Z_slopes[j, r] * e.turn).real if moves else 0.0
            if r == 0:
                state[r, n + 1 + j] = f.number_slopes[j, stop]


@small
def cells_of(f, length):
    """The number of parts in which a rest is computed."""
    return int(abs(length) / (f.numbers[OMEGA] * f.width)) + 1


@small
def constrain_gap(f, side, x, length, e, room):
    """room[0]: as of `begin_rest`, but this length in phase, which may be negative, after the impact."""
    begin_rest(f, side, x, e, room[0])
    cells = cells_of(f, length)
    for k in range(cells):
        advance(f, length / cells, e.turn * cmath.exp(1j * length / cells * k), room, e.course)


@small
def advance(f, step, swing, room, course):
    """Take room[0] a step in phase ahead, from e^{i phi} = swing on.

    course : (ORDER + 1,) receives the coefficients of the gap's free acceleration by powers of the share of the step
    """
    n, N, state, before, term = f.A.shape[0], f.A.shape[0] // 2, room[0], room[1], room[2]
    for r in range(n):
        for c in range(n + 1 + f.parameters):
            before[r, c] = state[r, c]
    for order in range(ORDER + 1):
        course[order] = free_acceleration(f, before, swing) - (f.A[N, n] if order > 0 else 0.0)
        if order == ORDER:
            return
        next_term(f, order + 1, step, swing, before, term)
        swing *= 1j * step / (order + 1)
        for r in range(n):
            for c in range(n + 1 + f.parameters):
                state[r, c] += term[r, c]
                before[r, c] = term[r, c]


@small
def press(f, side, x, e, work):
    """The least free acceleration into the stop during a rest: where it begins, or turns."""
    n = f.A.shape[0]
    begin_rest(f, side, x, e, work.resting[0])
    cells, least = cells_of(f, x[n + 1]), np.inf
    for k in range(cells):
        advance(f, x[n + 1] / cells, e.turn * cmath.exp(1j * x[n + 1] / cells * k), work.resting, e.course)
        for order in range(ORDER + 1):
            e.course[order] *= side
        if k == 0:
            least = e.course[0]
        work.turning[0] = np.inf
        extremes_of_cell(e.course, OVERLAP, 0.0, np.inf, work.turning, work.waiting)
        least = min(least, work.turning[0])
    return least


@small
def next_term(f, order, step, swing, before, term):
    """The Taylor term of this order from that before it; swing: (i step)^{order - 1}/(order - 1)! e^{i phi}."""
    n, N = f.A.shape[0], f.A.shape[0] // 2
    for r in range(n):
        if r == 0 or r == N:
            for c in range(n + 1 + f.parameters):
                term[r, c] = 0.0
        else:
            put_term(f, order, step, swing, before, term, r)


@small
def put_term(f, order, step, swing, before, term, r):
    """Row r of it, by the free rates."""
    n, N, omega = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA]
    size, share = n * (n + 1), step / (order * omega)
    for c in range(n + 1 + f.parameters):
        total = 0.0
        for k in range(n):
            total += f.A[r, k] * before[k, c]
        term[r, c] = share * total
    if order == 1:
        term[r, n] += share * f.A[r, n]
    if r >= N:
        term[r, n] += share * (f.values[size + r - N] * swing.real + f.values[size + r] * swing.imag)
    for j in range(f.parameters):
        total = f.A_slopes[j, r, n] if order == 1 else 0.0
        for k in range(n):
            total += f.A_slopes[j, r, k] * before[k, n]
        if r >= N:
            total += f.slopes[j, size + r - N] * swing.real + f.slopes[j, size + r] * swing.imag
        term[r, n + 1 + j] += share * total - f.number_slopes[j, OMEGA] / omega * term[r, n]


@small
def free_acceleration(f, state, turn):
    """The free acceleration of the gap by the whole motion z, as in `begin_rest`, since steady motions may be much
    larger."""
    n, N = f.A.shape[0], f.A.shape[0] // 2
    total = f.A[N, n] + f.values[n * (n + 1)] * turn.real + f.values[n * (n + 1) + N] * turn.imag
    for k in range(n):
        total += f.A[N, k] * state[k, n]
    return total


@small
def put_release(f, e, turn):
    """`release`: derivatives of the free acceleration at the end of the rest by xi, phi, s and the parameters."""
    n, N, omega = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA]
    for c in range(n + 2 + f.parameters):
        e.release[c] = 0.0
        for r in range(n):
            e.release[c] += f.A[N, r] * e.carry[r, c]
    by_phase = -(omega * f.Z[N] * turn).real
    for r in range(n):
        for k in range(n + 1):
            by_phase += f.A[N, r] * f.A[r, k] * e.after[k] / omega
    e.release[n] += by_phase
    e.release[n + 1] += by_phase
    for j in range(f.parameters):
        turning = 1j * (f.number_slopes[j, OMEGA] * f.Z[N] + omega * f.Z_slopes[j, N])
        e.release[n + 2 + j] += (turning * turn).real
        for k in range(n + 1):
            e.release[n + 2 + j] += f.A_slopes[j, N, k] * e.after[k]


@small
def put_rest(f, e, panel):
    """Row 2 of the event, and the rows of the flight after it: state and parameters."""
    n = f.A.shape[0]
    p, F, second = 3 * n + 2, 3 * n + 2 + f.parameters, n + 1
    panel[second, F] = e.pull
    for c in range(n + 2 + f.parameters):
        to = c if c < n + 2 else p + c - n - 2
        panel[second, to] = e.release[c]
        for r in range(n):
            for k in range(n):
                panel[n + 2 + r, to] -= e.E[0, r, k] * e.carry[k, c]
