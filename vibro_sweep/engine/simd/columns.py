"""States of eight orbits, one row each, as columns with a number of each orbit; and sums over them."""

from llvmlite import ir
from numba.core import types
from numba.core.extending import intrinsic

from vibro_sweep.engine.simd.lanes import CONTRACT, DOUBLE, INDEX, LANES, call, lanes
from vibro_sweep.engine.simd.memory import address, width_of_row


def _transpose(builder, rows):
    """Eight vectors as the columns of eight others: neighbours, then pairs, then fours change places."""
    kind = ir.VectorType(INDEX, LANES)
    for step in (1, 2, 4):
        own = [i & step == 0 for i in range(LANES)]  # the other half comes from the partner, `step` rows away
        low = ir.Constant(kind, [i if own[i] else i - step + LANES for i in range(LANES)])
        high = ir.Constant(kind, [i + step if own[i] else i + LANES for i in range(LANES)])
        rows = [
            builder.shuffle_vector(*((rows[i], rows[i + step], low) if own[i] else (rows[i - step], rows[i], high)))
            for i in range(LANES)
        ]
    return rows


def _blocks(array):
    """The number of blocks of eight in a row."""
    return width_of_row(array) // LANES


def _rows(builder, first, blocks, block):
    """The places of eight numbers in each of eight rows: block number `block` of so many."""
    return [builder.gep(first, [ir.Constant(INDEX, i * blocks + block)]) for i in range(LANES)]


def _first(context, builder, kind, array):
    return address(context, builder, (kind, types.intp), (array, ir.Constant(ir.IntType(64), 0)), 1, LANES)


@intrinsic
def transposed(typingctx, array, like):
    """The columns of a field (LANES, width), as many as `like`, another field, has rows."""
    if isinstance(array, types.Array) and isinstance(like, types.NestedArray):
        count, blocks = like.shape[0], _blocks(array)

        def codegen(context, builder, sig, args):
            first, columns = _first(context, builder, sig.args[0], args[0]), []
            for block in range(blocks):
                places = _rows(builder, first, blocks, block)
                columns += _transpose(builder, [builder.load(place, align=8) for place in places])
            return context.make_tuple(builder, sig.return_type, columns[:count])

        return types.UniTuple(lanes, count)(array, like), codegen


@intrinsic
def rows_of(typingctx, columns):
    """The rows of a field (m, LANES)."""
    if isinstance(columns, types.NestedArray):
        count = columns.shape[0]

        def codegen(context, builder, sig, args):
            places = (ir.Constant(ir.IntType(64), n) for n in range(count))
            kinds = (sig.args[0], types.intp)
            loaded = [
                builder.load(address(context, builder, kinds, (args[0], n), LANES, LANES), align=8) for n in places
            ]
            return context.make_tuple(builder, sig.return_type, loaded)

        return types.UniTuple(lanes, count)(columns), codegen


@intrinsic
def put_transposed(typingctx, array, columns):
    """The rows of `columns`, a field (m, LANES), become the first m columns of a field (LANES, width), others zero."""
    if isinstance(array, types.Array) and isinstance(columns, types.NestedArray):
        blocks, count = _blocks(array), columns.shape[0]

        def codegen(context, builder, sig, args):
            to, of = (_first(context, builder, kind, arg) for kind, arg in zip(sig.args, args, strict=True))
            for block in range(blocks):
                places = _rows(builder, of, 1, LANES * block)
                rows = [builder.load(place, align=8) for place in places[: max(0, count - LANES * block)]]
                rows += [ir.Constant(ir.VectorType(DOUBLE, LANES), [0.0] * LANES)] * (LANES - len(rows))
                for place, row in zip(_rows(builder, to, blocks, block), _transpose(builder, rows), strict=True):
                    builder.store(row, place, align=8)
            return context.get_dummy_value()

        return types.void(array, columns), codegen


@intrinsic
def sizes(typingctx, vectors):
    """The absolute values of a tuple of vectors."""
    if isinstance(vectors, types.UniTuple):

        def codegen(context, builder, sig, args):
            found = [call("fabs")(builder, builder.extract_value(args[0], i)) for i in range(len(vectors))]
            return context.make_tuple(builder, sig.return_type, found)

        return vectors(vectors), codegen


@intrinsic
def weigh(typingctx, rows, n, step, vectors):
    """Row n of `rows` times the first of the vectors, that `step` rows on times the second, ..., added by pairs."""
    if isinstance(rows, types.Array) and isinstance(vectors, types.UniTuple):

        def codegen(context, builder, sig, args):
            place = context.cast(builder, args[1], sig.args[1], types.intp)
            step = context.cast(builder, args[2], sig.args[2], types.intp)
            total, pair, count = None, None, len(vectors)
            for i in range(len(vectors)):
                kinds = (sig.args[0], types.intp)
                weight = builder.load(address(context, builder, kinds, (args[0], place), LANES, LANES), align=8)
                term = builder.fmul(weight, builder.extract_value(args[3], i), flags=CONTRACT)
                place = builder.add(place, step)
                pair = term if i % 2 == 0 else builder.fadd(pair, term, flags=CONTRACT)
                if i % 2 == 0 and i + 1 < count:
                    continue
                total = pair if total is None else builder.fadd(total, pair, flags=CONTRACT)
            return total

        return lanes(rows, n, step, vectors), codegen
