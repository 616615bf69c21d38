"""The run of a sweep: a new file, one that goes on, or one that is complete already."""

import contextlib
import json
import os
import secrets
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.hdf5 import OLD
from vibro_sweep.files.lock import locked
from vibro_sweep.files.making import make
from vibro_sweep.files.opening import foreign, open_file
from vibro_sweep.files.subject import (
    Complete,
    about_run,
    check_outputs,
    check_same,
    check_space,
    check_version,
    touch,
)
from vibro_sweep.files.sweep_file import SweepFile
from vibro_sweep.files.verifying import END_BYTES, damaged_points, in_words, unreadable
from vibro_sweep.tables.outcomes import NOT_COMPUTED


@contextlib.contextmanager
def sweep_run(
    data: xarray.Dataset,
    following: Collection[str],
    size: int,
    path: Path,
    mode: str,
    made_by: Mapping[str, Any],
    inputs: Collection[Path],
) -> Iterator[SweepFile | Complete]:
    """The file of a sweep, to be filled; `Complete` where it is there, and whole. Raises StoreError.

    data : the Dataset of the sweep with nothing computed (results/layout.py); `size` are its bytes
    following : variables that are known when all points are
    """
    check_outputs(path, mode, inputs)
    with locked(path):
        existed, again = os.path.lexists(path), None
        if existed and mode != "overwrite":
            again = _look(data, path, mode, made_by)
            if isinstance(again, Complete):
                yield again
                return
        else:
            check_space(size, path)
            _make(data, following, path, made_by, replaces=existed)
        with contextlib.closing(SweepFile(path, again)) as file:
            yield file


def _look(data: xarray.Dataset, path: Path, mode: str, made_by: Mapping[str, Any]) -> Complete | np.ndarray | None:
    """A file that needs no run, which is as new then; of one that goes on the points (bool) that are damaged, if any.
    Raises StoreError for any other."""
    try:
        with open_file(path) as old:
            check_same(old.attrs, data.attrs, path)
            if not old.encoding["sealed"]:
                raise StoreError(f"{foreign(path)}; no run continues it")
            damaged = damaged_points(old)
            lacking = _lacking(old, damaged)
            if mode == "new" or lacking:
                check_version(old.attrs, made_by, path)
            if not lacking:
                touch(path)
                return complete_of(old)
            if old.attrs["format"] == OLD:
                raise StoreError(f"{path} {lacking}, and is not a file that this version can continue; overwrite it")
    except StoreError as error:
        if mode == "resume":
            raise
        refusal = f"{path} exists, and holds something else than this run makes"
        raise StoreError(f"{refusal}; `overwrite` replaces it, or name another file\n{error}") from None
    if mode == "new":
        raise StoreError(f"{path} {lacking}; `resume` computes that, `overwrite` begins anew")
    return np.logical_or.reduce([*damaged.values()]) if damaged else None


def _lacking(old: xarray.Dataset, damaged: dict[str, np.ndarray]) -> str:
    """What `resume` computes of a file, in words; empty where nothing is."""
    if why_not := in_words(damaged) or unreadable(old):
        return f"is damaged: {why_not}"
    if not old.encoding["complete"]:
        missing = int(np.count_nonzero(old["status"].values == NOT_COMPUTED))
        return f"is an interrupted run: {missing:,} of {old['status'].size:,} points are not computed"
    return ""


def complete_of(old: xarray.Dataset) -> Complete:
    """How many orbits of a file have which status, and how long its run took."""
    codes, counts = np.unique(old["status"].values, return_counts=True)
    seconds = json.loads(old.attrs["provenance"]).get("wall_time_s", 0.0)
    return Complete(dict(zip(codes.tolist(), counts.tolist(), strict=True)), seconds)


def _make(
    data: xarray.Dataset, following: Collection[str], path: Path, made_by: Mapping[str, Any], replaces: bool
) -> None:
    """The whole file with nothing computed."""
    lead = data["status"].dims
    zeros = xarray.Variable(lead, np.broadcast_to(np.uint32(0), data["status"].shape), fastpath=True)  # without dask
    end = xarray.Variable(("byte",), np.broadcast_to(np.uint8(0), (END_BYTES,)), fastpath=True)
    sums = {str(name): zeros for name in data.data_vars}
    checks = xarray.Dataset(sums | {"end": end}, attrs={"following": " ".join(following)})
    about = about_run(data.attrs, made_by, secrets.token_hex(16))
    make(path, data.assign_attrs(about), data.data_vars, checks, replaces)
