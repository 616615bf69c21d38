"""Simulated motions as records: impacts, contacts, rests, sections, samples and the status."""

import numpy as np

import vibro_sweep as vs
from golden.kept_numbers import Table, differences, table
from golden.motions import system_of

SAMPLES = 7  # times between the first and the last one, both among them


def simulated(record: dict) -> vs.types.Orbit:
    return vs.simulate(system_of(record["system"]), record["state"], record["periods"], record["start_time"])


def words_of(orbit: vs.types.Orbit) -> dict:
    return {"status": str(orbit.status), "chatters": orbit.status.chatters}


def tables_of(orbit: vs.types.Orbit) -> dict[str, Table]:
    """The letters are kinds of numbers: t times, s sides, x displacements, v velocities, f forces."""
    impacts, contacts, rests, masses = orbit.impacts, orbit.contacts, orbit.sticking, orbit.system.masses
    tables = {
        "impacts": table(_columns(impacts, "t", "side", "v1"), "tsv"),
        "states at impacts": _states_at(impacts, masses),
        "contacts": table(
            _columns(contacts, "t_touch", "t_release", "side", "v_touch", "v_release", "max_penetration", "max_force"),
            "ttsvvxf",
        ),
        "rests": table(_columns(rests, "t_on", "t_off", "side"), "tts"),
        "section": table(orbit.section, "xv" * masses),
    }
    if orbit.status == "ok":
        times = np.linspace(orbit.start_time, orbit.section_times[-1], SAMPLES)
        tables["samples"] = table(orbit.sample(times), "xv" * masses)
    return tables


def _states_at(impacts: np.ndarray, masses: int) -> Table:
    """Of all masses before the impacts; of the paper's oscillator that of the second mass."""
    if "x2" in impacts.dtype.names:
        return table(_columns(impacts, "x2", "v2"), "xv")
    return table(np.hstack([impacts["x"], impacts["xdot"]]), "x" * masses + "v" * masses)


def _columns(events: np.ndarray, *names: str) -> np.ndarray:
    return np.stack([events[name].astype(float) for name in names], axis=-1)


def computed(record: dict) -> tuple[dict, dict[str, Table]]:
    orbit = simulated(record)
    return words_of(orbit), tables_of(orbit)


def differences_from(record: dict) -> list[str]:
    return differences(record["result"], *computed(record))
