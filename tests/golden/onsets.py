"""Onsets of sticking beyond the grazes of a branch as records, and what differs from a record."""

import vibro_sweep as vs
from golden.branches import followed
from golden.special_points import differences, special_record


def onsets_of(record: dict) -> list[dict | None]:
    """For each graze of the branch, computed now, the onset beyond it; None where there is none."""
    found = [vs.sticking_onset(special) for special in followed(record).special if special.type == "graze"]
    return [None if one is None else special_record(one) for one in found]


def compared(record: dict, result: list, now: list) -> list[str]:
    there, here = ([one is None for one in found] for found in (result, now))
    if there != here:
        return [f"no onset beyond these grazes: {there}, now {here}"]
    sizes = {record["parameter"]: record["bounds"][1] - record["bounds"][0]}
    return differences(*([one for one in found if one is not None] for found in (result, now)), sizes)


def differences_from(record: dict) -> list[str]:
    """Between a record and the onsets that are found now."""
    return compared(record, record["result"], onsets_of(record))
