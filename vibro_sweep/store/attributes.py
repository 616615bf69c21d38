"""Texts as attributes of fixed length: they lie in the headers of HDF5, which have checksums; those of variable length
lie in its heap, which has none."""

import h5py
import numpy as np

from vibro_sweep.model import catalogue

# the attributes of a file that hold a number, or a word, for all points (`numbers.attributes`)
NUMBERS = (*catalogue.NUMBERS, "order", "expand_at", "transient", "record")
WORDS = ("stops", "model", "type", "section", "section_stop")


def set_text(of: h5py.File | h5py.Dataset, name: str, value: str) -> None:
    raw = value.encode()
    of.attrs.create(name, np.bytes_(raw), dtype=h5py.string_dtype("utf-8", max(1, len(raw))))


def set_texts(of: h5py.File | h5py.Dataset, name: str, values: list[str]) -> None:
    raw = [value.encode() for value in values]
    kind = h5py.string_dtype("utf-8", max([2, *map(len, raw)]))  # h5netcdf takes those of length 1 for characters
    of.attrs.create(name, np.array(raw) if raw else h5py.Empty(kind), dtype=kind)


def text(of: h5py.File | h5py.Dataset, name: str) -> str:
    """An attribute that is a text, of either kind. Raises KeyError, ValueError."""
    value = of.attrs[name]
    if isinstance(value, bytes):
        value = value.decode()
    if not isinstance(value, str):
        raise ValueError(f"its attribute `{name}` is no text")
    return value


def texts(of: h5py.File | h5py.Dataset, name: str) -> list[str]:
    """An attribute that is a list of texts. Raises KeyError, ValueError."""
    values = of.attrs[name]
    found = [] if isinstance(values, h5py.Empty) else np.asarray(values, object).ravel().tolist()
    return [value.decode() if isinstance(value, bytes) else str(value) for value in found]


def check_numbers(file: h5py.File) -> None:
    """Raise KeyError or ValueError where an attribute of `NUMBERS` or `WORDS` is something else."""
    for name in NUMBERS:
        value = np.asarray(file.attrs.get(name, 0))
        if value.ndim or value.dtype.kind not in "if":
            raise ValueError(f"its attribute `{name}` is no number")
    found = {name: text(file, name) for name in WORDS if name in file.attrs}
    if found.get("model") == "map":
        file.attrs["order"]  # without which nobody can tell what was iterated
