"""Lyapunov exponents as records: with their errors and the residual; -inf where dimensions are lost, NaN where the
orbit fails."""

import numpy as np

import vibro_sweep as vs
from golden.kept_numbers import Table, differences
from golden.motions import system_of


def computed(record: dict) -> tuple[dict, dict[str, Table]]:
    system = system_of(record["system"])
    found = vs.lyapunov(system, record["state"], record["transient"], record["record"])
    exponents = np.asarray(found)
    finite = np.abs(exponents[np.isfinite(exponents)]).max(initial=system.omega)
    own = np.where(np.isfinite(exponents), np.maximum(np.abs(exponents), system.omega), system.omega)
    words = {
        "infinite": int(np.isneginf(exponents).sum()),
        "not a number": int(np.isnan(exponents).sum()),
    }
    tables = {
        "exponents": Table(np.stack([exponents, found.error], axis=-1), own[:, None]),
        "residual": Table(np.array([[found.residual]]), np.array([[finite]])),
    }
    return words, tables


def differences_from(record: dict) -> list[str]:
    return differences(record["result"], *computed(record))
