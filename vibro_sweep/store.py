"""The HDF5 file: written by one process, block by block, and read by everybody.

While a run goes on the file is FILE.h5.part. All space is allotted when it is made and flushed to the disk, so that
writing a block changes numbers in place and no structure: killed at any moment, the file stays readable. `status` is
written after the data of its block; what it calls computed, is.
"""

import contextlib
import datetime
import json
import math
import os
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from vibro_sweep import __version__
from vibro_sweep.kernels.jit import source_hash
from vibro_sweep.kernels.observe import RUNNING
from vibro_sweep.kernels.spectrum import periods_read
from vibro_sweep.kernels.status import MEANINGS, NOT_COMPUTED, OK
from vibro_sweep.scene import Scene


class StoreError(ValueError):
    """A file that is in the way, is none of ours, or does not fit the scene."""


class Quantity(NamedTuple):
    dtype: str
    fill: float
    extra: tuple[str, ...]  # dimensions after those of the sweep
    units: str
    long_name: str


_SECTION = {
    "x1": ("1", "displacement x_1 of the first mass at the section"),
    "v1": ("1", "velocity v_1 of the first mass at the section"),
    "x2": ("1", "displacement x_2 of the second mass at the section"),
    "v2": ("1", "velocity v_2 of the second mass at the section"),
}

_AXES = {
    "mu_m": ("1", "mass ratio mu_m = M_2/M_1"),
    "mu_k": ("1", "stiffness ratio mu_k = K_2/K_1"),
    "zeta": ("1", "damping ratio zeta"),
    "f2": ("1", "share f_2 of the force on the second mass"),
    "omega": ("1", "forcing frequency omega"),
    "R": ("1", "coefficient of restitution R"),
    "b": ("1", "clearance b"),
    "tau": ("rad", "forcing phase tau at t = 0"),
    "start": ("1", "start of the orbit"),
    "sample": ("1", "section point, counted from the end of the transient"),
    "exponent": ("1", "Lyapunov exponent, counted from the largest"),
    "elapsed": ("1", "forcing periods since the end of the transient"),
    "time": ("1", "forcing periods since the last section point"),
}


def quantities(scene: Scene) -> dict[str, Quantity]:
    """The datasets that a scene asks for; what it does not observe is not there."""
    wanted = {}
    if "section" in scene.observe:
        for name, (units, long_name) in _SECTION.items():
            wanted[name] = Quantity("f8", np.nan, ("sample",), units, long_name)
        if scene.section.kind == "impact":
            wanted["phase"] = Quantity("f8", np.nan, ("sample",), "rad", "forcing phase omega t mod 2 pi at the impact")
        wanted["period"] = Quantity(
            "i8", -1, (), "1", "period of the orbit in forcing periods, 0: none up to half of `record`"
        )
    if "lyapunov" in scene.observe:
        wanted["lyapunov"] = Quantity(
            "f8", np.nan, ("exponent",), "1", "Lyapunov exponents per unit time, natural logarithm"
        )
        text = "standard error of the exponents; of a periodic orbit: what one more period changes"
        wanted["lyapunov_error"] = Quantity("f8", np.nan, ("exponent",), "1", text)
        wanted["lyapunov_residual"] = Quantity("f8", np.nan, (), "1", "sum of the exponents minus its exact value")
    if "convergence" in scene.observe:
        text = "Lyapunov exponents as they converge, in the order of their vectors"
        wanted["lyapunov_running"] = Quantity("f8", np.nan, ("elapsed", "exponent"), "1", text)
    if "impacts" in scene.observe:
        wanted["impacts_right"] = Quantity("i8", -1, (), "1", "impacts on the right stop in the recorded periods")
        wanted["impacts_left"] = Quantity("i8", -1, (), "1", "impacts on the left stop in the recorded periods")
        wanted["min_impact_speed"] = Quantity(
            "f8", np.nan, (), "1", "smallest |v_1| before an impact in the recorded periods"
        )
        text = "largest distance from the stop at which an impact was computed"
        wanted["contact_error"] = Quantity("f8", np.nan, (), "1", text)
        wanted["sticking_time"] = Quantity("f8", np.nan, (), "1", "time at rest on a stop in the recorded periods")
    if scene.trajectory:
        for name, (units, long_name) in _SECTION.items():
            text = long_name.replace(" at the section", " along the orbit")
            wanted[f"trajectory_{name}"] = Quantity("f8", np.nan, ("time",), units, text)
    wanted["status"] = Quantity("i1", NOT_COMPUTED, (), "1", "outcome of the computation")
    return wanted


