"""Bifurcation curves of random systems, held against simulation, and against the same curves from other points and
with other steps."""

import numpy as np

import vibro_sweep as vs
from support.curves import chosen, steepest
from support.in_digits import of_point
from support.random_branches import attractors, random_system
from support.searching import Report, new_report
from vibro_sweep.types import SpecialPoint

TYPES = ("fold", "flip", "pitchfork", "neimark_sacker", "graze")
CLOSE = 1e-9  # of the state after a period of simulation, relative, times the largest multiplier
BESIDE = 1e-4  # relative distance of the two sides from a point
CROSSED = 1e-4  # relative: of both ends of a branch that crosses a curve
SAME = 1e-9  # relative: of a point of a curve and the special point there
NEAR = 0.1  # of the state: orbits there are no farther


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
        simulate_beside(report, curve, k, where, special.orbit)
    k, ways = int(rng.choice(chosen(curve, 9)[1:-1])), {}  # the ends lie on the bounds
    if (other := special_at(curve, k, special.orbit)) is not None:
        ways[f"from point {k}"] = vs.bifurcation_curve(other, ("b", "omega"), bounds)
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


def special_at(curve, k, orbit) -> SpecialPoint | None:
    """The special point of the branch that crosses a curve at one of its points; None where no orbit is found beside.

    orbit: that of the special point where the curve was begun
    """
    motion, name = of_point(curve, k, orbit), steepest(curve, k)
    value, state = float(curve.points[name][k]), motion.sample([0.0])[0]
    for distance in (CROSSED * value, -CROSSED * value):
        system = motion.system.replace(**{name: value + distance})
        try:
            beside = vs.periodic_orbit(system, state=state, periods=orbit.period)
        except ValueError:  # the state is behind a stop there
            continue
        if beside.ok and (beside.period, beside.symmetric) == (orbit.period, motion.sigma < 0):
            ends = sorted((value - distance, value + 2 * distance))
            for special in vs.continue_orbit(beside, name, ends).special:
                if special.type == curve.type and abs(special.parameters[name] - value) < SAME * abs(value):
                    return special
    return None


def simulate_beside(report: Report, curve, k, where: str, orbit) -> None:
    """The orbit on each side of the curve, where there is one, is the motion that the engine computes."""
    motion = of_point(curve, k, orbit)
    state = motion.sample([0.0])[0]
    for sign in (-1, 1):
        system = motion.system.replace(b=motion.system.b * (1 + sign * BESIDE))
        beside = vs.periodic_orbit(system, state=state, periods=orbit.period)
        if not beside.ok or np.abs(beside.state - state).max() > NEAR * np.abs(state).max():
            continue  # beyond a fold or a graze
        run = vs.simulate(system, beside.state, beside.period)
        size = np.abs(run.section).max() * max(1.0, np.abs(beside.multipliers).max())
        error = np.abs(run.section[-1] - beside.state).max() / size
        report.counted["points"] += 1
        if error > CLOSE or len(run.impacts) != len(beside.impacts):
            report.wrong.append(f"{where}: point {k} differs from simulation by {error:.1e}")
