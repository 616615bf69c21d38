"""All jit policy in one file: nogil, fused multiply-adds as the only fastmath, no reference counts, cached on disk.

numba's cache does not see an edit in a helper's file, so the cache folder is named by a hash of all kernel sources:
those of the engine, and what kernels have of the tables.
"""

import contextlib
import functools
import hashlib
import logging
import os
import tempfile
import time
from pathlib import Path

import llvmlite
import numba
from numba.core import config, types
from numba.core.caching import FunctionCache
from numba.core.cpu import CPUTargetOptions

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

ENGINE, TABLES = Path(__file__).parents[1], Path(__file__).parents[2] / "tables"
SHARED = "bifurcations.py", "exponents.py", "outcomes.py"  # of the tables: constants and formulas in kernels


@functools.cache  # of the sources as they were imported
def source_hash() -> str:
    """Names the folder of compiled kernels; what all numbers depend on is said by driver/code_hash.py."""
    digest = hashlib.sha256()
    for source in [*sorted(ENGINE.rglob("*.py")), *(TABLES / name for name in SHARED)]:
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder() -> str | None:
    """The folder in which compiled kernels are kept; None where there is no such place."""
    home = os.environ.get("XDG_CACHE_HOME", "")
    if not os.path.isabs(home):  # to be ignored, says the XDG base directory specification
        home = os.path.expanduser("~/.cache")
    folder = os.path.join(config.CACHE_DIR or os.path.join(home, "vibro_sweep"), source_hash())
    try:
        if not (config.CACHE_DIR or os.path.isabs(home)):
            raise OSError("there is no home folder; set NUMBA_CACHE_DIR")
        os.makedirs(folder, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        _warn_once(folder, error)
        return None


def _warn_once(folder: str, error: Exception) -> None:
    """Log once why compiled kernels cannot be kept in a folder."""
    global _warned
    if not _warned:
        _warned = True
        reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
        _log.warning("compiled kernels cannot be kept in %s (%s): they are compiled anew", folder, reason)


class _Cache(FunctionCache):
    """numba's cache, but a kernel that cannot be read is compiled anew, and one that cannot be written is not kept."""

    def load_overload(self, sig, target_context):
        """Without this, numba would load all that compiling takes, scipy too, before it looks for a compiled kernel."""
        try:
            found = self._load_overload(sig, target_context)
        except Exception as error:  # of pickle, any: the cached kernel is empty or cut off
            _warn_once(self.cache_path, error)
            with contextlib.suppress(OSError):
                self.flush()
            found = None
        if found is None:
            _announce(self.cache_path)
            self._began = time.perf_counter()
        return found

    def save_overload(self, sig, data):
        seconds = time.perf_counter() - self._began
        if seconds > WORTH_SAYING:
            _log.info("compiled %s in %.0f s", self._py_func.__name__, seconds)
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _warn_once(self.cache_path, error)


def _announce(folder: str) -> None:
    """Log once that kernels are being compiled."""
    global _announced
    if not _announced:
        _announced = True
        _log.info("compiling kernels, once: they are kept in %s", folder)
        if not AS_ONE:
            _log.info("with numba %s this takes about %s as long: %s", numba.__version__, SLOWER, _why_plainly())


def _why_plainly() -> str:
    """Why kernels do not compile as one."""
    return "it compiles them otherwise than expected" if IS_TESTED else f"tried were {', '.join(TESTED)}"


WORTH_SAYING = 1.0  # seconds
SLOWER = "five times"
_log = logging.getLogger("vibro_sweep")
_warned = _announced = False
_FOLDER = _cache_folder()


class _Part:
    """A kernel that other kernels call.

    numba's object for it is made when one of these is compiled: for all two hundred that takes 40 ms, which a start
    does without where compiled kernels are found.
    """

    def __init__(self, function, compiler, **options):
        functools.update_wrapper(self, function)
        self._make = functools.partial(_compiled, function, compiler, no_cpython_wrapper=True, **options)

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
        self._part, self._whole = jit(function), _compiled(function, self._compiler())
        _enable_caching(self._whole)

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


def _compiled(function, compiler, forceinline=False, **options):
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


def _works() -> bool:
    """Whether kernels compile as one, and compute what they should, with this numba."""
    from vibro_sweep.engine.simd import self_test  # whose kernels are made by this module

    try:
        return self_test.works(_compiled(self_test.kernel, WholeCompiler))
    except Exception:  # whatever numba's internals raise
        return False


def _usable() -> bool:
    """`_works`, tried once for each numba and kept beside the compiled kernels."""
    if WholeCompiler is None:
        return False
    kept = _FOLDER and Path(_FOLDER, f"compiles-as-one-{numba.__version__}-{llvmlite.__version__}")
    try:
        return kept.read_text() == "yes"
    except (AttributeError, OSError, ValueError):
        pass
    works = _works()
    with contextlib.suppress(AttributeError, OSError):
        kept.write_text("yes" if works else "no")
    return works


def _enable_caching(dispatcher):
    if _FOLDER is None:
        return
    before, config.CACHE_DIR = config.CACHE_DIR, _FOLDER
    try:
        dispatcher._cache = _Cache(dispatcher.py_func)
    finally:
        config.CACHE_DIR = before


if not _usable():
    NoInlineCompiler = PartCompiler = QuickCompiler = SmallCompiler = WholeCompiler = None

AS_ONE = WholeCompiler is not None  # else other multiply-adds are fused, and last digits differ
