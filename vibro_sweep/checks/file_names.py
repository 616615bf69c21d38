"""Names of files that a caller gives, checked; and errors of Python's own kinds for what is missing or in the way."""

import errno
import os
import stat
from pathlib import Path

from vibro_sweep.checks.arguments import check_type
from vibro_sweep.checks.errors import ArgumentError, VibroSweepError
from vibro_sweep.checks.refusals import not_allowed

SUFFIX = ".pieces"  # of the folder of a run that is not complete
WHAT = "the path of a file"


class FileError(VibroSweepError, ValueError, OSError):
    """A file that cannot be read or written: its name, and why."""

    # of the two bases' the one that Python takes; tblib, which Dask has, asks for it
    __new__ = OSError.__new__

    def __init__(self, path: str | Path, reason: str):
        super().__init__(path, reason)
        self.filename, self.strerror = str(path), reason

    def __reduce__(self):
        return type(self), (self.filename, self.strerror)

    def __str__(self):
        return f"{self.filename}: {self.strerror}"


class MissingFileError(FileError, FileNotFoundError):
    """A file does not exist."""

    def __init__(self, path: str | Path, reason: str = "there is no such file"):
        super().__init__(path, reason)
        self.errno = errno.ENOENT


class ExistingFileError(FileError, FileExistsError):
    """A file exists already and is left as it is."""

    def __init__(self, path: str | Path, reason: str = "there is a file already"):
        super().__init__(path, reason)
        self.errno = errno.EEXIST


def checked_path(name: str, value: str | Path) -> Path:
    """The path of a file. Raises TypeError for what is not a path, ValueError for one that no file can have."""
    check_type(name, value, (str, Path), WHAT)
    _check_name(name, value, str(value))
    return Path(value)


def file_to_write(name: str, value: str | Path) -> Path:
    """The path of a file, and ValueError for the name of a folder, too."""
    path = checked_path(name, value)
    if str(value).endswith(("/", os.sep)):
        raise ArgumentError(not_allowed(name, str(value), f"{WHAT}, and of no folder"))
    _check_name(name, value, f"{value}{SUFFIX}")
    return path


def _check_name(name: str, value: object, path: str) -> None:
    if not path:
        raise ArgumentError(not_allowed(name, value, f"{WHAT}, and not empty"))
    try:
        os.lstat(path)
    except UnicodeEncodeError:
        raise ArgumentError(not_allowed(name, value, f"{WHAT}, of whole characters")) from None
    except ValueError:
        raise ArgumentError(not_allowed(name, value, f"{WHAT}, without a NUL character")) from None
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            raise ArgumentError(not_allowed(name, value, f"{WHAT}, and shorter")) from None


def read_bytes(path: Path, most: int, pipes: bool = False) -> bytes:
    """The bytes of a file, or its first bytes. Raises FileError where it is not a file, or cannot be read.

    pipes : whether it may be a pipe into which a program writes
    """
    try:
        with open(path, "rb", opener=_without_waiting) as file:
            mode = os.fstat(file.fileno()).st_mode
            if pipes and stat.S_ISFIFO(mode):
                return _piped(file.fileno(), path, most)
            if not stat.S_ISREG(mode):
                raise FileError(path, "is not a regular file")
            return file.read(most)
    except FileError:
        raise
    except FileNotFoundError:
        raise MissingFileError(path) from None
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror or error}") from None


def _piped(pipe: int, path: Path, most: int) -> bytes:
    """What comes out of a pipe, that was opened without waiting, until it is closed."""
    parts = []
    try:
        parts.append(os.read(pipe, most))
        if not parts[0]:
            raise FileError(path, "is not a regular file, and nothing comes out of it")
    except BlockingIOError:  # nothing yet
        pass
    os.set_blocking(pipe, True)
    while (left := most - sum(map(len, parts))) and (part := os.read(pipe, left)):
        parts.append(part)
    return b"".join(parts)


def _without_waiting(path, flags: int) -> int:
    """A pipe is not waited for."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))
