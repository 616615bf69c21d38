"""What `info --json` and `windows --json` print: one object a file, in a line."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.opening import open_file
from vibro_sweep.files.verifying import damage
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.tables.file_columns import SWEEP
from vibro_sweep.tables.outcomes import status_of

ELSEWHERE = ("scene", "provenance", "history", "title", "kind", "sweep_dimensions")  # which have keys of their own
ROWS = ("window", "branch", "special", "unvisited", "edge")  # dimensions of which an object has a table


def description_of(path: Path) -> tuple[str, bool]:
    """The line about a file, and whether it says that the file is damaged. Raises StoreError."""
    with open_file(path) as data:
        try:
            known = _described(data, path)
        except (OSError, RuntimeError, ValueError, KeyError, TypeError) as error:
            raise StoreError(f"{path} is damaged ({error})") from None
    return json.dumps(_plain(known), allow_nan=False), bool(known["damaged"])


def _described(data: xarray.Dataset, path: Path) -> dict[str, Any]:
    known = {"file": str(path), "title": data.attrs["title"], "kind": data.attrs["kind"]}
    known |= {"complete": data.encoding["complete"], "sealed": data.encoding["sealed"], "damaged": damage(data)}
    known["attributes"] = {str(name): value for name, value in data.attrs.items() if name not in ELSEWHERE}
    known["dimensions"] = dict(data.sizes)
    known["variables"] = {
        str(name): {"dimensions": variable.dims, **{key: variable.attrs.get(key) for key in ("units", "description")}}
        for name, variable in data.variables.items()
    }
    if data.attrs["kind"] == SWEEP:
        sweep = Sweep(data, str(path))
        known["axes"] = {key: sweep.values(key) for key in sweep.keys}
        codes, counts = np.unique(sweep.values("status"), return_counts=True)
        known["statuses"] = {status_of(code).name: count for code, count in zip(codes, counts, strict=True)}
    else:
        known["tables"] = {dimension: _rows(data, dimension) for dimension in ROWS if dimension in data.sizes}
    history = str(data.attrs["history"]).splitlines()
    return known | {"scene": data.attrs["scene"], "made_by": _made_by(data.attrs["provenance"]), "history": history}


def _rows(data: xarray.Dataset, dimension: str) -> list[dict[str, Any]]:
    """What the variables along a dimension say of each of its places: words for codes, parameters by name."""
    columns = {}
    for name, variable in data.variables.items():
        key, values = str(name).removeprefix(f"{dimension}_"), variable.values
        if "flag_meanings" in variable.attrs:
            codes = np.atleast_1d(variable.attrs["flag_values"]).tolist()
            words = dict(zip(codes, str(variable.attrs["flag_meanings"]).split(), strict=False))
            values = np.array([words.get(code, code) for code in values.ravel().tolist()], object).reshape(values.shape)
        if variable.dims == (dimension,):
            columns[key] = values
        elif variable.dims == (dimension, "parameter"):
            names = np.atleast_1d(data.attrs["parameters"])
            columns |= {f"{key}_{parameter}": values[:, i] for i, parameter in enumerate(names)}
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def _made_by(provenance: object) -> Any:
    try:
        return json.loads(str(provenance))
    except ValueError:  # of a file that another program wrote
        return str(provenance)


def _plain(value: Any) -> Any:
    """What JSON can hold; null where a number is not finite, and else words."""
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    if isinstance(value, (np.ndarray, np.generic)):
        return _plain(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, bytes):
        return value.decode(errors="replace")
    return value if value is None or isinstance(value, (str, int)) else str(value)
