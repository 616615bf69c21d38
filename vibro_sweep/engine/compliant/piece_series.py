"""The polynomials of eight contacts in the pieces that they are in, from their tables (contact_pieces.py)."""

from vibro_sweep.engine.compliant.contact_pieces import PIECES, TERMS
from vibro_sweep.engine.simd.columns import weigh
from vibro_sweep.engine.simd.jit import inline, noinline
from vibro_sweep.engine.simd.lanes import bits, lowest, number, select
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.tables.flight import evaluate_rows


@inline
def tables_of(passage, right):
    """Which orbits take the tables of the right stop, and with which sign w2, ..., sin and cos enter them."""
    mirrored = row(passage.mirrored, 0) > 0.0
    return right | mirrored, select(mirrored & ~right, -1.0, 1.0)


@inline
def next_group(waiting, block, piece):
    """The orbits that are `waiting` in the same piece of the same tables as the first of them, these tables, and the
    piece."""
    first = lowest(bits(waiting))
    n, p = bits(block) >> first & 1, int(number(piece, first))
    return waiting & (piece >= float(p)) & (piece <= float(p)) & (block if n == 1 else ~block), n, p


@inline
def first_below(passage, kind, who, block, z):
    """The first piece at whose end a number of the contact is not positive, PIECES where there is none; and the number
    at both ends of that piece, 0 at the touch."""
    piece, begins, ends, inputs = 0.0 * z[0], 0.0 * z[0], 0.0 * z[0], len(z)
    for n in range(2):
        those = who & (block if n == 1 else ~block)
        for p in range(PIECES):
            if bits(those) == 0:
                break
            value = weigh(passage.ends, ((kind * 2 + n) * PIECES + p) * inputs, 1, z)
            ends = select(those, value, ends)
            those = those & (value > 0.0)
            begins = select(those, value, begins)
            piece = select(those, p + 1.0, piece)
    return piece, begins, ends


@inline
def load_course(passage, z, n, p):
    """The polynomial of delta in piece p; in piece 0 that of delta/u."""
    first = (n * PIECES + p) * (len(z) + 1) * TERMS
    for e in range(TERMS):
        put(passage.now, e, weigh(passage.course, first + e, TERMS, z))
    put(passage.now, TERMS, 0.0)


@inline
def load_delta(passage, z, n, p):
    """The polynomial of delta in any piece."""
    load_course(passage, z, n, p)
    if p == 0:
        times_u(passage.now)


@noinline
def times_u(c):
    """From the polynomial of delta/u that of delta."""
    for e in range(TERMS, 0, -1):
        put(c, e, row(c, e - 1))
    put(c, 0, 0.0)


@inline
def load_force(passage, k, c, preload):
    """The polynomial of F/m_e from that of delta."""
    for e in range(TERMS):
        force = k * row(passage.now, e) + (e + 1.0) * (c * row(passage.now, e + 1))
        put(passage.end, e, force + preload if e == 0 else force)


@inline
def delta_at(c, v):
    """delta and delta' at v, from all terms of `load_delta`."""
    x, slope = row(c, TERMS), 0.0 * v
    for e in range(TERMS - 1, -1, -1):
        slope = slope * v + x
        x = x * v + row(c, e)
    return x, slope


@noinline
def keep_others(passage, z, n, p, to, who, u, v, sign):
    """w2, w2', ... of these orbits at u, which is v after the node."""
    size, other = len(z) + 1, passage.other
    for m in range(1, len(passage.push)):
        first = ((n * PIECES + p) * (len(passage.push) - 1) + m - 1) * size * TERMS
        for e in range(TERMS):
            put(other, e, weigh(passage.others, first + e, TERMS, z))
        x, slope = evaluate_rows(other, 0, TERMS, v)
        w, rate = z[2 * m - 1], z[2 * m]
        put(to, 2 * m, select(who, sign * (w + (rate * u + x)), row(to, 2 * m)))
        put(to, 2 * m + 1, select(who, sign * (rate + slope), row(to, 2 * m + 1)))
