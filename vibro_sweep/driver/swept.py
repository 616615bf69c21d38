"""The results of a sweep from which something is computed: its file, or a Dataset that is in memory."""

import hashlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep import store
from vibro_sweep.analysis.windows.rows import Contents
from vibro_sweep.driver.source_file import SourceError, computed_from
from vibro_sweep.model.arguments import check_type
from vibro_sweep.model.built import BUILD
from vibro_sweep.model.files import checked_path
from vibro_sweep.scene import parse_scene
from vibro_sweep.tables.file_columns import SWEEP

if TYPE_CHECKING:
    import xarray


@contextmanager
def contents_of(data: "str | Path | xarray.Dataset") -> Iterator[Contents]:
    """The numbers of a file, or of a Dataset of `vibro_sweep.open` or `vibro_sweep.sweep`.

    What is refused while they are used is said with the name of the file. Raises StoreError, SourceError, and TypeError
    for anything else.
    """
    if isinstance(data, (str, Path)):
        path = checked_path("data", data)
        with computed_from(path), store.contents(path) as found:
            yield found
        return
    from xarray import Dataset  # it is imported already where it is one

    check_type("data", data, Dataset, "the path of a file, or a Dataset")
    with computed_from(str(data.encoding.get("source", "data"))):
        if not {"scene", "sweep_dimensions"} <= data.attrs.keys():
            raise SourceError("data: this dataset is not one of `vibro_sweep.open` or `vibro_sweep.sweep`")
        yield DatasetContents(data)


class DatasetContents:
    """The same as `Contents` of a file (store/arrays.py), of a Dataset or of a part of one that `sel` and the like have
    cut out. A part has a run id of its own: windows of another part, or of the whole, are not taken for its windows."""

    def __init__(self, data: "xarray.Dataset"):
        self._data = data
        swept = [str(name) for name in np.atleast_1d(data.attrs["sweep_dimensions"])]
        self.attrs: dict[str, Any] = data.attrs | {"sweep_dimensions": [name for name in swept if name in data.dims]}
        self.chosen = {name: float(data[name]) for name in swept if name not in data.dims and name in data.coords}
        self.sizes = {str(name): size for name, size in data.sizes.items()}
        if (part := self._part(swept)) is not None:
            self.attrs["identity"] = part

    def _part(self, swept: list[str]) -> str | None:
        """The run id of a part: of its run, and of the values that it has; None of the whole, and of what has no
        windows (`check_data`)."""
        if self.attrs.get("kind", SWEEP) != SWEEP or self.attrs.get("type") == BUILD:
            return None
        scene = parse_scene(self.attrs["scene"])
        axes = {**scene.sweep, **({"start": range(scene.n_starts)} if scene.n_starts > 1 else {})}
        values = {
            name: np.atleast_1d(self._data[name].values) for name in [*swept, "start"] if name in self._data.coords
        }
        if all(name in values and len(values[name]) == len(axis) for name, axis in axes.items()):
            return None
        named = repr([self.attrs.get("identity", ""), *((name, one.tolist()) for name, one in values.items())])
        return hashlib.sha256(named.encode()).hexdigest()[:32]

    def __contains__(self, name: str) -> bool:
        return name in self._data.data_vars

    def dims(self, name: str) -> list[str]:
        """Names of the dimensions of a quantity."""
        return [str(dim) for dim in self._data[name].dims]

    def values(self, name: str, first: Sequence[str] = ()) -> np.ndarray:
        """The values of a quantity or a dimension, with these dimensions first, in their order."""
        variable = self._data[name].variable
        return np.asarray((variable.transpose(*first, ...) if first else variable).values)
