"""A sweep that is computed into memory, as its file would be filled (files/sweep_file.py)."""

import json
import time
from typing import Any

import numpy as np
import xarray

from vibro_sweep.results.boxes import Box
from vibro_sweep.results.statuses import Statuses


class InMemory(Statuses):
    """The Dataset of a sweep with room for its numbers."""

    def __init__(self, data: xarray.Dataset):
        room = {
            name: xarray.Variable(variable.dims, np.array(variable.values), variable.attrs, fastpath=True)
            for name, variable in data.data_vars.items()
        }
        self.data = xarray.Dataset(room, data.coords, data.attrs)
        lists = {name: value for name, value in data.attrs.items() if isinstance(value, list) and len(value) == 1}
        self.data.attrs |= {name: value for name, (value,) in lists.items()}  # as xarray reads them
        self.status, self._began = self.data["status"].values, time.perf_counter()

    def write(self, box: Box, arrays: dict[str, np.ndarray]) -> None:
        """Keep a block."""
        for name, variable in self.data.data_vars.items():
            variable.values[box] = arrays[str(name)]

    def read(self, name: str) -> np.ndarray:
        """All numbers of a variable."""
        return self.data[name].values

    def finish(self, following: dict[str, np.ndarray], attributes: dict[str, Any]) -> float:
        """Keep what follows from all points, and how the run went. Returns its seconds."""
        for name, values in following.items():
            self.data[name].values[...] = values
        seconds = round(time.perf_counter() - self._began, 3)
        self.data.attrs["history"] = "\n".join([self.data.attrs["history"], *attributes.pop("history")])
        how = json.loads(self.data.attrs["provenance"]) | attributes | {"wall_time_s": seconds}
        self.data.attrs["provenance"] = json.dumps(how)
        return seconds
