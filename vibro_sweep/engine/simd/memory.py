"""Lanes in memory: rows of the fields of records, and of arrays.

How many numbers a row has is read from the shape of the field of a record; arrays without one have rows of eight.
"""

import math

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.core.extending import intrinsic

from vibro_sweep.engine.simd.lanes import DOUBLE, INDEX, LANES, LanesType, lanes, spread

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


def width_of_row(array):
    """Numbers in a row."""
    return array.shape[-1] if isinstance(array, types.NestedArray) else LANES


def address(context, builder, kinds, args, scale, count):
    """Of `count` numbers, from number `scale` args[1] of the array args[0] on."""
    data = context.data_model_manager[kinds[0]].get(builder, args[0], "data")
    place = context.cast(builder, args[1], kinds[1], types.intp)
    place = builder.mul(place, ir.Constant(place.type, scale)) if scale > 1 else place
    first = builder.gep(builder.bitcast(data, DOUBLE.as_pointer()), [place])
    return builder.bitcast(first, ir.VectorType(DOUBLE, count).as_pointer())


@intrinsic
def row(typingctx, array, n):
    """The n-th row of a contiguous array: as many numbers as rows of the field of a record have, else eight."""
    if isinstance(array, types.Array) and isinstance(n, types.Integer):
        width = width_of_row(array)

        def codegen(context, builder, sig, args):
            return builder.load(address(context, builder, sig.args, args, width, width), align=8)

        return LanesType(width)(array, n), codegen


@intrinsic
def eight(typingctx, array, place):
    """Eight numbers of a contiguous array, from `place` on."""
    if isinstance(array, types.Array) and isinstance(place, types.Integer):

        def codegen(context, builder, sig, args):
            return builder.load(address(context, builder, sig.args, args, 1, LANES), align=8)

        return lanes(array, place), codegen


@intrinsic
def put(typingctx, array, n, value):
    """The n-th row of a contiguous array becomes `value`."""
    if isinstance(array, types.Array) and isinstance(value, (LanesType, types.Number)):
        width = width_of_row(array)

        def codegen(context, builder, sig, args):
            value = spread(context, builder, sig.args[2], args[2], width)
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
