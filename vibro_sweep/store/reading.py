"""Reading a file: as an `xarray.Dataset`, or described in words."""

import contextlib
import json
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import h5py
import numpy as np

from vibro_sweep.model.branch_file import CHART, WINDOWS
from vibro_sweep.model.exponents import CERTAIN, sign_of
from vibro_sweep.model.files import checked_path
from vibro_sweep.model.status import NOT_COMPUTED, NOT_SETTLED, STATUSES, VALID, meaning
from vibro_sweep.store import checks
from vibro_sweep.store.arrays import Contents
from vibro_sweep.store.attributes import is_flat, quantities_of, text, texts
from vibro_sweep.store.opening import (
    REMEDY,
    ForeignError,
    StoreError,
    blocks_lost,
    open_file,
    opened,
)
from vibro_sweep.store.ragged_tables import curves_table, special_table, windows_table

if TYPE_CHECKING:
    import xarray

# what `describe` reads
ACCURACY = ("status", "lyapunov", "lyapunov_error", "lyapunov_residual", "contact_error", "min_impact_speed")


class Description(NamedTuple):
    """The lines of `describe`, and whether they say `damaged`."""

    text: str
    damaged: bool


def open(path: str | Path) -> "xarray.Dataset":  # the name that users of xarray expect
    """An HDF5 file, or what is computed in a part, as a Dataset; `vibro_sweep.open` (driver/any_file.py) says more."""
    from vibro_sweep.store import foreign, lazy

    try:
        data = _whole(path, lazy.dataset_of)
        data.encoding["source"] = str(path)  # as xarray says it
        return data
    except ForeignError as found:
        return foreign.dataset_of(found)


@contextlib.contextmanager
def contents(path: str | Path) -> Iterator[Contents]:
    """The same as `open`, for code that computes with the numbers: files without checksums are refused."""
    try:
        file = _whole(path, lambda file: file)
    except ForeignError as found:
        raise StoreError(f"{found}; nothing is computed from it") from None
    with file:
        yield Contents(file)


def _whole(path: str | Path, made: Callable[[h5py.File], Any]) -> Any:
    """The result made of a file, if it is not damaged."""
    path = checked_path("path", path)
    file, lost = open_file(path)
    try:
        if found := _damage(file, lost):
            raise StoreError(f"{path} is damaged: {found}; {REMEDY}")
        return made(file)
    except (OSError, RuntimeError, ValueError) as error:
        file.close()
        raise error if isinstance(error, StoreError) else StoreError(f"{path} is damaged ({error})") from None


def _damage(file: h5py.File, lost: int) -> str:
    """The damage in words; of a part, its blocks."""
    return blocks_lost(lost) if lost else checks.damage(file)


def describe(path: str | Path) -> str:
    """A description: what is in a file, how it was made, how far it is, and its stated accuracy. Raises StoreError."""
    return examine(path).text


def tables(path: str | Path) -> list[str]:
    """The tables of a file of branches or windows, line by line. Raises StoreError."""
    with opened(Path(path)) as (file, _):
        return _tables(file)


def examine(path: str | Path) -> Description:
    """The same as `describe`, and whether the file is damaged."""
    path = Path(path)
    try:
        with opened(path, ACCURACY, content=False) as (file, lost):
            return _examined(file, path, lost)
    except ForeignError as found:
        from vibro_sweep.store import foreign  # xarray takes long to be imported

        return Description(foreign.described(found), False)
    except StoreError:
        raise
    except (OSError, RuntimeError, ValueError, KeyError, TypeError) as error:
        raise StoreError(f"{path} is damaged ({error})") from None


def _examined(file: h5py.File, path: Path, lost: int) -> Description:
    lines = [f"{path}: {text(file, 'title')}"]
    found = _damage(file, lost)
    if is_flat(file):
        lines += [f"damaged      {found}; {REMEDY}"] if found else [*_tables(file), "checksums    all hold"]
        return Description("\n".join([*lines, *_made_by(file)]), bool(found))
    for name in texts(file, "sweep_dimensions"):
        lines.append(f"  {name:<10} {_ends(file[name])}({len(file[name]):,} values)")
    if file["status"].ndim > len(texts(file, "sweep_dimensions")):
        lines.append(f"  {'start':<10} {len(file['start'])} at each point")
    lines.append("datasets")
    for name in quantities_of(file):
        dataset = file[name]
        shape = " x ".join(map(str, dataset.shape)) or "one"
        lines.append(f"  {name:<18} {shape:<16} {_described(dataset)}")
    lines += _progress(file)
    lines.append(f"damaged      {found}; {REMEDY}" if found else "checksums    all hold")
    lines += [*_exponents(file), *_accuracy(file), *_made_by(file)]
    return Description("\n".join(lines), bool(found))


