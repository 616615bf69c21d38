"""`switch`: from a pitchfork, a flip, a graze or a split contact to the orbits that branch off there."""

import math
from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.branches.births import born, is_steady
from vibro_sweep.analysis.branches.sizes import size_of
from vibro_sweep.analysis.branches.special import Graze, SpecialPoint, graze_at, slopes
from vibro_sweep.analysis.branches.split_contacts import in_two, set_apart
from vibro_sweep.analysis.continuation.solution_curve import branch_through
from vibro_sweep.analysis.periodic.contact_numbers import impulse_by_speed, is_smooth, one_plus_R, preload
from vibro_sweep.analysis.periodic.joined_contacts import contacts_are_one, without_flights
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit, found_orbit
from vibro_sweep.analysis.periodic.seeds_of_free_motion import touches_of_free_motion, with_touches
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.checks.arguments import check_type
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.tables.bifurcations import BY_NAME, WAYS

BESIDE = 1e-4  # relative distance of the parameter from a graze
APART = (1e-2, 1e-3, 1e-4)  # of 1/omega: the flight between the two contacts of an orbit beside a split
NEAR = 0.1  # of the orbit beside a graze to what its slopes say, in 1/omega and the speed of the gap
ALIKE = 1.25  # times: what their distances from the graze at a step and half of it may differ from what they should
ROUNDED = 1e-9  # distance, in the same units, that tells nothing


def switch(special: SpecialPoint) -> list[PeriodicOrbit]:
    """Orbits just beyond a pitchfork (two mirror images), a flip (the doubled one), a graze (with, or without, the
    impact that has no speed there; at the graze of the free motion those that hit one stop or both) or a split (with
    one contact in place of two, or with two).

    Orbits that pass a stop are left out, as is free motion that is one of a family (`resonance` in `periodic_orbit`):
    no branch begins with it. Raises ValueError for a special point of another type.
    """
    check_type("special", special, SpecialPoint, "a special point of a branch")
    if special.type not in WAYS:
        raise ArgumentError(not_allowed("type", special.type, f"one of {', '.join(WAYS)}"))
    found = BEYOND[BY_NAME[special.type].beyond](special)
    system = special.orbit.system
    name = next(iter(special.parameters))
    orbits = [
        found_orbit(system.replace(**{name: solution.family.free[name]}), solution)
        for solution in found
        if solution is not None
    ]
    return [orbit for orbit in orbits if orbit.ok]


def _beyond_graze(special: SpecialPoint) -> list[Solution | None]:
    parent = special.orbit._solution
    name = next(iter(special.parameters))
    if parent.K:
        index = None if special.impact is None else index_in(special)
        return [_beside(parent, name, index)]
    free = Solution(parent.family, 1, 2, (), np.empty(0))
    if parent.sigma == -1:  # the motion touches both stops at once: orbits that hit one of them
        one = _beside(free, name, None)
        return [_beside(parent, name, None), *(sorted([one, mirrored(one)], key=_on_the_left) if one else [])]
    both = touches_of_free_motion(free)
    if len(both) < 2:
        return [_beside(parent, name, None)]
    return [_beside(free, name, None, with_touches(free, some)) for some in (both, both[:1], both[1:])]


def _beyond_split(special: SpecialPoint) -> list[Solution | None]:
    solution, name = special.orbit._solution, next(iter(special.parameters))
    unit = size_of(solution, name)
    if not contacts_are_one(solution):
        curve = branch_through(in_two(solution), name, unit)
        found = (set_apart(curve, length) for length in APART)
        return [next((one.solution for one in found if one is not None and one.solution.real), None)]
    one, value = without_flights(solution), solution.family.free[name]
    for step in (sign * BESIDE * unit / 2**k for k in range(20) for sign in (1, -1)):
        try:
            found = replace(one, family=one.family.replace(**{name: value + step})).corrected()
        except ValueError:  # the parameter is beyond its range
            continue
        if found is not None and found.real and np.abs((found.u - one.u) / one.units).max() < NEAR:
            return [found]
    return []


