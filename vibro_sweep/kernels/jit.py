"""All jit policy in one place: nogil, no fastmath but fused multiply-adds, no reference counts, cached on disk.

numba's cache does not see an edit in a helper's file, so the cache folder is named by a hash of all kernel sources.
"""

import functools
import hashlib
import os
from pathlib import Path

import numba
from numba.core import config
from numba.core.cpu import CPUTargetOptions

try:
    from vibro_sweep.kernels.compiler import AsideCompiler, PartCompiler, WholeCompiler
except ImportError:  # another numba: kernels compile as it does by itself, in twice the time
    AsideCompiler = PartCompiler = WholeCompiler = None


@functools.cache  # of the sources as they were imported
def source_hash() -> str:
    """Identifies the kernels: equal hashes give equal numbers on equal machines."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder() -> str:
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    return os.path.join(config.CACHE_DIR or os.path.join(home, "vibro_sweep"), source_hash())


_FOLDER = _cache_folder()


def jit(function):
    """`numba.njit` for a kernel that other kernels call."""
    return _compiled(function, PartCompiler, no_cpython_wrapper=True)


def inline(function):
    """`jit` for what is on the way of all orbits: a call would pass vectors, and the tables' many words, by memory."""
    return _compiled(function, PartCompiler, no_cpython_wrapper=True, forceinline=True)


def aside(function):
    """`jit` for what is rare: inlined, it would take registers and room from what is on the way."""
    return _compiled(function, AsideCompiler, no_cpython_wrapper=True)


class entry:  # noqa: N801  # a decorator
    """`numba.njit` for a kernel that Python calls, too: one for Python, cached, and a `jit` for other kernels."""

    def __init__(self, function):
        functools.update_wrapper(self, function)
        self._part, self._whole = jit(function), _compiled(function, WholeCompiler)
        _enable_caching(self._whole)

    def __call__(self, *args):
        return self._whole(*args)

    @property
    def _numba_type_(self):  # what other kernels see of it
        return self._part._numba_type_


def _compiled(function, compiler, forceinline=False, **options):
    """`contract` alone is allowed of fastmath: it fuses multiply-adds and keeps every NaN check.

    Kernels allocate nothing, and so are compiled without numba's reference counts: they took a third of the time, and
    threads would share them.
    """
    if hasattr(CPUTargetOptions, "_nrt"):
        options["_nrt"] = False
    if compiler:
        options["pipeline_class"] = compiler
    options |= {"nogil": True, "fastmath": {"contract"}, "error_model": "numpy", "no_cfunc_wrapper": True}
    return numba.njit(forceinline=forceinline, **options)(function)  # said, or a kernel would have it from its caller


def _enable_caching(dispatcher):
    before, config.CACHE_DIR = config.CACHE_DIR, _FOLDER
    try:
        dispatcher.enable_caching()
    except RuntimeError:  # no folder can be written: every start compiles anew
        pass
    finally:
        config.CACHE_DIR = before
