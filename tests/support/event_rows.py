"""Rows of tests/cases/events.yaml: the oscillator, its orbit, and what the reference says of it."""

import numpy as np
from reference import event_check
from reference.event_check import Findings, Recorded
from reference.machine import machine_of

import vibro_sweep as vs

PAPER = {"mu_m": 10.0, "mu_k": 5.0, "zeta": 0.05, "f2": 0.0, "omega": 0.63}


def oscillator_of(numbers: dict):
    """model: paper, that of a name, or none: matrices."""
    model, numbers = numbers.get("model"), {key: value for key, value in numbers.items() if key != "model"}
    if model in ("paper", "system"):
        return vs.System(**(PAPER if model == "paper" else {}) | numbers)
    return vs.Oscillator(**numbers) if model is None else vs.Oscillator.named(model, **numbers)


def recorded(orbit, end=None) -> Recorded:
    """An orbit of `simulate` as the reference reads it; contacts that have not ended are left out."""
    hits = orbit.impacts
    if "x" in hits.dtype.names:
        x, xdot = hits["x"], hits["xdot"]
    else:  # of the paper's oscillator: x1 is at its stop
        q = orbit.system.linear
        x = np.stack([np.where(hits["side"] > 0, q.contact.high, q.contact.low), hits["x2"]], -1)
        xdot = np.stack([hits["v1"], hits["v2"]], -1)
    contacts = orbit.contacts[~np.isnan(orbit.contacts["t_release"])]
    rests = orbit.sticking
    rows = {
        "impact": [((t,), (v,), a, b) for t, v, a, b in zip(hits["t"], hits["v1"], x, xdot, strict=True)],
        "rest": [((on,), (off,)) for on, off in zip(rests["t_on"], rests["t_off"], strict=True)],
        "contact": [tuple((one[name],) for name in event_check.KINDS["contact"]) for one in contacts],
        "section": [((t,), y[0::2], y[1::2]) for t, y in zip(orbit.section_times[1:], orbit.section[1:], strict=True)],
    }
    sides = {
        "impact": hits["side"],
        "rest": rests["side"],
        "contact": contacts["side"],
        "section": [0] * len(rows["section"]),
    }
    end = orbit.section_times[-1] if end is None else end
    whole = Recorded({kind: list(map(int, values)) for kind, values in sides.items()}, rows, end)
    return event_check.recorded_until(whole, end)


def findings_of(system, state, periods, start_time=0.0, most=None, **more) -> tuple[vs.types.Orbit, Findings]:
    """An orbit, of which at most so many impacts or contacts are compared, and what the reference says of it."""
    orbit = vs.simulate(system, state, periods, start_time)
    end = end_of(orbit, most)
    return orbit, errors(orbit, state, end, most=most, **more)


def errors(orbit, state, end, **more) -> Findings:
    machine, found = machine_of(orbit.system.linear), recorded(orbit, end)
    until = end * (1 + 1e-12)
    return event_check.errors(machine, list(state), found, until=until, start_time=orbit.start_time, **more)


def end_of(orbit, most) -> float:
    """When the orbit ends, or is between the impacts or contacts number `most` and the next."""
    ends = [float(orbit.section_times[-1])]
    for times in (orbit.impacts["t"], np.sort(orbit.contacts["t_release"])):
        if most is not None and len(times) > most and not np.isnan(times[most]):
            ends.append(float(times[most - 1] + times[most]) / 2)
    return min(ends)
