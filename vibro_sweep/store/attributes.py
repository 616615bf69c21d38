"""Texts as attributes of fixed length: they lie in the headers of HDF5, which have checksums; those of variable length
lie in its heap, which has none."""

import h5py
import numpy as np

from vibro_sweep.model import catalogue
from vibro_sweep.model.refusals import cut
from vibro_sweep.model.wording import sentence
from vibro_sweep.tables.file_columns import SWEEP
from vibro_sweep.tables.quantity import Observable, Quantity

# the attributes of a file that hold a number, or a word, for all points (scene/resolved_numbers.py)
NUMBERS = (*catalogue.NUMBERS, "order", "expand_at", "transient", "settle", "record")
WORDS = ("stops", "dynamics", "type", "section", "section_stop")
MATRIX = ("row", "column")  # the dimensions of a matrix
# how HDF5 joins datasets and their dimensions, and how CF names coordinates
SCALES = ("CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST", "coordinates")


def set_text(of: h5py.File | h5py.Dataset, name: str, value: str) -> None:
    raw = value.encode()
    of.attrs.create(name, np.bytes_(raw), dtype=h5py.string_dtype("utf-8", max(1, len(raw))))


def set_texts(of: h5py.File | h5py.Dataset, name: str, values: list[str]) -> None:
    raw = [value.encode() for value in values]
    kind = h5py.string_dtype("utf-8", max([2, *map(len, raw)]))  # h5netcdf takes those of length 1 for characters
    of.attrs.create(name, np.array(raw) if raw else h5py.Empty(kind), dtype=kind)


def set_value(of: h5py.File | h5py.Dataset, name: str, value: str | list[str] | float | np.ndarray) -> None:
    if isinstance(value, str):
        set_text(of, name, value)
    elif isinstance(value, list):
        set_texts(of, name, value)
    else:
        of.attrs[name] = value


def describe(dataset: h5py.Dataset, units: str, long_name: str, description: str) -> None:
    """Set its attributes for readers: `long_name` is short, for axes; `description` is a sentence."""
    for name, value in (("units", units), ("long_name", long_name), ("description", sentence(description))):
        set_text(dataset, name, value)


def set_flags(dataset: h5py.Dataset, quantity: Quantity) -> None:
    """The words of its codes, as CF has them."""
    if quantity.flags:
        dataset.attrs["flag_values"] = np.array(quantity.codes, quantity.dtype)
        set_text(dataset, "flag_meanings", " ".join(quantity.flags))


def text(of: h5py.File | h5py.Dataset, name: str) -> str:
    """An attribute that is a text, of either kind. Raises KeyError, ValueError."""
    value = of.attrs[name]
    if isinstance(value, bytes):
        value = value.decode()
    if not isinstance(value, str):
        raise ValueError(f"its attribute `{name}` is not a text")
    return value


def texts(of: h5py.File | h5py.Dataset, name: str) -> list[str]:
    """An attribute that is a list of texts. Raises KeyError, ValueError."""
    values = of.attrs[name]
    found = [] if isinstance(values, h5py.Empty) else np.asarray(values, object).ravel().tolist()
    return [value.decode() if isinstance(value, bytes) else str(value) for value in found]


def is_flat(file: h5py.File) -> bool:
    """Whether it holds branches, curves or windows, and no sweep."""
    return text(file, "kind") != SWEEP


def quantities_of(file: h5py.File) -> list[str]:
    """The datasets that blocks fill."""
    return [*texts(file, "quantities"), "status"]


def scales_of(dataset: h5py.Dataset, first: int = 0) -> list[str]:
    """Names of its dimensions from this one on."""
    return [dataset.dims[i][0].name.removeprefix("/") for i in range(first, dataset.ndim)]


def attributes(of: h5py.File | h5py.Dataset) -> dict:
    """All but those by which HDF5 joins datasets, as xarray has them."""
    return {name: _decoded(of.attrs[name]) for name in of.attrs if name not in SCALES}


def _decoded(value):
    """Texts as texts, a number as one."""
    if isinstance(value, h5py.Empty):
        return []
    if isinstance(value, bytes):
        return value.decode()
    if isinstance(value, np.ndarray) and value.dtype.kind in "SO":
        found = [item.decode() if isinstance(item, bytes) else item for item in value.tolist()]
        return found if len(found) != 1 else found[0]
    return value[0] if isinstance(value, np.ndarray) and value.shape == (1,) else value


def check_numbers(file: h5py.File) -> None:
    """Raise KeyError or ValueError where an attribute of `NUMBERS` or `WORDS` is something else."""
    for name in NUMBERS:
        value = np.asarray(file.attrs.get(name, 0))
        if value.ndim or value.dtype.kind not in "if":
            raise ValueError(f"its attribute `{name}` is not a number")
    along = np.asarray(file.attrs.get("contact_normal", [1.0]))
    if along.ndim != 1 or along.dtype.kind not in "if" or not np.isfinite(along).all():
        raise ValueError("its attribute `contact_normal` is not a list of numbers")
    found = {name: text(file, name) for name in WORDS if name in file.attrs}
    if found.get("dynamics") == "map":
        file.attrs["order"]  # without which it is unknown what was iterated


def check_own_dimensions(name: str, own: int) -> None:
    """Raise ValueError where a quantity has not so many dimensions, besides those of the sweep, as it should have."""
    known = catalogue.BY_NAME.get(name)
    if isinstance(known, Observable) and len(known.dimensions) != own:
        raise ValueError(f"its datasets do not fit together: `{name}` and its own dimensions")


def check_dataset(file: h5py.File, name: str) -> None:
    """Raise where it is missing, or leads to another place: links, virtual datasets, external storage."""
    if not isinstance(file.get(name, getlink=True), h5py.HardLink):
        raise ValueError(f"`{cut(name)}` is missing, or is a link")
    dataset = file[name]
    if not isinstance(dataset, h5py.Dataset):
        raise ValueError(f"`{cut(name)}` is not a dataset")
    if dataset.is_virtual or dataset.external:
        raise ValueError(f"the numbers of `{name}` are in another file")
