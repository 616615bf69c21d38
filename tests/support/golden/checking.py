"""A record compared with what is computed now."""

import numpy as np

from support.golden import branches, curves, files, searches, windows
from support.golden.special_points import changed


def compared(kind: str, record: dict) -> list[str]:
    """In words what differs; none: []."""
    rng, result = np.random.default_rng(1), record["result"]
    try:
        if kind == "branches":
            branch = branches.followed(record)
            lines = branches.compared(record, result, branch, rng)
            switched = {"switch": branches.switched(branch)}
            return lines if result["closed"] else lines + changed(record, switched, switched)
        if kind == "curves":
            return curves.compared(record, result, curves.traced(record))
        if kind == "searches":
            return searches.compared(record, result, searches.searched(record), rng)
        return windows.compared(record, result, windows.windows_in(files.FOLDER / record["file"]))
    except (ValueError, LookupError) as error:
        return [f"{type(error).__name__}: {error}"]
