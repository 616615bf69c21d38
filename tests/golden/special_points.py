"""Special points of branches and curves as records, and what differs between two lists of them."""

import numpy as np

from golden.motions import labels

ATTRIBUTES = ("stop", "kind", "impact", "direction", "criticality", "touches", "orbit")
NO_PLACE = ("closed", "failed")  # such ends are where the computation began, or gave up
# Clearance of a flip of "compliant 2.10.1, two_mass", which another processor puts 1.1 times both errors elsewhere.
TWICE_BOTH_ERRORS = (3.182212684340271,)
# Clearance of a window of "compliant one mass in b" where an orbit touches a stop and turns back within 1e-13 of each
# other: rounding decides which of them ends it.
EITHER = {1.442054214352: ("fold", "graze")}
EDGE = 1e-11  # relative to the box: the place at which a curve leaves it has no stated error


def special_record(special) -> dict:
    record = {"type": special.type, "parameters": dict(special.parameters), "error": special.error}
    record |= {name: getattr(special, name, None) for name in ATTRIBUTES[:-1]}
    return record | {"orbit": labels(special.orbit)}


def ends_of(followed) -> list[int]:
    """Indices of both ends of a branch or curve in its list of special points."""
    return [next(i for i, one in enumerate(followed.special) if one is end) for end in (followed.begins, followed.ends)]


def differences(stored: list[dict], found: list[dict], sizes: dict[str, float]) -> list[str]:
    """In words what is not the same; none: []. sizes : of the range of each parameter.

    What is closed begins anywhere, and is followed in either direction.
    """
    orders = [found]
    if any(one["type"] == "closed" for one in stored) and any(one["type"] == "closed" for one in found):
        inner = [one for one in found if one["type"] != "closed"]
        orders = [inner[k:] + inner[:k] for k in range(max(len(inner), 1))]
        orders += [order[::-1] for order in orders]
        stored = [one for one in stored if one["type"] != "closed"]
    return min((_differences(stored, order, sizes) for order in orders), key=len)


def _differences(stored, found, sizes) -> list[str]:
    types = [[_type(one) for one in points] for points in (stored, found)]
    if types[0] != types[1]:
        return [f"special points {types[0]}, now {types[1]}"] * (1 + abs(len(stored) - len(found)))
    return [line for one, other in zip(stored, found, strict=True) for line in _differs(one, other, sizes)]


def _type(one: dict) -> str:
    """Of a point that may be of either type, both."""
    b = one["parameters"].get("b", np.inf)
    either = [types for value, types in EITHER.items() if one["type"] in types and abs(b / value - 1) < EDGE]
    return " or ".join(either[0]) if either else one["type"]


def changed(stored: dict, now: dict, keys) -> list[str]:
    """In words which of the values under these keys are not the same."""
    return [f"{key}: {stored[key]}, now {now[key]}" for key in keys if stored[key] != now[key]]


def _differs(one: dict, other: dict, sizes) -> list[str]:
    lines = []
    if one["type"] not in NO_PLACE:
        for name, value in one["parameters"].items():
            apart, allowed = abs(other["parameters"][name] - value), one["error"] + other["error"]
            if value in TWICE_BOTH_ERRORS:
                allowed *= 2
            if one["type"] == "boundary":
                allowed = max(allowed, EDGE * sizes[name])
            if not apart <= allowed:
                lines.append(f"{one['type']}: {name} = {value!r} moved by {apart:.1e}, errors {allowed:.1e}")
    if one["type"] != other["type"]:
        return lines
    # Of a symmetric orbit the impact that vanishes has its mirror image on the other stop: either may be named.
    names = [name for name in ATTRIBUTES if not (name == "stop" and one["orbit"]["symmetric"])]
    return lines + [f"{one['type']} at {one['parameters']}: {line}" for line in changed(one, other, names)]


def nearest(points, record: dict):
    """Of a list of special points the one that a record is of."""
    same = [one for one in points if one.type == record["type"]]
    if not same:
        raise LookupError(f"no {record['type']} near {record['parameters']}")
    return min(same, key=lambda one: max(abs(one.parameters[k] - v) for k, v in record["parameters"].items()))
