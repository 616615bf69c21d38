"""Datasets as records: their numbers to seven digits, which is enough to be drawn."""

import numpy as np
import xarray as xr

DIGITS = 7


def record_of(data) -> dict:
    """What `dataset_of` makes the Dataset of."""
    names = {"dims": list, "dtype": str}
    return {
        "coordinates": list(data.coords), "attrs": {name: _plain(value) for name, value in data.attrs.items()},
        "variables": {
            name: {key: form(getattr(variable, key)) for key, form in names.items()}
            | {"attrs": {key: _plain(value) for key, value in variable.attrs.items()}, "shape": list(variable.shape)}
            | {"values": _digits(variable.values.ravel())}
            for name, variable in data.variables.items()
        },
    }  # fmt: skip


def dataset_of(record: dict):
    """The Dataset of a record."""
    variables = {
        name: (
            variable["dims"],
            np.array(variable["values"], variable["dtype"]).reshape(variable["shape"]),
            variable["attrs"],
        )
        for name, variable in record["variables"].items()
    }
    return xr.Dataset(variables, attrs=record["attrs"]).set_coords(record["coordinates"])


def _digits(values: np.ndarray) -> list:
    return [float(f"{value:.{DIGITS}g}") for value in values] if values.dtype.kind == "f" else values.tolist()


def _plain(value):
    return np.asarray(value).tolist() if isinstance(value, (np.ndarray, np.generic)) else value
