"""Branches or curves as the arrays of a file: one after another, ragged ones by their lengths (CF, contiguous ragged).

`shapes` : dimensions -> names of the arrays of one, as `SHAPES` of analysis/branches/branch_arrays.py and of
analysis/curves/curve_arrays.py has them, with n points, K impacts, s special points. In a file `value` and `state` are
columns with names.
"""

from collections.abc import Mapping

import numpy as np

from vibro_sweep.tables.coordinates import state

Arrays = dict[str, np.ndarray]


def joined(
    all_arrays: list[Arrays], shapes: Mapping[str, str], parameters: list[str], masses: int, others=None
) -> Arrays:
    """The arrays of a file, by name.

    others : of each branch the values of those `parameters` that do not change along it, behind those that do
    """
    counted = {"branch_row_size": "value", "branch_impacts": "impact_side", "branch_special": "special_type"}
    result = {name: np.array([len(arrays[of]) for arrays in all_arrays], np.int32) for name, of in counted.items()}
    points, specials = result["branch_row_size"], result["branch_special"]
    lengths = {"2": 2, "2N": 2 * masses}
    for dimensions, names in shapes.items():
        tail = [lengths[key] for key in dimensions.split() if key in lengths]
        for name in names.split():
            if not all(name in arrays for arrays in all_arrays):  # not asked for
                continue
            parts = [np.reshape(arrays[name], (-1, *tail)) for arrays in all_arrays]
            if dimensions == "K":
                parts = [np.tile(part, n) for part, n in zip(parts, points, strict=True)]
            result[name] = np.concatenate(parts) if parts else np.zeros((0, *tail))
    first_point, first_special = (np.cumsum(counts) - counts for counts in (points, specials))
    result["branch_begins"] = result["branch_begins"] + first_special
    result["branch_ends"] = result["branch_ends"] + first_special
    if "branch_origin" in result:
        result["branch_origin"] = result["branch_origin"] + first_point
    places = result["special_point"]
    result["special_point"] = np.where(places >= 0, places + np.repeat(first_point, specials), -1)
    result["special_branch"] = np.repeat(np.arange(len(all_arrays)), specials)
    count = 0 if others is None else len(parameters) - 1
    held = np.array(others or [], float).reshape(len(all_arrays), count)
    result["special_value"] = np.column_stack([result["special_value"], np.repeat(held, specials, axis=0)])
    values = np.column_stack([result.pop("value"), np.repeat(held, points, axis=0)])
    result |= dict(zip(parameters, values.T, strict=True))
    return result | dict(zip(state(masses), result.pop("state").T, strict=True))


def part_of(arrays: Mapping[str, np.ndarray], shapes: Mapping[str, str], parameters: list[str], index: int) -> Arrays:
    """The arrays of one branch, or curve, again, from those of a file. Raises IndexError.

    parameters : those that change along it
    """
    counts = np.array([arrays[name] for name in ("branch_row_size", "branch_impacts", "branch_special")], int)
    if not 0 <= index < counts.shape[1]:
        raise IndexError(index)
    n, K, s = counts[:, index]
    begin, _, before = counts[:, :index].sum(axis=1)
    first = (counts[0] * counts[1])[:index].sum()
    indices = {
        "": index,
        "n": slice(begin, begin + n),
        "K": slice(first, first + K),
        "n K": slice(first, first + n * K),
        "s": slice(before, before + s),
    }
    columns = {"value": parameters, "state": state(arrays["multiplier_re"].shape[1] // 2)}
    result = {}
    for dimensions, names in shapes.items():
        there = indices[dimensions if dimensions in indices else dimensions[0]]
        for name in names.split():
            if name not in columns and name not in arrays:  # not asked for
                continue
            parts = [np.asarray(arrays[key])[there] for key in columns.get(name, [name])]
            result[name] = np.stack(parts, axis=-1) if len(parts) > 1 else parts[0]
            if dimensions == "n K":
                result[name] = result[name].reshape(n, K)
    if len(parameters) == 1:  # beside it a file has those that do not change
        result["special_value"] = result["special_value"][:, 0]
    for name, offset in {"branch_begins": before, "branch_ends": before, "branch_origin": begin}.items():
        if name in result:
            result[name] = result[name] - offset
    result["special_point"] = np.where(result["special_point"] >= 0, result["special_point"] - begin, -1)
    return result
