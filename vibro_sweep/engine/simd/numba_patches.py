"""Patches that leave out steps of numba's compiler that kernels do not need: a third of the time.

numba looks after each pass for how long every variable lives, for references that kernels do not count; puts what it
computes into memory and takes it out again (values.py); measures how long each call of LLVM takes, once for each kernel
that is being compiled; finds the type of an operation anew wherever it stands, how its arguments are passed, and
whether the function that writes it takes a line number; goes through a whole kernel for each variable that is assigned
twice; writes out each statement and the types of the kernel, for its listeners; imports all that could be called,
once for each kernel; searches for `with` and for dictionaries; asks LLVM for the size of a type as often as a variable
has it; and prepares, for each operation, to catch warnings about it and to tell where an error has come from. (Errors
still name their line; warnings go where all others go.)
"""

import contextlib
import functools
from collections.abc import Iterator

from llvmlite import ir
from numba.core import (
    base,
    byteflow,
    cgutils,
    cpu,
    errors,
    event,
    interpreter,
    lowering,
    ssa,
    targetconfig,
    typeinfer,
    types,
)
from numba.core import ir as numba_ir
from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.transforms import canonicalize_cfg
from numba.np import arrayobj

from vibro_sweep.engine.simd import values

_lifetimes, _call_type = PostProcessor.run, types.Function.get_call_type
_pack, _rewrite = base.BaseContext.get_arg_packer, ssa._run_block_rewrite


def _lifetimes_if_counted(self, emit_dels=False, extend_lifetimes=False):
    """`PostProcessor.run` in full only where references are counted: for that it says where variables end."""
    if emit_dels and targetconfig.ConfigStack.top_or_none().nrt:
        _lifetimes(self, emit_dels, extend_lifetimes)
        return
    ir = self.func_ir
    ir.blocks = canonicalize_cfg(ir.blocks)
    ir.variable_lifetime, ir.generator_info = VariableLifetime(ir.blocks), None


def _call_type_once(self, context, args, kws):
    """The signature with which numba's own function is called, remembered."""
    key = self._code, tuple(kind._code for kind in args), tuple(kws.items())
    if key not in _call_types:
        _call_types[key] = _call_type(self, context, args, kws)
    return _call_types[key]


def _pack_once(self, kinds):
    """The packer of arguments of these types, remembered."""
    key = tuple(kind._code for kind in kinds)
    if key not in _packers:
        _packers[key] = _pack(self, kinds)
    return _packers[key]


_call_types: dict[tuple, object] = {}
_packers: dict[tuple, object] = {}


def _rewrite_where_named(blocks, states, handler):
    """`ssa._run_block_rewrite` of those blocks alone that name the variable which it is about."""
    named = {label: block for label, block in blocks.items() if states["varname"] in _names(block)}
    return blocks | _rewrite(named, states, handler)


def _names(block):
    """The names of all variables in a block, kept with its body."""
    body, names = getattr(block, "names_in", (None, None))
    if body is not block.body:
        names = {variable.name for step in block.body for variable in step.list_vars()}
        block.names_in = block.body, names
    return names


def _null_context(*args, **about):
    """Replaces numba's context managers that are entered for every operation."""
    return _nothing


_nothing = contextlib.nullcontext()


def _look_through_registries(context):
    """`CPUContext.load_additional_registries` for what has come meanwhile: all modules of numba are loaded already."""
    for registry in list(context._registries):
        context.install_registry(registry)


class _Silent:
    """Replaces numba's loggers, which log each bytecode and statement."""

    @staticmethod
    def debug(*args):
        pass


INSTEAD = (
    (PostProcessor, "run", _lifetimes_if_counted),
    (types.Function, "get_call_type", _call_type_once),
    (base.BaseContext, "get_arg_packer", _pack_once),
    (ssa, "_run_block_rewrite", _rewrite_where_named),
    (event, "install_timer", _null_context),
    (typeinfer, "new_error_context", _null_context),
    (lowering, "new_error_context", _null_context),
    (errors.WarningsFixer, "catch_warnings", _null_context),
    (base, "_has_loc", functools.cache(base._has_loc)),
    (interpreter, "peep_hole_delete_with_exit", lambda func_ir: func_ir),
    (interpreter, "peep_hole_fuse_dict_add_updates", lambda func_ir: func_ir),
    (types.Record, "__repr__", types.Type.__repr__),
    (numba_ir.Assign, "__str__", object.__repr__),
    (cpu.CPUContext, "load_additional_registries", _look_through_registries),
    (byteflow, "_logger", _Silent),
    (ssa, "_logger", _Silent),
    (cgutils, "create_struct_proxy", values.create_struct_proxy),
    (arrayobj, "make_array", values.make_array),
    (lowering.Lower, "_find_singly_assigned_variable", values.find_values),
    (lowering.Lower, "storevar", values.store_variable),
    (ir.IRBuilder, "extract_value", values.extract_value),
    (ir.IRBuilder, "insert_value", values.insert_value),
    (ir.IRBuilder, "mul", values.mul),
)


@contextlib.contextmanager
def patched() -> Iterator[None]:
    """Apply the patches while numba's lock for compiling is held: only what this kernel calls compiles meanwhile."""
    before = [(where, name, getattr(where, name)) for where, name, _ in INSTEAD]
    for where, name, instead in INSTEAD:
        setattr(where, name, instead)
    try:
        yield
    finally:
        for where, name, own in before:
            setattr(where, name, own)


def remember_sizes(context) -> None:
    """Let a target context ask LLVM for the size of each type once."""
    ask = context.get_abi_sizeof

    def size(kind):
        name = str(kind)
        if name not in _sizes:
            _sizes[name] = ask(kind)
        return _sizes[name]

    context.get_abi_sizeof = size


_sizes: dict[str, int] = {}
