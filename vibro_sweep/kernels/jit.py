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


# On the way of every impact: a call would pass the tables' many words, or vectors, through memory.
_INLINE = frozenset(
    "flight_of stops_of records_of control_points at_node first_suspect suspect_state state_at under_way end_period "
    "seek settle strike load derivatives parabola_root approach descend of_z third_derivative stays_clear take_off "
    "leaves_freely land evaluate count only leap_over join aim most_cells".split()
)


def jit(function):
    """`numba.njit` for a kernel that other kernels call."""
    return _compiled(function, no_cpython_wrapper=True)


def entry(function):
    """`numba.njit` for a kernel that Python calls, too."""
    return _compiled(function, no_cpython_wrapper=False)


def _compiled(function, **options):
    """`contract` alone is allowed of fastmath: it fuses multiply-adds and keeps every NaN check.

    Kernels allocate nothing, and so are compiled without numba's reference counts: they took a third of the time, and
    threads would share them.
    """
    if hasattr(CPUTargetOptions, "_nrt"):
        options["_nrt"] = False
    dispatcher = numba.njit(
        nogil=True,
        fastmath={"contract"},
        error_model="numpy",
        forceinline=function.__name__ in _INLINE,
        no_cfunc_wrapper=True,
        **options,
    )(function)
    before, config.CACHE_DIR = config.CACHE_DIR, _FOLDER
    try:
        dispatcher.enable_caching()
    except RuntimeError:  # no folder can be written: every start compiles anew
        pass
    finally:
        config.CACHE_DIR = before
    return dispatcher
