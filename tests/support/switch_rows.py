"""What `switch` gives at special points, as rows of a table: how a row is followed, and what differs from it.

branch : the branch with the point, as a row of branches.yaml: system, start, parameter, bounds
at : [type, n], the n-th special point of this type; a negative n counts from the last
born : of each orbit its itinerary, period, symmetric, stable
special : of the branch of the first orbit, as in branches.yaml, within `within` (else the bounds of its parent): it
    comes back to the point, whose kind of orbits `switch` gives there again
"""

import numpy as np

import vibro_sweep as vs
from support import branch_rows

STEPS = (0.5, 2)  # with which the list is the same
RETURNS = 1e-9  # of the state, times the largest multiplier
LARGEST = 1e5  # multiplier with which a simulation over a period still tells something
BIRTHS = ("flip", "pitchfork")
SAME = 1e-11  # relative: of the place of a point that is seen from both branches


def point_of(row: dict):
    branch = row["branch"]
    special = branch_rows.follow(branch, branch_rows.orbit_of(branch)).special
    of_type, n = row["at"]
    return [one for one in special if one.type == of_type][n]


def words(orbits) -> list[list]:
    return [[orbit.itinerary, orbit.period, orbit.symmetric, orbit.stable] for orbit in orbits]


def row_of_branch(row: dict) -> dict:
    """A row of branches.yaml, of the branch that is born."""
    bounds = row.get("within", row["branch"]["bounds"])
    return row["branch"] | {"bounds": bounds, "special": row["special"]}


def not_simulated(orbits) -> tuple[int, list[str]]:
    """(orbits, words) of those that do not come back in the engine's simulation, or come back before."""
    counted, wrong = 0, []
    for orbit in orbits:
        largest = max(1.0, float(np.abs(orbit.multipliers).max()))
        if largest > LARGEST:
            continue
        counted += 1
        section = vs.simulate(orbit.system, orbit.state, orbit.period).section
        size = np.abs(section).max()
        away = np.abs(section[-1] - orbit.state).max() / size
        if not away < RETURNS * largest:
            wrong.append(f"{orbit.itinerary} comes back {away:.1e} away")
        events = len(orbit.impacts) + len(orbit.contacts)
        if events != len(orbit.itinerary):
            wrong.append(f"{orbit.itinerary} has {events} events")
        for part in range(1, orbit.period):
            if orbit.period % part == 0 and np.abs(section[part] - section[0]).max() < 1e-7 * size:
                wrong.append(f"{orbit.itinerary} has the period {part}")
    return counted, wrong


def birth_of(special, branch) -> object:
    """The point of the born branch at which it meets its parent; None: it does not come there."""
    name = branch.parameter
    value = special.parameters[name]
    near = [
        one
        for one in branch.special
        if one.type == special.type and abs(one.parameters[name] - value) <= SAME * max(1.0, abs(value))
    ]
    return near[0] if near else None


def not_back(special, branch) -> list[str]:
    """What is wrong where a born branch meets its parent: the same point, the same orbit."""
    birth = birth_of(special, branch)
    if birth is None:
        return [f"the branch does not come back: {[(one.type, one.parameters) for one in branch.special]}"]
    if special.type in BIRTHS:
        same = branch_rows.kind(birth.orbit) == branch_rows.kind(special.orbit)
        same = same and birth.criticality == special.criticality
        return [] if same else [f"{birth} is not {special}"]
    parents = [branch_rows.kind(orbit)[:1] for orbit in vs.switch(birth)]
    return [] if branch_rows.kind(special.orbit)[:1] in parents else [f"{parents} is not {special.orbit}"]
