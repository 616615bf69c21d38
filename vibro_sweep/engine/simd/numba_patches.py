"""Patches that leave out steps of numba's compiler that kernels do not need: a third of the time.

numba looks after each pass for how long every variable lives, for references that kernels do not count; puts what it
computes into memory and takes it out again (values.py); measures how long each call of LLVM takes, once for each kernel
that is being compiled, and tells its listeners of each call and each pass; asks five questions of every part of a
statement in which it looks for variables; finds the type of an operation and of an attribute anew wherever it stands,
how its arguments are passed, and whether the function that writes it takes a line number; imports what makes a constant
for each constant, and writes names in several steps; goes through a whole kernel for each variable that is assigned
twice; writes out each statement and, at each pass, the types of the kernel; imports all that could be called, once for
each kernel; searches for `with` and for dictionaries; asks LLVM for the size of a type as often as a variable has it;
and prepares, for each operation, to catch warnings about it and to tell where an error has come from. (Errors still
name their line; warnings go where all others go.)
"""

import contextlib
import functools
from collections.abc import Iterator

from llvmlite import ir
from llvmlite.ir._utils import DuplicatedNameError, NameScope
from numba.core import (
    base,
    byteflow,
    cgutils,
    compiler_machinery,
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
from numba.core.typing.context import BaseContext
from numba.np import arrayobj

from vibro_sweep.engine.simd import values

_lifetimes, _call_type = PostProcessor.run, types.Function.get_call_type
_attribute = BaseContext.find_matching_getattr_template
_escaped = ir.NamedValue._get_reference
_pack, _rewrite = base.BaseContext.get_arg_packer, ssa._run_block_rewrite


def _lifetimes_if_counted(self, emit_dels=False, extend_lifetimes=False):
    """`PostProcessor.run` in full only where references are counted: for that it says where variables end."""
    if emit_dels and targetconfig.ConfigStack.top_or_none().nrt:
        _lifetimes(self, emit_dels, extend_lifetimes)
        return
    ir = self.func_ir
    ir.blocks = canonicalize_cfg(ir.blocks)
    ir.variable_lifetime, ir.generator_info = VariableLifetime(ir.blocks), None


def _run_pass(self, number, step, state):
    """`PassManager._runPass` without what it measures, tells listeners, and checks of numba's own passes."""
    step.analysis = self._analysis
    for do in step.run_initialization, step.run_pass, step.run_finalizer:
        do(state)


def _call_type_once(self, context, args, kws):
    """The signature with which numba's own function is called, remembered."""
    key = self._code, tuple(kind._code for kind in args), tuple(kws.items())
    if key not in _call_types:
        _call_types[key] = _call_type(self, context, args, kws)
    return _call_types[key]


def _attribute_once(self, kind, name):
    """What an attribute of a type is, remembered: of each function that is called numba asks for `__call__`."""
    key = kind._code, name
    if key not in _attributes:
        _attributes[key] = _attribute(self, kind, name)
    return _attributes[key]


def _pack_once(self, kinds):
    """The packer of arguments of these types, remembered."""
    key = tuple(kind._code for kind in kinds)
    if key not in _packers:
        _packers[key] = _pack(self, kinds)
    return _packers[key]


_call_types: dict[tuple, object] = {}
_attributes: dict[tuple, object] = {}
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


def _variables_in(self, parts):
    """`Inst._rec_list_vars` of a statement: most of its parts are names, places and None, and are passed over first."""
    found = []
    for part in parts.values() if type(parts) is dict else parts:
        kind = type(part)
        if kind is numba_ir.Var:
            found.append(part)
        elif kind is list or kind is tuple or kind is dict:
            found += self._rec_list_vars(part)
        elif kind not in NO_VARIABLES and isinstance(part, numba_ir.Inst):
            found += part.list_vars()
    return found


NO_VARIABLES = frozenset({str, int, bool, type(None), numba_ir.Loc})


def _constant(self, value):
    """`ir.Type.__call__`, which imports what it calls each time."""
    return ir.Constant(self, value)


def _register(self, name, deduplicate=False):
    """`NameScope.register` of a name, or of the next one that begins with it and is free."""
    begin, used, numbers = name, self._useset, self._basenamemap
    if name in used and not deduplicate:
        raise DuplicatedNameError(name)
    while name in used:
        numbers[begin] += 1
        name = f"{begin}.{numbers[begin]}"
    used.add(name)
    return name


def _reference(self):
    """`NamedValue._get_reference` of a name without quotes in it."""
    name = self._name
    return _escaped(self) if '"' in name or "\\" in name else f'{self.name_prefix}"{name}"'


def _null_context(*args, **about):
    """Replaces numba's context managers that are entered for every operation."""
    return _nothing


_nothing = contextlib.nullcontext()


def _look_through_registries(context):
    """`CPUContext.load_additional_registries` for what has come meanwhile: all modules of numba are loaded already."""
    for registry in list(context._registries):
        context.install_registry(registry)


def _say_nothing(*what, **about):
    """Replaces what tells numba's listeners of events."""


class _Silent:
    """Replaces numba's loggers, which log each bytecode and statement."""

    debug = staticmethod(_say_nothing)


INSTEAD = (
    (PostProcessor, "run", _lifetimes_if_counted),
    (compiler_machinery.PassManager, "_runPass", _run_pass),
    (types.Function, "get_call_type", _call_type_once),
    (BaseContext, "find_matching_getattr_template", _attribute_once),
    (base.BaseContext, "get_arg_packer", _pack_once),
    (ssa, "_run_block_rewrite", _rewrite_where_named),
    (numba_ir.Inst, "_rec_list_vars", _variables_in),
    (event, "install_timer", _null_context),
    (event, "start_event", _say_nothing),
    (event, "end_event", _say_nothing),
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
    (ir.Type, "__call__", _constant),
    (NameScope, "register", _register),
    (ir.NamedValue, "_get_reference", _reference),
    (ir.IRBuilder, "extract_value", values.extract_value),
    (ir.IRBuilder, "insert_value", values.insert_value),
    (ir.IRBuilder, "mul", values.mul),
)


@contextlib.contextmanager
def patched() -> Iterator[None]:
    """Apply the patches while numba's lock for compiling is held: only what this kernel calls compiles meanwhile.

    They stay for the kernels that it calls: each change of a class makes Python look up all of its attributes anew.
    """
    where, name, instead = INSTEAD[0]
    if getattr(where, name) is instead:
        yield
        return
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
