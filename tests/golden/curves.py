"""Bifurcation curves as records, by which way they were reached; and what differs from a record.

A curve is followed in a box, and again in a smaller one: where it leaves that one are two more of its points, to the
last digits.
"""

import numpy as np

import vibro_sweep as vs
from golden.branches import followed
from golden.motions import labels
from golden.passing import in_order, passed
from golden.special_points import changed, differences, ends_of, nearest, special_record

POINTS = 50
ENDS = ("closed", "boundary", "failed", "split", "unrelaxed")  # from which no other curve begins
LEAST_SPEED = 1e-6  # where all impacts graze, speeds are rounding


def start_of_curve(record: dict):
    """The special point from which the curve of a record is followed."""
    special = nearest(followed(record).special, record["special"])
    for step in record["then"]:
        curve = vs.bifurcation_curve(special, tuple(step["names"]), step["box"])
        special = vs.switch(nearest(curve.special, step["special"]))[step["switch"]]
    return special


def traced(record: dict):
    """The curve of a record, and that within the smaller box, computed now."""
    special = start_of_curve(record)
    return [vs.bifurcation_curve(special, tuple(record["names"]), record[box]) for box in ("box", "inner")]


def result_of(curves) -> dict:
    curve, small = curves
    points, (p, q) = curve.points, curve.parameters
    k = np.unique(np.linspace(0, points.sizes["point"] - 1, POINTS).round().astype(int))
    kept = {name: points[name].values[k].tolist() for name in (p, q, "virtual", "unstable")}
    kept["v"] = _speeds(points)[k].tolist()
    return {
        "type": curve.type,
        "closed": curve.closed,
        "ends": ends_of(curve),
        "special": [special_record(one) for one in curve.special],
        "inner": [special_record(one) for one in small.special],
        "switch": switched(curve),
        "points": kept,
    }


def switched(curve) -> list[list[list]]:
    """Of each point of codimension two the curves that pass it, or begin there."""
    return [
        [] if one.type in ENDS else [[start.type, labels(start.orbit)] for start in vs.switch(one)]
        for one in curve.special
    ]


def compared(record: dict, result: dict, curves) -> list[str]:
    now = result_of(curves)
    sizes = {name: hi - lo for name, (lo, hi) in zip(record["names"], record["box"], strict=True)}
    lines = changed(result, now, ("type", "closed"))
    for key in ("special", "inner"):
        lines += [f"{key}: {one}" for one in differences(result[key], now[key], sizes)]
    lines += [] if result["closed"] else changed(result, now, ("ends", "switch"))
    return lines + _passed(record["names"], sizes, result["points"], curves[0])


def _speeds(points) -> np.ndarray:
    """(points, impacts) velocities of the impacts by size, for they may be counted from any one; none at an onset of
    sticking, where points have different numbers of them."""
    v = np.sort(points.impact_v.values, axis=1)
    return v if np.isfinite(v).all() else v[:, :0]


def _passed(names, sizes, stored: dict, curve) -> list[str]:
    v, now = np.array(stored["v"]), _speeds(curve.points)
    if curve.type == "sticking":  # so many impacts of a chatter sequence, and its end, which has no speed
        common = max(min(v.shape[1], now.shape[1]) - 1, 0)
        v, now = (-np.sort(-np.abs(one), axis=1)[:, :common] for one in (v, now))
    if v.shape[1] != now.shape[1]:
        return [f"{v.shape[1]} impacts, now {now.shape[1]}"]
    size = max(np.abs(v).max(initial=0.0), LEAST_SPEED)
    a = np.column_stack([*(np.array(stored[name]) / sizes[name] for name in names), v / size])
    b = np.column_stack([*(curve.points[name].values / sizes[name] for name in names), now / size])
    if curve.closed:  # from where the record begins, in its direction
        first = int(np.argmin(np.linalg.norm(b - a[0], axis=1)))
        ring = np.roll(b[:-1], -first, axis=0)
        return min((in_order(a, np.vstack([one, one])) for one in (ring, ring[::-1])), key=len)
    lines, steps = passed(a, b)
    for k, i in enumerate(steps):  # away from where they change: neighbours agree, and so do both ends of the step
        for name in ("virtual", "unstable"):
            values = set(curve.points[name].values[i : i + 2].tolist())
            sure = len(values) == 1 and len(set(stored[name][max(k - 1, 0) : k + 2])) == 1
            if i >= 0 and sure and values != {stored[name][k]}:
                lines.append(f"point {k}: {name} {stored[name][k]}, now {values.pop()}")
    return lines


def differences_from(record: dict) -> list[str]:
    """Between a record and the curve that is followed now."""
    return compared(record, record["result"], traced(record))
