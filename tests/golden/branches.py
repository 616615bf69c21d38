"""Branches as records: special points, ends, labels, fifty points; and what differs from a record."""

import numpy as np

import vibro_sweep as vs
from golden.motions import (
    Motion,
    contacts_of,
    distance,
    errors_of,
    labels,
    motion_of,
    multiplier_distance,
    orbit_from,
    system_of,
)
from golden.passing import passed_in_order
from golden.special_points import changed, differences, ends_of, special_record

POINTS = 50  # of a branch
SWITCHED = ("graze", "pitchfork", "flip", "split")


def followed(record: dict):
    """The branch that a record is of, computed now."""
    orbit = orbit_from(system_of(record["system"]), record["start"])
    return vs.continue_orbit(orbit, record["parameter"], tuple(record["bounds"]))


def result_of(branch, rng, points: int = POINTS) -> dict:
    """What is kept of a branch."""
    return {
        "orbit": labels(own_orbit(branch)),
        "status": branch.status,
        "closed": branch.closed,
        "ends": ends_of(branch),
        "special": [special_record(one) for one in branch.special],
        "points": _points(branch, rng, points),
    }


def own_orbit(branch):
    """An orbit of this branch: special points may have the orbit from which it is born."""
    periods = {one.orbit.period for one in branch.special if one.orbit.period}
    last, values = branch.points.sizes["point"] - 1, branch.points[branch.parameter].values
    special = {one.parameters[branch.parameter] for one in branch.special[1:-1]}
    for share in (0.5, 0.3, 0.7, 0.1, 0.9):  # at a fold it may not be found
        k = round(share * last)
        if values[k] in special:  # two orbits meet there
            continue
        found = _orbit_at(branch, k, sorted(periods | {2 * n for n in periods}))
        if found is not None:
            return found
    raise LookupError("no orbit of the branch is found from its points")


def _orbit_at(branch, k: int, periods):
    point = branch.points.isel(point=k)
    system = branch.special[0].orbit.system.replace(**{branch.parameter: float(point[branch.parameter])})
    count = point.sizes["impact"]
    if not count:
        return vs.periodic_orbit(system, itinerary="")
    t, side, v = point.impact_t.values, point.impact_side.values, point.impact_v.values
    state, compliant = np.array([float(point[name]) for name in states(branch.points)]), system.linear.compliant
    for n in periods:
        try:
            orbit = Motion(system.omega, n, t, side, v, state, np.empty(0), compliant).found_again(system)
        except ValueError:  # more impacts than fit into the period
            continue
        if orbit.ok and len(orbit.impacts) + len(orbit.contacts) == count:
            return orbit
    return None


