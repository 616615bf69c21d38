"""What a file holds: its numbers bit for bit, the words of its codes, and what `info` says of it."""

from pathlib import Path

import h5py

import vibro_sweep as vs
from support.programs import ended


def arrays_of(path) -> dict:
    with h5py.File(path) as file:
        return {name: dataset[()] for name, dataset in file.items() if isinstance(dataset, h5py.Dataset)}


def numbers(path) -> dict[str, bytes]:
    """All numbers and words of a file, bit for bit."""
    arrays = arrays_of(path).items()
    return {name: (values.astype(str) if values.dtype == object else values).tobytes() for name, values in arrays}


def words_of(variable) -> list[str]:
    """The words that the codes of a variable stand for, by what its file says of them."""
    meanings = zip(variable.attrs["flag_values"].tolist(), variable.attrs["flag_meanings"].split(), strict=True)
    words = dict(meanings)
    return [words[code] for code in variable.values.ravel().tolist()]


def assert_same_bits(one: dict, other: dict) -> None:
    """Two files' arrays are equal; the names of starts are compared as words."""
    assert one.keys() == other.keys() and one
    for name, values in one.items():
        if values.dtype == object:
            assert values.tolist() == other[name].tolist()
        else:
            assert values.shape == other[name].shape and values.tobytes() == other[name].tobytes(), name


def described(path) -> str:
    """What `info` prints of a file, also of a damaged one. Raises StoreError with its message where it refuses it."""
    end = ended("info", path)
    if end.status == 2 and not end.out:
        raise vs.StoreError(end.err)
    assert end.status == (2 if "\ndamaged" in end.out else 0), end.err
    return end.out


def bytes_in(folder: Path) -> dict[str, bytes]:
    """The bytes of all files below a folder, by their names."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
