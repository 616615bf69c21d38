"""Numbers side by side: one for each of eight orbits, or those of the state of one orbit. The processor's vectors.

Jitted code writes a formula for `Lanes` as it would for floats; each operation is one on an LLVM vector, and no
compiler has to find out by itself that a loop can be turned into vectors. A lane never sees its neighbours: its
digits are the same whatever they hold. Where orbits part ways, both ways are computed and `select` takes one.

How many numbers there are belongs to the type: `Lanes(8)` for eight orbits, `Lanes(width)` for a state. It is read from
the shape of the field of a record; arrays without one have rows of eight.
"""

import itertools
import math
import operator

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.core.extending import intrinsic, lower_builtin, models, register_model
from numba.core.typing.templates import AbstractTemplate, infer_global, signature

LANES = 8
LINE = 64  # bytes of a cache line, which is as much as eight floats: what lies across two of them takes twice as long


def record(fields: list) -> np.dtype:
    """A structured dtype that fills whole cache lines; fields of eight numbers should come first."""
    missing = -np.dtype(fields).itemsize % LINE
    return np.dtype([*fields, ("padding", np.uint8, missing)])


def new_lines(shape: int | tuple[int, ...], dtype) -> np.ndarray:
    """Zeros that begin with a cache line."""
    size = math.prod(np.atleast_1d(shape)) * np.dtype(dtype).itemsize
    space = np.zeros(size + LINE, np.uint8)
    first = -space.ctypes.data % LINE
    return space[first : first + size].view(dtype).reshape(shape)


_DOUBLE, _INDEX = ir.DoubleType(), ir.IntType(32)
_CONTRACT = ("contract",)  # as in jit.py


class LanesType(types.Type):
    def __init__(self, count):
        super().__init__(f"Lanes({count})")
        self.count = count


class MaskType(types.Type):
    def __init__(self, count):
        super().__init__(f"Mask({count})")
        self.count = count


lanes, mask = LanesType(LANES), MaskType(LANES)


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, ir.VectorType(_DOUBLE, fe_type.count))


@register_model(MaskType)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, ir.VectorType(ir.IntType(1), fe_type.count))


def _spread(context, builder, kind, value, count):
    """A float as so many equal ones; lanes as they are."""
    if isinstance(kind, LanesType):
        return value
    value = context.cast(builder, value, kind, types.float64)
    nothing = ir.Constant(ir.VectorType(_DOUBLE, count), ir.Undefined)
    first = builder.insert_element(nothing, value, ir.Constant(_INDEX, 0))
    return builder.shuffle_vector(first, nothing, ir.Constant(ir.VectorType(_INDEX, count), [0] * count))


def _count(kinds):
    """How many numbers the lanes among these types have: one count, or None."""
    counts = {kind.count for kind in kinds if isinstance(kind, LanesType)}
    return counts.pop() if len(counts) == 1 else None


def _define(function, result, emit, count=2):
    """Teach numba `function` of so many Lanes, or Lanes and floats; emit(builder, *vectors) is its instruction.

    result: LanesType or MaskType.
    """

    class Typing(AbstractTemplate):
        def generic(self, args, kws):
            fits = len(args) == count and all(isinstance(kind, (LanesType, types.Number)) for kind in args)
            if fits and _count(args):
                return signature(result(_count(args)), *args)

    def lower(context, builder, sig, args):
        count, pairs = _count(sig.args), zip(sig.args, args, strict=True)
        return emit(builder, *(_spread(context, builder, kind, arg, count) for kind, arg in pairs))

    infer_global(function)(Typing)
    for kinds in itertools.product((LanesType, types.Number), repeat=count):
        if LanesType in kinds:
            lower_builtin(function, *kinds)(lower)


def _call(name):
    """An LLVM function of floats, on vectors."""

    def emit(builder, *vectors):
        vector = vectors[0].type
        kind = ir.FunctionType(vector, [vector] * len(vectors))
        full = f"llvm.{name}.v{vector.count}f64"
        function = builder.module.globals.get(full) or ir.Function(builder.module, kind, full)
        return builder.call(function, vectors)

    return emit


for _add in (operator.add, operator.iadd):
    _define(_add, LanesType, lambda builder, x, y: builder.fadd(x, y, flags=_CONTRACT))