def coordinates(scene: Scene) -> dict[str, np.ndarray]:
    """Every dimension of the scene's file, in order, with its coordinate."""
    result = dict(scene.sweep)
    if scene.n_starts > 1:
        both = scene.start.direction == "both"
        result["start"] = np.array(["up", "down"]) if both else np.arange(scene.n_starts)
    extra = {dimension for quantity in quantities(scene).values() for dimension in quantity.extra}
    if "sample" in extra:
        result["sample"] = np.arange(scene.record)
    if "exponent" in extra:
        result["exponent"] = np.arange(1, 5)
    if "elapsed" in extra:
        parts = min(RUNNING, scene.record)
        result["elapsed"] = np.array([periods_read.py_func(m, parts, scene.record) for m in range(parts)])
    if "time" in extra:
        result["time"] = np.linspace(0.0, scene.trajectory.periods, scene.trajectory.samples)
    return result


def size(scene: Scene) -> int:
    """Bytes of the scene's file, but for a few kilobytes of structure."""
    extents = {name: len(values) for name, values in coordinates(scene).items()}
    total = 0
    for quantity in quantities(scene).values():
        shape = scene.shape + tuple(extents[dimension] for dimension in quantity.extra)
        total += math.prod(shape) * np.dtype(quantity.dtype).itemsize
    return total + 8 * sum(extents.values())


class Writer:
    """The open file of a run."""

    def __init__(self, file: h5py.File, part: Path, path: Path):
        self._file, self._part, self._path = file, part, path

    def missing(self) -> np.ndarray:
        """Which points of the sweep have an orbit that is not computed yet, bool of the sweep's shape."""
        status = self._file["status"][()]
        starts = status.ndim > len(self._file.attrs["sweep_dimensions"])
        return np.any(status == NOT_COMPUTED, axis=-1) if starts else np.asarray(status == NOT_COMPUTED)

    def write(self, box: tuple[slice, ...], arrays: dict[str, np.ndarray]) -> None:
        """Put a block in its place, and on the disk."""
        for name in self._file.attrs["quantities"]:
            self._file[name][box] = arrays[name]
        self._file.flush()
        self._file["status"][box] = arrays["status"]
        self._file.flush()

    def finish(self, provenance: dict) -> dict[int, int]:
        """Give the file its name. Returns how many orbits have which status."""
        codes, counts = np.unique(self._file["status"][()], return_counts=True)
        if not self._part.exists():  # it was complete before
            return dict(zip(codes.tolist(), counts.tolist(), strict=True))
        now = datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
        self._file.attrs["history"] = self._file.attrs["history"] + f"\n{now} complete"
        self._file.attrs["provenance"] = json.dumps(_made_by() | provenance)
        self._file.close()
        with self._part.open("rb") as file:
            os.fsync(file.fileno())
        os.replace(self._part, self._path)
        return dict(zip(codes.tolist(), counts.tolist(), strict=True))


@contextlib.contextmanager
def writer(scene: Scene, path: Path, mode: str):
    """The `Writer` of a scene's file; `mode` is "new", "resume" or "overwrite". Raises StoreError."""
    part = Path(f"{path}.part")
    if mode == "new":
        for old in (path, part):
            if old.exists():
                raise StoreError(f"{old} exists; `resume` continues it, `overwrite` replaces it")
    if mode == "resume" and part.exists():
        file = _open(part, "r+")
    elif mode == "resume" and path.exists():
        file = _open(path, "r")
    else:
        file = _create(scene, part)
    try:
        _check_origin(file, scene)
        yield Writer(file, part, path)
    finally:
        file.close()


def _locking(path: Path) -> bool | None:
    """Readers do not lock a file that is being written; all others do as HDF5 does by default."""
    return False if path.suffix == ".part" else None


def _open(path: Path, mode: str) -> h5py.File:
    try:
        file = h5py.File(path, mode, locking=_locking(path) if mode == "r" else None)
    except BlockingIOError:
        raise StoreError(f"{path} is being written by another run") from None
    except FileNotFoundError:
        raise StoreError(f"{path}: there is no such file") from None
    except OSError as error:
        raise StoreError(f"{path} is not an HDF5 file, or it is damaged ({error})") from None
    if "status" not in file or "scene" not in file.attrs:
        file.close()
        raise StoreError(f"{path} is an HDF5 file, but none that vibro-sweep wrote")
    return file


def _check_origin(file: h5py.File, scene: Scene) -> None:
    """A run is continued by the scene and the kernels that began it, or its points would not belong together."""
    if file.attrs["scene"] != scene.text:
        raise StoreError(f"{file.filename} was made from another scene; name another file, or overwrite it")
    made_by = json.loads(file.attrs["provenance"])
    if file.mode == "r+" and made_by["kernels"] != source_hash():
        raise StoreError(
            f"{file.filename} was begun by vibro_sweep {made_by['vibro_sweep']} with other kernels; overwrite it"
        )


def _made_by() -> dict:
    return {"vibro_sweep": __version__, "kernels": source_hash()}


def _discard(part: Path) -> None:
    """Remove what an interrupted run left, unless it is not interrupted: HDF5 truncates a file before it locks it."""
    if not part.exists():
        return
    try:
        h5py.File(part, "r+").close()
    except BlockingIOError:
        raise StoreError(f"{part} is being written by another run") from None
    except OSError:  # damaged
        pass
    part.unlink()


