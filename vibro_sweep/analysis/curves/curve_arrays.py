"""A bifurcation curve as plain arrays, with which it travels between processes and lies in files; and back.

The arrays, `SHAPES`, have the names that they have in files. Words are codes of tables/bifurcations.py.
"""

from collections.abc import Sequence

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import common
from vibro_sweep.analysis.branches.branch_orbits import Arrays, solution_of
from vibro_sweep.analysis.branches.branch_run import stop_and_impact
from vibro_sweep.analysis.branches.criticality import critical_angle
from vibro_sweep.analysis.branches.special import bare
from vibro_sweep.analysis.continuation.starting_orbit import StartingOrbit
from vibro_sweep.analysis.curves.bifurcation_curve import BifurcationCurve
from vibro_sweep.analysis.curves.curve_record import CurvePoint
from vibro_sweep.analysis.curves.curve_start import slow_impacts
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.problem import GRAZE
from vibro_sweep.oscillator.linear import Linear, gap_response
from vibro_sweep.tables.bifurcations import CODES_OF_CURVES, CODIMENSION_TWO, CURVES
from vibro_sweep.tables.coordinates import state

# n points, K impacts of the whole orbit, s special points, N masses
SHAPES = {
    # branch_begins, branch_ends: indices among the special points; branch_grazing: of the impact without speed along a
    # graze curve, or -1
    "": "branch_type branch_period branch_symmetric branch_closed branch_begins branch_ends branch_grazing",
    "n 2": "value",  # both parameters
    "n": "b_star stop_distance min_impact_speed residual unstable status",
    "n 2N": "state multiplier_re multiplier_im",
    "n K": "impact_t impact_v impact_t_off",  # continuous along the curve; ends of rests and contacts, else NaN
    "K": "impact_side",
    "s": "special_type special_point special_touches special_error",  # in order along the curve
    "s 2": "special_value",
}


def arrays_of(curve: BifurcationCurve) -> Arrays:
    """The arrays of a curve."""
    if curve._arrays is not None:
        return curve._arrays
    data, solution_curve, start = curve.points, curve._solution_curve, curve._solution_curve.orbit
    grazing = solution_curve.problem.index if solution_curve.problem.kind == GRAZE else -1
    value = np.column_stack([data[name].values for name in curve.parameters])
    t, v, sides = (data[name].values for name in ("impact_t", "impact_v", "impact_side"))
    speeds = np.abs(np.delete(v, grazing, axis=1) if grazing >= 0 else v)
    oscillators = [solution_curve.oscillators.at(p).linear for p in value]
    off, rests, rows = np.full(t.shape, np.nan), list(start.rests), curve._rows
    off[:, rests] = t[:, rests] + (rows.ends - rows.t[:, rests])
    if start.sigma == -1:
        half = np.array([np.pi * start.half_periods / q.omega for q in oscillators])
        t, off = (np.hstack([times, times + half[:, None]]) for times in (t, off))
        v, sides = np.hstack([v, -v]), np.hstack([sides, -sides])
    result = common(curve, start, curve.parameters, value, CODES_OF_CURVES) | {
        "branch_type": np.int8(CURVES.index(curve.type)),
        "branch_grazing": np.int32(grazing),
        "value": value,
        "state": np.column_stack([data[name].values for name in state(data.sizes["multiplier"] // 2)]),
        **{name: data[name].values for name in ("multiplier_re", "multiplier_im", "stop_distance", "residual")},
        "min_impact_speed": speeds.min(axis=1, initial=np.inf),
        "b_star": np.array([_grazing_clearance(q) for q in oscillators]),
        "unstable": data.unstable.values.astype(np.int32),
        "status": data.virtual.values.astype(np.int8),
        "impact_t": t,
        "impact_v": v,
        "impact_t_off": off,
        "impact_side": sides[0].astype(np.int8),
        "special_touches": np.array([one.touches for one in curve.special], np.int8),
    }
    return {name: np.asarray(values) for name, values in result.items()}


def _grazing_clearance(q: Linear) -> float:
    """b at which the free motion touches both stops; NaN where there is none."""
    response = gap_response(q) if q.contact.low == -q.contact.high and not np.any(q.constant) else None
    return np.nan if response is None else abs(response)


def type_of(arrays: Arrays) -> str:
    return CURVES[int(arrays["branch_type"])]


def solution_at(arrays: Arrays, point: int, system) -> Solution:
    """The orbit at a point of a curve; `system` has the parameters of that point."""
    return solution_of(arrays, system, *(arrays[name][point] for name in ("impact_t", "impact_v", "impact_t_off")))


def start_from(arrays: Arrays, point: int, system) -> StartingOrbit:
    """The bifurcation at a point of a curve, to follow it again from there."""
    solution = solution_at(arrays, point, system)
    theta = critical_angle(solution) if type_of(arrays) == "neimark_sacker" else 0.0
    return StartingOrbit(type_of(arrays), solution, max(int(arrays["branch_grazing"]), 0), theta)


def curve_of(arrays: Arrays, names: tuple[str, str], system) -> BifurcationCurve:
    """The curve with these arrays; `system` is one of its oscillators."""
    special = [point_of_codimension_two(arrays, i, names, system) for i in range(len(arrays["special_type"]))]
    begins, ends = (special[int(arrays[name])] for name in ("branch_begins", "branch_ends"))
    closed = bool(arrays["branch_closed"])
    return BifurcationCurve(type_of(arrays), names, special, begins, ends, closed, None, None, arrays)


def point_of_codimension_two(arrays: Arrays, index: int, names: Sequence[str], system) -> CurvePoint:
    """A special point of a curve; `system` is one of its oscillators."""
    parameters = dict(zip(names, map(float, arrays["special_value"][index]), strict=True))
    there = system.replace(**parameters)
    solution = solution_at(arrays, int(arrays["special_point"][index]), there)
    touches, grazing = bool(arrays["special_touches"][index]), int(arrays["branch_grazing"])
    if index in (arrays["branch_begins"], arrays["branch_ends"]):  # perhaps the birth of a doubled or asymmetric orbit
        one = bare(solution, grazing) if touches and grazing >= 0 else solution
        simpler = one.reduced(exact=False)  # Newton's method may fail there
        solution = simpler if simpler.half_periods < solution.half_periods else solution
    kind = CODIMENSION_TWO[int(arrays["special_type"][index])].name
    own, stop, impact = solution, None, None
    if 0 <= grazing < solution.K:
        own = bare(solution, grazing)
    elif not touches and slow_impacts(solution):
        grazing = int(np.argmin(np.abs(solution.jumps)))
    if 0 <= grazing < solution.K:
        stop, impact = stop_and_impact(solution, grazing)
    return CurvePoint(
        kind, parameters, orbit_of(there, solution), own.multipliers, float(arrays["special_error"][index]),
        stop=stop, impact=impact, curve=type_of(arrays), touches=touches,
    )  # fmt: skip
