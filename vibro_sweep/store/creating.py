"""HDF5 files as they are made in memory: the skeleton of a run, and the head that files of all kinds have."""

import datetime
import io
import json
from collections.abc import Callable, Iterator

import h5py
import numpy as np

from vibro_sweep import __version__
from vibro_sweep.model.branch_file import SWEEP
from vibro_sweep.scene import Scene
from vibro_sweep.store import datasets, heap, layout, numbers, parts
from vibro_sweep.store.attributes import set_text, set_texts
from vibro_sweep.store.checks import Piece
from vibro_sweep.store.image import Frame
from vibro_sweep.store.opening import made_by
from vibro_sweep.store.sink import LIBVER


def skeleton_of(scene: Scene, run_id: bytes) -> memoryview:
    """The bytes of an HDF5 file."""

    def fill(file: h5py.File) -> None:
        set_texts(file, "sweep_dimensions", list(scene.sweep))
        for name, value in numbers.attributes(scene).items():
            file.attrs[name] = value
        datasets.create(file, scene)

    names = [name for name in layout.quantities(scene) if name != "status"]
    return image_of(SWEEP, scene.name, scene.text, run_id, made_by(), names, fill)


def image_of(
    kind: str,
    title: str,
    scene: str,
    run_id: bytes,
    provenance: dict,
    quantities: list[str],
    fill: Callable[[h5py.File], None],
) -> memoryview:
    """The bytes of an HDF5 file of any kind; `fill` writes what only this kind has."""
    image = io.BytesIO()
    with h5py.File(image, "w", libver=LIBVER) as file:
        file.attrs["format"] = parts.FORMAT
        set_text(file, "identity", run_id.hex())
        set_text(file, "Conventions", "CF-1.11")
        set_text(file, "kind", kind)
        set_text(file, "title", f"vibro_sweep: {title}")
        set_text(file, "history", f"{now()} begun by vibro_sweep {__version__}")
        set_text(file, "scene", scene)
        set_text(file, "provenance", json.dumps(provenance))
        set_texts(file, "quantities", quantities)
        fill(file)
    found = [(at, *heap.measured(image, at)) for at in heap.collections(image)]
    with h5py.File(image, "r+", libver=LIBVER) as file:
        file.attrs["heap"] = np.array(found, np.uint64).reshape(-1)
    return image.getbuffer()


def units(file: h5py.File, frame: Frame) -> Iterator[Piece]:
    """Boxes of the orbits that together are all of them, each within one chunk of the dataset with the most numbers."""
    largest = max(frame.datasets, key=lambda name: np.prod(frame.datasets[name][1][len(frame.shape) :]))
    edges = (file[largest].chunks or ())[: len(frame.shape)]
    counts = [-(-extent // edge) for extent, edge in zip(frame.shape, edges, strict=True)]
    for corner in np.ndindex(*counts):
        yield tuple(
            slice(at * edge, min(at * edge + edge, extent))
            for at, edge, extent in zip(corner, edges, frame.shape, strict=True)
        )


def now() -> str:
    """The time as the history of a file has it."""
    return datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
