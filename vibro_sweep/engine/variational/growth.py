"""What tangent vectors have grown by: products, whose logarithms are taken before they leave the range of the floats.

Compliant stops may shrink vectors at rates of many thousands. There logarithms, and what contacts do to the volume that
the vectors span, are kept in two floats: the sum of the exponents is a small difference of theirs.

t: a record of tangent.py; `who`: the mask of the orbits to which something happens; i: one of them.
"""

import math

import numpy as np
from numba.core import types
from numba.core.extending import intrinsic

from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.simd.lanes import LANES, select
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.tables.twofold import add, multiply

SHORTEST, LONGEST = 1e-100, 1e100  # products of lengths before their logarithm is taken
ROUNDING = 2.0**-46  # of what vectors span, for each unit of their condition number, and
IN_CONTACT = 2.0**-26  # of the entries of contacts, which may be 10^7 times as large as what they do in the end


@intrinsic
def if_compliant(typingctx, t):
    """None for tangent vectors where all stops are rigid: what is only for others is not compiled then."""
    kept = isinstance(t, types.Record) and t.fields["low"].type.shape[0] > 1
    kind = types.boolean if kept else types.none

    def codegen(context, builder, sig, args):
        return context.get_constant(kind, True) if kept else context.get_dummy_value()

    return kind(t), codegen


@jit
def start_record(t, i):
    """Count growth from here on."""
    for j in range(len(t.growth)):
        t.growth[j, i], t.logs[j, i] = 1.0, 0.0


@jit
def start_in_two(t, i):
    """Begin what only compliant stops need of a record."""
    t.log_volume[0, i] = t.log_volume[1, i] = 0.0
    for j in range(len(t.growth)):
        t.low[j, i] = t.forgotten[j, i] = 0.0


@inline
def add_log(t, j, i, more, low=0.0):
    """Let vector j grow by this logarithm, and what rounding leaves of it, where there are compliant stops; -inf: by
    nothing."""
    if min(t.logs[j, i], more) == -np.inf:  # of which there is no rounding
        t.logs[j, i], t.low[j, i] = -np.inf, 0.0
    else:
        t.logs[j, i], t.low[j, i] = add(t.logs[j, i], t.low[j, i], more, low)


@noinline
def take_logs(compliant, t, who):
    """Begin the products of these orbits anew before they leave the range of the floats. who: as bits."""
    for j in range(len(t.growth)):
        for i in range(LANES):
            if who >> i & 1 and not SHORTEST < t.growth[j, i] < LONGEST:
                if compliant is None:
                    t.logs[j, i] += np.log(t.growth[j, i])
                if compliant is not None:
                    add_log(t, j, i, np.log(t.growth[j, i]))
                t.growth[j, i] = 1.0


@jit
def log_growth(t, j, i):
    """-inf for dimensions that are lost."""
    return t.logs[j, i] + np.log(t.growth[j, i])


@inline
def log_growth_in_two(t, j, i):
    """`log_growth` and what rounding leaves of it."""
    if t.logs[j, i] > -np.inf and t.growth[j, i] > 0.0:
        return add(t.logs[j, i], t.low[j, i], np.log(t.growth[j, i]), 0.0)
    return log_growth(t, j, i), 0.0


@jit
def change_volume(t, i, more):
    """A touch multiplies volumes by e^more."""
    t.log_volume[0, i], t.log_volume[1, i] = add(t.log_volume[0, i], t.log_volume[1, i], more, 0.0)


@jit
def shrink_volume(t, i, c, w):
    """The time w in contact with a stop multiplies volumes by e^-cw."""
    more, low = multiply(-c, 0.0, w, 0.0)
    t.log_volume[0, i], t.log_volume[1, i] = add(t.log_volume[0, i], t.log_volume[1, i], more, low)


@inline
def shrink_volumes(t, who, less):
    """Short contacts of these orbits multiply volumes by e^-less."""
    before = row(t.log_volume, 0)
    after = before - less
    change = after - before
    low = row(t.log_volume, 1) + ((before - (after - change)) - (less + change))
    put(t.log_volume, 0, select(who, after, before))
    put(t.log_volume, 1, select(who, low, row(t.log_volume, 1)))


@jit
def excess(t, i, logs, low):
    """How much more vectors have grown by, as a logarithm, than what contacts do to volumes explains.

    logs: of the growth of each, and what rounding leaves of all.
    """
    high, low = add(-t.log_volume[0, i], -t.log_volume[1, i], low, 0.0)
    for j in range(len(t.growth)):
        high, low = add(high, low, logs[j], 0.0)
    return high


@jit
def excess_of_record(t, i):
    """`excess` at the end of a record."""
    high, low = -t.log_volume[0, i], -t.log_volume[1, i]
    for j in range(len(t.growth)):
        more, rest = log_growth_in_two(t, j, i)
        high, low = add(high, low, more, rest)
    return high


@inline
def close_volume(compliant, t, who):
    """What rounding has done to the last of the vectors, which are orthogonal now: its length is what the others leave
    of the volume, the product of known determinants. What it does to the places of stops has been divided by the length
    as it was computed, and goes with it: what it did to them in all stays.

    A contact that shrinks one direction to 1e-9 of the others leaves it seven digits. What rounding does not explain
    stays as it is, and shows in the sum of the exponents.
    """
    size = len(t.growth)
    if compliant is not None:
        volume, place = row(t.volume, 0), 0
        whole = 0.0 * volume
        spanned = 1.0 + whole
        for i in range(size):
            square = row(t.square_length, i)
            spanned = spanned * math.sqrt(square)
            whole = whole + square
            for _ in range(i + 1, size):
                whole = whole + square * (row(t.normal, place) * row(t.normal, place))
                place += 1
        whole = whole / size
        most = whole
        for _ in range(size // 2 - 1):
            most = most * whole
        known = who & (row(t.lost, 0) < 1.0) & (abs(volume - spanned) < ROUNDING * most + IN_CONTACT * volume)
        last = row(t.growth, size - 1)
        put(t.growth, size - 1, select(known, last * (volume / spanned), last))
        for m in range(size - 1, len(t.places), size):
            place = row(t.places, m)
            put(t.places, m, select(known, place * (spanned / volume), place))
