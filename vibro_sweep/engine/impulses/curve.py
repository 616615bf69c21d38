"""Many steps along a bifurcation curve: predictor, corrector, tests and certificate of every point.

Distances are measured in the units of the curve, over times, impulses, parameters and theta. A call ends where
something happens between two points, so that the caller can locate it; both points are kept.
"""

import math

import numpy as np

from vibro_sweep.engine.impulses.chatter_steps import follow
from vibro_sweep.engine.impulses.curve_path import bulges, comes_back, copy_place, keep, outside, remember
from vibro_sweep.engine.impulses.curve_tests import BEFORE, LAST, LENGTH, RESIDUAL, examine, happens
from vibro_sweep.engine.impulses.locus import (
    FIRST,
    SECOND,
    STICK,
    THETA,
    TORUS,
    assemble,
    in_order,
    move,
    newton_step,
    size_of,
)
from vibro_sweep.engine.impulses.pairs import coarse, exchanged
from vibro_sweep.engine.impulses.plane import move_exactly, move_to
from vibro_sweep.engine.simd.jit import entry, jit

FULL, EVENT, CLOSED, FAILED, FAR, LEFT, STRONG, CHATTER = range(8)
# why a call ends; FAR: beyond the reach of the plane, LEFT: perhaps out of the box, STRONG: near the resonance 1:1 or
# 1:2, CHATTER: more or fewer impacts of a chatter sequence are to be written out
MOST_CORRECTIONS = 6
CONVERGED = 1e-9  # Newton's change after which the next one is below rounding
BEYOND = 1.2  # times the reach of the plane, up to where its polynomials hold
EARLY = 10  # points before which a curve is not yet taken to be closed
COARSE = 0.03  # of the longest step: to that they are shortened where they do not tell pairs of multipliers apart
NEAR_STRONG = 0.05  # theta from 0 or pi
LATEST, EARLIEST = 0.9, 0.4  # values of LAST and BEFORE at which another number of impacts is to be written out


@jit
def counts(place, j):
    """Whether distances are measured over unknown j: not over the state h."""
    return j < 2 * len(place.t) or j >= len(place.w)


@jit
def take_row(c, place, row):
    """The plane across the tangent."""
    for j in range(size_of(c, place)):
        row[j] = place.tangent[j] if counts(place, j) else 0.0


@jit
def normalise(c, place):
    size = 0.0
    for j in range(size_of(c, place)):
        if counts(place, j):
            size += place.tangent[j] ** 2
    size = math.sqrt(size)
    for j in range(size_of(c, place)):
        place.tangent[j] /= size


@jit
def cosine(c, a, b):
    total = 0.0
    for j in range(size_of(c, a)):
        if counts(a, j):
            total += a.tangent[j] * b.tangent[j]
    return total


@jit
def correct(f, c, place, row, b):
    """Newton's method from `place` on the plane through it across `row`. Corrections made; 0: none found."""
    before = np.inf
    for count in range(1, MOST_CORRECTIONS + 1):
        for j in range(2):
            if not abs(place.p[j] - f.centre[j]) <= BEYOND * f.reach[j]:
                return 0
        if not move_to(f, place.p[FIRST], place.p[SECOND]):
            return 0
        change = newton_step(f, c, place, row, b, place.tangent)
        if not change <= 1.0 or not in_order(f.P, place):
            return 0
        if change < CONVERGED or (change < 1e-7 and change > 0.3 * before):
            place.tests[RESIDUAL] = change
            normalise(c, place)
            return count
        before = change
    return 0


@jit
def rate_again(f, a, b):
    """h' before the first impact of a, where b was used for another point since."""
    if move_to(f, a.p[FIRST], a.p[SECOND]):
        for r in range(len(a.h)):
            b.room.rate[0, r] = f.A[r, len(a.h)]
            for k in range(len(a.h)):
                b.room.rate[0, r] += f.A[r, k] * a.h[k]


