"""Orbits born where the steady motion grazes as records, and what differs from a record."""

import vibro_sweep as vs
from golden.motions import labels, system_of
from golden.special_points import changed
from golden.units import allowances, apart, moved_inputs

MAY_DIFFER = ("speeds", "allowed")


def born(record: dict) -> list[dict]:
    """What is born now, in an order that does not depend on how equal entries are sorted."""
    found = [
        {"born": one.born, "orbit": labels(one.orbit), "speeds": one.speed_per_distance.tolist()}
        for one in vs.born_at_grazing(system_of(record["system"]), periods=record["periods"])
    ]
    return sorted(found, key=_order)


def _order(one: dict) -> tuple:
    return one["orbit"]["period"], one["orbit"]["itinerary"], one["born"], one["speeds"]


def result_of(record: dict) -> list[dict]:
    """What is born, with the change of its speeds that rounding may make."""
    result = born(record)
    beside = [born(record | {"system": system}) for system in moved_inputs(record["system"])]
    if any(_kinds(other) != _kinds(result) for other in beside):
        raise LookupError("rounding decides what is born")
    for k, one in enumerate(result):
        one["allowed"] = allowances(one["speeds"], [other[k]["speeds"] for other in beside]).tolist()
    return result


def _kinds(found: list[dict]) -> list[dict]:
    return [{key: value for key, value in one.items() if key not in MAY_DIFFER} for one in found]


def compared(result: list[dict], now: list[dict]) -> list[str]:
    if len(result) != len(now):
        return [f"{len(result)} orbits are born, now {len(now)}"]
    lines = []
    for stored, one in zip(result, now, strict=True):
        differs = changed(stored, one, [key for key in one if key not in MAY_DIFFER])
        if not differs and len(apart(stored["speeds"], one["speeds"], stored["allowed"])):
            differs = [f"speeds {stored['speeds']}, now {one['speeds']}"]
        lines += [f"{stored['orbit']['itinerary']} of period {stored['orbit']['period']}: {line}" for line in differs]
    return lines


def differences_from(record: dict) -> list[str]:
    """Between a record and what is born now."""
    return compared(record["result"], born(record))
