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

APART = ("scene", "provenance", "history", "title", "kind")  # attributes that have a place of their own


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
    known |= {"complete": data.encoding["complete"], "damaged": damage(data)}
    known["attributes"] = {str(name): value for name, value in data.attrs.items() if name not in APART}
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
    elif not known["damaged"]:
        known["table"] = _table(path)
    made_by = json.loads(data.attrs["provenance"])
    return known | {"scene": data.attrs["scene"], "made_by": made_by, "history": data.attrs["history"].splitlines()}


def _table(path: Path) -> list[dict[str, Any]]:
    """Windows; or special points, each with the number of its branch or curve."""
    from vibro_sweep.driver.loaded_results import load

    results = load(path)
    if hasattr(results, "to_dataframe"):
        return results.to_dataframe().to_dict("records")
    return [
        {"number": number} | row
        for number, result in enumerate(results)
        for row in result.to_dataframe().to_dict("records")
    ]


def _plain(value: Any) -> Any:
    """What JSON can hold; null where a number is not finite."""
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    if isinstance(value, (np.ndarray, np.generic)):
        return _plain(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value