_define(operator.sub, LanesType, lambda builder, x, y: builder.fsub(x, y, flags=_CONTRACT))
_define(operator.mul, LanesType, lambda builder, x, y: builder.fmul(x, y, flags=_CONTRACT))
_define(operator.truediv, LanesType, lambda builder, x, y: builder.fdiv(x, y))
_define(operator.neg, LanesType, lambda builder, x: builder.fneg(x), 1)
_define(operator.lt, MaskType, lambda builder, x, y: builder.fcmp_ordered("<", x, y))
_define(operator.le, MaskType, lambda builder, x, y: builder.fcmp_ordered("<=", x, y))
_define(operator.gt, MaskType, lambda builder, x, y: builder.fcmp_ordered(">", x, y))
_define(operator.ge, MaskType, lambda builder, x, y: builder.fcmp_ordered(">=", x, y))
_define(abs, LanesType, _call("fabs"), 1)
_define(math.sqrt, LanesType, _call("sqrt"), 1)


@intrinsic
def select(typingctx, condition, x, y):
    """x where the mask `condition` holds, else y."""
    if isinstance(condition, MaskType):

        def codegen(context, builder, sig, args):
            pairs = zip(sig.args[1:], args[1:], strict=True)
            x, y = (_spread(context, builder, kind, arg, condition.count) for kind, arg in pairs)
            return builder.select(args[0], x, y)

        return LanesType(condition.count)(condition, x, y), codegen


def _define_logic(function, emit, count):
    class Typing(AbstractTemplate):
        def generic(self, args, kws):
            if len(args) == count and len(set(args)) == 1 and isinstance(args[0], MaskType):
                return signature(args[0], *args)

    infer_global(function)(Typing)
    lower_builtin(function, *(MaskType,) * count)(lambda context, builder, sig, args: emit(builder, *args))


_define_logic(operator.and_, lambda builder, x, y: builder.and_(x, y), 2)
_define_logic(operator.or_, lambda builder, x, y: builder.or_(x, y), 2)
_define_logic(operator.invert, lambda builder, x: builder.not_(x), 1)


@intrinsic
def alike(typingctx, x):
    """Eight equal numbers."""
    if isinstance(x, types.Number):
        return lanes(x), lambda context, builder, sig, args: _spread(context, builder, sig.args[0], args[0], LANES)


@intrinsic
def bits(typingctx, condition):
    """A mask as an integer: bit i is lane i."""
    if isinstance(condition, MaskType):

        def codegen(context, builder, sig, args):
            return builder.zext(builder.bitcast(args[0], ir.IntType(LANES)), ir.IntType(64))

        return types.int64(condition), codegen


@intrinsic
def number(typingctx, x, i):
    """Number i of lanes."""
    if isinstance(x, LanesType) and isinstance(i, types.Integer):

        def codegen(context, builder, sig, args):
            return builder.extract_element(args[0], context.cast(builder, args[1], sig.args[1], types.int32))

        return types.float64(x, i), codegen


@intrinsic
def count_leading(typingctx, condition):
    """How many lanes from the first on a mask holds in."""
    if isinstance(condition, MaskType):

        def codegen(context, builder, sig, args):
            number = builder.zext(builder.bitcast(args[0], ir.IntType(LANES)), ir.IntType(64))
            return builder.cttz(builder.not_(number), ir.Constant(ir.IntType(1), 1))

        return types.int64(condition), codegen


@intrinsic
def lanes_of(typingctx, number):
    """The mask with the bits of an integer."""
    if isinstance(number, types.Integer):

        def codegen(context, builder, sig, args):
            number = context.cast(builder, args[0], sig.args[0], types.int64)
            return builder.bitcast(builder.trunc(number, ir.IntType(LANES)), ir.VectorType(ir.IntType(1), LANES))

        return mask(number), codegen


def _width(array):
    """Numbers in a row."""
    return array.shape[-1] if isinstance(array, types.NestedArray) else LANES


def _address(context, builder, kinds, args, scale, count):
    """Of `count` numbers, from number `scale` args[1] of the array args[0] on."""
    data = context.data_model_manager[kinds[0]].get(builder, args[0], "data")
    place = context.cast(builder, args[1], kinds[1], types.intp)
    place = builder.mul(place, ir.Constant(place.type, scale)) if scale > 1 else place
    first = builder.gep(builder.bitcast(data, _DOUBLE.as_pointer()), [place])
    return builder.bitcast(first, ir.VectorType(_DOUBLE, count).as_pointer())


@intrinsic
def row(typingctx, array, n):
    """The n-th row of a contiguous array: as many numbers as rows of the field of a record have, else eight."""
    if isinstance(array, types.Array) and isinstance(n, types.Integer):
        width = _width(array)

        def codegen(context, builder, sig, args):
            return builder.load(_address(context, builder, sig.args, args, width, width), align=8)

        return LanesType(width)(array, n), codegen


