"""Curves of bifurcations of random oscillators with compliant stops, with several lengths of steps."""

import collections
from functools import partial

import numpy as np

import vibro_sweep as vs
from support.compliant_branches import drawn_case
from support.random_curves import TYPES, key
from support.same_branch import TooLongError, follow

OTHERS = ("omega", "b", "zeta", "k_stop")  # the other number: the first that is not the branch's
BESIDE, FAR = (0.1, 0.05), (0.4, 0.4)  # of both numbers, within which a curve is followed
SAME = 1e-8  # of the numbers of a point of codimension two
CRITICAL = {
    "cusp": (1,), "fold_flip": (1, -1), "fold_graze": (1,), "flip_graze": (-1,), "pitchfork_graze": (-1,),
    "resonance_1_1": (1,), "resonance_1_2": (-1,), "resonance_1_3": (np.exp(2j / 3 * np.pi),), "resonance_1_4": (1j,),
    "fold_neimark_sacker": (1,), "flip_neimark_sacker": (-1,), "degenerate_flip": (-1,),
}  # fmt: skip
ROUNDED = 1e-3  # of a multiplier: beside a graze it moves like the square root of the numbers


def study(seed: int, most=2, beside=BESIDE) -> tuple[collections.Counter, list[str]]:
    """What was counted, and what is wrong, of the curves through special points of one drawn branch."""
    counted, wrong, case = collections.Counter(drawn=1), [], drawn_case(seed)
    if case is None:
        return counted, wrong
    try:
        branch = follow(case)
    except TooLongError:
        return counted, wrong
    other = next(name for name in OTHERS if name != case.name and case.orbit.system.numbers.get(name))
    for special in [one for one in branch.special if one.type in TYPES][:most]:
        names = case.name, other
        values = special.parameters[case.name], special.orbit.system.numbers[other]
        reach = [part * abs(value) for part, value in zip(beside, values, strict=True)]
        bounds = [(value - by, value + by) for value, by in zip(values, reach, strict=True)]
        where = f"seed {seed}, {special.type} at {case.name} = {values[0]!r} with {other}"
        counted["begun"] += 1
        try:
            curve = vs.bifurcation_curve(special, names, bounds)
        except ValueError as error:
            wrong.append(f"{where}: {error}")
            continue
        counted.update(curves=1, points=curve.points.sizes["point"])
        counted.update(one.type for one in curve.special)
        wrong += [f"{where}: failed at {one.parameters}" for one in known(curve) if one.type == "failed"]
        wrong += [f"{where}: {one.type} with {one.multipliers}" for one in curve.special if is_misnamed(one)]
        ways = []
        for factor in (0.5, 2.0):
            ways.append((f"steps times {factor}", vs.bifurcation_curve(special, names, bounds, step=factor)))
        counted["again"] += len(ways)
        for way, again in ways:
            pairs = [sorted(map(key, known(one))) for one in (curve, again)]
            same = len(pairs[0]) == len(pairs[1]) and all(
                a[0] == b[0] and np.allclose(a[1:], b[1:], rtol=SAME, atol=0) for a, b in zip(*pairs, strict=True)
            )
            if not curve.closed and not same:
                wrong.append(f"{where}: other points {way}: {pairs}")
    return counted, wrong


study_far = partial(study, most=3, beside=FAR)  # through more special points, and farther


def is_misnamed(special) -> bool:
    """Whether a point of codimension two of a motion lacks a multiplier that its type has."""
    needed = CRITICAL.get(special.type, ()) if special.orbit.ok else ()
    return any(not np.abs(special.multipliers - mu).min(initial=np.inf) < ROUNDED for mu in needed)


def known(curve):
    """Special points, but the ends of what is no motion: nothing is claimed of it."""
    virtual = curve.points.virtual.values
    left_out = [end for end, is_virtual in ((curve.begins, virtual[0]), (curve.ends, virtual[-1])) if is_virtual]
    return [
        one
        for one in curve.special
        if one.type not in ("boundary", "failed") or not any(one is end for end in left_out)
    ]
