"""Reading a file: as an `xarray.Dataset`, or described in words."""

import json
from pathlib import Path

import h5py
import numpy as np

from vibro_sweep.kernels.status import MEANINGS, NOT_COMPUTED, OK
from vibro_sweep.store import checks
from vibro_sweep.store.opening import StoreError, opened


def open(path):  # the name that users of xarray expect
    """The file as an `xarray.Dataset`, with coordinates. It is read through once, for its checksums.

    Raises StoreError for a file that is none of ours, and for a damaged one: it names the datasets.
    """
    import xarray

    path = Path(path)
    with opened(path) as file:
        found = checks.damaged(file)
    if found:
        raise StoreError(f"{path} is damaged: {checks.summary(found)}; {_remedy(path)}")
    return xarray.open_dataset(path, engine="h5netcdf")


def _remedy(path: Path) -> str:
    return "`run --resume` computes that again" + (", if no run is just writing it" if path.suffix == ".part" else "")


def describe(path: str | Path) -> str:
    """What is in a file, how it was made, how far it is, and how accurate it says it is. Raises StoreError."""
    path = Path(path)
    with opened(path) as file:
        lines = [f"{path}: {file.attrs['title']}"]
        found = checks.damaged(file)
        broken = {name for name, _ in found}
        for name in file.attrs["sweep_dimensions"]:
            ends = "" if name in broken else f"{file[name][0]:g} .. {file[name][-1]:g} "
            lines.append(f"  {name:<10} {ends}({len(file[name]):,} values)")
        if "start" in file:
            lines.append(f"  {'start':<10} {len(file['start'])} at each point")
        lines.append("datasets")
        for name in (*file.attrs["quantities"], "status"):
            dataset = file[name]
            lines.append(
                f"  {name:<18} {' x '.join(map(str, dataset.shape)) or 'one':<16} {dataset.attrs['long_name']}"
            )
        lines += _progress(file)
        lines.append(f"damaged      {checks.summary(found)}; {_remedy(path)}" if found else "checksums    all hold")
        lines += _accuracy(file)
        lines.append("made by")
        lines += [
            f"  {key:<12} {value}" for key, value in json.loads(file.attrs["provenance"]).items() if value is not None
        ]
        lines += [f"  {entry}" for entry in file.attrs["history"].splitlines()]
        return "\n".join(lines)


def _progress(file: h5py.File) -> list[str]:
    """Done, missing and failed."""
    counts, total = checks.statuses(file), file["status"].size
    done = counts.total() - counts[NOT_COMPUTED]
    failed = {MEANINGS[code]: count for code, count in sorted(counts.items()) if code not in (OK, NOT_COMPUTED)}
    return [
        f"computed     {done:,} of {total:,} orbits ({100 * done / total:.4g} %)",
        f"missing      {total - done:,}",
        f"failed       {sum(failed.values()):,}",
        *(f"  {meaning}: {count:,}" for meaning, count in failed.items()),
    ]


def _accuracy(file: h5py.File) -> list[str]:
    lines = []
    if "lyapunov_residual" in file:
        total, known, largest = 0, 0, 0.0
        for _, exponents in checks.readable(file["lyapunov"]):
            total += np.count_nonzero(np.isfinite(exponents[..., 0]))
        for residual in _finite(file["lyapunov_residual"]):
            known, largest = known + residual.size, max(largest, np.max(np.abs(residual)))
        if known:
            lines.append(f"accuracy     |sum of exponents - exact sum| <= {largest:.2g}")
        if known < total:
            lines.append(f"             not known where dimensions are lost: {total - known:,} of {total:,} orbits")
    if "contact_error" in file:
        missed = [np.max(values) for values in _finite(file["contact_error"])]
        if missed:
            lines.append(f"             impacts were found within {max(missed):.2g} of the stop")
    if "min_impact_speed" in file:
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