@intrinsic
def eight(typingctx, array, place):
    """Eight numbers of a contiguous array, from `place` on."""
    if isinstance(array, types.Array) and isinstance(place, types.Integer):

        def codegen(context, builder, sig, args):
            return builder.load(_address(context, builder, sig.args, args, 1, LANES), align=8)

        return lanes(array, place), codegen


@intrinsic
def put(typingctx, array, n, value):
    """The n-th row of a contiguous array becomes `value`."""
    if isinstance(array, types.Array) and isinstance(value, (LanesType, types.Number)):
        width = _width(array)

        def codegen(context, builder, sig, args):
            value = _spread(context, builder, sig.args[2], args[2], width)
            builder.store(value, _address(context, builder, sig.args, args, width, width), align=8)
            return context.get_dummy_value()

        return types.void(array, n, value), codegen


@intrinsic
def put_state(typingctx, array, n, x, like):
    """The n-th 2 N numbers of a contiguous array become the first of x; like: a field with N rows."""
    if isinstance(array, types.Array) and isinstance(x, LanesType) and isinstance(like, types.NestedArray):
        states = 2 * like.shape[0]

        def codegen(context, builder, sig, args):
            first = ir.Constant(ir.VectorType(_INDEX, states), list(range(states)))
            value = builder.shuffle_vector(args[2], args[2], first)
            builder.store(value, _address(context, builder, sig.args, args, states, states), align=8)
            return context.get_dummy_value()

        return types.void(array, n, x, like), codegen


@intrinsic
def state_and_rest(typingctx, x, rest, like):
    """The first 2 N numbers of x, then those of `rest`; like: a field with N rows."""
    if isinstance(x, LanesType) and x == rest and isinstance(like, types.NestedArray):
        states, width = 2 * like.shape[0], x.count

        def codegen(context, builder, sig, args):
            chosen = [i if i < states else width + i for i in range(width)]
            return builder.shuffle_vector(args[0], args[1], ir.Constant(ir.VectorType(_INDEX, width), chosen))

        return x(x, rest, like), codegen


def _transpose(builder, rows):
    """Eight vectors as the columns of eight others: neighbours, then pairs, then fours change places."""
    kind = ir.VectorType(_INDEX, LANES)
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
    """How many eights a row has."""
    return _width(array) // LANES


def _rows(builder, first, blocks, block):
    """The places of eight numbers in each of eight rows: block number `block` of so many."""
    return [builder.gep(first, [ir.Constant(_INDEX, i * blocks + block)]) for i in range(LANES)]


def _first(context, builder, kind, array):
    return _address(context, builder, (kind, types.intp), (array, ir.Constant(ir.IntType(64), 0)), 1, LANES)


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
def put_transposed(typingctx, array, columns):
    """The rows of `columns`, a field (m, LANES), become the first m columns of a field (LANES, width), others zero."""
    if isinstance(array, types.Array) and isinstance(columns, types.NestedArray):
        blocks, count = _blocks(array), columns.shape[0]

        def codegen(context, builder, sig, args):
            to, of = (_first(context, builder, kind, arg) for kind, arg in zip(sig.args, args, strict=True))
            for block in range(blocks):
                places = _rows(builder, of, 1, LANES * block)
                rows = [builder.load(place, align=8) for place in places[: max(0, count - LANES * block)]]
                rows += [ir.Constant(ir.VectorType(_DOUBLE, LANES), [0.0] * LANES)] * (LANES - len(rows))
                for place, row in zip(_rows(builder, to, blocks, block), _transpose(builder, rows), strict=True):
                    builder.store(row, place, align=8)
            return context.get_dummy_value()

        return types.void(array, columns), codegen


@intrinsic
def sizes(typingctx, vectors):
    """The absolute values of a tuple of vectors."""
    if isinstance(vectors, types.UniTuple):

        def codegen(context, builder, sig, args):
            found = [_call("fabs")(builder, builder.extract_value(args[0], i)) for i in range(len(vectors))]
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
                weight = builder.load(_address(context, builder, kinds, (args[0], place), LANES, LANES), align=8)
                term = builder.fmul(weight, builder.extract_value(args[3], i), flags=_CONTRACT)
                place = builder.add(place, step)
                pair = term if i % 2 == 0 else builder.fadd(pair, term, flags=_CONTRACT)
                if i % 2 == 0 and i + 1 < count:
                    continue
                total = pair if total is None else builder.fadd(total, pair, flags=_CONTRACT)
            return total

        return lanes(rows, n, step, vectors), codegen
