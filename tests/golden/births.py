"""Orbits born where the steady motion grazes as records, and what differs from a record."""

import vibro_sweep as vs
from golden.motions import labels, system_of
from golden.special_points import changed
from golden.units import allowances, apart, moved_inputs

MAY_DIFFER = ("speeds", "allowed")


def born(record: dict) -> list[dict]:
    """What is born now, in an order that does not depend on how equal entries are sorted."""
    births = [
        {"born": birth.born, "orbit": labels(birth.orbit), "speeds": birth.speed_per_distance.tolist()}
        for birth in vs.born_at_grazing(system_of(record["system"]), periods=record["periods"])
    ]
    return sorted(births, key=_order)


def _order(birth: dict) -> tuple:
    return birth["orbit"]["period"], birth["orbit"]["itinerary"], birth["born"], birth["speeds"]


def result_of(record: dict) -> list[dict]:
    """What is born, with the change of its speeds that rounding may make."""
    result = born(record)
    beside = [born(record | {"system": system}) for system in moved_inputs(record["system"])]
    if any(_kinds(other) != _kinds(result) for other in beside):
        raise LookupError("rounding decides what is born")
    for k, birth in enumerate(result):
        birth["allowed"] = allowances(birth["speeds"], [other[k]["speeds"] for other in beside]).tolist()
    return result


def _kinds(births: list[dict]) -> list[dict]:
    return [{key: value for key, value in birth.items() if key not in MAY_DIFFER} for birth in births]


def compared(result: list[dict], now: list[dict]) -> list[str]:
    if len(result) != len(now):
        return [f"{len(result)} orbits are born, now {len(now)}"]
    lines = []
    for stored, birth in zip(result, now, strict=True):
        differs = changed(stored, birth, [key for key in birth if key not in MAY_DIFFER])
        if not differs and len(apart(stored["speeds"], birth["speeds"], stored["allowed"])):
            differs = [f"speeds {stored['speeds']}, now {birth['speeds']}"]
        lines += [f"{stored['orbit']['itinerary']} of period {stored['orbit']['period']}: {line}" for line in differs]
    return lines


def differences_from(record: dict) -> list[str]:
    """Between a record and what is born now."""
    return compared(record["result"], born(record))
