"""The derivative of the linearised equations of an event that lasts (lasting_event.py) along a null vector v.

The state after it, E(s) Z(y, phi) - S(phi + s), and row 2, a functional of it, are bilinear in E and Z. For a row a of
weights on Z at the end, and Z_v = v and Z_phi v_phi,

    a D_v(E Z)_u = a E D_v Z_u + a B E (Z_u s_v + Z_v s_u) + a B^2 E Z s_v s_u

and so are its derivatives by the parameters. Where row 2 is m Z, m' = (e_g B E - m)/s and m'' = (e_g B^2 E - 2 m')/s.
"""

import cmath
import math

from vibro_sweep.engine.continuation.lasting import ends_by_force, force_scale
from vibro_sweep.engine.continuation.lasting_event import begin, dot, put_end
from vibro_sweep.engine.continuation.lasting_map import put_map
from vibro_sweep.engine.simd.jit import small

LEAST = 1e-5  # length in phase: of a shorter event the gradient at this length, since m' and m'' are divided by it
A, AB, ABB, E0, E1, E2 = range(6)  # of work.rows: a, a B, a B B, and these times E


@small
def differentiate_last(f, compliant, side, x, e, through, work):
    """Add w.(D_v J) of the map and of row 2 to `e.slopes` and `work.slopes_p`; of contacts, since curves of orbits that
    rest are not followed.

    through : (n,) complex, what the rows of the flight after it make of the state y after it, times w
    """
    if compliant is not None:
        n, N, varied, rows, end = f.A.shape[0], f.A.shape[0] // 2, work.varied, work.rows, work.end[0]
        length = math.copysign(max(abs(x[n + 1]), LEAST), x[n + 1])
        phase, longer, turn = e.v[n], e.v[n + 1], e.turn * cmath.exp(1j * length)
        begin(f, compliant, side, x, e, work)
        put_map(f, compliant, side, length, work)
        put_end(f, work)
        for k in range(n + 4):
            varied[k] = work.start_rate[k] * phase + (work.moving[k] * e.v[k] if k < n else 0.0)
            rows[A, k] = through[k] if k < n else 0j
        by_force = ends_by_force(f, compliant, side, x[n + 1], end[N])
        weight = e.w[1] / force_scale(f, compliant, side) if by_force else e.w[1]
        if by_force:
            for k in range(n + 4):
                rows[A, k] += weight * work.force[0, k]
        else:
            rows[A, 0] = 0j  # the gap is that of the stop
        multiply(rows[A], work.generator[0], n + 2, rows[AB])
        multiply(rows[AB], work.generator[0], n + 2, rows[ABB])
        for i in range(3):
            multiply(rows[i], work.lasting[0], n + 4, rows[E0 + i])
        if not by_force:
            add_place(f, length, weight, work)
        add_slopes(f, e, phase, longer, turn, through, work)
        for j in range(f.parameters):
            work.slopes_p[j] += by_parameter(f, j, e, phase, longer, turn, through, work)
            if by_force:
                for r in range(n + 4):
                    moved = dot(work.lasting[0, r], varied, n + 4)
                    moved += longer * dot(work.generator[0, r], end, n + 4) if r < n + 2 else 0.0
                    work.slopes_p[j] += weight * work.force[1 + j, r] * moved
            else:
                work.slopes_p[j] += weight * place_by_parameter(f, j, length, longer, work)


@small
def multiply(row, table, count, out):
    """out: a row times a table of so many rows."""
    for k in range(len(out)):
        out[k] = 0j
        for i in range(count):
            out[k] += row[i] * table[i, k]


@small
def add_place(f, length, weight, work):
    """Add m and its derivatives by s to the rows."""
    n, N, rows = f.A.shape[0], f.A.shape[0] // 2, work.rows
    for k in range(n + 4):
        mean, second, speed = work.mean[0, k], 0.0, work.generator[0, 0, N]
        first = (speed * work.lasting[0, N, k] - mean) / length
        for r in range(n + 4):
            second += speed * work.generator[0, N, r] * work.lasting[0, r, k]
        rows[E0, k] += weight * mean
        rows[E1, k] += weight * first
        rows[E2, k] += weight * (second - 2.0 * first) / length


@small
def add_slopes(f, e, phase, longer, turn, through, work):
    """Add the terms by xi, dphi and ds."""
    n, rows, start = f.A.shape[0], work.rows, work.start[0]
    steady = 0j  # of the state after the event
    for r in range(n):
        steady += through[r] * (f.Z[r] * turn).real * (phase + longer)
        e.slopes[r] += work.moving[r] * longer * rows[E1, r]
        e.slopes[n] -= phase * rows[E0, r] * work.moving[r] * (f.Z[r] * e.turn).real
    for k in range(n, n + 2):
        e.slopes[n] -= phase * rows[E0, k] * start[k]
    e.slopes[n] += longer * dot(rows[E1], work.start_rate, n + 2) + steady
    e.slopes[n + 1] += dot(rows[E1], work.varied, n + 4) + longer * dot(rows[E2], start, n + 4) + steady


@small
def by_parameter(f, j, e, phase, longer, turn, through, work):
    """The terms by parameter j, but for what it changes of the weights."""
    n, rows, start = f.A.shape[0], work.rows, work.start
    total = longer * dot(rows[E1], start[1 + j], n + 4)
    for r in range(n):
        total -= through[r] * (phase + longer) * (1j * f.Z_slopes[j, r] * turn).real
        total += rows[E0, r] * phase * work.moving[r] * (1j * f.Z_slopes[j, r] * e.turn).real
        total += rows[A, r] * dot(work.lasting[1 + j, r], work.varied, n + 4)
        total += longer * rows[A, r] * dot(work.generator[1 + j, r], work.end[0], n + 4)
        total += longer * rows[AB, r] * dot(work.lasting[1 + j, r], start[0], n + 4)
    return total


@small
def place_by_parameter(f, j, length, longer, work):
    """The terms by parameter j of m Z_v + m' Z s_v."""
    n, N, start = f.A.shape[0], f.A.shape[0] // 2, work.start[0]
    rate = dot(work.generator[1 + j, 0], work.end[0], n + 4)
    rate += work.generator[0, 0, N] * dot(work.lasting[1 + j, N], start, n + 4)
    return dot(work.mean[1 + j], work.varied, n + 4) + longer * (rate - dot(work.mean[1 + j], start, n + 4)) / length