def states(points) -> list[str]:
    return [f"{kind}{i + 1}" for i in range(points.sizes["multiplier"] // 2) for kind in "xv"]


def switched(branch) -> list[list[dict]]:
    """What branches off at each special point."""
    return [
        [labels(orbit) for orbit in vs.switch(one)] if one.type in SWITCHED else [] for one in branch.special
    ]  # fmt: skip


def _points(branch, rng, count: int) -> dict:
    points, name = branch.points, branch.parameter
    own = own_orbit(branch)
    system, motions = own.system, motions_of(branch, own)
    inner = np.unique(np.linspace(1, len(motions) - 2, count).round().astype(int)) if len(motions) > 2 else []
    values = points[name].values
    kept = {key: [] for key in ("value", "t", "v", "state", "re", "im", "error", "multiplier_error")}
    if system.linear.compliant:
        kept["contacts"] = []
    for k in inner:
        value, motion = float(values[k]), motions[k]
        if system.linear.compliant:
            orbit = motion.found_again(system.replace(**{name: value}))
            motion.contacts = contacts_of(motion_of(orbit), motion) if orbit.ok else None
        errors = errors_of(system, name, value, motion, rng) or (None, None)
        numbers = (value, motion.t, motion.v, motion.state, motion.multipliers.real, motion.multipliers.imag, *errors)
        numbers += (motion.contacts,) if "contacts" in kept else ()
        for key, number in zip(kept, numbers, strict=True):
            kept[key].append(number.tolist() if isinstance(number, np.ndarray) else number)
    side = points.impact_side.values[0].tolist() if points.sizes["impact"] else []
    if side and not system.linear.compliant:
        del kept["state"]
    return kept | {"side": side, "period": own.period}


def motions_of(branch, orbit) -> list[Motion]:
    """Of all points of a branch, which `orbit` is one of."""
    p, name = branch.points, branch.parameter
    state = np.stack([p[one].values for one in states(p)], axis=1)
    omega = p["omega"].values if name == "omega" else np.full(len(state), orbit.system.omega)
    multipliers = p.multiplier_re.values + 1j * p.multiplier_im.values
    rows = zip(omega, p.impact_t.values, p.impact_side.values, p.impact_v.values, state, multipliers, strict=True)
    return [Motion(w, orbit.period, *numbers, orbit.system.linear.compliant) for w, *numbers in rows]


def stored_motions(system, name: str, points: dict) -> list[Motion]:
    """Of the points of a record."""
    result, side = [], np.array(points["side"], int)
    for k, value in enumerate(points["value"]):
        omega = value if name == "omega" else system.omega
        t, v = np.array(points["t"][k], float), np.array(points["v"][k], float)
        state = np.array(points["state"][k] if "state" in points else [])
        multipliers = np.array(points["re"][k]) + 1j * np.array(points["im"][k])
        contacts = points["contacts"][k] if "contacts" in points else None
        contacts = None if contacts is None else np.array(contacts)
        compliant = system.linear.compliant
        result.append(Motion(omega, points["period"], t, side, v, state, multipliers, compliant, contacts))
    return result


def compared(record: dict, result: dict, branch, rng) -> list[str]:
    """What differs between a stored branch, the `result` of a record, and one that was computed now."""
    now = result_of(branch, rng, points=0)
    lines = changed(result, now, ("status", "closed", "orbit"))
    size = {record["parameter"]: record["bounds"][1] - record["bounds"][0]}
    lines += differences(result["special"], now["special"], size)
    lines += [] if result["closed"] else changed(result, now, ("ends",))
    system = system_of(record["system"])
    stored = stored_motions(system, record["parameter"], result["points"])
    lines += corrected(system, record["parameter"], result["points"], stored)
    values = np.array(result["points"]["value"])
    width = size[record["parameter"]]
    path = motions_of(branch, own_orbit(branch))
    lines += passed_in_order(values / width, stored, branch.points[record["parameter"]].values / width, path)
    return lines


def corrected(system, name: str, points: dict, stored: list[Motion]) -> list[str]:
    """Points of a record that are not orbits now, or have other multipliers."""
    lines = []
    for value, motion, error, more in zip(
        points["value"], stored, points["error"], points["multiplier_error"], strict=True
    ):
        if error is None:  # it was not found again either when the record was made
            continue
        orbit = motion.found_again(system.replace(**{name: value}))
        if orbit.status not in ("ok", "inadmissible"):
            lines.append(f"point at {value!r}: {orbit.status}")
            continue
        found = motion_of(orbit)
        moved, changed = distance(motion, found), multiplier_distance(motion, found)
        if not moved <= error:  # the record's error knows nothing of the rounding of modes, which moves frequencies
            now, _ = errors_of(orbit.system, "omega", orbit.system.omega, found, np.random.default_rng(0)) or (0.0, 0.0)
            if not moved <= error + now:
                lines.append(f"point at {value!r} moved by {moved:.1e}, errors {error:.1e} and {now:.1e}")
                continue
        if not changed <= more:  # the record's error is that of another processor's rounding: with that of this one
            _, now = errors_of(system, name, value, found, np.random.default_rng(0)) or (None, 0.0)
            if not changed <= more + now:
                lines.append(
                    f"point at {value!r}: multipliers changed by {changed:.1e}, errors {more:.1e} and {now:.1e}"
                )
    return lines


def differences_from(record: dict) -> list[str]:
    """Between a record and the branch that is followed now, with what branches off."""
    branch = followed(record)
    lines = compared(record, record["result"], branch, np.random.default_rng(1))
    now = {"switch": switched(branch)}
    return lines if record["result"]["closed"] else lines + changed(record, now, now)