def _on_the_left(solution: Solution) -> int:
    return solution.sides.count(-1)


BEYOND = {  # what branches off a type of special point
    "doubled": lambda special: [born(special.orbit._solution, next(iter(special.parameters)), 1)],
    "mirror images": lambda special: [
        born(special.orbit._solution, next(iter(special.parameters)), sign) for sign in (1, -1)
    ],
    "graze": _beyond_graze,
    "split": _beyond_split,
}


def index_in(special: SpecialPoint) -> int:
    """Index in the solution of the impact of a graze, which `special` counts as `orbit.impacts` does."""
    first, _ = special.orbit._canonical_frame
    return (special.impact + first) % special.orbit._solution.K


def _beside(solution: Solution, name: str, impact: int | None, touching: Solution | None = None) -> Solution | None:
    """The orbit with (without) the grazing impact, a little beside the graze on the side where it exists; `touching` as
    of `graze_at`. That at half the distance lies between the two, or another orbit was found."""
    value = solution.family.free[name]
    try:
        graze = graze_at(solution, name, impact, touching)
        target = graze.touching if impact is None else graze.without
        grows = math.isinf(graze.speed_slope) and impact is None
        du = np.zeros(len(target.u)) if grows else slopes(target, name)
    except np.linalg.LinAlgError:  # a fold as well: no slopes
        return None
    slope = graze.speed_slope if impact is None else graze.distance_slope
    step, last, ratio = math.copysign(BESIDE * size_of(solution, name), slope), None, math.sqrt(2) if grows else 2.0
    for _ in range(20):
        try:
            family = solution.family.replace(**{name: value + step})
            u = pressed(graze, step) if grows else target.u + step * du
            guess = replace(target, family=family, u=u)
            found = guess.corrected()
        except ValueError:  # the parameter is beyond its range
            found = None
        near = found is not None and found.real and np.abs((found.u - guess.u) / target.units).max(initial=0.0) < NEAR
        if near and is_steady(found, name):
            away = float(np.abs((found.u - target.u) / target.units).max(initial=0.0))
            if away < ROUNDED or (last and ratio / ALIKE < last[1] / away < ratio * ALIKE):
                return last[0] if last else found
            last = found, away
        step /= 2
    return last and last[0]


def pressed(graze: Graze, step: float) -> np.ndarray:
    """The unknowns of the orbit with all that touch, where the parameter is beyond the graze by `step`.

    The gap turns with the acceleration a. In a contact that begins smoothly it is behind the stop by d = |slope step|
    at most, for the time s with d = |a| s^2/8, and touches it with the speed |a| s/2 = (2 |a| d)^(1/2); so does an
    impact that the orbit has forgotten when it comes again.
    """
    target, touched = graze.touching, graze.at_once
    u, K, q = target.u.copy(), target.K, target.family.linear
    depths, impulses = -graze.distance_slopes, None
    if touched is not None:
        depths, impulses = touched.begun(np.ones(K, bool))
    for number, k in enumerate(graze.gone.tolist()):
        side, a, d = target.sides[k], abs(float(target.motion[k, 1])), abs(depths[number] * step)
        grows = impulses is None or is_smooth(q, side)
        v = math.sqrt(2 * a * d) if grows else abs(impulses[number] * step) / impulse_by_speed(q, side)
        u[k] -= v / a
        u[K + k] -= side * v * one_plus_R(q, [side])[0]
        if k in target.rests:
            u[2 * K + target.rests.index(k)] += 2 * v / (a + preload(q, side)) - v / a
    return u


def mirrored(solution: Solution) -> Solution:
    """x -> -x, t -> t + T/2."""
    shift = math.pi / solution.family.linear.omega
    u = np.concatenate([solution.times + shift, -solution.jumps, solution.ends + shift])
    return replace(solution, sides=tuple(-side for side in solution.sides), u=u)
