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
    name = Path(f"{path}.lock")
    while True:
        try:
            descriptor = os.open(name, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666)
        except OSError as error:
            raise StoreError(f"{name} cannot be made: {error.strerror}") from None
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(descriptor)
            raise StoreError(f"{path} is being written by another run") from None
        except OSError:
            pass  # a file system without locks
        with contextlib.suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(descriptor), os.lstat(name)):
                break
        os.close(descriptor)  # its last owner removed it between the two calls
    try:
        yield
    finally:
        with contextlib.suppress(OSError):
            os.unlink(name)
        os.close(descriptor)
