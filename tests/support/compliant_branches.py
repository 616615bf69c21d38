"""Branches of random oscillators with compliant stops, from several starts and with several lengths of steps."""

import collections

import numpy as np

from support.drawn_branches import MOST_IMPACTS, Case, drawn_number, drawn_oscillator, recorded
from support.same_branch import TooLongError, differences, follow, listed
from vibro_sweep.analysis.branches.branch_arrays import arrays_of
from vibro_sweep.tables.bifurcations import BY_NAME

MODELS = ("two_mass", "one_mass", "chain", "linear")
BY_FORCE = 1000  # seeds from there on have `release: force`
NEAR = 1e-6  # of an orbit to the point of a branch from which it is corrected
ON_CIRCLE = 1e-6  # of | |mu| - 1 |: so near to it counts are rounding


def drawn_stops(model: str, rng, release: str):
    """An oscillator as of `drawn_oscillator`, its stops compliant: soft or stiff, some damped, some preloaded."""
    system = drawn_oscillator(model, rng)
    k, z = 10 ** rng.uniform(0.5, 4), rng.choice([0.0, rng.uniform(0.01, 0.4)])
    rigid = dict.fromkeys(("R", "R_left")) if system.numbers.get("R_left") is not None else {"R": None}
    preload = float(rng.choice([0.0, 0.0, rng.uniform(0, 0.3)]))
    return system.replace(**rigid, k_stop=k, c_stop=2 * z * np.sqrt(k), preload=preload, release=release)


def drawn_case(seed: int) -> Case | None:
    """An attractor of a drawn oscillator, and the number in which its branch is followed."""
    rng = np.random.default_rng(seed)
    system = drawn_stops(MODELS[seed % len(MODELS)], rng, "displacement" if seed < BY_FORCE else "force")
    for _ in range(4):
        orbit = recorded(system, rng)
        if orbit is not None and orbit.ok and 0 < len(orbit.itinerary) <= MOST_IMPACTS:
            return Case(orbit, *drawn_number(system, rng))
    return None


def unexplained(branch) -> list[str]:
    """Changes of the number of unstable multipliers between special points that no special point explains."""
    start = branch._start.family.numbers[branch.parameter]
    arrays = arrays_of(branch, start)
    mu = branch.points.multiplier_re.values + 1j * branch.points.multiplier_im.values
    sure = np.all(np.abs(np.abs(mu) - 1) > ON_CIRCLE, axis=1)
    outside, found = np.sum(np.abs(mu) > 1, axis=1), []
    at_points = [(one, at) for one, at in zip(branch.special, arrays["special_point"].tolist(), strict=True) if at >= 0]
    places = [at for _, at in at_points]  # without the one where a closed branch comes back to its first point
    for first, last in zip([-1, *places], [*places, len(mu)], strict=True):
        between = np.flatnonzero(sure[first + 1 : last]) + first + 1
        if len(between) and np.ptp(outside[between]) > 0:
            found.append(f"unstable {np.unique(outside[between])} between points {first} and {last}")
    for one, at in at_points:
        before, behind = np.flatnonzero(sure[:at]), np.flatnonzero(sure[at + 1 :]) + at + 1
        inner = (
            len(before)
            and len(behind)
            and not any(other != at and before[-1] <= other <= behind[0] for other in places)
        )
        crossing = np.dot(BY_NAME[one.type].crosses, (1, 1, 2))
        if inner and one.type in ("fold", "flip", "pitchfork", "neimark_sacker"):
            if abs(outside[behind[0]] - outside[before[-1]]) != crossing:
                found.append(f"{one.type} at {one.parameters}: {outside[before[-1]]} and {outside[behind[0]]}")
    return found


def within(bounds, special, name: str) -> bool:
    """Whether a special point lies within the bounds of its branch."""
    return bounds[0] <= special.parameters[name] <= bounds[1]


def apart_at_ends(branch) -> list[str]:
    """Ends at whose last point the branch has other multipliers than the end itself."""
    mu, found = branch.points.multiplier_re.values + 1j * branch.points.multiplier_im.values, []
    for one, there in ((branch.begins, mu[0]), (branch.ends, mu[-1])):
        of_end = np.sort(np.abs(one.multipliers)) ** (2 if one.orbit.symmetric else 1)
        if one.type in ("boundary", "graze") and not np.allclose(np.sort(np.abs(there)), of_end, rtol=1e-6, atol=1e-9):
            found.append(f"{one.type} at {one.parameters}: multipliers {there}, and {one.multipliers}")
    return found


def other_starts(branch, case: Case, rng, most=3):
    """(words, orbit) at points of the branch."""
    count = branch.points.sizes["point"]
    for k in rng.permutation(np.unique(np.r_[1, count - 2, rng.integers(1, count - 1, 3)]))[:most].tolist():
        orbit = branch.orbit(k)
        system, there = orbit.system, orbit._solution
        found = there.corrected()  # which from a fold leads anywhere
        if found is not None and np.abs((found.u - there.u) / there.units).max() < NEAR:
            yield f"point {k}", type(case.orbit)(system, "ok", found.reduced(), None)


def study(seed: int) -> tuple[collections.Counter, list[str]]:
    """What was counted, and what is wrong, of one drawn branch."""
    counted, wrong, case = collections.Counter(drawn=1), [], drawn_case(seed)
    if case is None:
        return counted, wrong
    try:
        branch = follow(case)
    except TooLongError:
        return counted + collections.Counter(too_long=1), wrong
    counted.update(branches=1, points=branch.points.sizes["point"])
    counted.update(one.type for one in branch.special)
    wrong += unexplained(branch) + apart_at_ends(branch)
    wrong += [f"{one.type} at {one.parameters}" for one in branch.special if not within(case.bounds, one, case.name)]
    wrong += [f"failed at {one.parameters}" for one in branch.special if one.type == "failed"]
    wrong += [f"{one.type} at {one.parameters}: error {one.error:.1e}" for one in branch.special if one.error > 1e-9]
    runs = [(f"steps times {factor}", case.orbit, factor) for factor in (0.5, 2.0)]
    rng = np.random.default_rng(seed + 10**6)
    runs += [(words, orbit, 1.0) for words, orbit in other_starts(branch, case, rng)]
    for words, orbit, factor in runs:
        again = follow(case._replace(orbit=orbit), factor)
        counted["runs"] += 1
        size = case.bounds[1] - case.bounds[0]
        for kind, difference in dict(differences(listed(branch), listed(again), size, branch.closed)).items():
            wrong.append(f"{words}: {kind}, {difference}")
    return counted, [f"seed {seed}, {case}: {line}" for line in wrong]