def _create(scene: Scene, part: Path) -> h5py.File:
    """The whole file, with nothing computed yet."""
    _discard(part)
    try:
        file = h5py.File(part, "x")
    except FileExistsError:
        raise StoreError(f"{part} is being written by another run") from None
    wanted = quantities(scene)
    now = datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
    file.attrs["Conventions"] = "CF-1.11"
    file.attrs["title"] = f"vibro_sweep: {scene.name}"
    file.attrs["history"] = f"{now} begun by vibro_sweep {__version__}"
    file.attrs["scene"] = scene.text
    file.attrs["provenance"] = json.dumps(_made_by())
    file.attrs["sweep_dimensions"] = list(scene.sweep) or np.empty(0, h5py.string_dtype())
    file.attrs["quantities"] = [name for name in wanted if name != "status"] or np.empty(0, h5py.string_dtype())
    axes = coordinates(scene)
    for name, values in axes.items():
        text = values.dtype.kind == "U"
        file.create_dataset(
            name, data=values.astype(object) if text else values, dtype=h5py.string_dtype() if text else None
        )
        file[name].make_scale(name)
        file[name].attrs["units"], file[name].attrs["long_name"] = _AXES[name]
    lead = [name for name in axes if name in scene.sweep or name == "start"]
    for name, quantity in wanted.items():
        dimensions = (*lead, *quantity.extra)
        create = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        create.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
        dataset = file.create_dataset(
            name,
            shape=tuple(len(axes[dimension]) for dimension in dimensions),
            dtype=quantity.dtype,
            fillvalue=quantity.fill,
            dcpl=create,
        )
        dataset.attrs["units"], dataset.attrs["long_name"] = quantity.units, quantity.long_name
        for i, dimension in enumerate(dimensions):
            dataset.dims[i].attach_scale(file[dimension])
    file["status"].attrs["flag_values"] = np.array(list(MEANINGS), np.int8)
    file["status"].attrs["flag_meanings"] = " ".join(MEANINGS.values())
    file.flush()
    return file


def open(path):  # the name that users of xarray expect
    """The file as an `xarray.Dataset`, with coordinates. Raises StoreError for a file that is none of ours."""
    import xarray

    path = Path(path)
    _open(path, "r").close()
    return xarray.open_dataset(path, engine="h5netcdf", driver_kwds={"locking": _locking(path)})


def describe(path: str | Path) -> str:
    """What is in a file, how it was made, how far it is, and how accurate it says it is. Raises StoreError."""
    with _open(Path(path), "r") as file:
        status = np.atleast_1d(file["status"][()])
        sweep = list(file.attrs["sweep_dimensions"])
        lines = [f"{path}: {file.attrs['title']}"]
        for name in sweep:
            values = file[name]
            lines.append(f"  {name:<10} {values[0]:g} .. {values[-1]:g} ({len(values):,} values)")
        if "start" in file:
            lines.append(f"  {'start':<10} {len(file['start'])} at each point")
        lines.append("datasets")
        for name in (*file.attrs["quantities"], "status"):
            dataset = file[name]
            lines.append(
                f"  {name:<18} {' x '.join(map(str, dataset.shape)) or 'one':<16} {dataset.attrs['long_name']}"
            )
        done = int(np.count_nonzero(status != NOT_COMPUTED))
        lines.append(f"computed     {done:,} of {status.size:,} orbits ({100 * done / status.size:.4g} %)")
        for code, meaning in MEANINGS.items():
            count = int(np.count_nonzero(status == code))
            if code not in (OK, NOT_COMPUTED) and count:
                lines.append(f"  {meaning}: {count:,}")
        lines += _accuracy(file)
        lines.append("made by")
        lines += [
            f"  {key:<12} {value}" for key, value in json.loads(file.attrs["provenance"]).items() if value is not None
        ]
        lines += [f"  {entry}" for entry in file.attrs["history"].splitlines()]
        return "\n".join(lines)


def _accuracy(file: h5py.File) -> list[str]:
    lines = []
    if "lyapunov_residual" in file:
        residual, found = np.abs(file["lyapunov_residual"][()]), file["lyapunov"][..., 0]
        checked = np.isfinite(residual)
        total = np.count_nonzero(np.isfinite(found))
        if checked.any():
            lines.append(f"accuracy     |sum of exponents - exact sum| <= {np.max(residual[checked]):.2g}")
        if checked.sum() < total:
            lines.append(
                f"             not known where dimensions are lost: {total - checked.sum():,} of {total:,} orbits"
            )
    if "contact_error" in file:
        missed = file["contact_error"][()]
        if np.isfinite(missed).any():
            lines.append(f"             impacts were found within {np.nanmax(missed):.2g} of the stop")
    if "min_impact_speed" in file:
        speed = file["min_impact_speed"][()]
        if np.isfinite(speed).any():
            lines.append(f"             slowest impact {np.nanmin(speed):.2g}: the nearest to a graze")
    return lines
