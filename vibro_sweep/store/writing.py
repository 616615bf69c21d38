"""Writing a file: made, continued or replaced by one run at a time, and given its name when it is complete."""

import contextlib
import datetime
import errno
import io
import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np

from vibro_sweep import __version__
from vibro_sweep.journal import CHECKPOINT_BYTES, DamagedError, Journal
from vibro_sweep.kernels.status import NOT_COMPUTED
from vibro_sweep.scene import Scene
from vibro_sweep.store import checks, layout
from vibro_sweep.store.opening import StoreError, check_kernels, check_scene, checked, made_by, opened


class Writer:
    """The open file of a run. All methods raise StoreError where the disk, or somebody on it, does not let them."""

    def __init__(self, file: h5py.File, journal: Journal, path: Path):
        self._file, self._journal, self._path = file, journal, path
        self._names = (*file.attrs["quantities"], "status")
        self._starts = file["status"].ndim > len(file.attrs["sweep_dimensions"])

    def missing(self, box: tuple[slice, ...]) -> np.ndarray:
        """Which points of a box of the sweep have an orbit that is not computed yet, bool of the box's shape."""
        absent = np.asarray(self._file["status"][box] == NOT_COMPUTED)
        return np.any(absent, axis=-1) if self._starts else absent

    def done(self) -> int:
        """Orbits computed so far."""
        counts = checks.statuses(self._file)
        return counts.total() - counts[NOT_COMPUTED]

    def write(self, box: tuple[slice, ...], arrays: dict[str, np.ndarray]) -> None:
        """Put a block in its place: once this returns, a kill does not lose it."""
        with _said(self._journal):
            for name in self._names:
                self._file[name][box] = arrays[name]
            self._commit()

    def mend(self, scene: Scene) -> None:
        """Mark as not computed what the checksums of the file do not confirm."""
        found = _mendable(self._file, self._path)
        if not found:
            return
        with _said(self._journal):
            for name, piece in found:
                checks.mend(self._file, scene, name, piece)
            self._note(f"damage found, to be computed again: {checks.summary(found)}")
            self._commit()

    def finish(self, provenance: dict) -> dict[int, int]:
        """Give the file its name. Returns how many orbits have which status."""
        counts = checks.statuses(self._file)
        if self._file.mode == "r":  # it was complete before
            return counts
        with _said(self._journal):
            self._note("complete")
            self._file.attrs["provenance"] = json.dumps(made_by() | provenance)
            self._commit()
            self._journal.rename(self._path)
        return counts

    def _note(self, what: str) -> None:
        self._file.attrs["history"] = f"{self._file.attrs['history']}\n{_now()} {what}"

    def _commit(self) -> None:
        self._file.flush()
        self._journal.commit()


@contextlib.contextmanager
def writer(scene: Scene, path: Path, mode: str) -> Iterator[Writer]:
    """The `Writer` of a scene's file; `mode` is "new", "resume" or "overwrite". Raises StoreError."""
    part = Path(f"{path}.part")
    if mode == "new":
        for old in (path, part):
            if old.exists():
                raise StoreError(f"{old} exists; `resume` continues it, `overwrite` replaces it")
    with contextlib.closing(_held(part)) as journal:
        if mode == "resume" and path.exists() and not part.exists():
            with opened(path) as file:
                check_scene(file, path, scene)
                if not _mendable(file, path):
                    yield Writer(file, journal, path)
                    return
                check_kernels(file, path)
            os.replace(path, part)
        begun = mode == "resume" and part.exists()
        if not begun:
            _create(scene, part, journal)
        with _said(journal):
            journal.open()
        with checked(journal, part) as file:
            check_scene(file, part, scene)
            check_kernels(file, part)
            result = Writer(file, journal, path)
            if begun:
                result.mend(scene)
            yield result


def _mendable(file: h5py.File, path: Path) -> list[tuple[str, checks.Piece]]:
    """The damaged chunks; StoreError where a dataset's list of chunks is damaged itself."""
    found = checks.damaged(file)
    if not all(piece for _, piece in found):
        raise StoreError(f"{path} is damaged beyond repair: {checks.summary(found)}; overwrite it")
    return found


def _held(part: Path) -> Journal:
    try:
        return Journal(part)
    except BlockingIOError:
        raise StoreError(f"{part} is being written by another run") from None


def _create(scene: Scene, part: Path, journal: Journal) -> None:
    """The whole file with nothing computed yet, in place of what is there."""
    _check_space(scene, part)
    part.unlink(missing_ok=True)
    journal.discard()
    image = io.BytesIO()
    with h5py.File(image, "w", libver="v110") as file:  # whose structure has checksums too
        file.attrs["Conventions"] = "CF-1.11"
        file.attrs["title"] = f"vibro_sweep: {scene.name}"
        file.attrs["history"] = f"{_now()} begun by vibro_sweep {__version__}"
        file.attrs["scene"] = scene.text
        file.attrs["provenance"] = json.dumps(made_by())
        names = [name for name in layout.quantities(scene) if name != "status"]
        file.attrs["sweep_dimensions"] = list(scene.sweep) or np.empty(0, h5py.string_dtype())
        file.attrs["quantities"] = names or np.empty(0, h5py.string_dtype())
        layout.create(file, scene)
    new = Path(f"{part}.new")  # a file that is killed here is not mistaken for one
    with _said(journal):
        with new.open("wb") as file:
            file.write(image.getbuffer())
            os.fsync(file.fileno())
        os.replace(new, part)


def _check_space(scene: Scene, part: Path) -> None:
    """A run that will not fit is not begun; other programs may still fill the disk later on."""
    size = layout.size(scene)
    need, free = size + min(size, CHECKPOINT_BYTES), shutil.disk_usage(part.parent).free
    if part.exists():  # it makes room
        free += part.stat().st_size
    if need > free:
        raise StoreError(f"{part} needs {need / 1e6:,.0f} MB, and only {free / 1e6:,.0f} MB are free in {part.parent}")


@contextlib.contextmanager
def _said(journal: Journal) -> Iterator[None]:
    """Faults of the disk, in words, and that nothing is lost."""
    part = journal.path
    try:
        yield
    except (FileNotFoundError, NotADirectoryError):
        try:
            journal.put_back()
        except OSError as error:
            raise StoreError(f"{part} was removed during the run, and cannot be put back: {error}") from None
        raise StoreError(
            f"{part} was removed during the run; it is there again, with all that was computed: `resume` continues it"
        ) from None
    except BlockingIOError:
        raise StoreError(f"{part} was taken over by another run; this one stops, nothing is lost") from None
    except DamagedError as error:
        raise StoreError(f"{part} is damaged: {error.strerror}; overwrite it") from None
    except OSError as error:
        kept = "what was computed until then is kept: `resume` continues it"
        reason = os.strerror(error.errno) if error.errno else str(error)
        full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
        raise StoreError(f"{part}: {reason}; {'make room; ' if full else ''}{kept}") from None


def _now() -> str:
    return datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
