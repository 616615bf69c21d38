"""The discontinuity map as records: where it takes states, and its derivative there."""

import numpy as np

import vibro_sweep as vs
from golden.kept_numbers import Table, differences, table
from golden.motions import system_of


def computed(record: dict) -> tuple[dict, dict[str, Table]]:
    mapping = vs.discontinuity_map(system_of(record["system"]), record["order"], record["expand_at"])
    states = np.array(record["states"])
    size = states.shape[1]
    jacobians = np.array([mapping.jacobian(state) for state in states])
    tables = {
        "graze": table(mapping.graze, "x" * size),  # where the gap has no velocity
        "states": table([mapping(state) for state in states], "xv" * (size // 2)),
        "jacobians": table(jacobians, "j" * size),
    }
    return {}, tables


def differences_from(record: dict) -> list[str]:
    return differences(record["result"], *computed(record))
