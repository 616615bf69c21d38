"""Branches that are rows of a table: how a row is followed, and what differs from it.

system : numbers of an oscillator and its `model`; `paper` is `vs.System`. A row of a group changes some `numbers`
start : arguments of `vs.periodic_orbit`; with `settled`, periods simulated from rest before
parameter, bounds : of the branch
special : [type, value, error, attributes] of its special points in order; values may differ by the error, and a
    branch that is followed from this start may state no more than five times as much
steps : lengths of steps that give the same list
not_from : types of special points from which another branch is followed, of which `why` tells
"""

from collections import Counter
from itertools import chain

import numpy as np

import vibro_sweep as vs
from support import cases, conditions
from support.drawn_branches import Case
from support.searching import Report

POINTS = 3  # from which a branch is followed again
STEPS = (0.5, 2)  # of a row that names none
SAMPLE = 8  # points of a branch that are simulated
AT_ONE = {"fold": 1, "flip": -1, "pitchfork": -1}  # the critical multiplier, over half a period of symmetric orbits
NEXT_TO_END = 1  # points at the ends are singular: speeds vanish there


def system_of(row: dict):
    numbers = row["system"] | row.get("numbers", {})
    model = numbers.pop("model")
    return vs.System(**numbers) if model == "paper" else vs.Oscillator.named(model, **numbers)


def orbit_of(row: dict):
    system, start = system_of(row), dict(row["start"])
    if settled := start.pop("settled", None):
        start["state"] = vs.simulate(system, np.zeros(2 * system.masses), settled).section[-1]
    orbit = vs.periodic_orbit(system, **start)
    assert orbit.ok, orbit
    return orbit


def follow(row: dict, orbit, step: float = 1.0):
    return vs.continue_orbit(orbit, row["parameter"], row["bounds"], step=step)


def starts(row: dict, branch):
    """(words, orbit) of other orbits from which the same branch is followed: at its special points and at others."""
    left_out = {"sticking", "failed", *row.get("not_from", ())}
    for special in branch.special:
        birth = special in (branch.begins, branch.ends) and special.type in AT_ONE
        if special.orbit.ok and special.type not in left_out and not birth:
            yield f"from {special.type} at {special.parameters[branch.parameter]!r}", special.orbit
    count = branch.points.sizes["point"]
    for k in np.unique(np.linspace(0, count - 1, row.get("points", POINTS) + 2).astype(int)[1:-1]).tolist():
        yield f"from point {k}", branch.orbit(k)


def with_other_steps(row: dict, orbit) -> list[str]:
    """What a row's branch has otherwise when it is followed with other steps."""
    return [
        f"step {step}: {words}"
        for step in row.get("steps", STEPS)
        for words in differences(row, follow(row, orbit, step))
    ]


def from_other_orbits(row: dict, branch) -> tuple[int, list[str]]:
    """(starts, words) of what it has otherwise when it is followed from other orbits of the same kind."""
    counted, wrong, same = 0, [], kind(middle(branch))
    for start, other in starts(row, branch):
        if kind(other) == same:
            wrong += [f"{start}: {words}" for words in differences(row, follow(row, other))]
            counted += 1
    return counted, wrong


def study(k: int) -> Report:
    """The k-th row of tests/cases/branches.yaml, with all steps and from all starts."""
    row = cases.nth("branches", k)
    orbit = orbit_of(row)
    counted, wrong = from_other_orbits(row, follow(row, orbit))
    return Report(Counter(branches=1, starts=counted), with_other_steps(row, orbit) + wrong)


