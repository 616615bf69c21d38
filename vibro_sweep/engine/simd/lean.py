"""Steps of numba's compiler that kernels have no use for, left out while kernels compile: a fifth of the time.

numba looks after each pass for how long every variable lives, which is needed once, at the end; measures how long each
call of LLVM takes, once for each kernel that is being compiled; finds the type of an operation anew wherever it stands,
and whether the function that writes it takes a line number; searches for `with` and for dictionaries; asks LLVM for the
size of a type as often as a variable has it; and prepares, for each operation, to catch warnings about it and to tell
where an error has come from. (Errors still name their line; warnings go where all others go.)
"""

import contextlib
import functools
from collections.abc import Iterator

from numba.core import base, errors, event, interpreter, lowering, typeinfer, types
from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.transforms import canonicalize_cfg

_settle, _call_type = PostProcessor.run, types.Function.get_call_type


def _settle_at_the_end(self, emit_dels=False, extend_lifetimes=False):
    """`PostProcessor.run` in full only before machine code is made: then it says where variables end."""
    if emit_dels:
        _settle(self, emit_dels, extend_lifetimes)
        return
    ir = self.func_ir
    ir.blocks = canonicalize_cfg(ir.blocks)
    ir.variable_lifetime, ir.generator_info = VariableLifetime(ir.blocks), None


def _call_type_once(self, context, args, kws):
    """The signature with which numba's own function is called, remembered."""
    key = self, tuple(args), tuple(kws.items())
    if key not in _call_types:
        _call_types[key] = _call_type(self, context, args, kws)
    return _call_types[key]


_call_types: dict[tuple, object] = {}
_nothing = contextlib.nullcontext()


def _in_no_context(*args, **about):
    """In place of numba's context managers that are entered for every operation."""
    return _nothing


INSTEAD = (
    (PostProcessor, "run", _settle_at_the_end),
    (types.Function, "get_call_type", _call_type_once),
    (event, "install_timer", _in_no_context),
    (typeinfer, "new_error_context", _in_no_context),
    (lowering, "new_error_context", _in_no_context),
    (errors.WarningsFixer, "catch_warnings", _in_no_context),
    (base, "_has_loc", functools.cache(base._has_loc)),
    (interpreter, "peep_hole_delete_with_exit", lambda func_ir: func_ir),
    (interpreter, "peep_hole_fuse_dict_add_updates", lambda func_ir: func_ir),
)


@contextlib.contextmanager
def lean() -> Iterator[None]:
    """While numba's lock for compiling is held: nobody else compiles meanwhile, but kernels that this one calls."""
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
