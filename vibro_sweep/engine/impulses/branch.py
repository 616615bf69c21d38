"""Many steps along a branch of periodic orbits: predictor, corrector, tests and certificate of every point.

Distances along the branch are measured as analysis/branches/walk.py does: times, impulses and the parameter in units
`scale`.
A call ends where something happens between two points, so that the caller can locate it; both points are kept. It ends
too where something may happen twice between two points, unseen by their tests: then the call goes on from the second of
three points only when the caller has looked between them.
"""

import math

import numpy as np

from vibro_sweep.engine.impulses.blocks import eliminate, finish
from vibro_sweep.engine.impulses.checks import certify, comes_back, happens, test, touches
from vibro_sweep.engine.impulses.medium import OMEGA, PERIOD, flight_matrix, move_to, set_phase
from vibro_sweep.engine.impulses.pairs import coarse
from vibro_sweep.engine.impulses.places import DEFECT_HERE, LENGTH, ON_CIRCLE, REFLECTION, TANGENT, P
from vibro_sweep.engine.simd.jit import entry, jit

# Why a call ends. FAR: beyond the reach of the medium; TOUCH: something may vanish twice beside a
FULL, EVENT, CLOSED, FAILED, FAR, NO_START, TOUCH = range(7)
MOST_CORRECTIONS = 8
CONVERGED = 1e-9  # Newton's change after which the next one is below rounding
DEFECT = 1e-10  # largest jump of the motion between its flights, relative to the gap
PASSED = 1e-13  # distance beyond a stop, relative to the gap, which rounding does not explain
BEYOND = 1.5  # times the reach of the medium, up to where its polynomials hold
COARSE = 0.03  # of the longest step: to that they are shortened where they do not tell pairs of multipliers apart
SHIFTED = 0.8  # of a step, where its end lies on a bifurcation by chance
MOST_SHIFTS = 5  # of one step
EARLY = 10  # points before which a branch is not yet taken to be closed


@jit
def copy_place(a, b):
    """b <- a."""
    for i in range(len(a.t)):
        b.t[i], b.D[i], b.releases[i] = a.t[i], a.D[i], a.releases[i]
        b.tangent_t[i], b.tangent_jump[i] = a.tangent_t[i], a.tangent_jump[i]
        for j in range(a.z.shape[1]):
            b.z[i, j], b.tangent_z[i, j] = a.z[i, j], a.tangent_z[i, j]
    for i in range(len(a.multipliers)):
        b.multipliers[i, 0], b.multipliers[i, 1] = a.multipliers[i, 0], a.multipliers[i, 1]
    for i in range(len(a.numbers)):
        b.numbers[i] = a.numbers[i]


@jit
def correct(f, sides, sigma, steps, row_p, place, w):
    """Newton's method from `place` on the plane through it across the row in `w`. Corrections made; 0: none found.

    place becomes the point; `w` has its tangent (second change, not normalised) and room what is eliminated there.
    """
    K = len(sides)
    before = np.inf
    for count in range(1, MOST_CORRECTIONS + 1):
        if abs(place.numbers[P] - f.centre) > BEYOND * f.reach:
            return 0
        move_to(f, place.numbers[P])
        sign = eliminate(f, sides, sigma, place.t, place.D, place.z, w.room[0], w.strikes)
        if sign == 0.0:
            return 0
        if not finish(sigma, w.row_t, w.row_jump, row_p, w.room[0], w.strikes, steps.scale_p, w.change_t, w.change_jump,
                      w.change_z, w.change_p):  # fmt: skip
            return 0
        change = abs(w.change_p[0]) / steps.scale_p
        for i in range(K):
            change = max(change, abs(w.change_t[0, i]) / steps.scale_t, abs(w.change_jump[0, i]) / steps.scale_jump)
        if not change <= 1.0:
            return 0
        for i in range(K):
            place.t[i] -= w.change_t[0, i]
            place.D[i] -= w.change_jump[0, i]
            for j in range(place.z.shape[1]):
                place.z[i, j] -= w.change_z[0, i, j]
        place.numbers[P] -= w.change_p[0]
        for i in range(K):
            following = place.t[i + 1] if i + 1 < K else place.t[0] + f.numbers[PERIOD]
            if not following > place.t[i]:
                return 0
        if change < CONVERGED or (change < 1e-7 and change > 0.3 * before):
            place.numbers[REFLECTION] = sign
            move_to(f, place.numbers[P])
            return count
        before = change
    return 0


@jit
def take_tangent(steps, place, w):
    """The unit tangent from the second change in `w`."""
    size = (w.change_p[1] / steps.scale_p) ** 2
    for i in range(len(place.t)):
        size += (w.change_t[1, i] / steps.scale_t) ** 2 + (w.change_jump[1, i] / steps.scale_jump) ** 2
    scale = 1.0 / math.sqrt(size)
    place.numbers[TANGENT] = w.change_p[1] * scale
    for i in range(len(place.t)):
        place.tangent_t[i], place.tangent_jump[i] = w.change_t[1, i] * scale, w.change_jump[1, i] * scale
        for j in range(place.z.shape[1]):
            place.tangent_z[i, j] = w.change_z[1, i, j] * scale


@jit
def cosine(steps, a, b):
    """Of the angle between two tangents."""
    total = a.numbers[TANGENT] * b.numbers[TANGENT] / steps.scale_p**2
    for i in range(len(a.t)):
        total += a.tangent_t[i] * b.tangent_t[i] / steps.scale_t**2
        total += a.tangent_jump[i] * b.tangent_jump[i] / steps.scale_jump**2
    return total


