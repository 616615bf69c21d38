"""The file from which something is computed: where what it holds is refused, the message names it."""

import hashlib
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.checks.arguments import check_type
from vibro_sweep.checks.errors import VibroSweepError
from vibro_sweep.checks.file_names import FileError
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.reading import sweep_in, warn_where_incomplete
from vibro_sweep.oscillator.function_model import BUILD
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.scene import Continuation, parse_scene
from vibro_sweep.tables.file_columns import SWEEP

if TYPE_CHECKING:
    import xarray


class SourceError(VibroSweepError, ValueError):
    """A file or scene cannot be computed from: a file, or a scene's `continue: from`; the message says from which."""


@contextmanager
def computed_from(path: str | Path, key: str = "") -> Iterator[None]:
    """Name the file, and the key of the scene that has its name, in what is refused while one computes from it.

    Values that have passed all checks of the file may be refused much later, by whatever computes with them. Errors
    that name a file already are left as they are: it may be another one, which is written.
    """
    try:
        yield
    except (SourceError, StoreError, FileError):
        raise
    except ValueError as error:
        raise SourceError(f"{key}{path}: {error}") from error


@contextmanager
def swept(data: "str | Path | xarray.Dataset") -> Iterator[Sweep]:
    """The results of a sweep from which something is computed: its file, or a Dataset of `open` or `sweep`.

    What is refused while they are used is said with the name of the file. Raises StoreError, SourceError, and TypeError
    for anything else.
    """
    if not isinstance(data, (str, Path)):
        from xarray import Dataset  # it is imported already where it is one

        check_type("data", data, Dataset, "the path of a file, or a Dataset")
        if not {"scene", "sweep_dimensions"} <= data.attrs.keys():
            raise SourceError("data: this dataset is not one of `vibro_sweep.open` or `vibro_sweep.sweep`")
    name = data if isinstance(data, (str, Path)) else "data"
    with computed_from(name), sweep_in(data, computes=True) as sweep:
        warn_where_incomplete(sweep.data)
        yield sweep


def computed_from_source(scene: Continuation) -> AbstractContextManager[None]:
    """The same for the file that a scene begins from, if any."""
    if scene.origin not in ("sweep", "branches"):
        return nullcontext()
    return computed_from(scene.begin, f"continue.from.{scene.origin}: ")


def run_id_of(data: Sweep) -> str:
    """The run that computed a sweep; of a part, which has windows of its own, also the values that it has."""
    known = str(data.attrs.get("identity", ""))
    if data.attrs.get("kind", SWEEP) != SWEEP or data.attrs.get("type") == BUILD:
        return known
    scene = parse_scene(data.attrs["scene"])
    whole = {**scene.sweep, **({"start": range(scene.n_starts)} if scene.n_starts > 1 else {})}
    values = {name: np.atleast_1d(data.data[name].values) for name in whole if name in data.data.coords}
    if all(name in values and len(values[name]) == len(axis) for name, axis in whole.items()):
        return known
    named = repr([known, *((name, swept_values.tolist()) for name, swept_values in values.items())])
    return hashlib.sha256(named.encode()).hexdigest()[:32]
