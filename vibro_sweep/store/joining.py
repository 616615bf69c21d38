"""Branches as the flat arrays of a file: one after another, ragged ones by their lengths (CF, contiguous ragged)."""

import numpy as np

from vibro_sweep.model.state import state

Arrays = dict[str, np.ndarray]
_ALONG_POINTS = ("multiplier_re", "multiplier_im", "unstable", "margin", "min_impact_speed", "residual", "status")
_ALONG_IMPACTS = ("impact_t", "impact_v", "impact_t_off")
_OF_CURVES = ("branch_type", "branch_period", "branch_symmetric", "branch_closed", "branch_grazing")
_OF_SPECIAL = ("type", "stop", "kind", "impact", "direction", "criticality", "error")


def joined(flats: list[Arrays], parameters: list[str], others: list[tuple[float, ...]], masses: int) -> Arrays:
    """The arrays of a file of branches, by name.

    flats : of each branch, as analysis/branches/flat.py has them
    others : of each branch the values of all `parameters` but the first, which do not change along it
    """
    points, specials, result = _common(flats, masses)
    first_point = np.append(0, np.cumsum(points))[: len(points)]
    result["branch_origin"] = first_point + np.array([int(flat["branch_origin"]) for flat in flats], int)
    for name in ("branch_status", "branch_period", "branch_symmetric", "branch_closed"):
        result[name] = np.array([flat[name] for flat in flats])
    for name in _ALONG_IMPACTS:
        result[name] = _stacked([flat[name].ravel() for flat in flats])
    values = np.array(others, float).reshape(len(flats), len(parameters) - 1)
    result[parameters[0]] = _stacked([flat["value"] for flat in flats])
    result |= {name: np.repeat(values[:, i], points) for i, name in enumerate(parameters[1:])}
    own = _stacked([flat["special_value"] for flat in flats])
    result["special_value"] = np.column_stack([own, np.repeat(values, specials, axis=0)])
    for name in _OF_SPECIAL:
        result[f"special_{name}"] = _stacked([flat[f"special_{name}"] for flat in flats])
    return result


def joined_curves(flats: list[Arrays], parameters: list[str], masses: int) -> Arrays:
    """The arrays of a file of curves in two parameters, as analysis/curves/flat.py has them."""
    _, _, result = _common(flats, masses)
    result["special_value"] = _stacked([flat["special_value"] for flat in flats], 2)
    result["b_star"] = _stacked([flat["b_star"] for flat in flats])
    for name in _OF_CURVES:
        result[name] = np.array([flat[name] for flat in flats])
    values = _stacked([flat["value"] for flat in flats], 2)
    result |= {name: values[:, i] for i, name in enumerate(parameters)}
    for name in ("impact_t", "impact_v"):
        result[name] = _stacked([flat[name].ravel() for flat in flats])
    for name in ("special_type", "special_touches", "special_error"):
        result[name] = _stacked([flat[name] for flat in flats])
    return result


def _common(flats: list[Arrays], masses: int) -> tuple[np.ndarray, np.ndarray, Arrays]:
    """Points and special points of each branch or curve, and the arrays that files of both have."""
    points = np.array([len(flat["value"]) for flat in flats], np.int32)
    specials = np.array([len(flat["special_type"]) for flat in flats], np.int32)
    first_point, first_special = (np.append(0, np.cumsum(counts))[: len(counts)] for counts in (points, specials))
    places = _stacked([flat["special_point"] for flat in flats])
    result = {
        "branch_row_size": points,
        "branch_impacts": np.array([len(flat["impact_side"]) for flat in flats], np.int32),
        "branch_special": specials,
        "branch_begins": first_special + np.array([int(flat["branch_begins"]) for flat in flats], int),
        "branch_ends": first_special + np.array([int(flat["branch_ends"]) for flat in flats], int),
        "impact_side": _stacked([np.tile(flat["impact_side"], n) for flat, n in zip(flats, points, strict=True)]),
        "special_branch": np.repeat(np.arange(len(flats)), specials),
        "special_point": np.where(places >= 0, places + np.repeat(first_point, specials), -1),
    }
    states = _stacked([flat["state"] for flat in flats], 2 * masses)
    result |= {name: states[:, i] for i, name in enumerate(state(masses))}
    columns = {"multiplier_re": 2 * masses, "multiplier_im": 2 * masses}
    for name in _ALONG_POINTS:
        result[name] = _stacked([flat[name] for flat in flats], columns.get(name))
    return points, specials, result


