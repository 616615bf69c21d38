"""The derivative of the linearised equations of a contact (compliant_contact.py) along a null vector v.

The motion z in contact is affine in its start a and in e^{i phi}. So its change q along v, with the length s held, is
the difference of two such motions, and so is what q changes by with the parameters. With b = xi + .. as there,

    z_v = q + z' s_v        D_v z_u = z'_b s_v + z_v' (dphi + ds) - E_c q'(0) dphi + E_c D_v a_u + (q_p + z'_p s_v) dp

at the release, where z'_b and z'_p are the rates of change of E_c b and z_p. Row 2 is their mean rate over the contact,
or its force, which is linear in them.
"""

import cmath
import math

from vibro_sweep.engine.continuation.compliant_contact import begin_contact, press_on
from vibro_sweep.engine.continuation.contact_map import apply, copy_motion, ends_by_force, force_scale, put_rates
from vibro_sweep.engine.continuation.moving_flow import OMEGA, law_at
from vibro_sweep.engine.simd.jit import small

LEAST = 1e-5  # length in phase of a contact: of a shorter one the gradient at this length, as rates are divided by it
START, END, MEAN, END_RATE, START_VARIED, END_VARIED = range(6)  # of `work.varied`: rates at both ends but END, MEAN


@small
def differentiate_contact(f, side, x, e, through, work):
    """Add w.(D_v J) of the map and of row 2 to `e.slopes` and `work.slopes_p`.

    through : (n,) complex, what the rows of the flight after it make of the state y after it, times w
    """
    n, kept, room = f.A.shape[0], work.varied, work.resting
    length = math.copysign(max(abs(x[n + 1]), LEAST), x[n + 1])
    end = e.turn * cmath.exp(1j * length)
    begin_contact(f, x, e, room[0])
    put_rates(f, side, work.rates)
    put_motion_rate(f, work.rates, e.turn, room[0], kept[START])
    by_length = press_on(f, side, length, e.turn, work)
    copy_motion(room[0], kept[END])
    copy_motion(room[3], kept[MEAN])
    put_motion_rate(f, work.rates, end, room[0], kept[END_RATE])
    by_force = ends_by_force(f, side, kept[END, n // 2, n])
    for k in range(2):
        phase, longer = part_of(e.v[n], k), part_of(e.v[n + 1], k)
        begin_contact(f, x, e, room[0])
        for r in range(1, n):
            room[0, r, n] += part_of(e.v[r], k) + phase * (e.rate[r] + (1j * f.Z[r] * e.turn).real)
        put_motion_rate(f, work.rates, e.turn * (1.0 + 1j * phase), room[0], kept[START_VARIED])
        press_on(f, side, length, e.turn * (1.0 + 1j * phase), work)
        for r in range(n):
            room[0, r, n] += longer * kept[END_RATE, r, n]
        put_motion_rate(f, work.rates, end * (1.0 + 1j * (phase + longer)), room[0], kept[END_VARIED])
        unit = 1.0 + 0j if k == 0 else 1j
        add_map(f, e, end, by_force, phase, longer, unit, through, work)
        if by_force:
            add_force(f, side, e, phase, longer, unit * e.w[1], work)
        else:
            add_place(f, e, length, by_length, phase, longer, unit * e.w[1], work)


@small
def put_motion_rate(f, rates, swing, motion, out):
    """out: the rate of change by phase of a motion in contact, its derivatives with it."""
    n, omega = f.A.shape[0], f.numbers[OMEGA]
    apply(f, rates, swing, motion, out)
    for r in range(n):
        for c in range(n + 1 + f.parameters):
            out[r, c] /= omega
        for j in range(f.parameters):
            out[r, n + 1 + j] -= f.number_slopes[j, OMEGA] / omega * out[r, n]


@small
def part_of(value, k):
    """The real part (k = 0) or the imaginary one."""
    return value.real if k == 0 else value.imag


@small
def jump_of_rate(f, e, r):
    """b by the phase: the free rate of coordinate r before the touch less that in contact, where the gap is held."""
    return (e.rate[r] + (1j * f.Z[r] * e.turn).real) * (1.0 if r != 0 else 0.0)


@small
def moved_start(f, e, k, phase, work):
    """What the rate of coordinate k at the touch changes by along v, beside that of a motion at the same phase."""
    kept = work.varied
    own = phase * (f.Z[k] * e.turn).real if k != 0 else 0.0
    return kept[START_VARIED, k, f.A.shape[0]] - kept[START, k, f.A.shape[0]] + own


@small
def add_map(f, e, end, by_force, phase, longer, unit, through, work):
    """Add the terms of the state after the contact."""
    n, later = f.A.shape[0], phase + longer
    for r in range(n):
        weight = unit * through[r]
        if r != 0 or by_force:  # else the gap is that of the stop
            add_motion(f, e, r, phase, longer, weight, work)
        for i in range(2):
            e.slopes[n + i] += weight * later * (f.Z[r] * end).real
        for j in range(f.parameters):
            work.slopes_p[j] -= weight * later * (1j * f.Z_slopes[j, r] * end).real


@small
def add_motion(f, e, r, phase, longer, weight, work):
    """Add the terms of coordinate r of the whole motion at the release."""
    n, kept, state = f.A.shape[0], work.varied, work.resting[0]
    turned = kept[END_VARIED, r, n] - kept[END_RATE, r, n]
    by_phase = turned
    for k in range(n):
        if k != 0:
            e.slopes[k] += weight * longer * kept[END_RATE, r, k]
        by_phase += longer * kept[END_RATE, r, k] * (jump_of_rate(f, e, k) - kept[START, k, n])
        by_phase -= kept[END, r, k] * moved_start(f, e, k, phase, work)
    e.slopes[n] += weight * by_phase
    e.slopes[n + 1] += weight * turned
    for j in range(f.parameters):
        column = n + 1 + j
        moved = longer * kept[END_RATE, r, column] + state[r, column] - kept[END, r, column]
        for k in range(1, n):
            moved += kept[END, r, k] * (1j * f.Z_slopes[j, k] * e.turn).real * phase
        work.slopes_p[j] += weight * moved


@small
def add_force(f, side, e, phase, longer, weight, work):
    """Add the terms of row 2 of a release by force."""
    n, N, law, kept, state = f.A.shape[0], f.A.shape[0] // 2, law_at(f, side), work.varied, work.resting[0]
    weight /= force_scale(f, side)
    for i in range(2):  # k d, c v
        r = i * N
        add_motion(f, e, r, phase, longer, weight * f.values[law + i], work)
        for j in range(f.parameters):
            work.slopes_p[j] += weight * f.slopes[j, law + i] * (state[r, n] - kept[END, r, n])


@small
def add_place(f, e, length, by_length, phase, longer, weight, work):
    """Add the terms of row 2 of a release at the stop, d(release)/length."""
    n, N, omega = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA]
    kept, state, mean = work.varied, work.resting[0], work.resting[3]
    change = mean[0, n] - kept[MEAN, 0, n] + longer * by_length  # of the mean rate along v
    speed = state[N, n] - kept[END, N, n]
    e.slopes[n + 1] += weight * (speed / omega - change - longer * by_length) / length
    pace = (kept[END_RATE, N, n] - kept[MEAN, N, n]) / length
    by_phase = (mean[N, n] - kept[MEAN, N, n] + longer * pace) / omega
    for k in range(n):
        pace = (kept[END, N, k] / omega - kept[MEAN, 0, k]) / length
        if k != 0:
            e.slopes[k] += weight * longer * pace
        by_phase += longer * pace * (jump_of_rate(f, e, k) - kept[START, k, n])
        by_phase -= kept[MEAN, 0, k] * moved_start(f, e, k, phase, work)
    e.slopes[n] += weight * by_phase
    for j in range(f.parameters):
        column, d_omega = n + 1 + j, f.number_slopes[j, OMEGA]
        rate = (kept[END, N, column] - d_omega / omega * kept[END, N, n]) / omega
        moved = longer * (rate - kept[MEAN, 0, column]) / length + mean[0, column] - kept[MEAN, 0, column]
        for k in range(1, n):
            moved += kept[MEAN, 0, k] * (1j * f.Z_slopes[j, k] * e.turn).real * phase
        work.slopes_p[j] += weight * moved
