"""What the eliminated equations (residual.py) give: right sides and rows taken along, solutions, left vectors."""

import math

from vibro_sweep.engine.continuation.problem import unknowns
from vibro_sweep.engine.continuation.workspace import THETA
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import eight, put_eight


@jit
def reflect(panel, width, columns, mirrors, scales):
    """Reflections that make the first columns an upper triangle. Sign of its determinant; 0.0 where it is singular.

    width : of the rows, in use
    mirrors : (columns, rows) receives m of each reflection 1 - s m m^T, from entry `column` on; scales: (columns,) s
    What is left below the triangle is rounding.
    """
    rows, stride, sign = panel.shape[0], panel.shape[1], 1.0
    for c in range(columns):
        size = 0.0
        for r in range(c, rows):
            size += panel[r, c] * panel[r, c]
        if not size > 0.0:
            return 0.0
        corner = panel[c, c]
        diagonal = -math.copysign(math.sqrt(size), corner)
        if diagonal < 0.0:
            sign = -sign
        scales[c] = 1.0 / (size - corner * diagonal)
        panel[c, c] = mirrors[c, c] = corner - diagonal
        for r in range(c + 1, rows):
            mirrors[c, r] = panel[r, c]
        for place in range(c - c % LANES, width, LANES):
            total = mirrors[c, c] * eight(panel, c * stride + place)
            for r in range(c + 1, rows):
                total = total + mirrors[c, r] * eight(panel, r * stride + place)
            total = total * scales[c]
            for r in range(c, rows):
                first = r * stride + place
                put_eight(panel, first, eight(panel, first) - mirrors[c, r] * total)
        panel[c, c] = diagonal
    return sign


@jit
def copy_row(source, i, target, j, width):
    """The first `width` numbers of row i of one table to row j of another one with as many columns."""
    stride = source.shape[1]
    for place in range(0, width, LANES):
        put_eight(target, j * stride + place, eight(source, i * stride + place))


@jit
def take_down(b, n, vector, sides, end):
    """Q^T times a vector over all rows: `end` (n,) is what is left of it for the last equations.

    vector : (K + 1, n + 2): rows of each event and of the flight after it; last those of xi_1
    sides : whether what belongs to the eliminated rows is kept in `events.sides`
    """
    K, column = len(b.events), b.work[0].column
    for r in range(n):
        end[r] = vector[K, r]
    for i in range(K):
        mirrors, scales = b.events[i].mirrors, b.events[i].scales
        for r in range(n):
            column[r] = end[r]
        for r in range(n + 2):
            column[n + r] = vector[i, r]
        for c in range(n + 2):
            total = 0j
            for r in range(c, 2 * n + 2):
                total += mirrors[c, r] * column[r]
            total *= scales[c]
            for r in range(c, 2 * n + 2):
                column[r] -= mirrors[c, r] * total
        for r in range(n):
            end[r] = column[n + 2 + r]
        if sides:
            for r in range(n + 2):
                b.events[i].sides[r] = column[r]


@jit
def take_up(b, n, end, out):
    """Q times a vector of the last equations and, in `events.sides`, of the eliminated rows: out as in `take_down`."""
    K, column = len(b.events), b.work[0].column
    for r in range(n):
        column[n + 2 + r] = end[r]
    for i in range(K - 1, -1, -1):
        e = b.events[i]
        for r in range(n + 2):
            column[r] = e.sides[r]
        for c in range(n + 1, -1, -1):
            total = 0j
            for r in range(c, 2 * n + 2):
                total += e.mirrors[c, r] * column[r]
            total *= e.scales[c]
            for r in range(c, 2 * n + 2):
                column[r] -= e.mirrors[c, r] * total
        for r in range(n + 2):
            out[i, r] = column[n + r]
        for r in range(n):
            column[n + 2 + r] = column[r]
    for r in range(n):
        out[K, r] = column[r]


@jit
def clear_sides(b):
    for i in range(len(b.events)):
        sides = b.events[i].sides
        for r in range(len(sides)):
            sides[r] = 0.0


@jit
def substitute_back(e, n, after, first, x):
    """x (n + 2,): xi, dphi, dD of an event, from its right sides there, xi_{i+1} and xi_1."""
    kept, X = e.kept, 2 * n + 2
    for r in range(n + 1, -1, -1):
        total = x[r]
        for j in range(n):
            total -= kept[r, n + 2 + j] * after[j] + kept[r, X + j] * first[j]
        for j in range(r + 1, n + 2):
            total -= kept[r, j] * x[j]
        x[r] = total / kept[r, r]


@jit
def take_apart(f, c, b, s, first, p, with_residual):
    """`changes[s]` of all events, from xi_1 and the parameters (in their units); or without the residual."""
    K, n = len(b.events), f.A.shape[0]
    P, F = 3 * n + 2, 3 * n + 2 + c.parameters
    for i in range(K - 1, -1, -1):
        e = b.events[i]
        x = e.changes[s]
        for r in range(n + 2):
            x[r] = e.kept[r, F] if with_residual else 0.0
            for j in range(c.parameters):
                x[r] -= e.kept[r, P + j] * p[j] * c.unit[j]
        if i + 1 < K:
            substitute_back(e, n, b.events[i + 1].changes[s], first, x)
        else:
            after = b.work[0].closure
            for r in range(n):
                after[r] = c.sigma * first[r]
            substitute_back(e, n, after, first, x)


@jit
def reduce_row(c, b, n, k):
    """Eliminate scalar row k, `events.rows` and `work.row_p`: it becomes row n + k of the last equations."""
    work = b.work[0]
    line, X, P, F = work.line, 2 * n + 2, 3 * n + 2, 3 * n + 2 + c.parameters
    for j in range(F):
        line[j] = 0.0
    line[F] = work.row_left[k]
    for j in range(c.parameters):
        line[P + j] = work.row_p[k, j] / c.unit[j]
    for i in range(len(b.events)):
        e = b.events[i]
        for r in range(n + 2):
            line[r] += e.rows[k, r]
        for r in range(n + 2):
            e.factors[k, r] = line[r] / e.kept[r, r]
            for j in range(r, F + 1):
                line[j] -= e.factors[k, r] * e.kept[r, j]
        for r in range(n):
            line[r], line[n + 2 + r] = line[n + 2 + r], 0.0
        line[n] = line[n + 1] = 0.0
    ends, m = work.ends, unknowns(c)
    for r in range(n):
        ends[n + k, r] = c.sigma * line[r] + line[X + r]
    for j in range(m):
        ends[n + k, n + j] = line[P + j] * c.unit[j] if j < c.parameters else work.row_p[k, THETA]
    ends[n + k, n + m], ends[n + k, n + m + 1] = line[F], 0.0


@jit
def put_last(c, b, n):
    """The first n of the last equations: G(1) xi_1, parameters, residual."""
    work, X, P = b.work[0], 2 * n + 2, 3 * n + 2
    m = unknowns(c)
    for r in range(n):
        for j in range(n):
            work.ends[r, j] = c.sigma * work.last[r, j] + work.last[r, X + j]
        for j in range(m):
            work.ends[r, n + j] = work.last[r, P + j] * c.unit[j] if j < c.parameters else 0.0
        work.ends[r, n + m], work.ends[r, n + m + 1] = work.last[r, P + c.parameters], 0.0
