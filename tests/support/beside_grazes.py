"""Branches followed from orbits ever nearer to the graze at their end: whether the graze is said to be the same."""

from collections import Counter
from dataclasses import replace
from functools import partial

import numpy as np

from support import compliant_branches
from support.drawn_branches import drawn_case
from support.same_branch import CLOSE, TooLongError, follow
from vibro_sweep.oscillator.family import family_of

MODELS = ("two_mass", "one_mass", "chain", "linear")
DECADES = range(3, 17)  # of the way from the graze to the second point beside it: the first may be as near as 1e-8


def case_of(seed: int, stops: str):
    """The branch that is drawn."""
    if stops == "compliant":
        return compliant_branches.drawn_case(seed)
    return drawn_case(MODELS[seed % len(MODELS)], np.random.default_rng(seed))


def told(special) -> tuple:
    """What is said of a graze. Of the two stops that a symmetric orbit touches either may be named."""
    stop = None if special.orbit.symmetric else special.stop
    return special.type, special.kind, special.direction, special.impact, stop


def starts(branch, case, decades=DECADES):
    """(graze, decade, orbit) beside the grazes at the ends of a branch; None where Newton's method finds no orbit."""
    values, last = branch.points[case.name].values, branch.points.sizes["point"] - 1
    for graze, here, beside in ((branch.begins, 0, 2), (branch.ends, last, last - 2)):
        if graze.type != "graze" or last < 2:
            continue
        begin = branch.orbit(here)
        step = branch.orbit(beside)._solution.u - begin._solution.u
        for decade in decades:
            share = 10.0**-decade
            there = begin.system.replace(**{case.name: float(values[here] + share * (values[beside] - values[here]))})
            guess = replace(begin._solution, family=family_of(there))
            found = replace(guess, u=guess.u + share * step).corrected()
            real = found is not None and found.real
            yield graze, decade, type(case.orbit)(there, "ok", found.reduced(), None) if real else None


def study(seed: int, stops: str, decades=DECADES) -> tuple[Counter, list[str]]:
    """What was counted, and what is wrong, of one drawn branch."""
    counted, wrong, case = Counter(drawn=1), [], case_of(seed, stops)
    if case is None:
        return counted, wrong
    try:
        branch = follow(case)
        counted.update(branches=1, grazes=[branch.begins.type, branch.ends.type].count("graze"))
        for graze, decade, orbit in starts(branch, case, decades):
            if orbit is None:
                counted["without an orbit"] += 1
                continue
            counted["starts"] += 1
            value = graze.parameters[case.name]
            ends = (one for end in (follow(case._replace(orbit=orbit)),) for one in (end.begins, end.ends))
            near = [told(one) for one in ends if abs(one.parameters[case.name] - value) <= CLOSE * max(1, abs(value))]
            if told(graze) not in near:
                wrong.append(f"seed {seed}, {stops}, 1e-{decade} beside {case.name} = {value}: {near}, {told(graze)}")
    except TooLongError:
        counted["too_long"] += 1
    return counted, wrong


study_of_rigid, study_of_compliant = partial(study, stops="rigid"), partial(study, stops="compliant")
