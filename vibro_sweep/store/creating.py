"""HDF5 files as they are made in memory: the skeleton with which a run of any kind begins."""

import datetime
import io
import json
from collections.abc import Callable, Collection
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import h5py
import numpy as np

from vibro_sweep import __version__
from vibro_sweep.scene import Scene, resolved_numbers
from vibro_sweep.store import datasets, heap, layout, parts
from vibro_sweep.store.attributes import set_text, set_texts, set_value, text
from vibro_sweep.store.sink import LIBVER
from vibro_sweep.tables.file_columns import SWEEP


class Subject(NamedTuple):
    """The subject of a file. Runs of equal subjects make equal files.

    kind : "sweep", "branches", "windows" or "curves"
    scene : the YAML text that was computed; of windows that of the sweep
    attributes : numbers and texts of the file, those that tell its run from others among them
    """

    kind: str
    title: str
    scene: str
    attributes: dict[str, Any]


class Run(NamedTuple):
    """A run of any kind.

    quantities : names of the datasets that its blocks fill; none where sizes are not known before
    create : create(file) makes what is in the file before anything is computed
    size : bytes of the file, as far as known before
    inputs : files that the run reads, which it must not write
    made_by : the versions of what computes it; a run is continued only by the same `code`
    """

    subject: Subject
    quantities: list[str]
    create: Callable[[h5py.File], None]
    size: int
    inputs: Collection[Path]
    made_by: dict[str, Any]


def sweep_run(scene: Scene, made_by: dict[str, Any]) -> Run:
    """The run of a sweep."""

    def create(file: h5py.File) -> None:
        set_texts(file, "sweep_dimensions", list(scene.sweep))
        for name, value in resolved_numbers.attributes(scene).items():
            file.attrs[name] = value
        datasets.create(file, scene)

    subject = Subject(SWEEP, scene.name, scene.text, {})
    return Run(subject, list(layout.quantities(scene)), create, layout.size(scene), scene.inputs, made_by)


def ragged_run(subject: Subject, made_by: dict[str, Any], inputs: Collection[Path] = ()) -> Run:
    """The run of branches, curves or windows; `inputs` are files that it reads."""
    return Run(subject, [], lambda file: set_texts(file, "sweep_dimensions", []), 0, inputs, made_by)


def skeleton_of(run: Run, run_id: bytes) -> bytes:
    """The bytes of the HDF5 file of a run with nothing computed in it."""
    image, subject = io.BytesIO(), run.subject
    with h5py.File(image, "w", libver=LIBVER) as file:
        file.attrs["format"] = parts.FORMAT
        set_text(file, "identity", run_id.hex())
        set_text(file, "Conventions", "CF-1.11")
        set_text(file, "kind", subject.kind)
        set_text(file, "title", f"vibro_sweep: {subject.title}")
        set_text(file, "history", f"{now()} begun by vibro_sweep {__version__}")
        set_text(file, "scene", subject.scene)
        set_text(file, "provenance", json.dumps(run.made_by))
        set_texts(file, "quantities", [name for name in run.quantities if name != "status"])
        for name, value in subject.attributes.items():
            set_value(file, name, value)
        run.create(file)
    seal(image)
    return image.getvalue()  # not getbuffer(): collecting both as garbage crashes Python 3.12


def seal(image: BinaryIO) -> None:
    """Write the checksums of the heap of an HDF5 file into the file."""
    found = [(at, *heap.measured(image, at)) for at in heap.collections(image)]
    with h5py.File(image, "r+", libver=LIBVER) as file:
        file.attrs["heap"] = np.array(found, np.uint64).reshape(-1)


def complete(file: h5py.File, how: dict[str, Any], notes: Collection[str] = ()) -> None:
    """Write into the file how it was computed, what its runs noted, and that it is complete."""
    lines = (text(file, "history"), *notes, f"{now()} complete")
    set_text(file, "history", "\n".join(lines))
    set_text(file, "provenance", json.dumps(json.loads(text(file, "provenance")) | how))


def now() -> str:
    """The time as the history of a file has it."""
    return datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
