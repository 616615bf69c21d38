"""Lanes in memory: rows of the fields of records, and of arrays.

How many numbers a row has is read from the shape of the field of a record; arrays without one have rows of eight.
"""

import math

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.core.extending import intrinsic

from vibro_sweep.engine.simd.lanes import DOUBLE, INDEX, LANES, LanesType, lanes, singles, spread

LINE = 64  # bytes of a cache line, which is as much as eight floats: what lies across two of them takes twice as long


def record(fields: list) -> np.dtype:
    """A structured dtype that fills whole cache lines; fields of eight numbers should come first."""
    missing = -np.dtype(fields).itemsize % LINE
    return np.dtype([*fields, ("padding", np.uint8, (missing,))])


def new_lines(shape: int | tuple[int, ...], dtype) -> np.ndarray:
    """Zeros that begin with a cache line."""
    dtype = np.dtype(dtype)
    space = np.zeros(math.prod(shape if isinstance(shape, tuple) else (shape,)) * dtype.itemsize + LINE, np.uint8)
    return np.ndarray(shape, dtype, space, offset=-space.ctypes.data % LINE)


def width_of_row(array):
    """Numbers in a row."""
    return array.shape[-1] if isinstance(array, types.NestedArray) else LANES


def address(context, builder, kinds, args, scale, count, element=DOUBLE):
    """The address of `count` numbers, from number `scale` args[1] of the array args[0] on."""
    data = context.data_model_manager[kinds[0]].get(builder, args[0], "data")
    place = context.cast(builder, args[1], kinds[1], types.intp)
    place = builder.mul(place, ir.Constant(place.type, scale)) if scale > 1 else place
    first = builder.gep(builder.bitcast(data, element.as_pointer()), [place])
    return builder.bitcast(first, ir.VectorType(element, count).as_pointer())


@intrinsic
def row(typingctx, array, n):
    """The n-th row of a contiguous array: as many numbers as rows of the field of a record have, else eight."""
    if isinstance(array, types.Array) and isinstance(n, types.Integer):
        width = width_of_row(array)

        def codegen(context, builder, sig, args):
            return builder.load(address(context, builder, sig.args, args, width, width), align=8)

        return LanesType(width)(array, n), codegen


@intrinsic
def head(typingctx, array, n, like):
    """The beginning of the n-th row: the least power of two that holds 2 N numbers; like: a field with N rows."""
    if isinstance(array, types.Array) and isinstance(n, types.Integer) and isinstance(like, types.NestedArray):
        width, states = width_of_row(array), 2 * like.shape[0]
        count = 1 << (states - 1).bit_length()

        def codegen(context, builder, sig, args):
            return builder.load(address(context, builder, sig.args, args, width, count), align=8)

        return LanesType(count)(array, n, like), codegen


@intrinsic
def widened(typingctx, x, array):
    """x and zeros, as many numbers as a row of the array has."""
    if isinstance(x, LanesType) and isinstance(array, types.Array):
        like = LanesType(width_of_row(array))
        chosen = ir.Constant(ir.VectorType(INDEX, like.count), [min(i, x.count) for i in range(like.count)])

        def codegen(context, builder, sig, args):
            return builder.shuffle_vector(args[0], ir.Constant(x.vector, [0.0] * x.count), chosen)

        return like(x, array), codegen


@intrinsic
def eight(typingctx, array, place):
    """Eight numbers of a contiguous array, from `place` on."""
    if isinstance(array, types.Array) and isinstance(place, types.Integer):

        def codegen(context, builder, sig, args):
            return builder.load(address(context, builder, sig.args, args, 1, LANES), align=8)

        return lanes(array, place), codegen


@intrinsic
def put_eight(typingctx, array, place, value):
    """Eight numbers of a contiguous array, from `place` on, become `value`."""
    if isinstance(array, types.Array) and isinstance(place, types.Integer) and isinstance(value, LanesType):

        def codegen(context, builder, sig, args):
            builder.store(args[2], address(context, builder, sig.args, args, 1, LANES), align=8)
            return context.get_dummy_value()

        return types.void(array, place, value), codegen


@intrinsic
def sixteen(typingctx, array, place):
    """Sixteen numbers of a contiguous array in single precision, from `place` on; rows follow one another."""
    if isinstance(array, types.Array) and array.dtype == singles.element and isinstance(place, types.Integer):
        count, element = singles.count, singles.vector.element

        def codegen(context, builder, sig, args):
            return builder.load(address(context, builder, sig.args, args, 1, count, element), align=4)

        return singles(array, place), codegen


@intrinsic
def put(typingctx, array, n, value):
    """The n-th row of a contiguous array becomes `value`."""
    if isinstance(array, types.Array) and isinstance(value, (LanesType, types.Number)):
        width = width_of_row(array)

        def codegen(context, builder, sig, args):
            value = spread(context, builder, sig.args[2], args[2], LanesType(width))
            builder.store(value, address(context, builder, sig.args, args, width, width), align=8)
            return context.get_dummy_value()

        return types.void(array, n, value), codegen


@intrinsic
def put_state(typingctx, array, n, x, like):
    """The n-th 2 N numbers of a contiguous array become the first of x; like: a field with N rows."""
    if isinstance(array, types.Array) and isinstance(x, LanesType) and isinstance(like, types.NestedArray):
        states = 2 * like.shape[0]

        def codegen(context, builder, sig, args):
            first = ir.Constant(ir.VectorType(INDEX, states), list(range(states)))
            value = builder.shuffle_vector(args[2], args[2], first)
            builder.store(value, address(context, builder, sig.args, args, states, states), align=8)
            return context.get_dummy_value()

        return types.void(array, n, x, like), codegen
