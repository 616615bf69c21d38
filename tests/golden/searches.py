"""Searches over special points as records: the branches that `follow_branches` reaches, and in which way."""

import numpy as np

import vibro_sweep as vs
from golden import branches
from golden.motions import orbit_from, system_of
from golden.special_points import changed

POINTS = 5  # of each branch


def searched(record: dict, progress=None) -> list:
    orbit = orbit_from(system_of(record["system"]), record["start"])
    ways = {"follow": tuple(record["follow"]), "depth": record["depth"], "progress": progress}
    return vs.follow_branches(orbit, record["parameter"], tuple(record["bounds"]), **ways)


def result_of(found: list, rng, points: int = POINTS) -> list[dict]:
    return [_reached(one, found) | branches.result_of(one.branch, rng, points) for one in found]


def _reached(one, found) -> dict:
    """From which special point of which branch."""
    index = None if one.parent is None else next(
        i for i, special in enumerate(found[one.parent].branch.special) if special is one.special
    )  # fmt: skip
    return {"generation": one.generation, "parent": one.parent, "from": index}


def compared(record: dict, result: list[dict], found: list, rng) -> list[str]:
    if len(result) != len(found):
        return [f"{len(result)} branches, now {len(found)}"]
    lines = []
    for k, (stored, one) in enumerate(zip(result, found, strict=True)):
        now = _reached(one, found)
        own = changed(stored, now, now) + branches.compared(record, stored, one.branch, rng)
        lines += [f"branch {k}: {line}" for line in own]
    return lines


def differences_from(record: dict) -> list[str]:
    """Between a record and what is reached now."""
    return compared(record, record["result"], searched(record), np.random.default_rng(1))