def curve_of(arrays, parameters: list[str], index: int) -> Arrays:
    """The arrays of one curve again, from a mapping with those of a file. Raises IndexError."""
    sizes, impacts = (np.asarray(arrays[name]).astype(int) for name in ("branch_row_size", "branch_impacts"))
    if not 0 <= index < len(sizes):
        raise IndexError(index)
    K, n, begin = impacts[index], sizes[index], sizes[:index].sum()
    along, first = slice(begin, begin + n), (sizes * impacts)[:index].sum()
    before = int(np.asarray(arrays["branch_special"])[:index].sum())
    special = slice(before, before + int(arrays["branch_special"][index]))
    places = np.asarray(arrays["special_point"][special])
    result = {name: np.asarray(arrays[name][along]) for name in _ALONG_POINTS}
    result |= {name: np.asarray(arrays[name][first : first + n * K]).reshape(n, K) for name in ("impact_t", "impact_v")}
    result |= {name: np.asarray(arrays[name][index]) for name in _OF_CURVES}
    result |= {name: np.asarray(arrays[name][special]) for name in ("special_type", "special_touches", "special_error")}
    return result | {
        "value": np.column_stack([arrays[name][along] for name in parameters]),
        "impact_side": np.asarray(arrays["impact_side"][first : first + K]),
        "special_value": np.asarray(arrays["special_value"][special]),
        "special_point": np.where(places >= 0, places - begin, -1),
        "branch_begins": np.asarray(arrays["branch_begins"][index] - before),
        "branch_ends": np.asarray(arrays["branch_ends"][index] - before),
    }


def branch_of(arrays, parameter: str, index: int) -> Arrays:
    """The arrays of one branch again, from a mapping with those of a file. Raises IndexError."""
    sizes, impacts = np.asarray(arrays["branch_row_size"]), np.asarray(arrays["branch_impacts"])
    if not 0 <= index < len(sizes):
        raise IndexError(index)
    K, n, begin = int(impacts[index]), int(sizes[index]), int(sizes[:index].sum())
    along, first = slice(begin, begin + n), int((sizes[:index].astype(int) * impacts[:index]).sum())
    own = slice(first, first + n * K)
    before = int(arrays["branch_special"][:index].sum())
    special = slice(before, before + int(arrays["branch_special"][index]))
    places = np.asarray(arrays["special_point"][special])
    result = {name: np.asarray(arrays[name][along]) for name in _ALONG_POINTS}
    names = state(result["multiplier_re"].shape[1] // 2)
    result |= {name: np.asarray(arrays[name][own]).reshape(n, K) for name in _ALONG_IMPACTS}
    result |= {
        "value": np.asarray(arrays[parameter][along]),
        "state": np.stack([np.asarray(arrays[name][along]) for name in names], axis=-1),
        "impact_side": np.asarray(arrays["impact_side"][first : first + K]),
        "branch_origin": np.asarray(arrays["branch_origin"][index] - begin),
        "special_value": np.asarray(arrays["special_value"][special])[:, 0],
        "special_point": np.where(places >= 0, places - begin, -1),
        "branch_begins": np.asarray(arrays["branch_begins"][index] - before),
        "branch_ends": np.asarray(arrays["branch_ends"][index] - before),
    }
    result |= {name: np.asarray(arrays[name][index]) for name in ("branch_period", "branch_symmetric", "branch_closed")}
    return result | {f"special_{name}": np.asarray(arrays[f"special_{name}"][special]) for name in _OF_SPECIAL}


def _stacked(parts: list[np.ndarray], columns: int | None = None) -> np.ndarray:
    """Also of no parts."""
    return np.concatenate(parts) if parts else np.zeros((0,) if columns is None else (0, columns))
