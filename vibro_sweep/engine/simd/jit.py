"""All jit policy in one file: nogil, fused multiply-adds as the only fastmath, no reference counts, kept on disk."""

import contextlib
import functools
import hashlib

import numba
from numba.core import config, types
from numba.core.cpu import CPUTargetOptions

from vibro_sweep.checks.errors import MachineError
from vibro_sweep.engine.simd import kernel_cache
from vibro_sweep.engine.simd.kernel_cache import cache_of

if config.DISABLE_JIT:
    raise MachineError("NUMBA_DISABLE_JIT is set, and kernels need numba's compiler: unset it")

TESTED = ("0.62", "0.63", "0.64", "0.65", "0.66", "0.67", "0.68")  # versions of numba with which compiler.py was tried
IS_TESTED = ".".join(map(str, numba.version_info.short)) in TESTED
NoInlineCompiler = PartCompiler = QuickCompiler = SmallCompiler = WholeCompiler = None
if IS_TESTED:
    with contextlib.suppress(Exception):  # internals that are missing: kernels compile plainly
        from vibro_sweep.engine.simd.compiler import (
            NoInlineCompiler,
            PartCompiler,
            QuickCompiler,
            SmallCompiler,
            WholeCompiler,
        )


@property
def _mangling(kind: types.Type) -> tuple[str, tuple[int]]:
    """The mangled form of a record, or of a tuple with names, in the names of kernels in machine code.

    For records numba takes a number that they get as they come up in a process. So two processes can give kernels of
    different records one name, and where a third one loads both from the cache, one of them is called in place of the
    other (numba issue 7654). For tuples with names it takes all that they hold, field by field: 20 kB, wherever a
    kernel is named.
    """
    return type(kind).__name__, (_digest(kind.name),)


@functools.cache
def _digest(name: str) -> int:
    return int.from_bytes(hashlib.blake2b(name.encode(), digest_size=8).digest())


for _kind in (types.Record, types.NamedTuple, types.NamedUniTuple):
    _kind.mangling_args = _mangling


class _Part:
    """A kernel that other kernels call.

    numba's object for it is made when one of these is compiled: for all two hundred that takes 40 ms, which a start
    does without where compiled kernels are found.
    """

    def __init__(self, function, compiler, **options):
        functools.update_wrapper(self, function)
        self._make = functools.partial(kernel_of, function, compiler, no_cpython_wrapper=True, **options)

    def __call__(self, *args):
        """Call the function as Python runs it; nothing is compiled."""
        return self.__wrapped__(*args)

    @functools.cached_property
    def _kernel(self):
        return self._make()

    @property
    def _numba_type_(self):  # what other kernels see of it
        return self._kernel._numba_type_


def jit(function):
    """`numba.njit` for a kernel that other kernels call."""
    return _Part(function, PartCompiler)


def inline(function):
    """`jit` for a hot path, always inlined: a call would pass vectors, and the tables' many words, by memory."""
    return _Part(function, PartCompiler, forceinline=True)


def noinline(function):
    """`jit` for a rare path, never inlined: inlined, it would take registers and room from the hot path."""
    return _Part(function, NoInlineCompiler)


def small(function):
    """`jit` for what a step does seldom, or what is short beside it: compiled for size, which takes LLVM less time."""
    return _Part(function, SmallCompiler)


def exactly(function):
    """`jit` for sums and products whose rounding errors are computed: none may be fused."""
    return _Part(function, PartCompiler, fastmath=False)


class exported:  # noqa: N801  # a decorator
    """`numba.njit` for a kernel that Python calls, too: one for Python, cached, and a `jit` for other kernels."""

    def __init__(self, function):
        functools.update_wrapper(self, function)
        self._part, self._whole = jit(function), kernel_of(function, self._compiler())
        self._whole._cache = cache_of(function)

    @staticmethod
    def _compiler():
        return WholeCompiler

    def __call__(self, *args):
        return self._whole(*args)

    @property
    def compiled(self) -> int:
        """The number of its kernels that this process has compiled because they were not in the cache."""
        return sum(self._whole.stats.cache_misses.values())

    @property
    def _numba_type_(self):  # what other kernels see of it
        return self._part._numba_type_


class exported_quickly(exported):  # noqa: N801
    """`exported` for a kernel with hundreds of parts, of which LLVM's first level makes code that is as fast."""

    @staticmethod
    def _compiler():
        return QuickCompiler


def kernel_of(function, compiler, forceinline=False, **options):
    """`contract` alone is allowed of fastmath: it fuses multiply-adds and keeps every NaN check.

    Kernels allocate nothing, and so are compiled without numba's reference counts: they took a third of the time, and
    threads would share them.
    """
    if hasattr(CPUTargetOptions, "_nrt"):
        options["_nrt"] = False
    if compiler:
        options["pipeline_class"] = compiler
    options = {"fastmath": {"contract"}} | options
    options |= {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
    kernel = numba.njit(forceinline=forceinline, **options)(function)  # said, or a kernel would have it from its caller
    template = kernel.get_call_template
    # one kernel for all numbers that stand in calls of it, where numba compiles one for each
    kernel.get_call_template = lambda args, kws: template(tuple(map(types.unliteral, args)), kws)
    return kernel


AS_ONE = WholeCompiler is not None  # else other multiply-adds are fused, and last digits differ
if not AS_ONE:
    tried = ", ".join(TESTED)
    kernel_cache.slower = f"with numba {numba.__version__} this takes about five times as long: tried were {tried}"
