"""One run at a time writes a file: a lock on FILE.h5.lock, never on FILE.h5, which HDF5's readers lock."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from vibro_sweep.files.file_errors import StoreError

try:
    import fcntl
except ImportError:  # Windows, where files are read only
    fcntl = None  # type: ignore[assignment]


@contextlib.contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold the lock of a file, which goes with the process. Raises StoreError where another run holds it."""
    if fcntl is None:
        raise StoreError(f"{path}: runs need the locks of Linux or macOS; on this system files can only be read")
    name, descriptor = Path(f"{path}.lock"), None
    try:
        descriptor = _acquired(path, name)
        yield
    finally:
        if descriptor is None:  # another run's, or Ctrl-C came before it was known
            _remove_if_free(name)
        else:
            with contextlib.suppress(OSError):
                os.unlink(name)
            os.close(descriptor)


def _acquired(path: Path, name: Path) -> int:
    while True:
        try:
            descriptor = os.open(name, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666)
        except OSError as error:
            raise StoreError(f"{name} cannot be made: {error.strerror}") from None
        try:
            _lock(path, descriptor)
            if _is_at(descriptor, name):
                return descriptor
        except BaseException:  # Ctrl-C among them
            os.close(descriptor)
            raise
        os.close(descriptor)  # its last owner removed it between the two calls


def _lock(path: Path, descriptor: int) -> None:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise StoreError(f"{path} is being written by another run") from None
    except OSError:
        pass  # a file system without locks


def _is_at(descriptor: int, name: Path) -> bool:
    with contextlib.suppress(FileNotFoundError):
        return os.path.samestat(os.fstat(descriptor), os.lstat(name))
    return False


def _remove_if_free(name: Path) -> None:
    with contextlib.suppress(OSError):
        descriptor = os.open(name, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.unlink(name)
        finally:
            os.close(descriptor)
