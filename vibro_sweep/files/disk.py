"""Names on the disk: nothing is written through a link or to a device, nothing that exists is replaced unasked; and the
messages of a disk that fails."""

import contextlib
import errno
import os
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from vibro_sweep.files.file_errors import MissingError, StoreError


def open_raw(path: Path) -> BinaryIO:
    """A regular file, for reading; a pipe is not waited for. Raises StoreError."""
    try:
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    except FileNotFoundError:
        raise MissingError(path) from None
    except OSError as error:
        raise StoreError(f"{path} cannot be read: {error.strerror}") from None
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise StoreError(f"{path} is a folder, a device or a pipe; it must be a file")
    return os.fdopen(descriptor, "rb")


def obstacle(path: Path) -> str | None:
    """Why the program neither writes nor replaces what stands at a name; None where it may, or nothing is there."""
    try:
        mode = os.lstat(path).st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None
    if stat.S_ISLNK(mode):
        return f"is a link to {os.readlink(path)}; name that file itself, or remove the link"
    if stat.S_ISDIR(mode):
        return "is a folder; it must be a file"
    return None if stat.S_ISREG(mode) else "is a device, a pipe or a socket; it must be a file"


def same_file(first: Path, second: Path) -> bool:
    """Whether two names lead to one file, also through links; not where nothing stands at one of them."""
    try:
        return first.samefile(second)
    except OSError:
        return False


def publish(new: Path, path: Path, replaces: bool) -> None:
    """Give a finished file its name, in one step. Raises FileExistsError unless it `replaces` what is there."""
    if replaces:
        os.replace(new, path)
    else:
        try:
            os.link(new, path)
        except FileExistsError:
            raise
        except (OSError, NotImplementedError):  # a file system without hard links: take the name, then replace that
            os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
            os.replace(new, path)
        else:
            os.unlink(new)
    with contextlib.suppress(OSError):  # bring the name to the disk, where the system can
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def write_all(descriptor: int, data: memoryview, at: int) -> None:
    """Write bytes at a place. Raises OSError."""
    while data:  # a write may take less than it is given
        count = os.pwrite(descriptor, data, at)
        data, at = data[count:], at + count


def to_disk(descriptor: int) -> None:
    """Wait until what was written is on the disk."""
    (getattr(os, "fdatasync", None) or os.fsync)(descriptor)


@contextlib.contextmanager
def faults_said(path: Path, kept: str) -> Iterator[None]:
    """Faults of the disk under a file, in words, and what is kept of it. Raises StoreError."""
    try:
        yield
    except OSError as error:
        if isinstance(error, ValueError):  # one of our own
            raise
        reason = os.strerror(error.errno) if error.errno else str(error)
        full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
        raise StoreError(f"{path}: {reason}; {'make room; ' if full else ''}{kept}") from None
