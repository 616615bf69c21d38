"""Many steps along a branch or a bifurcation curve: predictor, corrector, tests and certificate of every point.

Distances are measured in the units of the problem, over phases, jumps, parameters and theta. A call ends where
something happens between two points, so that the caller can locate it; both points are kept. It ends too where
something may happen twice between two points of a branch, unseen by their tests: then the caller looks between them.
A step that goes over to another branch is made shorter, and those of a curve beside which something may happen twice.
"""

import math

import numpy as np

from vibro_sweep.engine.continuation.certificate import certify
from vibro_sweep.engine.continuation.corrector import assemble, in_order, move, newton_step, put_plane
from vibro_sweep.engine.continuation.curve_tests import overflows
from vibro_sweep.engine.continuation.guesses import close, converge_all
from vibro_sweep.engine.continuation.lasting import contacts_begin, forced
from vibro_sweep.engine.continuation.looking_at import examine, goes_over, happens, may_pass_twice, refresh, touches
from vibro_sweep.engine.continuation.moving_flow import (
    OMEGA,
    build_middle,
    build_swing,
    move_exactly,
    move_to,
    take_shift,
)
from vibro_sweep.engine.continuation.path import (
    bulges,
    comes_back,
    copy_place,
    go_back,
    keep,
    measured,
    outside,
    rate,
    remember,
    state_at,
)
from vibro_sweep.engine.continuation.reflections import take_apart, take_up
from vibro_sweep.engine.continuation.residual import follow
from vibro_sweep.engine.continuation.workspace import FIRST, SECOND, TEST
from vibro_sweep.engine.impulses.pairs import coarse, exchanged
from vibro_sweep.engine.simd.jit import exported_quickly, jit

FULL, EVENT, CLOSED, FAILED, FAR, LEFT, CHATTER, TOUCH = range(8)
# why a call ends; FAR: beyond the reach of the plane, LEFT: perhaps out of bounds, CHATTER: more or fewer impacts of a
# chatter sequence are to be written out, TOUCH: something may vanish twice
MOST_CORRECTIONS = 6
CONVERGED = 1e-9  # Newton's change after which the next one is below rounding
MOST_EXACTLY = 20  # corrections of a point that is read
EXACTLY = 1e-15  # its last change, unless the changes stop falling
SHIFTED = 0.8  # of a step, where its end lies on a bifurcation by chance
MOST_SHIFTS = 5  # of one step
BEYOND = 1.2  # times the reach of the plane, up to where its polynomials hold
EARLY = 10  # points before which a curve is not yet taken to be closed
KINK = 1e-3  # of the longest step: in which a branch may turn where a contact ends in another way
FINE = 1e-6  # of the longest step: to that they are shortened where they go over to another branch
COARSE = 0.03  # of the longest step: to that they are shortened where they do not distinguish pairs of multipliers
TWICE = 1e-3  # of the longest step: to that they are shortened where a test of a curve may vanish twice


@jit
def take_row(c, place, row):
    """The plane across the tangent."""
    for k in range(len(row)):
        row[k] = rate(c, place, k)


@jit
def normalise(c, place):
    size = 0.0
    for k in range(measured(c, place)):
        size += rate(c, place, k) ** 2
    scale = 1.0 / math.sqrt(size) if size > 0.0 else 0.0  # a single point has no tangent
    for i in range(len(place.x)):
        for r in range(place.x.shape[1]):
            place.tangent[i, r] *= scale
    for j in range(3):
        place.tangent_p[j] *= scale


@jit
def cosine(c, a, b):
    total = 0.0
    for k in range(measured(c, a)):
        total += rate(c, a, k) * rate(c, b, k)
    return total


@jit
def correct(f, c, place, row, b, most, enough):
    """Newton's method from `place` on the plane through it across `row`, so many corrections at most, until a change is
    small enough. Corrections made; 0: none found."""
    before = np.inf
    for count in range(1, most + 1):
        for j in range(2):
            if not abs(place.p[j] - f.centre[j]) <= BEYOND * f.reach[j]:
                return 0
        if not move_to(f, place.p[FIRST], place.p[SECOND]):
            return 0
        change = newton_step(f, c, place, row, b)
        if not change <= 1.0 or not in_order(f, c, place):
            return 0
        if change < enough or (change < 1e-7 and change > 0.3 * before):
            if not contacts_begin(c, place, b):  # that of another branch
                return 0
            place.tests[TEST.residual] = change
            normalise(c, place)
            return count
        before = change
    return 0


@jit
def hides(path, a, b, length):
    """Whether two pairs, or one twice, may cross the unit circle between two points: their test does not tell."""
    here, there = a.multipliers, b.multipliers
    return exchanged(here, there) or coarse(path.past.multipliers, here, there, path.before[0], length)


