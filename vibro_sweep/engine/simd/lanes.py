"""Eight numbers side by side, one for each of eight orbits: what the processor does at once.

Jitted code writes a formula for `Lanes` as it would for floats; each operation is one on an LLVM vector, and no
compiler has to find out by itself that a loop can be turned into vectors. A lane never sees its neighbours: its
digits are the same whatever they hold. Where orbits part ways, both ways are computed and `select` takes one.
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
_VECTOR, _BITS = ir.VectorType(_DOUBLE, LANES), ir.VectorType(ir.IntType(1), LANES)
_CONTRACT = ("contract",)  # as in jit.py


class LanesType(types.Type):
    def __init__(self):
        super().__init__("Lanes")


class MaskType(types.Type):
    def __init__(self):
        super().__init__("Mask")


lanes, mask = LanesType(), MaskType()


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, _VECTOR)


@register_model(MaskType)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, _BITS)


def _spread(context, builder, kind, value):
    """A float as eight equal ones; lanes as they are."""
    if isinstance(kind, LanesType):
        return value
    value = context.cast(builder, value, kind, types.float64)
    nothing = ir.Constant(_VECTOR, ir.Undefined)
    first = builder.insert_element(nothing, value, ir.Constant(_INDEX, 0))
    return builder.shuffle_vector(first, nothing, ir.Constant(ir.VectorType(_INDEX, LANES), [0] * LANES))


def _define(function, result, emit, count=2):
    """Teach numba `function` of so many Lanes, or Lanes and floats; emit(builder, *vectors) is its instruction."""

    class Typing(AbstractTemplate):
        def generic(self, args, kws):
            fits = len(args) == count and all(isinstance(kind, (LanesType, types.Number)) for kind in args)
            if fits and any(isinstance(kind, LanesType) for kind in args):
                return signature(result, *args)

    def lower(context, builder, sig, args):
        return emit(builder, *(_spread(context, builder, kind, arg) for kind, arg in zip(sig.args, args, strict=True)))

    infer_global(function)(Typing)
    for kinds in itertools.product((LanesType, types.Number), repeat=count):
        if LanesType in kinds:
            lower_builtin(function, *kinds)(lower)


def _call(name):
    """An LLVM function of floats, on vectors."""

    def emit(builder, *vectors):
        kind = ir.FunctionType(_VECTOR, [_VECTOR] * len(vectors))
        full = f"llvm.{name}.v{LANES}f64"
        function = builder.module.globals.get(full) or ir.Function(builder.module, kind, full)
        return builder.call(function, vectors)

    return emit


for _add in (operator.add, operator.iadd):
    _define(_add, lanes, lambda builder, x, y: builder.fadd(x, y, flags=_CONTRACT))
_define(operator.sub, lanes, lambda builder, x, y: builder.fsub(x, y, flags=_CONTRACT))
_define(operator.mul, lanes, lambda builder, x, y: builder.fmul(x, y, flags=_CONTRACT))
_define(operator.truediv, lanes, lambda builder, x, y: builder.fdiv(x, y))
_define(operator.neg, lanes, lambda builder, x: builder.fneg(x), 1)
_define(operator.lt, mask, lambda builder, x, y: builder.fcmp_ordered("<", x, y))
_define(operator.le, mask, lambda builder, x, y: builder.fcmp_ordered("<=", x, y))
_define(operator.gt, mask, lambda builder, x, y: builder.fcmp_ordered(">", x, y))
_define(operator.ge, mask, lambda builder, x, y: builder.fcmp_ordered(">=", x, y))
_define(abs, lanes, _call("fabs"), 1)
_define(math.sqrt, lanes, _call("sqrt"), 1)


@intrinsic
def select(typingctx, condition, x, y):
    """x where the mask `condition` holds, else y."""
    if isinstance(condition, MaskType):

        def codegen(context, builder, sig, args):
            x, y = (_spread(context, builder, kind, arg) for kind, arg in zip(sig.args[1:], args[1:], strict=True))
            return builder.select(args[0], x, y)

        return lanes(condition, x, y), codegen


def _define_logic(function, emit, count):
    class Typing(AbstractTemplate):
        def generic(self, args, kws):
            if len(args) == count and all(isinstance(kind, MaskType) for kind in args):
                return signature(mask, *args)

    infer_global(function)(Typing)
    lower_builtin(function, *(MaskType,) * count)(lambda context, builder, sig, args: emit(builder, *args))


_define_logic(operator.and_, lambda builder, x, y: builder.and_(x, y), 2)
_define_logic(operator.or_, lambda builder, x, y: builder.or_(x, y), 2)
_define_logic(operator.invert, lambda builder, x: builder.not_(x), 1)


@intrinsic
def alike(typingctx, x):
    """Eight equal numbers."""
    if isinstance(x, types.Number):
        return lanes(x), lambda context, builder, sig, args: _spread(context, builder, sig.args[0], args[0])


@intrinsic
def bits(typingctx, condition):
    """A mask as an integer: bit i is lane i."""
    if isinstance(condition, MaskType):

        def codegen(context, builder, sig, args):
            return builder.zext(builder.bitcast(args[0], ir.IntType(LANES)), ir.IntType(64))

        return types.int64(condition), codegen


@intrinsic
def first_number(typingctx, x):
    """The first of eight numbers."""
    if isinstance(x, LanesType):

        def codegen(context, builder, sig, args):
            return builder.extract_element(args[0], ir.Constant(_INDEX, 0))

        return types.float64(x), codegen


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
            return builder.bitcast(builder.trunc(number, ir.IntType(LANES)), _BITS)

        return mask(number), codegen


def _address(context, builder, kinds, args, scale):
    array = context.make_array(kinds[0])(context, builder, args[0])
    place = context.cast(builder, args[1], kinds[1], types.intp)
    place = builder.mul(place, ir.Constant(place.type, scale)) if scale > 1 else place
    return builder.bitcast(
        builder.gep(builder.bitcast(array.data, _DOUBLE.as_pointer()), [place]), _VECTOR.as_pointer()
    )


def _loader(scale):
    def typing(typingctx, array, place):
        if isinstance(array, types.Array) and isinstance(place, types.Integer):

            def codegen(context, builder, sig, args):
                return builder.load(_address(context, builder, sig.args, args, scale), align=8)

            return lanes(array, place), codegen

    return typing


row = intrinsic(
    _loader(LANES)
)  # row(array, n): the n-th eight numbers of a contiguous array, its row if it is (m, LANES)
eight = intrinsic(_loader(1))  # eight(array, n): eight numbers from place n on


@intrinsic
def put(typingctx, array, n, value):
    """The n-th eight numbers of a contiguous array become `value`."""
    if isinstance(array, types.Array) and isinstance(value, (LanesType, types.Number)):

        def codegen(context, builder, sig, args):
            value = _spread(context, builder, sig.args[2], args[2])
            builder.store(value, _address(context, builder, sig.args, args, LANES), align=8)
            return context.get_dummy_value()

        return types.void(array, n, value), codegen


@intrinsic
def put_four(typingctx, array, n, x):
    """The n-th four numbers of a contiguous array become the first four of x."""
    if isinstance(array, types.Array) and isinstance(x, LanesType):

        def codegen(context, builder, sig, args):
            first = ir.Constant(ir.VectorType(_INDEX, 4), [0, 1, 2, 3])
            value = builder.shuffle_vector(args[2], args[2], first)
            place = _address(context, builder, sig.args, args, 4)
            builder.store(value, builder.bitcast(place, value.type.as_pointer()), align=8)
            return context.get_dummy_value()

        return types.void(array, n, x), codegen


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


@intrinsic
def transposed(typingctx, array):
    """The columns of the first eight rows of a contiguous array (m, LANES)."""
    if isinstance(array, types.Array):

        def codegen(context, builder, sig, args):
            first = _address(context, builder, (sig.args[0], types.intp), (args[0], ir.Constant(ir.IntType(64), 0)), 1)
            rows = [builder.load(builder.gep(first, [ir.Constant(_INDEX, i)]), align=8) for i in range(LANES)]
            return context.make_tuple(builder, sig.return_type, _transpose(builder, rows))

        return types.UniTuple(lanes, LANES)(array), codegen


@intrinsic
def put_transposed(typingctx, array, columns):
    """Eight vectors become the columns of the first eight rows of a contiguous array (m, LANES)."""
    if isinstance(array, types.Array) and columns == types.UniTuple(lanes, LANES):

        def codegen(context, builder, sig, args):
            first = _address(context, builder, (sig.args[0], types.intp), (args[0], ir.Constant(ir.IntType(64), 0)), 1)
            columns = [builder.extract_value(args[1], i) for i in range(LANES)]
            for i, row in enumerate(_transpose(builder, columns)):
                builder.store(row, builder.gep(first, [ir.Constant(_INDEX, i)]), align=8)
            return context.get_dummy_value()

        return types.void(array, columns), codegen