@jit
def state_at(f, sigma, place, origin, state, w):
    """The state at the time `origin`, before an impact there."""
    room = w.room[0]
    K, n = len(place.t), room.E.shape[0]
    P_now = f.numbers[PERIOD]
    turns = math.ceil((origin - place.t[0]) / P_now) - 1.0
    s = origin - turns * P_now  # in (t_1, t_1 + P]
    i = K - 1
    while i > 0 and not place.t[i] < s:
        i -= 1
    zeta = room.zeta[0]
    for j in range(n):
        zeta[j] = place.z[i, j]
    zeta[n // 2] += place.D[i]
    set_phase(f, zeta, place.t[i])
    flight_matrix(f, max(s - place.t[i], 0.0), room.E)
    sign = 1.0 if sigma > 0 or turns % 2.0 == 0.0 else -1.0
    for r in range(n):
        total = 0.0
        for j in range(n + 3):
            total += room.E[r, j] * zeta[j]
        state[r] = sign * total


@jit
def keep(f, sigma, place, origin, record, count, w):
    for i in range(len(place.t)):
        record.t[count, i], record.D[count, i] = place.t[i], place.D[i]
        record.motion[count, i, 0], record.motion[count, i, 1] = w.strikes[i].motion[0], w.strikes[i].motion[1]
    for i in range(len(place.numbers)):
        record.numbers[count, i] = place.numbers[i]
    state_at(f, sigma, place, origin, record.state[count], w)


@jit
def start(f, sides, sigma, steps, a, w):
    """Correct `a` at its parameter on the plane across its own tangent, and test it. False where that fails."""
    for i in range(len(sides)):
        w.row_t[i], w.row_jump[i] = a.tangent_t[i] / steps.scale_t**2, a.tangent_jump[i] / steps.scale_jump**2
    if correct(f, sides, sigma, steps, a.numbers[TANGENT] / steps.scale_p**2, a, w) == 0:
        return False
    take_tangent(steps, a, w)
    certify(f, sides, sigma, a, w.room[0], w.strikes)
    test(f, sides, sigma, a, w.room[0], w.strikes)
    return True


@entry
def settle(media, sides, sigma, steps, place, w):
    """Newton's method from `place` where no parameter changes. Corrections made; 0: none found."""
    for i in range(len(sides)):
        w.row_t[i] = w.row_jump[i] = 0.0
    return correct(media[0], sides, sigma, steps, 1.0, place, w)


@entry
def walk(media, sides, sigma, steps, size, origin, passed, first, a, b, record, w, begins):
    """Steps from a until something happens. (reason, points recorded, corrections made).

    Recorded are the points before the step in which it happens; a and b are the two points of this step.

    size : of the gap
    origin : time of the recorded states, in forcing periods
    passed : points of the branch so far
    begins : whether a, which then needs its place and tangent only, is corrected and tested first
    """
    f = media[0]
    K, n = a.z.shape
    count, corrections = 0, 0
    if begins:
        w.past[LENGTH] = 0.0
        if not start(f, sides, sigma, steps, a, w):
            return NO_START, count, corrections
    length, shifts = a.numbers[LENGTH], 0
    while count < len(record.t):
        if not abs(a.numbers[P] - f.centre) <= f.reach:
            a.numbers[LENGTH] = length
            return FAR, count, corrections
        copy_place(a, b)
        b.numbers[P] += length * a.numbers[TANGENT]
        for i in range(K):
            w.row_t[i], w.row_jump[i] = a.tangent_t[i] / steps.scale_t**2, a.tangent_jump[i] / steps.scale_jump**2
            b.t[i] += length * a.tangent_t[i]
            b.D[i] += length * a.tangent_jump[i]
            for j in range(n):
                b.z[i, j] += length * a.tangent_z[i, j]
        made = correct(f, sides, sigma, steps, a.numbers[TANGENT] / steps.scale_p**2, b, w)
        turn = np.inf
        if made > 0:
            take_tangent(steps, b, w)
            turn = math.acos(min(1.0, max(-1.0, cosine(steps, a, b))))
        if turn <= steps.straight:
            certify(f, sides, sigma, b, w.room[0], w.strikes)
            if b.numbers[DEFECT_HERE] > DEFECT * size:
                turn = np.inf
        corrections += made
        if not turn <= steps.straight:
            length *= 0.5
            if length < steps.shortest:
                return FAILED, count, corrections
            continue
        b.numbers[LENGTH] = length
        test(f, sides, sigma, b, w.room[0], w.strikes)
        if b.numbers[ON_CIRCLE] > a.numbers[ON_CIRCLE] and shifts < MOST_SHIFTS:  # signs there would be rounding
            length *= SHIFTED
            shifts += 1
            continue
        shifts = 0
        if length > COARSE * steps.longest:
            if coarse(w.past_multipliers, a.multipliers, b.multipliers, w.past[LENGTH], length):
                length *= 0.5
                continue
        if happens(sides, steps, a, b, length, PASSED * size):
            return EVENT, count, corrections
        if touches(w.past, a, b, length):
            return TOUCH, count, corrections
        if passed + count >= EARLY and comes_back(steps, a, first, length):
            return CLOSED, count, corrections
        keep(f, sigma, b, origin * 2.0 * math.pi / f.numbers[OMEGA], record, count, w)
        count += 1
        if turn < steps.straight / 3 and made <= 3:
            length = min(1.5 * length, steps.longest)
        for i in range(len(w.past)):
            w.past[i] = a.numbers[i]
        w.past[LENGTH] = b.numbers[LENGTH]
        for i in range(n):
            w.past_multipliers[i, 0], w.past_multipliers[i, 1] = a.multipliers[i, 0], a.multipliers[i, 1]
        copy_place(b, a)
        a.numbers[LENGTH] = length
    return FULL, count, corrections