@jit
def take_steps(f, c, path, place, row, b):
    """Steps from `path.a` until something happens, and why the call ends.

    Recorded are the points before the step in which it happens; path.a and place are the two points of this step.
    """
    a, counts, shifts = path.a, path.counts, 0
    counts[1] = counts[2] = 0
    length = a.tests[TEST.length]
    while counts[1] < len(path.record.p):
        for j in range(2):
            if not abs(a.p[j] - f.centre[j]) <= f.reach[j]:
                a.tests[TEST.length] = length
                return FAR
        if overflows(c, a):
            a.tests[TEST.length] = length
            return CHATTER
        copy_place(a, place)
        take_row(c, a, row)
        move(c, place, a.tangent, a.tangent_p, length)
        made = correct(f, c, place, row, b, MOST_CORRECTIONS, CONVERGED)
        turn = np.inf
        if made > 0:
            turn = math.acos(min(1.0, max(-1.0, cosine(c, a, place))))
        counts[2] += made
        kinks = made > 0 and length < KINK * path.longest and forced(b) != a.tests[TEST.forced]
        if not turn <= path.straight and not kinks:
            length *= 0.5
            if length < path.shortest:
                return FAILED
            continue
        place.tests[TEST.length] = length
        left = outside(path, place)
        if not (move_to(f, place.p[FIRST], place.p[SECOND]) and refresh(f, c, place, b) and examine(f, c, place, b)):
            return LEFT if left else FAILED
        if place.tests[TEST.on_circle] > a.tests[TEST.on_circle] and shifts < MOST_SHIFTS:  # signs would be rounding
            length *= SHIFTED
            shifts += 1
            continue
        shifts = 0
        over = length > FINE * path.longest and goes_over(c, a, place)
        if over or (length > COARSE * path.longest and hides(path, a, place, length)):
            length *= 0.5
            continue
        if min(length, path.before[0]) > TWICE * path.longest and may_pass_twice(path, c, a, place):
            length = go_back(path, length)
            continue
        touching = touches(path, c, a, place)
        remember(path, a, length)
        if touching:
            return TOUCH
        if left or bulges(path, c, a, place):  # it may leave and come back, and if not it goes on from here
            return LEFT
        if happens(c, a, place):
            return EVENT
        if counts[0] + counts[1] >= EARLY and comes_back(c, a, path.first, length):
            return CLOSED
        keep(place, b, f.numbers[OMEGA], path.record, counts[1])
        counts[1] += 1
        if turn < path.straight / 3 and made <= 3:
            length = min(1.5 * length, path.longest)
        copy_place(place, a)
        a.tests[TEST.length] = length
    return FULL


@jit
def take_states(f, c, path, b):
    """States of the recorded points at their phases. 0.0 where one has no forced motion."""
    record = path.record
    for i in range(path.counts[1]):
        if not move_to(f, record.p[i, 0], record.p[i, 1]):
            return 0.0
        state_at(f, c, record.x[i], record.phase[i], b, record.state[i])
    return 1.0


# what `at` is to do
MOVE, ASSEMBLE, CORRECT, EXAMINE, NEAR, SOLVE, STEPS, STATES, FOLLOW, TAKE_APART, TAKE_UP = range(11)
CLOSE, CONVERGE, CERTIFY = range(11, 14)  # of an orbit alone


@exported_quickly
def at(task, planes, c, path, place, row, b):
    """One kernel for Python, since each is compiled with all that it calls; 0 or NaN where something is singular.

    MOVE: to the parameters of `place`, with the values `exact` of the plane; CORRECT, one step of Newton's method (its
    size is returned), and EXAMINE, tests, do that first. ASSEMBLE: equations, and null vectors. NEAR: all steps of
    Newton's method, with the polynomials of the plane, and tests. SOLVE: the same as far as rounding allows, with the
    polynomials shifted so that they pass through `exact` at `place`. STEPS: why they end. STATES:
    of the recorded points, at `record.phase`. FOLLOW: states before all events
    from that before the first. TAKE_APART: the change of all events, `events.changes[1]`, for xi_1 and parameters in
    `work.null`. TAKE_UP: the left vector, in `trial`, for those of the last and of the eliminated equations.
    CLOSE: the motion through all events, without rests; CONVERGE: Newton's method from many guesses, in `row`; CERTIFY:
    the certificate of the motion through all events.
    """
    f = planes[0]
    take_shift(f, place.p[FIRST], place.p[SECOND], task == SOLVE)
    if task == MOVE or task == CORRECT or task == EXAMINE:
        moved = move_exactly(f, place.p[FIRST], place.p[SECOND])
        if task == MOVE or not moved:
            return 1.0 if moved else np.nan if task == CORRECT else 0.0
    if task == CORRECT:
        change = newton_step(f, c, place, row, b)
        return change if in_order(f, c, place) else np.nan
    if task == CLOSE:
        close(f, c, place, b)
        return 1.0
    if task == CONVERGE:
        converge_all(f, c, place, row, b)
        return 1.0
    if task == CERTIFY:
        build_middle(f)
        build_swing(f)
        return certify(f, c, place, b)
    if task == STEPS:
        return float(take_steps(f, c, path, place, row, b))
    if task == STATES:
        return take_states(f, c, path, b)
    if task == FOLLOW:
        follow(f, c, place, b)
        return 1.0
    if task == TAKE_APART:
        for j in range(3):
            b.work[0].step_p[1, j] = b.work[0].null[f.A.shape[0] + j]
        take_apart(f, c, b, 1, b.work[0].null, b.work[0].step_p[1], False)
        return 1.0
    if task == TAKE_UP:
        take_up(b, f.A.shape[0], b.work[0].left, b.trial)
        return 1.0
    if task == NEAR or task == SOLVE:
        most, enough = (MOST_EXACTLY, EXACTLY) if task == SOLVE else (MOST_CORRECTIONS, CONVERGED)
        if not (correct(f, c, place, row, b, most, enough) > 0 and move_to(f, place.p[FIRST], place.p[SECOND])):
            return 0.0
    if not assemble(f, c, place, b):
        return 0.0
    if task == EXAMINE or task == NEAR or task == SOLVE:
        return 1.0 if examine(f, c, place, b) else 0.0
    put_plane(f, c, b, row)
    return 1.0
