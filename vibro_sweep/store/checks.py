"""Going through a file in pieces that fit into memory: counting, and finding what its checksums do not confirm."""

from collections import Counter
from collections.abc import Iterator

import h5py
import numpy as np

from vibro_sweep.store.attributes import is_flat, texts
from vibro_sweep.store.opening import axes_of, following_of
from vibro_sweep.store.ragged_checks import damage_of
from vibro_sweep.tables.outcomes import NOT_COMPUTED

Piece = tuple[slice, ...]  # the box of a chunk; () for a dataset of one number


def pieces(dataset: h5py.Dataset) -> list[Piece]:
    """The chunks that have their place in the file; where nothing is computed yet there are none."""
    if not dataset.chunks:
        return [()]
    corners = []
    dataset.id.chunk_iter(lambda chunk: corners.append(chunk.chunk_offset))
    lengths = list(zip(dataset.chunks, dataset.shape, strict=True))
    return [
        tuple(slice(at, min(at + most, end)) for at, (most, end) in zip(corner, lengths, strict=True))
        for corner in corners
    ]


def statuses(file: h5py.File) -> Counter:
    """The number of orbits with each status; those whose status cannot be read count as not computed."""
    counts = Counter()
    for _, values in readable(file["status"]):
        codes, numbers = np.unique(values, return_counts=True)
        counts.update(dict(zip(codes.tolist(), numbers.tolist(), strict=True)))
    counts[NOT_COMPUTED] += file["status"].size - counts.total()
    return +counts


def readable(dataset: h5py.Dataset) -> Iterator[tuple[Piece, np.ndarray]]:
    """The chunks whose checksums hold, and what is in them."""
    return ((piece, values) for piece, values in _read(dataset) if values is not None)


def damaged(file: h5py.File) -> list[tuple[str, Piece]]:
    """Every chunk whose checksum is wrong, with the name of its dataset, `status` first; () for all of a dataset."""
    names = ["status", *axes_of(file), *following_of(file), *texts(file, "quantities")]
    return [(name, piece) for name in names for piece, values in _read(file[name]) if values is None]


def damage(file: h5py.File, lost: int = 0) -> str:
    """The damage of a file, or of a part with so many `lost` blocks, in words; empty where there is none."""
    if lost:
        return blocks_lost(lost)
    return damage_of(file) if is_flat(file) else summary(damaged(file))


def blocks_lost(count: int) -> str:
    """Damaged blocks of a part, in words."""
    return f"{count} block{'s' if count > 1 else ''} of the run"


def _read(dataset: h5py.Dataset) -> Iterator[tuple[Piece, np.ndarray | None]]:
    """Every chunk and what is in it, None where that cannot be read."""
    try:
        found = pieces(dataset)
    except (OSError, RuntimeError):  # the list of chunks itself is damaged
        yield (), None
        return
    for piece in found:
        try:
            values = dataset[piece]
        except OSError:
            values = None
        yield piece, values


def summary(found: list[tuple[str, Piece]]) -> str:
    """The damaged datasets, for a message."""
    chunks = Counter(name for name, _ in found)
    return ", ".join(f"{name} ({count} chunk{'s' if count > 1 else ''})" for name, count in chunks.items())
