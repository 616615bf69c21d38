"""Bifurcation curves of random systems, held against simulation, and against the same curves from other points and
with other steps."""

from dataclasses import replace

import numpy as np

import vibro_sweep as vs
from support.curves import chosen, solution_at
from support.random_branches import attractors, random_system
from support.searching import Report, new_report
from vibro_sweep.analysis.branches.branch_run import stop_and_impact
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.types import SpecialPoint

TYPES = ("fold", "flip", "pitchfork", "neimark_sacker", "graze")
CLOSE = 1e-9  # of the state after a period of simulation, relative, times the largest multiplier
BESIDE = 1e-4  # relative distance of the two sides from a point


def study(seed: int, most_curves=4) -> Report:
    """`points` are compared with simulation on each side; `again` curves from another point or with other steps."""
    report, rng = new_report(systems=1), np.random.default_rng(seed)
    system = random_system(rng)
    for state, periods in attractors(system, rng, most=1):
        orbit = vs.periodic_orbit(system, state=state, periods=periods)
        if not orbit.ok or not orbit.impacts.size or orbit.sticking.size:
            continue
        branch = vs.continue_orbit(orbit, "b", (0.5 * system.b, 1.5 * system.b))
        specials = [special for special in branch.special if special.type in TYPES]
        for special in specials[:most_curves]:
            _follow(report, seed, special, rng)
    return report


def _follow(report: Report, seed: int, special, rng) -> None:
    b, omega = special.parameters["b"], special.orbit.system.omega
    bounds = ((0.9 * b, 1.1 * b), (0.95 * omega, 1.05 * omega))
    curve = vs.bifurcation_curve(special, ("b", "omega"), bounds)
    report.counted["curves"] += 1
    report.counted["codimension two"] += len(curve.special) - 2 * (not curve.closed)
    where = f"seed {seed}, {special.type} at b = {b!r}"
    if any(end.type == "failed" for end in (curve.begins, curve.ends)):
        report.wrong.append(f"{where}: failed")
    for k in chosen(curve, 3):
        simulate_beside(report, curve, k, where)
    k = int(rng.choice(chosen(curve, 9)))
    ways = {f"from point {k}": vs.bifurcation_curve(special_at(curve, k, special), ("b", "omega"), bounds)}
    for factor in (0.5, 2.0):
        again = vs.bifurcation_curve(special, ("b", "omega"), bounds, step=factor)
        ways[f"with steps of {factor} times the length"] = again
    report.counted["again"] += len(ways)
    for way, other in ways.items():
        pairs = [sorted(map(key, one.special)) for one in (curve, other)]
        same = len(pairs[0]) == len(pairs[1]) and all(
            a[0] == b[0] and np.allclose(a[1:], b[1:], rtol=1e-9, atol=0) for a, b in zip(*pairs, strict=True)
        )
        if not curve.closed and not same:
            report.wrong.append(f"{where}: other points {way}: {pairs}")
    if len({key(one) for one in curve.special}) < len(curve.special) and not curve.closed:
        report.wrong.append(f"{where}: a point twice")


def key(special):
    return special.type, *(float(f"{value:.10g}") for value in special.parameters.values())


def special_at(curve, k, special) -> SpecialPoint:
    solution = solution_at(curve, k)
    names = curve.parameters
    system = special.orbit.system.replace(**{name: float(curve.points[name][k]) for name in names})
    impact = stop_and_impact(solution, curve._solution_curve.problem.index)[1] if curve.type == "graze" else None
    parameters = {name: solution.family.numbers[name] for name in names}
    return SpecialPoint(curve.type, parameters, orbit_of(system, solution), np.empty(0), impact=impact)


def simulate_beside(report: Report, curve, k, where: str) -> None:
    """The orbit on each side of the curve, where there is one, is the motion that the engine computes."""
    solution = solution_at(curve, k)
    if curve.type == "graze":
        keep = np.delete(np.arange(solution.K), curve._solution_curve.problem.index)
        sides = tuple(solution.sides[i] for i in keep)
        u = np.concatenate([solution.times[keep], solution.jumps[keep]])
        solution = replace(solution, sides=sides, u=u)
    for sign in (-1, 1):
        family = solution.family.replace(b=solution.family.numbers["b"] * (1 + sign * BESIDE))
        found = replace(solution, family=family).corrected()
        if found is None or not found.real:
            continue  # beyond a fold or a graze
        orbit = orbit_of(_system(curve, family), found)
        run = vs.simulate(orbit.system, orbit.state, orbit.period)
        size = np.abs(run.section).max() * max(1.0, np.abs(orbit.multipliers).max())
        error = np.abs(run.section[-1] - orbit.state).max() / size
        report.counted["points"] += 1
        if error > CLOSE or len(run.impacts) != len(orbit.impacts):
            report.wrong.append(f"{where}: point {k} differs from simulation by {error:.1e}")


def _system(curve, family) -> vs.System:
    system = curve.special[0].orbit.system
    return system.replace(**{name: family.numbers[name] for name in curve.parameters})
