"""A kernel as LLVM's text, which can be compiled for another machine.

In a process of its own: what was made of a part of a kernel is kept, and here it is made in another way.
"""

from numba import typeof

from vibro_sweep.engine.simd import jit


def text_of(kernel: jit.exported, arguments: tuple) -> str:
    """The text of a kernel for arguments of these types. Nothing else may have been compiled in this process."""
    from vibro_sweep.engine.simd import compiler

    compiler.leave_functions_as_they_are()
    try:
        jit.kernel_of(kernel.__wrapped__, compiler.TextCompiler).compile(tuple(map(typeof, arguments)))
    except compiler.CapturedTextError as captured:
        return captured.text
    raise RuntimeError("the kernel was compiled, and not captured")
