"""Numbers side by side: one for each of eight orbits, or those of the state of one orbit. The processor's vectors.

Jitted code writes a formula for `Lanes` as it would for floats; each operation is one on an LLVM vector, and no
compiler has to find out by itself that a loop can be turned into vectors. A lane never sees its neighbours: its
digits are the same whatever they hold. Where orbits part ways, both ways are computed and `select` takes one.

How many numbers there are belongs to the type: `Lanes(8)` for eight orbits, `Lanes(width)` for a state. So does their
precision: `singles` are twice as many as `lanes` in a vector of the same size, for bounds that have room for it.
"""

import itertools
import math
import operator

from llvmlite import ir
from numba.core import types
from numba.core.extending import intrinsic, lower_builtin, models, register_model
from numba.core.typing.templates import AbstractTemplate, infer_global, signature

LANES = 8
SINGLES = 2 * LANES
INDEX = ir.IntType(32)
FLOATS = {types.float64: ir.DoubleType(), types.float32: ir.FloatType()}
DOUBLE = FLOATS[types.float64]
CONTRACT = ("contract",)  # as in jit.py


class LanesType(types.Type):
    def __init__(self, count, element=types.float64):
        super().__init__(f"Lanes({count}, {element})")
        self.count, self.element = count, element

    @property
    def vector(self):
        return ir.VectorType(FLOATS[self.element], self.count)


class MaskType(types.Type):
    def __init__(self, count):
        super().__init__(f"Mask({count})")
        self.count = count


lanes, mask = LanesType(LANES), MaskType(LANES)
singles = LanesType(SINGLES, types.float32)


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, fe_type.vector)


@register_model(MaskType)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, ir.VectorType(ir.IntType(1), fe_type.count))


def spread(context, builder, kind, value, like):
    """A float as equal ones, of the type `like`; lanes as they are."""
    if isinstance(kind, LanesType):
        return value
    value = context.cast(builder, value, kind, like.element)
    nothing = ir.Constant(like.vector, ir.Undefined)
    first = builder.insert_element(nothing, value, ir.Constant(INDEX, 0))
    return builder.shuffle_vector(first, nothing, ir.Constant(ir.VectorType(INDEX, like.count), [0] * like.count))


def _lanes_of(kinds):
    """The type of the lanes among these types: one type, or None."""
    found = {kind for kind in kinds if isinstance(kind, LanesType)}
    return found.pop() if len(found) == 1 else None


def _define(function, result, emit, count=2):
    """Teach numba `function` of so many Lanes, or Lanes and floats; emit(builder, *vectors) is its instruction.

    result: LanesType or MaskType.
    """

    class Typing(AbstractTemplate):
        def generic(self, args, kws):
            fits = len(args) == count and all(isinstance(kind, (LanesType, types.Number)) for kind in args)
            kind = _lanes_of(args)
            if fits and kind:
                return signature(kind if result is LanesType else result(kind.count), *args)

    def lower(context, builder, sig, args):
        like, pairs = _lanes_of(sig.args), zip(sig.args, args, strict=True)
        return emit(builder, *(spread(context, builder, kind, arg, like) for kind, arg in pairs))

    infer_global(function)(Typing)
    for kinds in itertools.product((LanesType, types.Number), repeat=count):
        if LanesType in kinds:
            lower_builtin(function, *kinds)(lower)


def call(name):
    """An LLVM function of floats, on vectors."""

    def emit(builder, *vectors):
        vector = vectors[0].type
        kind = ir.FunctionType(vector, [vector] * len(vectors))
        full = f"llvm.{name}.v{vector.count}f{64 if vector.element == DOUBLE else 32}"
        function = builder.module.globals.get(full) or ir.Function(builder.module, kind, full)
        return builder.call(function, vectors)

    return emit


for _add in (operator.add, operator.iadd):
    _define(_add, LanesType, lambda builder, x, y: builder.fadd(x, y, flags=CONTRACT))