def _made_by(file: h5py.File) -> list[str]:
    provenance = json.loads(text(file, "provenance"))
    lines = [f"  {key:<12} {value}" for key, value in provenance.items() if value is not None]
    return ["made by", *lines, *(f"  {entry}" for entry in text(file, "history").splitlines())]


def _tables(file: h5py.File) -> list[str]:
    """The tables of a file of branches or windows."""
    arrays = {name: file[name][()] for name in quantities_of(file)}
    parameters = texts(file, "parameters")
    if text(file, "kind") == WINDOWS:
        return windows_table(arrays, parameters[0])
    if text(file, "kind") == CHART:
        return curves_table(arrays, parameters)
    return special_table(arrays, parameters)


def _ends(axis: h5py.Dataset) -> str:
    try:
        return f"{axis[0]:g} .. {axis[-1]:g} "
    except OSError:  # damaged
        return ""


def _described(dataset: h5py.Dataset) -> str:
    return text(dataset, "description") if "description" in dataset.attrs else ""


def _progress(file: h5py.File) -> list[str]:
    """Done, missing and failed."""
    counts, total = checks.statuses(file), file["status"].size
    done = counts.total() - counts[NOT_COMPUTED]
    failed = {code: count for code, count in sorted(counts.items()) if code not in (*VALID, NOT_COMPUTED)}
    advice = {code: f"\n    {STATUSES[code].advice}" if code in STATUSES else "" for code in failed}
    return [
        f"computed     {done:,} of {total:,} orbits ({100 * done / total:.4g} %)",
        f"missing      {total - done:,}",
        f"failed       {sum(failed.values()):,}",
        *(f"  {meaning(code)}: {count:,}{advice[code]}" for code, count in failed.items()),
        *([f"not settled  {counts[NOT_SETTLED]:,}"] if counts[NOT_SETTLED] else []),
    ]


def _exponents(file: h5py.File) -> list[str]:
    """The line on how many orbits are chaotic."""
    if not {"lyapunov", "lyapunov_error"} <= set(quantities_of(file)):
        return []
    certain, counts = float(file["lyapunov_error"].attrs.get("significant", CERTAIN)), Counter()
    for piece, exponents in checks.readable(file["lyapunov"]):
        with contextlib.suppress(OSError):  # a damaged chunk, which is reported elsewhere
            largest, error = exponents[..., 0], file["lyapunov_error"][piece][..., 0]
            counts.update(sign_of(largest, error, certain)[~np.isnan(largest)].tolist())
    words = f"{counts[1]:,} of {counts.total():,} orbits; not told from zero: {counts[0]:,}"
    return [f"lambda_1     above zero by more than {certain:g} errors: {words}"] if counts else []


def _accuracy(file: h5py.File) -> list[str]:
    lines = []
    names = quantities_of(file)
    if {"lyapunov", "lyapunov_residual"} <= set(names):
        total, known, largest = 0, 0, 0.0
        for _, exponents in checks.readable(file["lyapunov"]):
            total += np.count_nonzero(np.isfinite(exponents[..., 0]))
        for residual in _finite(file["lyapunov_residual"]):
            known, largest = known + residual.size, max(largest, np.max(np.abs(residual)))
        if known:
            lines.append(f"accuracy     |sum of exponents - exact sum| <= {largest:.2g}")
        if known < total:
            lines.append(f"             not known where dimensions are lost: {total - known:,} of {total:,} orbits")
    if "contact_error" in names:
        missed = [np.max(values) for values in _finite(file["contact_error"])]
        if missed:
            lines.append(f"             impacts were found within {max(missed):.2g} of the stop")
    if "min_impact_speed" in names:
        speeds = [np.min(values) for values in _finite(file["min_impact_speed"])]
        if speeds:
            lines.append(f"             slowest impact {min(speeds):.2g}: the nearest to a graze")
    return lines


def _finite(dataset: h5py.Dataset):
    """The finite numbers of each chunk that has any."""
    for _, values in checks.readable(dataset):
        finite = values[np.isfinite(values)]
        if finite.size:
            yield finite
