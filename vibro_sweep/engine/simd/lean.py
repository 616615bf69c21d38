"""Steps of numba's compiler that kernels have no use for, left out while kernels compile: a tenth of the time.

numba looks after each pass for how long every variable lives, which is needed once, at the end; measures how long each
call of LLVM takes, once for each kernel that is being compiled; and asks LLVM for the size of a type as often as a
variable has it.
"""

import contextlib
from collections.abc import Iterator

from numba.core import event
from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.transforms import canonicalize_cfg

_settle = PostProcessor.run


def _settle_at_the_end(self, emit_dels=False, extend_lifetimes=False):
    """`PostProcessor.run` in full only before machine code is made: then it says where variables end."""
    if emit_dels:
        _settle(self, emit_dels, extend_lifetimes)
        return
    ir = self.func_ir
    ir.blocks = canonicalize_cfg(ir.blocks)
    ir.variable_lifetime, ir.generator_info = VariableLifetime(ir.blocks), None


@contextlib.contextmanager
def lean() -> Iterator[None]:
    """While numba's lock for compiling is held: nobody else compiles meanwhile."""
    timer = event.install_timer
    PostProcessor.run, event.install_timer = _settle_at_the_end, lambda kind, callback: contextlib.nullcontext()
    try:
        yield
    finally:
        PostProcessor.run, event.install_timer = _settle, timer


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