_define(operator.sub, LanesType, lambda builder, x, y: builder.fsub(x, y, flags=CONTRACT))
_define(operator.mul, LanesType, lambda builder, x, y: builder.fmul(x, y, flags=CONTRACT))
_define(operator.truediv, LanesType, lambda builder, x, y: builder.fdiv(x, y))
_define(operator.neg, LanesType, lambda builder, x: builder.fneg(x), 1)
_define(operator.lt, MaskType, lambda builder, x, y: builder.fcmp_ordered("<", x, y))
_define(operator.le, MaskType, lambda builder, x, y: builder.fcmp_ordered("<=", x, y))
_define(operator.gt, MaskType, lambda builder, x, y: builder.fcmp_ordered(">", x, y))
_define(operator.ge, MaskType, lambda builder, x, y: builder.fcmp_ordered(">=", x, y))
_define(abs, LanesType, call("fabs"), 1)
_define(math.sqrt, LanesType, call("sqrt"), 1)
_define(math.floor, LanesType, call("floor"), 1)


@intrinsic
def select(typingctx, condition, x, y):
    """x where the mask `condition` holds, else y."""
    if isinstance(condition, MaskType):
        like = _lanes_of((x, y)) or LanesType(condition.count)

        def codegen(context, builder, sig, args):
            pairs = zip(sig.args[1:], args[1:], strict=True)
            x, y = (spread(context, builder, kind, arg, like) for kind, arg in pairs)
            return builder.select(args[0], x, y)

        return like(condition, x, y), codegen


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
        return lanes(x), lambda context, builder, sig, args: spread(context, builder, sig.args[0], args[0], lanes)


@intrinsic
def bits(typingctx, condition):
    """A mask as an integer: bit i is lane i."""
    if isinstance(condition, MaskType):

        def codegen(context, builder, sig, args):
            return builder.zext(builder.bitcast(args[0], ir.IntType(condition.count)), ir.IntType(64))

        return types.int64(condition), codegen


@intrinsic
def number(typingctx, x, i):
    """Number i of lanes."""
    if isinstance(x, LanesType) and isinstance(i, types.Integer):

        def codegen(context, builder, sig, args):
            return builder.extract_element(args[0], context.cast(builder, args[1], sig.args[1], types.int32))

        return x.element(x, i), codegen


@intrinsic
def added(typingctx, x):
    """The sum of eight numbers: of neighbours, then of pairs, then of fours."""
    if x == lanes:

        def codegen(context, builder, sig, args):
            total = args[0]
            for step in (1, 2, 4):
                partner = ir.Constant(ir.VectorType(INDEX, LANES), [i ^ step for i in range(LANES)])
                total = builder.fadd(total, builder.shuffle_vector(total, total, partner))
            return builder.extract_element(total, ir.Constant(INDEX, 0))

        return types.float64(x), codegen


@intrinsic
def lowest(typingctx, number):
    """The place of the lowest bit that is set in an integer other than 0."""
    if isinstance(number, types.Integer):

        def codegen(context, builder, sig, args):
            number = context.cast(builder, args[0], sig.args[0], types.int64)
            return builder.cttz(number, ir.Constant(ir.IntType(1), 1))

        return types.int64(number), codegen


@intrinsic
def lanes_of(typingctx, number):
    """The mask with the bits of an integer."""
    if isinstance(number, types.Integer):

        def codegen(context, builder, sig, args):
            number = context.cast(builder, args[0], sig.args[0], types.int64)
            return builder.bitcast(builder.trunc(number, ir.IntType(LANES)), ir.VectorType(ir.IntType(1), LANES))

        return mask(number), codegen


@intrinsic
def state_and_rest(typingctx, x, rest, like):
    """The first 2 N numbers of x, then those of `rest`; like: a field with N rows."""
    if isinstance(x, LanesType) and x == rest and isinstance(like, types.NestedArray):
        states, width = 2 * like.shape[0], x.count

        def codegen(context, builder, sig, args):
            chosen = [i if i < states else width + i for i in range(width)]
            return builder.shuffle_vector(args[0], args[1], ir.Constant(ir.VectorType(INDEX, width), chosen))

        return x(x, rest, like), codegen
