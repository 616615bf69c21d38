"""Names in a folder: nothing is written through a link or to a device, nothing that exists is replaced unasked."""

import contextlib
import errno
import os
import stat
from pathlib import Path
from typing import NamedTuple


class Stamp(NamedTuple):
    """A file as it was when it was looked at: another one at its name, or a changed one, has another stamp."""

    inode: int
    size: int
    changed: int  # nanoseconds


def stamp(path: Path) -> Stamp | None:
    """The stamp of what stands at a name, a link itself and not its target; None where nothing does."""
    try:
        found = os.lstat(path)
    except (FileNotFoundError, NotADirectoryError):
        return None
    return Stamp(found.st_ino, found.st_size, found.st_mtime_ns)


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


def same_file(one: Path, other: Path) -> bool:
    """Whether two names lead to one file, also through links; not where nothing stands at one of them."""
    try:
        return one.samefile(other)
    except OSError:
        return False


def publish(new: Path, path: Path, old: Stamp | None) -> None:
    """Give a finished file its name, in the same folder and in one step; it may replace `old` and nothing else.

    Raises FileExistsError where another file stands there, also one that has just appeared.
    """
    found = stamp(path)
    if found is None:
        _link(new, path)
    elif found == old and obstacle(path) is None:
        os.replace(new, path)
    else:
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), os.fspath(path))
    sync_folder(path)


def _link(new: Path, path: Path) -> None:
    try:
        os.link(new, path)
    except FileExistsError:
        raise
    except (OSError, NotImplementedError):  # a file system without hard links: take the name, then replace that
        os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
        os.replace(new, path)
    else:
        os.unlink(new)


def sync_folder(path: Path) -> None:
    """Bring a new name to the disk, where the system can."""
    with contextlib.suppress(OSError):
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
