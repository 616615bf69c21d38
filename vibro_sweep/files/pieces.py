"""A run of branches, curves or windows: what it has computed is kept in pieces, which make the file at the end.

FILE.h5.pieces/run.json says what is computed; NNNNNN.npz are the pieces, each written under another name first. numpy's
zip has a CRC-32 of every array: a piece that does not fit is computed again.
"""

import contextlib
import json
import os
import secrets
import shutil
import time
import zipfile
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from vibro_sweep.files.disk import faults_said
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.lock import locked
from vibro_sweep.files.making import make
from vibro_sweep.files.opening import foreign, open_file
from vibro_sweep.files.subject import (
    Complete,
    about_run,
    check_outputs,
    check_same,
    check_version,
    now,
    pieces_of,
    touch,
)
from vibro_sweep.results import ragged_dataset

KEPT = "what was computed until then is kept: `resume` continues it"
NAME = "piece name"  # of the array that holds the name of a piece

Arrays = dict[str, np.ndarray]


class Pieces:
    """What an unfinished run has computed, by names."""

    def __init__(self, path: Path, header: dict[str, Any]):
        self.path, self.header, self._began = path, header, time.perf_counter()
        self._folder = pieces_of(path)
        self._known: dict[str, Arrays] = {}
        files = sorted(self._folder.glob("*.npz"))
        for file in files:
            with contextlib.suppress(OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
                with np.load(file, allow_pickle=False) as piece:
                    kept_arrays = {name: piece[name] for name in piece.files}
                self._known[str(kept_arrays.pop(NAME))] = kept_arrays
        self._next = 1 + max((int(file.stem) for file in files if file.stem.isdigit()), default=-1)

    def get(self, name: str) -> Arrays | None:
        """A piece that is known already."""
        return self._known.get(name)

    def write(self, name: str, arrays: Mapping[str, np.ndarray]) -> None:
        """Keep a piece: once this returns, a kill does not lose it. Raises StoreError."""
        self._known[name] = {key: np.asarray(values) for key, values in arrays.items()}
        file = self._folder / f"{self._next:06d}.npz"
        with faults_said(self._folder, KEPT), open(f"{file}.new", "wb") as new:
            np.savez(new, **{NAME: np.array(name)}, **self._known[name])
            new.flush()
            os.fsync(new.fileno())
            os.replace(new.name, file)
        self._next += 1

    def drop(self) -> None:
        """Remove what is left of a run that cannot have a result."""
        shutil.rmtree(self._folder, ignore_errors=True)

    def finish(self, data: xarray.Dataset) -> None:
        """Make the file, give it its name, and remove the pieces. Raises StoreError."""
        header = {name: value for name, value in self.header.items() if name != "replaces"}
        how = {"wall_time_s": round(time.perf_counter() - self._began, 3)}
        header["history"] = f"{header['history']}\n{now()} complete"
        header["provenance"] = json.dumps(json.loads(header["provenance"]) | how)
        make(self.path, data.assign_attrs(header | data.attrs), replaces=self.header["replaces"])
        self.drop()


@contextlib.contextmanager
def pieces_run(
    attributes: Mapping[str, Any], path: Path, mode: str, made_by: Mapping[str, Any], inputs: Collection[Path] = ()
) -> Iterator[Pieces | Complete]:
    """The run of branches, curves or windows; `Complete` where its file is there, and whole. Raises StoreError."""
    check_outputs(path, mode, inputs)
    with locked(path):
        folder = pieces_of(path)
        begun = _begun(folder) if mode != "overwrite" else None
        if os.path.lexists(path) and mode != "overwrite":
            with open_file(path) as old:
                identity = old.attrs["identity"]
            if begun is None or identity == begun["identity"]:  # killed when its file had its name already
                yield _complete(attributes, path, mode)
                shutil.rmtree(folder, ignore_errors=True)
                return
        if begun is not None and mode == "new":
            raise StoreError(f"{folder} is an interrupted run; `resume` continues it, `overwrite` replaces it")
        if begun is not None:
            check_same(begun, attributes, folder)
            check_version(begun, made_by, folder)
            if os.path.lexists(path) and not begun["replaces"]:
                raise StoreError(
                    f"{path} stands beside the interrupted run {folder}, which is not to replace it; move "
                    "one of them away, or `overwrite` both"
                )
        else:
            begun = about_run(attributes, made_by, secrets.token_hex(16)) | {"replaces": os.path.lexists(path)}
            with faults_said(path, "nothing is computed yet"):
                shutil.rmtree(folder, ignore_errors=True)
                folder.mkdir()
                new = folder / "run.json.new"
                new.write_text(json.dumps(begun, default=_plain))
                os.replace(new, folder / "run.json")
        yield Pieces(path, begun)


def _begun(folder: Path) -> dict[str, Any] | None:
    """What an interrupted run computes; None where there is none. Raises StoreError."""
    if not folder.exists():
        return None
    try:
        return json.loads((folder / "run.json").read_text())
    except (OSError, ValueError) as error:
        raise StoreError(f"{folder} is damaged ({error}); overwrite it") from None


def _plain(value: Any) -> Any:
    return np.asarray(value).tolist()


def _complete(attributes: Mapping[str, Any], path: Path, mode: str) -> Complete:
    """A file that needs no run. Raises StoreError for any other."""
    try:
        with open_file(path) as old:
            check_same(old.attrs, attributes, path)
            try:
                ragged_dataset.check(old)
            except (OSError, RuntimeError, ValueError, KeyError, AttributeError) as error:
                raise StoreError(f"{path} is damaged: {error}; overwrite it") from None
            if not old.encoding["sealed"]:
                raise StoreError(f"{foreign(path)}; overwrite it")
            touch(path)
            return Complete({}, json.loads(old.attrs["provenance"]).get("wall_time_s", 0.0))
    except StoreError as error:
        if mode == "resume":
            raise
        refusal = f"{path} exists, and holds something else than this run makes"
        raise StoreError(f"{refusal}; `overwrite` replaces it, or name another file\n{error}") from None
