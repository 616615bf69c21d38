"""The lines that `info` says of a file, and the tables of its branches, curves or windows."""

import contextlib
import json
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from vibro_sweep.cli.ragged_tables import curves_table, special_table, windows_table
from vibro_sweep.store import checks
from vibro_sweep.store.attributes import is_flat, quantities_of, text, texts
from vibro_sweep.store.opening import REMEDY, ForeignError, StoreError, opened
from vibro_sweep.tables.exponents import CERTAIN, periods_to_go, sign_of
from vibro_sweep.tables.file_columns import CHART, WINDOWS
from vibro_sweep.tables.observables import GAP
from vibro_sweep.tables.outcomes import NOT_COMPUTED, NOT_SETTLED, REASONS, VALID, named, status_of

# datasets of a sweep that are read
ACCURACY = ("status", "lyapunov", "lyapunov_error", "lyapunov_residual", "contact_error", "min_impact_speed")


class Description(NamedTuple):
    """The lines about a file, and whether they say `damaged`."""

    text: str
    damaged: bool


def tables(path: str | Path) -> list[str]:
    """The tables of a file of branches or windows, line by line. Raises StoreError."""
    with opened(Path(path)) as (file, _):
        return _tables(file)


def examine(path: str | Path) -> Description:
    """A description: what is in a file, how it was made, how far it is, and its stated accuracy. Raises StoreError."""
    path = Path(path)
    try:
        with opened(path, ACCURACY, content=False) as (file, lost):
            return _examined(file, path, lost)
    except ForeignError as found:
        return Description(_of_another_program(found), False)
    except StoreError:
        raise
    except (OSError, RuntimeError, ValueError, KeyError, TypeError) as error:
        raise StoreError(f"{path} is damaged ({error})") from None


def _examined(file: h5py.File, path: Path, lost: int) -> Description:
    lines = [f"{path}: {text(file, 'title')}"]
    found = checks.damage(file, lost)
    made_by = ["made by", *_record(text(file, "provenance"), text(file, "history"))]
    if is_flat(file):
        lines += [f"damaged      {found}; {REMEDY}"] if found else [*_tables(file), "checksums    all hold"]
        return Description("\n".join([*lines, *made_by]), bool(found))
    for name in texts(file, "sweep_dimensions"):
        lines.append(f"  {name:<10} {_ends(file[name])}({len(file[name]):,} values)")
    if file["status"].ndim > len(texts(file, "sweep_dimensions")):
        lines.append(f"  {'start':<10} {len(file['start'])} at each point")
    lines.append("datasets")
    lines += [_dataset(name, file[name].shape, _described(file[name])) for name in quantities_of(file)]
    lines += _progress(file)
    lines.append(f"damaged      {found}; {REMEDY}" if found else "checksums    all hold")
    lines += [*_turning(file), *_exponents(file), *_accuracy(file), *made_by]
    return Description("\n".join(lines), bool(found))


def _of_another_program(found: ForeignError) -> str:
    """The lines about a file that another program wrote from one of ours."""
    from vibro_sweep.store.foreign import undoubted  # xarray takes long to be imported

    with undoubted(found) as data:
        lines = [f"{found.path}: {data.attrs.get('title', '')}"]
        lines += [f"  {name:<10} ({size:,} values)" for name, size in data.sizes.items()]
        lines.append("datasets")
        lines += [_dataset(name, one.shape, one.attrs.get("description", "")) for name, one in data.data_vars.items()]
        lines.append(f"checksums    none: written by {found.program}, not by this program")
        history = "\n".join(np.atleast_1d(data.attrs.get("history", "")).astype(str))
        about = _record(data.attrs.get("provenance", "{}"), history)
        return "\n".join([*lines, "written from a file that was made by", *about])


def _record(provenance: str, history: str) -> list[str]:
    """The lines about how a file was made."""
    try:
        known = json.loads(provenance)
    except (TypeError, ValueError):
        known = {}
    pairs = known.items() if isinstance(known, dict) else ()
    return [
        *(f"  {key:<12} {value}" for key, value in pairs if value is not None),
        *(f"  {line}" for line in history.splitlines()),
    ]


def _dataset(name: str, shape: tuple[int, ...], description: str) -> str:
    return f"  {name:<18} {' x '.join(map(str, shape)) or 'one':<16} {description}"


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
    failed = {status_of(code): count for code, count in sorted(counts.items()) if code not in (*VALID, NOT_COMPUTED)}
    return [
        f"computed     {done:,} of {total:,} orbits ({100 * done / total:.4g} %)",
        f"missing      {total - done:,}",
        f"failed       {sum(failed.values()):,}",
        *(f"  {one.name}: {count:,}" + f"\n    {one.advice}" * bool(one.advice) for one, count in failed.items()),
        *([f"not settled  {counts[NOT_SETTLED]:,}{_to_go(file)}"] if counts[NOT_SETTLED] else []),
    ]


def _to_go(file: h5py.File) -> str:
    """How many periods more orbits need that approach a periodic one, as far as it is known."""
    if "approached_factor" not in file:
        return ""
    with np.errstate(all="ignore"):
        known = [
            periods_to_go(file["approached_distance"][piece], factors)
            for piece, factors in checks.readable(file["approached_factor"])
        ]
    needed = np.concatenate([values[np.isfinite(values)] for values in known]) if known else np.empty(0)
    needed = needed[needed > 0]
    if not len(needed):
        return ""
    longest = float(f"{needed.max():.2g}")
    return f"; {len(needed):,} arrive at a periodic orbit after up to about {longest:,.0f} periods more (`settle`)"


def _turning(file: h5py.File) -> list[str]:
    """The line on orbits without a period because nothing holds the masses: only a contact between them leaves that."""
    if not {GAP, "period"} <= set(quantities_of(file)):
        return []
    without = sum(int((periods == 0).sum()) for _, periods in checks.readable(file["period"]))
    if not without:
        return []
    from vibro_sweep.engine.impulses.free_modes import turns  # these two take a second to be imported
    from vibro_sweep.scene.scene import parse_scene

    with contextlib.suppress(ValueError):  # there is no text of what a function made
        if turns(parse_scene(text(file, "scene")).system.linear):
            return [f"turning      {without:,} orbits: {named(REASONS, 'turning').text}"]
    return []


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
