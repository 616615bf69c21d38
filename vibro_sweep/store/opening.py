"""Opening a file or a part for reading: is it one of ours, whole, and what the scene describes? Nothing is written."""

import contextlib
import io
import itertools
import json
import tempfile
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

import h5py
import numpy as np

from vibro_sweep import __version__
from vibro_sweep.model.errors import VibroSweepError
from vibro_sweep.model.files import MissingFileError
from vibro_sweep.model.refusals import cut
from vibro_sweep.store import heap, parts
from vibro_sweep.store.attributes import (
    MATRIX,
    check_dataset,
    check_numbers,
    check_own_dimensions,
    is_flat,
    quantities_of,
    scales_of,
    text,
    texts,
)
from vibro_sweep.store.image import Index, frame_of
from vibro_sweep.store.parts import FORMAT, PartError
from vibro_sweep.store.ragged_checks import damage_of
from vibro_sweep.store.sink import Sink, changing

IN_MEMORY = 2**26  # bytes of a part as HDF5; what is larger goes through a temporary file without a name
REMEDY = "`--resume` computes that again"
NETCDF = "_NCProperties"  # the attribute by which a netCDF library says that it has made the file
TEXTS = ("title", "history", "scene", "provenance")


class StoreError(VibroSweepError, ValueError):
    """A file that is in the way, is not one of ours, is damaged or does not fit the scene; or a disk that fails.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> try:
    ...     vs.open("nothing.h5")
    ... except vs.StoreError as error:
    ...     print(error)
    nothing.h5: there is no such file
    """


class MissingError(StoreError, MissingFileError):
    """A file does not exist."""


class ForeignError(StoreError):
    """Another program has written this file from one of ours (store/foreign.py)."""

    def __init__(self, path: Path, program: str):
        super().__init__(path, program)
        self.path, self.program = path, cut(program.replace("=", " "))

    def __str__(self):
        return (
            f"{self.path} was not written by this program, but by {self.program} from a file of this program: nothing "
            "tells whether its numbers are still those that were computed"
        )


class Opened(NamedTuple):
    """A file for reading; of a part, how many of its blocks are damaged and therefore not in it."""

    file: h5py.File
    lost: int


@contextlib.contextmanager
def opened(path: Path, names: Collection[str] | None = None, content: bool = True) -> Iterator[Opened]:
    """A file for reading, or what a part holds; of the part only the datasets in `names`. Raises StoreError.

    content : as of `checked`
    """
    result = open_file(path, names, content)
    with result.file:
        yield result


def open_file(path: Path, names: Collection[str] | None = None, content: bool = True) -> Opened:
    """The same as `opened`, for callers that close the file themselves."""
    try:
        with parts.open_regular(path) as raw:
            if parts.is_part(raw):
                return _from_part(raw, path, names)
            return Opened(checked(path, path, raw, content), 0)
    except FileNotFoundError:
        raise MissingError(path) from None
    except PartError as error:
        raise StoreError(f"{path} {error}") from None


def _from_part(raw: BinaryIO, path: Path, names: Collection[str] | None) -> Opened:
    """The part as HDF5, in memory or in a temporary file that has no name."""
    image = tempfile.SpooledTemporaryFile(IN_MEMORY)
    try:
        with skeleton(raw, path, image) as file:
            if is_flat(file):
                kind = cut(text(file, "kind"))
                raise StoreError(
                    f"{path} is a run of {kind} that is not complete; where it is not being written, `--resume` "
                    "continues it"
                )
            index = Index(raw, parts.read_head(raw), frame_of(file))
        sink = Sink(image)
        with changing(sink) as file:
            index.fill(raw, file, sink, names)
        return Opened(h5py.File(image, "r"), index.damaged)
    except OSError as error:
        raise StoreError(f"{path} cannot be read by way of {tempfile.gettempdir()}: {error}") from None


def skeleton(raw: BinaryIO, path: Path, image: BinaryIO | None = None) -> h5py.File:
    """The empty file that a part begins with, copied into `image` or into memory. Raises StoreError, PartError."""
    image = image or io.BytesIO()
    parts.copy_skeleton(raw, parts.read_head(raw), image)
    return checked(image, path, image)


