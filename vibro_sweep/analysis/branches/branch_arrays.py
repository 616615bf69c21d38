"""A branch as plain arrays, with which it travels between processes and lies in files; and its orbits from these.

The arrays, `SHAPES`, have the names that they have in files. Words are codes of tables/bifurcations.py
and tables/outcomes.py. An index that does not exist is -1.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.branches.branch import Branch
from vibro_sweep.analysis.branches.branch_orbits import Arrays, orbit_at, outline
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.continuation.starting_orbit import keeps_symmetry
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.oscillator.family import family_of
from vibro_sweep.oscillator.linear import forcing_period
from vibro_sweep.tables.bifurcations import BIRTHS, CODES, CRITICALITIES, KINDS, TYPES
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.file_columns import OF_CONTACTS
from vibro_sweep.tables.outcomes import BRANCHES, names

# n points, K impacts, s special points, N masses
SHAPES = {
    # branch_origin: the point that it was followed from; branch_begins, branch_ends: indices among the special points
    "": "branch_period branch_symmetric branch_closed branch_origin branch_begins branch_ends branch_status",
    # value: of the parameter; the last two where contacts are observed
    "n": "value stop_distance min_impact_speed residual unstable status contact_force_max penetration_max",
    "n 2N": "state multiplier_re multiplier_im",
    # as `orbit.impacts`; impact_t_off: the end of the rest after an impact, or NaN
    "n K": "impact_t impact_v impact_t_off",
    "K": "impact_side",
    # in order along the branch; a sticking onset lies beyond an end
    "s": "special_type special_value special_point special_stop special_kind special_impact special_direction "
    "special_criticality special_error",
}


def arrays_of(branch: Branch, origin: float) -> Arrays:
    """The arrays of a branch; origin: the parameter of the orbit that it was followed from."""
    if branch._arrays is not None:
        return branch._arrays
    start, parameter = branch._start, branch.parameter
    data = {name: values for name, (_, values) in branch._columns.items()}
    p, special = data[parameter], branch.special
    words = state(data["multiplier_re"].shape[1] // 2)
    result = outline(start, parameter, branch._frame, branch._rows) | common(branch, start, (parameter,), p, CODES)
    result |= {
        "branch_status": np.int8(names(BRANCHES).index(branch.status)),
        "branch_origin": np.int32(np.argmin(np.abs(p - origin))),
        "state": np.stack([data[name] for name in words], axis=-1),
        **{
            name: data[name]
            for name in ("multiplier_re", "multiplier_im", "stop_distance", "min_impact_speed", "residual")
        },
        **{column.name: data[column.name] for column in OF_CONTACTS if column.name in data},
        "unstable": data["unstable"].astype(np.int32),
        "status": np.zeros(len(p), np.int8),
        "special_impact": np.array([-1 if one.impact is None else one.impact for one in special], np.int32),
    }
    codes = {
        "special_stop": [one.stop or 0 for one in special],
        "special_kind": [KINDS.index((one.kind or "none").replace(" ", "_")) for one in special],
        "special_direction": [one.direction or 0 for one in special],
        "special_criticality": [CRITICALITIES.index(one.criticality or "none") for one in special],
    }
    result |= {name: np.array(values, np.int8) for name, values in codes.items()}
    return {name: np.asarray(values) for name, values in result.items()}


def common(of, start: Solution, names: tuple[str, ...], p: np.ndarray, codes: Mapping[str, int]) -> Arrays:
    """Arrays of a branch or curve of orbits like `start` in the parameters `names`: what it is, where its special
    points are. p : (n,) or (n, 2); codes : of their types"""
    places = np.array([[one.parameters[name] for name in names] for one in of.special])
    points, least, values = [], 0, p.reshape(len(p), -1)
    for place in places:  # they are among the points, in the same order
        there = np.flatnonzero(np.all(values == place, axis=1)).tolist()  # `closed` is the first point
        least = next((point for point in there if point >= least), least)
        points.append(least if least in there else there[0] if there else -1)  # an onset of sticking is none of them
    return {
        "branch_period": np.int32(start.whole().half_periods // 2),
        "branch_symmetric": np.int8(start.sigma == -1),
        "branch_closed": np.int8(of.closed),
        "branch_begins": np.int32(of.special.index(of.begins)),
        "branch_ends": np.int32(len(of.special) - 1 - of.special[::-1].index(of.ends)),
        "special_type": np.array([codes[one.type] for one in of.special], np.int8),
        "special_value": places.reshape(-1, *p.shape[1:]),
        "special_point": np.array(points, np.int32),
        "special_error": np.array([one.error for one in of.special], float),
    }


def branch_of(arrays: Arrays, parameter: str, system) -> Branch:
    """The branch with these arrays; `system` is one of its oscillators."""
    special = [special_point(arrays, i, parameter, system) for i in range(len(arrays["special_type"]))]
    origin = int(arrays["branch_origin"])
    orbit = orbit_at(arrays, origin, system.replace(**{parameter: float(arrays["value"][origin])}))
    begins, ends = (special[int(arrays[name])] for name in ("branch_begins", "branch_ends"))
    closed = bool(arrays["branch_closed"])
    return Branch(parameter, special, begins, ends, closed, orbit._solution, (0, 0), None, arrays)


def sections_of(arrays: Arrays, parameter: str, system) -> np.ndarray:
    """(n, m, 2N) all section states of each point: those at t = 0 mod T of the orbit and of its mirror image.

    All points begin with the same impact, so that each row of states is continuous along the branch. Where the
    parameter breaks the symmetry of the oscillator there are no mirror images, not at the one value either at which it
    is symmetric: m is the same for all points.
    """
    family = family_of(system)
    mirrors = family.linear.symmetric and keeps_symmetry(family, parameter)
    systems = [system.replace(**{parameter: value}) for value in arrays["value"].tolist()]
    orbits = [orbit_at(arrays, i, one) for i, one in enumerate(systems)]
    frame = orbits[int(arrays["branch_origin"])]._canonical_frame
    return np.array([section_states(replace(one, _frame=frame), mirrors) for one in orbits])


def special_point(arrays: Arrays, index: int, parameter: str, system) -> SpecialPoint:
    """A special point of a branch; `system` is one of its oscillators."""
    kind, value = TYPES[arrays["special_type"][index]].name, float(arrays["special_value"][index])
    there, point = system.replace(**{parameter: value}), int(arrays["special_point"][index])
    orbit = PeriodicOrbit(there, "sticking") if point < 0 else orbit_at(arrays, point, there)
    if kind in BIRTHS and index in (arrays["branch_begins"], arrays["branch_ends"]):  # a birth
        orbit = orbit_of(orbit.system, orbit._solution.reduced())
    impact, graze = int(arrays["special_impact"][index]), kind == "graze"
    multipliers = orbit.multipliers if point < 0 else orbit._solution.multipliers
    return SpecialPoint(
        kind, {parameter: value}, orbit, multipliers, float(arrays["special_error"][index]),
        stop=int(arrays["special_stop"][index]) if graze else None,
        kind=KINDS[arrays["special_kind"][index]].replace("_", " ") if graze else None,
        impact=impact if impact >= 0 else None,
        direction=int(arrays["special_direction"][index]) if graze else None,
        criticality=CRITICALITIES[c] if (c := int(arrays["special_criticality"][index])) else None,
    )  # fmt: skip


def section_states(orbit: PeriodicOrbit, mirrors: bool = True) -> np.ndarray:
    """(m, 2N) at t = 0 mod T, of an orbit and, behind these, of its mirror image where that is another one.

    mirrors : whether mirror images are asked for
    """
    T = forcing_period(orbit._solution.family.linear)
    times, mirrored = T * np.arange(orbit.period), np.zeros(0)
    if mirrors and orbit._solution.family.linear.symmetric and not orbit.symmetric:  # x(t) -> -x(t + T/2)
        mirrored = times + T / 2
    states = orbit.sample(np.append(times, mirrored))
    states[orbit.period :] *= -1
    return states
