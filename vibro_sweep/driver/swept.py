"""The results of a sweep from which something is computed: its file, or a Dataset that is in memory."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from vibro_sweep import store
from vibro_sweep.analysis.windows.rows import Contents
from vibro_sweep.driver.source_file import SourceError, computed_from
from vibro_sweep.model.arguments import check_type
from vibro_sweep.model.files import checked_path

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
    """As `Contents` of a file (store/arrays.py), of a Dataset or of a part of one that `sel` and the like have cut
    out."""

    def __init__(self, data: "xarray.Dataset"):
        self._data = data
        swept = [str(name) for name in np.atleast_1d(data.attrs["sweep_dimensions"])]
        self.attrs: dict[str, Any] = data.attrs | {"sweep_dimensions": [name for name in swept if name in data.dims]}
        self.chosen = {name: float(data[name]) for name in swept if name not in data.dims and name in data.coords}
        self.sizes = {str(name): size for name, size in data.sizes.items()}

    def __contains__(self, name: str) -> bool:
        return name in self._data.data_vars

    def dims(self, name: str) -> list[str]:
        """Names of the dimensions of a quantity."""
        return [str(dim) for dim in self._data[name].dims]

    def values(self, name: str, first: Sequence[str] = ()) -> np.ndarray:
        """Of a quantity or a dimension; these dimensions first, in their order."""
        variable = self._data[name].variable
        return np.asarray((variable.transpose(*first, ...) if first else variable).values)