def middle(branch):
    """An orbit of the branch; at an end it may be that of another branch."""
    return branch.orbit(branch.points.sizes["point"] // 2)


def kind(orbit) -> tuple:
    return orbit.period, sorted(orbit.itinerary), orbit.symmetric


def differences(row: dict, branch) -> list[str]:
    """What a branch has otherwise than its row, in the better of both directions."""
    if branch.closed or not (branch.begins in branch.special[:2] and branch.ends in branch.special[-2:]):
        return ["the branch is closed, or its ends are not the first and the last special point"]
    orders = branch.special, branch.special[::-1]
    return min((in_order(row["special"], order, branch.parameter) for order in orders), key=len)


def in_order(expected: list, special: list, parameter: str) -> list[str]:
    if [kind for kind, *_ in expected] != [one.type for one in special]:
        found = [f"{one.type} {one.parameters[parameter]!r}" for one in special]
        return [f"{found} instead of {[f'{kind} {value!r}' for kind, value, *_ in expected]}"] * (1 + len(special))
    pairs = zip(expected, special, strict=True)
    return list(chain.from_iterable(of_point(entry, one, one.parameters[parameter]) for entry, one in pairs))


def of_point(entry: list, special, found: float) -> list[str]:
    kind, value, error, *attributes = entry
    wrong = [] if abs(found - value) <= error else [f"{kind} at {found!r}, not {value!r} +- {error}"]
    for name, expected in chain.from_iterable(names.items() for names in attributes):
        if getattr(special, name) != expected:
            wrong.append(f"{name} of {kind} at {value!r} is {getattr(special, name)!r}")
    return wrong


def imprecise(row: dict, branch) -> list[str]:
    """Special points whose stated errors say less than is known of them, or whose multipliers are not critical."""
    wrong = []
    for (kind, value, error, *_), special in zip(row["special"], branch.special, strict=True):
        if not (special.error <= 5 * error or kind == "boundary"):
            wrong.append(f"{kind} at {value!r} states the error {special.error:.1e}")
        if kind in AT_ONE and not np.abs(special.multipliers - AT_ONE[kind]).min() < row.get("critical", 1e-10):
            wrong.append(f"{kind} at {value!r} has multipliers {special.multipliers}")
    return wrong


def not_simulated(row: dict, branch) -> tuple[int, list[str]]:
    """(points, words) of a sample of points that are started in the engine's simulation: they have to come back."""
    system, points, orbit = system_of(row), branch.points, middle(branch)
    count, wrong, counted, rests = points.sizes["point"], [], 0, len(orbit.sticking) > 0
    columns = [f"{letter}{i + 1}" for i in range(system.masses) for letter in "xv"]
    for k in sorted(set(np.linspace(1, max(count - 2, 0), SAMPLE).astype(int).tolist()) & set(range(count))):
        point = points.isel(point=k)
        here = system.replace(**{branch.parameter: float(point[branch.parameter])})
        start = np.array([float(point[name]) for name in columns])
        largest = float(np.hypot(point.multiplier_re, point.multiplier_im).max())
        try:
            flown = vs.simulate(here, start, orbit.period)
        except ValueError:  # rounding has put it beyond a stop
            continue
        counted += 1
        apart = np.abs(flown.section[-1] - start).max()
        if "impact_v" in points and not (here.linear.compliant or rests):
            apart = max(apart, apart_in_speed(flown.impacts["v1"], point.impact_v.values))
        if not apart < 1e-9 * max(1.0, largest):
            wrong.append(f"point {k} comes back {apart:.1e} away")
    return counted, wrong


def apart_in_speed(one, other) -> float:
    """The largest difference of the speeds of impacts; an impact that one orbit has not counts as one without speed."""
    speeds = np.zeros((2, max(len(one), len(other))))
    for row, values in zip(speeds, (one, other), strict=True):
        row[len(row) - len(values) :] = np.sort(np.abs(values))
    return float(np.abs(speeds[0] - speeds[1]).max(initial=0.0))


def against_saltation(row: dict, branch, orbit) -> tuple[int, list[str]]:
    """(points, words): all points, and multipliers, by matrices of `reference.saltation`; rigid stops without rests."""
    case = Case(orbit, branch.parameter, tuple(row["bounds"]))
    pieces, points = conditions.Pieces(branch, case), branch.points
    inner = slice(NEXT_TO_END, -NEXT_TO_END)
    wrong = [f"point {k + 1} is no orbit: {off:.1e}" for k, off in enumerate(pieces.off[inner]) if not off < 1e-7]
    own = np.abs(points.multiplier_re.values + 1j * points.multiplier_im.values)
    others = np.sort(np.abs(pieces.multipliers) ** (2 if pieces.symmetric else 1), axis=1)[:, ::-1]
    apart = np.abs(own[:, 0] / others[:, 0] - 1)
    wrong += [f"multipliers of point {k + 1}: {own[k + 1]}" for k, far in enumerate(apart[inner]) if not far < 1e-5]
    wrong += off_the_sum_rule(pieces.oscillators, branch, orbit.period)
    outside = np.sum(np.abs(pieces.multipliers) > 1, axis=1)
    wrong += [
        f"{int(points.unstable[k])} multipliers outside at point {k}, not {outside[k]}"
        for k in np.flatnonzero(pieces.sure & (pieces.off < 1e-7) & (outside != points.unstable.values)).tolist()
    ]
    for special in branch.special:
        far, words = conditions.distance(special)
        wrong += [f"condition of {special.type}: {far:.1e}, {words}"] if far >= conditions.MEETS else []
    for _, words in (
        *conditions.unexplained(pieces),
        *conditions.passing(pieces),
        *conditions.free_passes(branch, case),
    ):
        wrong.append(words)
    return int(pieces.sure.sum()), wrong


def off_the_sum_rule(oscillators, branch, period: int) -> list[str]:
    """Points whose multipliers have another product than R^2 of all impacts times exp(-trace(M^-1 C) n T)."""
    points, wrong = branch.points, []
    sides = points.impact_side.values[0] if "impact_side" in points else []
    for k, q in list(enumerate(oscillators))[NEXT_TO_END:-NEXT_TO_END]:
        R = np.array([q.contact.R_high if side > 0 else q.contact.R_low for side in sides])
        lost = np.trace(np.linalg.solve(q.M, q.C)) * period * 2 * np.pi / q.omega
        own = np.log(np.hypot(points.multiplier_re[k], points.multiplier_im[k]).values).sum()
        if not abs(own - 2 * np.log(R).sum() + lost) < 1e-8:
            wrong.append(f"product of multipliers of point {k}: {own} for {2 * np.log(R).sum() - lost}")
    return wrong