@jit
def set_up(f, c, place, b):
    """What tests of a corrected point need; of a chatter's tail, what the last correction left serves."""
    if c.kind != STICK:
        return assemble(f, c, place, b)
    for r in range(len(place.h)):
        b.room.h[0, r] = place.h[r]
    follow(f, c.sides, c.sigma, place.t, place.D, b.room)
    return True


@jit
def hides(path, a, b, length):
    """Whether two pairs, or one twice, may cross the unit circle between two points: their test does not tell."""
    here, there = a.multipliers, b.multipliers
    return exchanged(here, there) or coarse(path.past, here, there, path.before[0], length)


@jit
def walk(f, c, path, place, row, b):
    """Steps from `path.a` until something happens, and why the call ends.

    Recorded are the points before the step in which it happens; path.a and place are the two points of this step.
    """
    a, record, counts = path.a, path.record, path.counts
    counts[1] = counts[2] = 0
    length = a.tests[LENGTH]
    rate_again(f, a, b)
    while counts[1] < len(record.p):
        for j in range(2):
            if not abs(a.p[j] - f.centre[j]) <= f.reach[j]:
                a.tests[LENGTH] = length
                return FAR
        if c.kind == STICK and (a.tests[LAST] > LATEST or a.tests[BEFORE] < EARLIEST):
            a.tests[LENGTH] = length
            return CHATTER
        copy_place(a, place)
        take_row(c, a, row)
        move(c, place, a.tangent, length, b.room.rate)
        made = correct(f, c, place, row, b)
        turn = np.inf
        if made > 0:
            turn = math.acos(min(1.0, max(-1.0, cosine(c, a, place))))
        counts[2] += made
        if not turn <= path.straight:
            length *= 0.5
            if length < path.shortest:
                return FAILED
            rate_again(f, a, b)
            continue
        place.tests[LENGTH] = length
        if outside(path, place):
            return LEFT
        if not (move_to(f, place.p[FIRST], place.p[SECOND]) and set_up(f, c, place, b)):
            return FAILED
        examine(f, c, place, b)
        if length > COARSE * path.longest and hides(path, a, place, length):
            length *= 0.5
            rate_again(f, a, b)
            continue
        remember(path, a, length)
        if bulges(path, c, a, place):  # the curve may leave and come back, and if not it goes on from here
            return LEFT
        if c.kind == TORUS and not NEAR_STRONG < place.p[THETA] < math.pi - NEAR_STRONG:
            return STRONG
        if happens(c, a, place):
            return EVENT
        if counts[0] + counts[1] >= EARLY and comes_back(c, a, path.first, length):
            return CLOSED
        keep(place, b, record, counts[1])
        counts[1] += 1
        if turn < path.straight / 3 and made <= 3:
            length = min(1.5 * length, path.longest)
        copy_place(place, a)
        a.tests[LENGTH] = length
    return FULL


MOVE, ASSEMBLE, CORRECT, EXAMINE, NEAR, WALK = range(6)  # what `at` is to do


@entry
def at(task, planes, c, path, place, row, b):
    """One kernel for Python, since each is compiled with all that it calls; 0 or NaN where something is singular.

    MOVE: to the parameters of `place`, with the values `exact` of the plane; CORRECT, one step of Newton's method (its
    size is returned), and EXAMINE, tests, do that first. ASSEMBLE: equations. NEAR: all steps of Newton's method, with
    the polynomials of the plane, and tests. WALK: why it ends.
    """
    f = planes[0]
    if task == MOVE or task == CORRECT or task == EXAMINE:
        moved = move_exactly(f, place.p[FIRST], place.p[SECOND])
        if task == MOVE or not moved:
            return 1.0 if moved else np.nan if task == CORRECT else 0.0
    if task == CORRECT:
        change = newton_step(f, c, place, row, b, place.tangent)
        return change if in_order(f.P, place) else np.nan
    if task == WALK:
        return float(walk(f, c, path, place, row, b))
    if task == NEAR and not (correct(f, c, place, row, b) > 0 and move_to(f, place.p[FIRST], place.p[SECOND])):
        return 0.0
    if not assemble(f, c, place, b):
        return 0.0
    if task == EXAMINE or task == NEAR:
        examine(f, c, place, b)
    return 1.0
