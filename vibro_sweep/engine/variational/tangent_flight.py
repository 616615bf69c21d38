"""The flight of tangent vectors: collected as two numbers of each mode (c_1, s_1, c_2, s_2, ...), and applied to the
vectors at the next impact.

`who` is the mask of the orbits to which something happens; i is one of them. The frame: tangent.py.
"""

from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.simd.lanes import bits, lanes_of, lowest, select
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.tables.flight import ORDER, decaying
from vibro_sweep.engine.variational.orthonormal import orthonormalise

FEW = 8  # periods


@inline
def only(i):
    """The mask of one orbit."""
    return lanes_of(1 << i)


@inline
def joined(t, j, a, b, c, s):
    """The two numbers of mode j in a flight with the numbers a, b that is followed by one with c, s."""
    return a * c - row(t.square, j) * (b * s), a * s + b * c


@jit
def fly(t, who):
    """Lengthen the collected flight by `leap` and `part`."""
    flight, leap, series, u, size = t.flight, t.leap, t.series, row(t.part, 0), len(t.growth)
    last = size * (ORDER - 1)
    for j in range(len(t.scale)):
        before, before_s = row(flight, 2 * j), row(flight, 2 * j + 1)
        a, b = joined(t, j, before, before_s, row(leap, 2 * j), row(leap, 2 * j + 1))
        c, s = row(series, last + 2 * j), row(series, last + 2 * j + 1)
        for n in range(last - size, -1, -size):
            c = c * u + row(series, n + 2 * j)
            s = s * u + row(series, n + 2 * j + 1)
        a, b = joined(t, j, a, b, c, s)
        put(flight, 2 * j, select(who, a, before))
        put(flight, 2 * j + 1, select(who, b, before_s))


@inline
def leap_in_period(t, i, nodes, cells):
    """The factors of a flight over whole cells, no more than a period."""
    frame = nodes[cells].frame
    for j in range(len(frame)):
        t.leap[j, i] = frame[j]


@jit
def leap_over(t, i, q, nodes, cells):
    """The factors of a flight over whole cells."""
    t.part[i] = 0.0
    if cells <= q.cells:
        leap_in_period(t, i, nodes, cells)
    elif cells <= FEW * q.cells:
        leap_over_periods(t, i, q, nodes, cells)
    else:
        decay_over(t, i, q, cells * q.width)


@jit
def leap_over_periods(t, i, q, nodes, cells):
    """The factors of a flight over some periods and cells: as products, which takes less time than sines do."""
    frame, period = nodes[cells % q.cells].frame, nodes[q.cells].frame
    for j in range(len(t.scale)):
        c, s = frame[2 * j], frame[2 * j + 1]
        for _ in range(cells // q.cells):
            c, s = (
                c * period[2 * j] - q.frame_square[j] * (s * period[2 * j + 1]),
                c * period[2 * j + 1] + s * period[2 * j],
            )
        t.leap[2 * j, i], t.leap[2 * j + 1, i] = c, s


@jit
def decay_over(t, i, q, u):
    """The factors of a flight of any length."""
    for j in range(len(t.scale)):
        eta = -q.frame_series[1, 2 * j]
        t.leap[2 * j, i], t.leap[2 * j + 1, i], _, _ = decaying(eta, q.frame_square[j] + eta * eta, u)


@inline
def most_cells(t, i, q):
    """Cells that may be flown between orthonormalisations of the vectors."""
    return q.most_cells_mixed if t.mixed[i] > 0.0 else q.most_cells_in_planes


@noinline
def stop_over(t, i, q, nodes, cells):
    """Fly on with orthonormalisations, without which all vectors would align. Returns the cells left."""
    limit = most_cells(t, i, q)
    while t.flown[i] + cells > limit:
        part = limit - t.flown[i]
        leap_over(t, i, q, nodes, part)
        fly(t, only(i))
        catch_up(t, only(i))
        cells -= part
    return cells


@noinline
def aim_far(t, i, q, nodes, cells, u):
    """`aim` where the flight is long, or the system stiff."""
    if t.flown[i] + cells > most_cells(t, i, q):
        cells = stop_over(t, i, q, nodes, cells)
    t.flown[i] += cells
    leap_over(t, i, q, nodes, cells)
    if not q.stiff:
        t.part[i] = u
    elif u > 0.0:  # too far for the series
        fly(t, only(i))
        decay_over(t, i, q, u)


@inline
def aim(t, i, q, nodes, k, s):
    """Set what `fly` has to do to bring the collected flight of orbit i to offset s of cell k of this period."""
    cells, u = k - t.cell[i], s - t.offset[i]
    if u < 0.0:
        cells, u = (cells - 1, u + q.width) if cells > 0 else (0, 0.0)  # 0: it is rounding
    t.cell[i], t.offset[i] = k, s
    if cells > q.cells or t.flown[i] + cells > most_cells(t, i, q) or q.stiff:
        aim_far(t, i, q, nodes, cells, u)
    else:
        t.flown[i] += cells
        t.part[i] = u
        leap_in_period(t, i, nodes, cells)


@jit
def fly_to(t, i, q, nodes, k, s):
    """Lengthen the collected flight of orbit i to offset s of cell k of this period."""
    aim(t, i, q, nodes, k, s)
    fly(t, only(i))


@jit
def apply_flight(t, who):
    """Z after the collected flight."""
    Z, flight, volume, size = t.Z, t.flight, row(t.volume, 0), len(t.growth)
    for j in range(len(t.scale)):
        c, s = row(flight, 2 * j), row(flight, 2 * j + 1)
        above, below = row(t.scale, j) * s, -row(t.square, j) / row(t.scale, j) * s
        for m in range(size):
            place = 2 * size * j + m
            first, second = row(Z, place), row(Z, place + size)
            put(Z, place, select(who, c * first + above * second, first))
            put(Z, place + size, select(who, below * first + c * second, second))
        volume = volume * (c * c - above * below)
        put(flight, 2 * j, select(who, 1.0, c))
        put(flight, 2 * j + 1, select(who, 0.0, s))
    put(t.volume, 0, select(who, volume, row(t.volume, 0)))
    left = bits(who)
    while left != 0:
        t.flown[lowest(left)] = 0
        left &= left - 1


@jit
def catch_up(t, who):
    """Bring Z to where the collected flight ends, orthonormal."""
    apply_flight(t, who)
    orthonormalise(t, who)
