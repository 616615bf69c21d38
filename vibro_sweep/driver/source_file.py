"""The file from which something is computed: where what it holds is refused, the message names it."""

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path

from vibro_sweep.model.errors import VibroSweepError
from vibro_sweep.model.files import FileError
from vibro_sweep.scene import Continuation
from vibro_sweep.store import StoreError


class SourceError(VibroSweepError, ValueError):
    """A file or scene cannot be computed from: a file, or a scene's `continue: from`; the message says from which."""


@contextmanager
def computed_from(path: str | Path, key: str = "") -> Iterator[None]:
    """Name the file, and the key of the scene that has its name, in what is refused while one computes from it.

    Values that have passed all checks of the file may be refused much later, by whatever computes with them. Errors
    that name a file already are left as they are: it may be another one, which is written.
    """
    try:
        yield
    except (SourceError, StoreError, FileError):
        raise
    except ValueError as error:
        raise SourceError(f"{key}{path}: {error}") from error


def computed_from_source(scene: Continuation) -> AbstractContextManager[None]:
    """The same for the file that a scene begins from, if any."""
    if scene.origin not in ("sweep", "branches"):
        return nullcontext()
    return computed_from(scene.begin, f"continue.from.{scene.origin}: ")
