"""Where compiled kernels are kept, and that they are being compiled.

numba's cache does not see an edit in a helper's file, so the folder is named by a hash of all kernel sources: those of
the engine, and what kernels have of the tables.
"""

import contextlib
import functools
import hashlib
import logging
import os
import tempfile
import time
from pathlib import Path

from numba.core import caching, config

from vibro_sweep.engine import simd

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

ENGINE, TABLES = Path(__file__).parents[1], Path(__file__).parents[2] / "tables"
SHARED = "bifurcations.py", "exponents.py", "outcomes.py"  # of the tables: constants and formulas in kernels
WORTH_SAYING = 1.0  # seconds
PAUSE = 0.1  # seconds between two looks whether another process has compiled a kernel
PATIENCE = 600.0  # seconds of such a wait
PURPOSES = {  # of kernels that take long: what for, and seconds of processor time
    "run_points": ("orbits of sweeps, one kernel for each number of masses and kind of stops", 15),
    "run_trajectories": ("trajectories", 8),
    "run_energy": ("energies", 10),
    "at": ("branches and curves", 12),
    "differentiate": ("derivatives by parameters", 8),
    "find_contacts": ("flights of periodic orbits", 4),
}
_log = logging.getLogger("vibro_sweep")
_said: set[str] = set()
_needed: list[str] = []  # of PURPOSES, by what is being computed
slower = ""  # what is said besides, where compiling takes longer


@functools.cache  # of the sources as they were imported
def source_hash() -> str:
    """Names the folder of compiled kernels; what all numbers depend on is said by driver/code_hash.py."""
    digest = hashlib.sha256()
    for source in [*sorted(ENGINE.rglob("*.py")), *(TABLES / name for name in SHARED)]:
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def _folder() -> str | None:
    """The folder in which compiled kernels are kept; None where there is no such place.

    One that has some already, and cannot be written, is read.
    """
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
        with contextlib.suppress(OSError):
            if os.listdir(folder):
                return folder
        _warn_once(folder, error)
        return None


def _once(level: int, key: str, text: str, *words: object) -> None:
    """Log a text the first time that there is something to say of this key."""
    if key not in _said:
        _said.add(key)
        _log.log(level, text, *words)


def _warn_once(folder: str, error: Exception) -> None:
    """Log why compiled kernels cannot be kept in a folder."""
    reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
    text = "compiled kernels cannot be kept in %s (%s): they are compiled anew"
    _once(logging.WARNING, "not kept", text, folder, reason)


def _announce(kernel: str, where: str) -> None:
    """Log that kernels are being compiled: where they are kept, and of each what it is for and how long it takes."""
    _once(logging.INFO, "compiling", "compiling kernels%s", where)
    if kernel in PURPOSES:
        purpose, seconds = PURPOSES[kernel]
        is_one_of_several = kernel in _needed and len(_needed) > 1
        count = f", {_needed.index(kernel) + 1} of {len(_needed)} that this needs" if is_one_of_several else ""
        _log.info("compiling for %s: about %d s of processor time%s", purpose, seconds, count)
    if slower:
        simd.FREE.set()  # by numba's own compiler, which does not say when LLVM works
        _once(logging.INFO, "slower", slower)


def announce_count(kernels: list[str]) -> None:
    """Which of the kernels that take long what is computed next needs: so each is announced as one of so many."""
    _needed[:] = kernels


FOLDER = _folder()


class _Locator(getattr(caching, "UserProvidedCacheLocator", None) or caching._UserProvidedCacheLocator):
    """numba's, for a folder in which this process need not be able to write."""

    def ensure_cache_path(self):
        with contextlib.suppress(OSError):
            super().ensure_cache_path()


class _Implementation(caching.CompileResultCacheImpl):
    _locator_classes = (_Locator,)


class _Cache(caching.FunctionCache):
    """numba's cache, but a kernel that cannot be read is compiled anew, and one that cannot be written is not kept.

    Of several processes that need a kernel one compiles it, and the others wait for it.
    """

    _impl_class = _Implementation
    _lock = None

    def load_overload(self, sig, target_context):
        """A kernel that is kept; None where it is to be compiled."""
        found = self._kept(sig, target_context)
        if found is None:
            _announce(self._py_func.__name__, f", once: they are kept in {self.cache_path}")
            if self._has_waited(sig):
                found = self._kept(sig, target_context)
            if found is not None:
                self._unlock()
            self._began = time.perf_counter()
        if found is not None and self._py_func.__name__ in PURPOSES:
            simd.FREE.set()
        return found

    def _kept(self, sig, target_context):
        """Without this, numba would load all that compiling takes, scipy too, before it looks for a compiled kernel."""
        try:
            return self._load_overload(sig, target_context)
        except Exception as error:  # of pickle, any: the cached kernel is empty or cut off
            _warn_once(self.cache_path, error)
            with contextlib.suppress(OSError):
                self.flush()
            return None

    def _has_waited(self, sig) -> bool:
        """Take the lock of a kernel that is to be compiled. Whether another process had it meanwhile."""
        self._unlock()
        name = hashlib.blake2b(f"{self._impl.filename_base} {sig}".encode(), digest_size=8).hexdigest()
        began, waited = time.monotonic(), False
        while fcntl and time.monotonic() < began + PATIENCE:
            try:
                self._lock = open(os.path.join(FOLDER, f"{name}.lock"), "w")  # until it is compiled
                fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                _once(logging.INFO, "waits", "another process compiles them: waiting for it")
                self._lock.close()
                self._lock = None  # it is the other's, which removes it
                time.sleep(PAUSE)
                waited = True
            except OSError:  # nothing can be written there, or locked
                break
        return waited

    def _unlock(self) -> None:
        if self._lock:
            with contextlib.suppress(OSError):
                os.unlink(self._lock.name)
            self._lock.close()
            self._lock = None

    def save_overload(self, sig, data):
        seconds = time.perf_counter() - self._began
        if seconds > WORTH_SAYING:
            _log.info("compiled %s in %.0f s", self._py_func.__name__, seconds)
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _warn_once(self.cache_path, error)
        self._unlock()


class _NotKept(caching.NullCache):
    def __init__(self, kernel: str = ""):
        super().__init__()
        self._kernel = kernel

    def load_overload(self, sig, target_context):
        """Nothing is kept."""
        _announce(self._kernel, "")


def cache_of(function):
    """The cache of a kernel that Python calls."""
    if FOLDER is None:
        return _NotKept(function.__name__)
    before, config.CACHE_DIR = config.CACHE_DIR, FOLDER
    try:
        return _Cache(function)
    finally:
        config.CACHE_DIR = before