def checked(source: Path | BinaryIO, path: Path, raw: BinaryIO, content: bool = True) -> h5py.File:
    """A file, if it is one of ours; `raw` are its bytes. Raises StoreError.

    content : whether branches, windows and curves must hold what such files do; else they only say what they are
    """
    try:
        result = h5py.File(source, "r")
    except OSError as error:
        if path.suffix.lower() in (".yaml", ".yml"):
            raise StoreError(f"{path} is a scene, not an HDF5 file: `vibro-sweep run {path}` makes that") from None
        raise StoreError(f"{path} is not an HDF5 file, or it is damaged ({error})") from None
    try:
        if not {"kind", "scene"} <= result.attrs.keys():
            raise StoreError(f"{path} is an HDF5 file, but none that vibro-sweep wrote")
        if NETCDF in result.attrs:
            for at in heap.collections(raw):
                heap.measured(raw, at)  # HDF5 can walk through it
            raise ForeignError(path, text(result, NETCDF).removeprefix("version=2,"))
        if (found := result.attrs.get("format")) != FORMAT:
            raise StoreError(
                f"{path} has the format {cut(str(found))} of another version of vibro_sweep; this one reads {FORMAT}"
            )
        _check_heap(result, raw)
        _check(result)
        if content and is_flat(result) and (found := damage_of(result)):
            raise StoreError(f"{path} is damaged: {found}; {REMEDY}")
        return result
    except StoreError:
        result.close()
        raise
    except (OSError, RuntimeError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        result.close()
        raise StoreError(f"{path} is damaged ({error})") from None


def _check_heap(file: h5py.File, raw: BinaryIO) -> None:
    for at, last, checksum in np.reshape(file.attrs["heap"], (-1, 3)).tolist():
        heap.verify(raw, at, last, checksum)


def _check(file: h5py.File) -> None:
    """Raise ValueError and the like for what a file of ours has not; what else is in it does not matter."""
    for name in TEXTS:
        text(file, name)
    provenance = json.loads(text(file, "provenance"))
    if not isinstance(provenance, dict):
        raise ValueError("its provenance is not a JSON object")
    check_numbers(file)
    if is_flat(file):
        return
    axes = texts(file, "sweep_dimensions")
    for name in [*axes, *quantities_of(file)]:
        check_dataset(file, name)
    shape, sweep = file["status"].shape, tuple(len(file[name]) for name in axes)
    if shape[: len(sweep)] != sweep or len(shape) - len(sweep) not in (0, 1):
        raise ValueError("its datasets do not fit together: `status` and the sweep")
    extents = {}  # of the axes that are checked
    for name, dimensions in dimensions_of(file).items():
        dataset = file[name]
        if dataset.dtype.kind not in "if" or dataset.shape[: len(shape)] != shape:
            raise ValueError(f"its datasets do not fit together: `status` and `{name}`")
        check_own_dimensions(name, dataset.ndim - len(shape))
        for axis, extent in zip(dimensions, dataset.shape, strict=True):
            if axis not in extents:
                check_dataset(file, axis)
                extents[axis] = file[axis].shape
            if extents[axis] != (extent,):
                raise ValueError(f"its datasets do not fit together: `{name}` and its axis `{axis}`")
    for name in text(file, "coordinates").split() if "coordinates" in file.attrs else []:
        check_dataset(file, name)
    for name, along in following_of(file).items():
        if not set(along) <= {*axes, *MATRIX} or file[name].shape != tuple(len(file[axis]) for axis in along):
            raise ValueError(f"its datasets do not fit together: `{name}` and its axes")
    for name in axes:
        if file[name].dtype.kind not in "if":
            raise ValueError(f"the axis `{name}` holds no numbers")


def dimensions_of(file: h5py.File) -> dict[str, list[str]]:
    """Names of each quantity's dimensions: those of the sweep, `start` if there is one, its own by their scales."""
    lead = _lead_of(file)
    return {name: [*lead, *scales_of(file[name], len(lead))] for name in quantities_of(file)}


def _lead_of(file: h5py.File) -> list[str]:
    """Names of the dimensions of `status`, with which those of all quantities begin; none of branches and windows."""
    if is_flat(file):
        return []
    lead = texts(file, "sweep_dimensions")
    return [*lead, *["start"] * (file["status"].ndim - len(lead))]


def axes_of(file: h5py.File) -> list[str]:
    """All dimensions of a file that have coordinates: none of branches or windows."""
    if is_flat(file):
        return []
    return list(dict.fromkeys(itertools.chain(*dimensions_of(file).values())))


def following_of(file: h5py.File) -> dict[str, list[str]]:
    """The coordinates that follow from the axes (b_star, tau), in a file that has any, and over which axes they are."""
    names = text(file, "coordinates").split() if "coordinates" in file.attrs else []
    return {name: scales_of(file[name]) for name in names}


def is_dataset(file: h5py.File, name: str) -> bool:
    """Whether it has that dataset itself."""
    try:
        check_dataset(file, name)
    except (OSError, RuntimeError, ValueError, KeyError):
        return False
    return True


def check_version(file: h5py.File, path: Path, made_by: dict) -> None:
    """Raise StoreError where the code that began a file is not that of `made_by`."""
    old, code = json.loads(text(file, "provenance")), made_by["code"]
    begun = f"{path} was begun by vibro_sweep {cut(str(old.get('vibro_sweep')))}"
    if old.get("code") != code:
        raise StoreError(
            f"{begun}, code {cut(str(old.get('code')))}, and this is vibro_sweep {__version__} with other code, "
            f"{code}, another numpy or numba, or a processor that rounds otherwise (README, Tested); overwrite it"
        )
