"""Runs whose results have sizes that are not known before: windows and branches. Pieces are kept in FILE.h5.part.

A piece is what one worker returns: arrays by name, kept under a key. The file is made of all pieces at the end.
"""

import contextlib
import json
import math
import os
import time
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np

from vibro_sweep.model.column import Column
from vibro_sweep.store import appending, names, parts
from vibro_sweep.store.appending import LockedPart
from vibro_sweep.store.attributes import text
from vibro_sweep.store.beginning import check_outputs
from vibro_sweep.store.opening import StoreError, check_version, made_by, opened, skeleton
from vibro_sweep.store.parts import PartError, Scan
from vibro_sweep.store.ragged_checks import damage_of
from vibro_sweep.store.ragged_files import Subject, image_of
from vibro_sweep.store.writing import said, unfinished

Arrays = dict[str, np.ndarray]


class Pieces:
    """A run of branches or windows. Methods raise StoreError where the disk does not let them."""

    complete = False

    def __init__(self, part: LockedPart, path: Path, subject: Subject, known: dict[str, Arrays]):
        self._part, self._path, self._subject, self._known = part, path, subject, known
        self._began = time.perf_counter()

    def get(self, key: str, usable: Callable[[Arrays], bool]) -> Arrays | None:
        """A piece that is known already, if it is one of those that can be used."""
        found = self._known.get(key)
        return found if found is not None and usable(found) else None

    def write(self, key: str, arrays: Arrays) -> None:
        """Keep a piece: once this returns, a kill does not lose it."""
        layout = [[name, values.dtype.str, list(values.shape)] for name, values in arrays.items()]
        data = [memoryview(np.ascontiguousarray(values).reshape(-1).view(np.uint8)) for values in arrays.values()]
        with said(self._part):
            self._part.append({"piece": key, "arrays": layout}, data)
        self._known[key] = arrays

    def drop(self) -> None:
        """Remove the part of a run that cannot have a result."""
        with said(self._part):
            self._part.remove()

    def finish(self, provenance: dict, columns: list[Column], arrays: Arrays) -> None:
        """Give the file its name, and remove the part."""
        head = self._part.head
        provenance["wall_time_s"] = round(time.perf_counter() - self._began, 3)
        image = image_of(self._subject, head.run_id, json.dumps(made_by() | provenance), columns, arrays)
        new = unfinished(self._path, head.run_id)
        with said(self._part):
            new.unlink(missing_ok=True)  # of a run that was killed here
            try:
                with open(new, "xb") as file:
                    file.write(image)
                    file.flush()
                    os.fsync(file.fileno())
                names.publish(new, self._path, head.replaces)
            except FileExistsError:
                raise StoreError(
                    f"{self._path} has appeared during the run and is left alone; move it away, then `resume` gives "
                    f"the result in {self._part.path} its name"
                ) from None
            finally:
                new.unlink(missing_ok=True)
            self._part.remove()


class CompleteResult:
    """A file that exists already, of the same subject and code."""

    complete = True


@contextlib.contextmanager
def pieces(subject: Subject, path: Path, mode: str, inputs: Collection[Path]) -> Iterator[Pieces | CompleteResult]:
    """A run of a subject into `path`; `mode` is "new", "resume" or "overwrite". Raises StoreError.

    inputs : files that the run reads, which it must not write
    """
    part = check_outputs(path, mode, inputs)
    replaces = names.stamp(path) if mode == "overwrite" else None
    if mode != "overwrite" and names.stamp(path) and not names.stamp(part):
        damage = _damage_of_made(subject, path)
        if not damage:
            yield CompleteResult()
            return
        if mode == "new":
            raise StoreError(f"{path} exists, and is damaged: {damage}; `resume` computes it again")
        replaces = names.stamp(path)
    try:
        locked = appending.lock(part) if names.stamp(part) else appending.make(part)
    except (BlockingIOError, FileExistsError):
        raise StoreError(f"{part} is being written by another run") from None
    with contextlib.closing(locked):
        try:
            if mode == "resume" and parts.is_begun(locked.file):
                known = _continued(locked, subject, path)
            else:
                known = {}
                _begin(locked, subject, replaces)
        except PartError as error:
            raise StoreError(f"{part} {error}") from None
        yield Pieces(locked, path, subject, known)


def _begin(locked: LockedPart, subject: Subject, replaces: names.Stamp | None) -> None:
    run_id = parts.new_run_id()
    content = image_of(subject, run_id, json.dumps(made_by()), [], {})
    with said(locked):
        locked.begin(parts.new_head(content, replaces, run_id), content)


def _continued(locked: LockedPart, subject: Subject, path: Path) -> dict[str, Arrays]:
    """The pieces of an interrupted run."""
    head = parts.read_head(locked.file)
    with skeleton(locked.file, locked.path) as file:
        _check_subject(file, subject, locked.path)
        check_version(file, locked.path)
    if (found := names.stamp(path)) and found != head.replaces:
        raise StoreError(f"{path} stands beside the interrupted run {locked.path}; move one of them away")
    scan, known = Scan(locked.file, head), {}
    for record in scan:
        if (found := _piece(locked.file, record)) is not None:
            known |= found
    locked.go_on(head, scan.end)
    return known


def _piece(file: BinaryIO, record: parts.Record) -> dict[str, Arrays] | None:
    """A piece as `write` keeps it, under its key; None for any other record."""
    key, layout = record.text.get("piece"), record.text.get("arrays")
    if not (isinstance(key, str) and isinstance(layout, list)):
        return None
    file.seek(record.at)
    raw, at, result = file.read(record.length), 0, {}
    try:
        for name, dtype, shape in layout:
            kind, count = np.dtype(dtype), math.prod(shape)
            if kind.kind not in "biuf" or count < 0:
                return None
            result[str(name)] = np.frombuffer(raw, kind, count, at).reshape(shape)
            at += result[str(name)].nbytes
    except (TypeError, ValueError):
        return None
    return {key: result} if at == len(raw) else None


def _damage_of_made(subject: Subject, path: Path) -> str:
    """The damage of a file that exists already, in words. Raises StoreError where it is of another subject."""
    try:
        with opened(path, content=False) as (file, _):
            _check_subject(file, subject, path)
            check_version(file, path)
            return damage_of(file)
    except StoreError as error:
        raise StoreError(f"{path} exists, and is not what this makes; `overwrite` replaces it\n{error}") from None


def _check_subject(file, subject: Subject, path: Path) -> None:
    """Raise StoreError where a file or part is about something else."""
    same = "kind" in file.attrs and text(file, "kind") == subject.kind and text(file, "scene") == subject.scene
    for name, value in subject.attributes.items():
        if isinstance(value, str):
            same = same and name in file.attrs and text(file, name) == value
    if not same:
        raise StoreError(f"{path} was made from something else; name another file, or overwrite it")
