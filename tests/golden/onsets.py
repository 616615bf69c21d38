"""Onsets of sticking beyond the grazes of a branch as records, and what differs from a record."""

import vibro_sweep as vs
from golden.branches import followed
from golden.special_points import differences, special_record


def onsets_of(record: dict) -> list[dict | None]:
    """For each graze of the branch, computed now, the onset beyond it; None where there is none."""
    onsets = [vs.sticking_onset(special) for special in followed(record).special if special.type == "graze"]
    return [None if onset is None else special_record(onset) for onset in onsets]


def compared(record: dict, result: list, now: list) -> list[str]:
    there, here = ([onset is None for onset in onsets] for onsets in (result, now))
    if there != here:
        return [f"no onset beyond these grazes: {there}, now {here}"]
    sizes = {record["parameter"]: record["bounds"][1] - record["bounds"][0]}
    return differences(*([onset for onset in onsets if onset is not None] for onsets in (result, now)), sizes)


def differences_from(record: dict) -> list[str]:
    """Between a record and the onsets that are there now."""
    return compared(record, record["result"], onsets_of(record))
