"""Eight square matrices, one of each orbit: their columns as tuples of vectors, which stay in registers.

A field (n^2, LANES) holds them, entry (m, j) in row n m + j.
"""

import math

from llvmlite import ir
from numba.core import types
from numba.core.extending import intrinsic

from vibro_sweep.engine.simd.lanes import CONTRACT, INDEX, LANES, MaskType, lanes
from vibro_sweep.engine.simd.memory import address


def _places(context, builder, kinds, args, n):
    """Addresses of the n vectors of a column; kinds, args: of the matrices and the number of the column."""
    first = address(context, builder, kinds, args, LANES, LANES)
    return [builder.gep(first, [ir.Constant(INDEX, n * m)]) for m in range(n)]


def _vectors(builder, values, n):
    """The vectors of a tuple of n."""
    return [builder.extract_value(values, m) for m in range(n)]


@intrinsic
def column(typingctx, matrices, j):
    """Column j, a tuple of n vectors."""
    if isinstance(matrices, types.NestedArray) and isinstance(j, types.Integer):
        n = math.isqrt(matrices.shape[0])

        def codegen(context, builder, sig, args):
            values = [builder.load(place, align=8) for place in _places(context, builder, sig.args, args, n)]
            return context.make_tuple(builder, sig.return_type, values)

        return types.UniTuple(lanes, n)(matrices, j), codegen


@intrinsic
def put_column(typingctx, matrices, j, values):
    """Column j becomes these n vectors."""
    if isinstance(matrices, types.NestedArray) and isinstance(values, types.UniTuple):
        n = len(values)

        def codegen(context, builder, sig, args):
            places = _places(context, builder, sig.args, args, n)
            for place, value in zip(places, _vectors(builder, args[2], n), strict=True):
                builder.store(value, place, align=8)
            return context.get_dummy_value()

        return types.void(matrices, j, values), codegen


@intrinsic
def product(typingctx, x, y):
    """The scalar products of x and y, both of an even number of vectors, added by pairs."""
    if isinstance(x, types.UniTuple) and x == y:
        n = len(x)

        def codegen(context, builder, sig, args):
            pairs = zip(*(_vectors(builder, arg, n) for arg in args), strict=True)
            terms = [builder.fmul(a, b, flags=CONTRACT) for a, b in pairs]
            total = None
            for m in range(0, n, 2):
                pair = builder.fadd(terms[m], terms[m + 1], flags=CONTRACT)
                total = pair if total is None else builder.fadd(total, pair, flags=CONTRACT)
            return total

        return lanes(x, y), codegen


@intrinsic
def subtract(typingctx, who, x, factor, y):
    """x - factor y in the orbits `who`, else x."""
    if isinstance(who, MaskType) and isinstance(x, types.UniTuple) and x == y:
        n = len(x)

        def codegen(context, builder, sig, args):
            who, x, factor, y = args
            values = []
            for a, b in zip(_vectors(builder, x, n), _vectors(builder, y, n), strict=True):
                difference = builder.fsub(a, builder.fmul(factor, b, flags=CONTRACT), flags=CONTRACT)
                values.append(builder.select(who, difference, a))
            return context.make_tuple(builder, sig.return_type, values)

        return x(who, x, factor, y), codegen


@intrinsic
def scaled(typingctx, who, x, factor):
    """factor x in the orbits `who`, else x."""
    if isinstance(who, MaskType) and isinstance(x, types.UniTuple):
        n = len(x)

        def codegen(context, builder, sig, args):
            who, x, factor = args
            vectors = _vectors(builder, x, n)
            values = [builder.select(who, builder.fmul(factor, a, flags=CONTRACT), a) for a in vectors]
            return context.make_tuple(builder, sig.return_type, values)

        return x(who, x, factor), codegen
