"""A contact in power series: what it makes of the state before it, and its two rows (normal_form.py).

The motion z in contact is linear in (z, cos, sin, 1) of its start, and autonomous in these: first it is taken over the
length of the orbit's contact, then over the change ds of the length, exp(B ds) to third order.
"""

import cmath

from vibro_sweep.engine.continuation.compliant_contact import press_gap, press_on
from vibro_sweep.engine.continuation.contact_map import ends_by_force, force_scale
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA, law_at
from vibro_sweep.engine.continuation.power_series import put_wave, steady, times
from vibro_sweep.engine.continuation.workspace import TERMS
from vibro_sweep.engine.simd.jit import small


@small
def press_series(f, side, x, e, y, work):
    """y (n, TERMS) becomes the state after a contact, and `e.left` its rows, from `e.series` of dphi and ds."""
    n, N, s, jets, motion = f.A.shape[0], f.A.shape[0] // 2, x[f.A.shape[0] + 1], work.jets, work.states[1]
    put_whole_map(f, side, s, x, e, work)
    put_wave(e.turn, e.series[0], jets)
    for m in range(TERMS):
        for r in range(n):
            y[r, m] += steady(f.Z[r], jets, m)
        e.left[0, m], y[0, m] = y[0, m], 0.0
        for r in range(n):
            motion[r, m] = work.image[r, n] * jets[3, m] + work.image[r, n + 1] * jets[4, m]
            for i in range(n):
                motion[r, m] += work.image[r, i] * y[i, m]
    turn, longer = e.turn * cmath.exp(1j * s), work.states[2, 0]
    for r in range(n):
        motion[r, 0] += work.image[r, n + 2]
    put_wave(turn, e.series[0], jets)
    lengthen(f, work.rates[0], e.series[1], motion, y, work.states[2], jets)
    for m in range(TERMS):
        longer[m] = e.series[0, m] + e.series[1, m]
    put_wave(turn, longer, jets)
    by_force, law, scale = ends_by_force(f, side, motion[N, 0].real), law_at(f, side), force_scale(f, side)
    for m in range(TERMS):
        if by_force:
            e.left[1, m] = (f.values[law] * motion[0, m] + f.values[law + 1] * motion[N, m]) / scale
        else:
            e.left[1, m], motion[0, m] = motion[0, m] / s, 0.0
        for r in range(n):
            y[r, m] = motion[r, m] - steady(f.Z[r], jets, m)
    if by_force:
        e.left[1, 0] += side * f.values[law + 2] / scale
    y[0, 0] += f.numbers[HIGH if side > 0 else LOW]


@small
def put_whole_map(f, side, s, x, e, work):
    """work.image: the motion at the end of a contact by (z, cos, sin, 1) at its begin."""
    n, state, image = f.A.shape[0], work.resting[0], work.image
    press_gap(f, side, x, s, e, work)
    for r in range(n):
        for i in range(n):
            image[r, i] = state[r, i]
    for k, swing in enumerate((1.0 + 0j, 1j, 0j)):
        for r in range(n):
            for i in range(state.shape[1]):
                state[r, i] = 0.0
        press_on(f, side, s, swing, work)
        for r in range(n):
            image[r, n + k] = state[r, n]
    for r in range(n):
        image[r, n] -= image[r, n + 2]
        image[r, n + 1] -= image[r, n + 2]


@small
def lengthen(f, rates, ds, motion, change, rate, jets):
    """Take a motion in contact over the length ds, a series. change, rate: room like motion; jets: as of `put_wave`."""
    n, power, other, constant = f.A.shape[0], jets[0], jets[1], 1.0
    for m in range(TERMS):
        power[m] = 1.0 if m == 0 else 0.0
        for r in range(n):
            change[r, m] = motion[r, m]
    for k in range(1, 4):
        times(power, ds, other)
        for m in range(TERMS):
            power[m] = other[m] / (k * f.numbers[OMEGA])
            for r in range(n):
                rate[r, m] = rates[r, n] * jets[3, m] + rates[r, n + 1] * jets[4, m]
                for i in range(n):
                    rate[r, m] += rates[r, i] * change[i, m]
        for m in range(TERMS):
            jets[3, m], jets[4, m] = -jets[4, m] * f.numbers[OMEGA], jets[3, m] * f.numbers[OMEGA]
        for r in range(n):
            rate[r, 0] += rates[r, n + 2] * constant
            times(power, rate[r], other)
            for m in range(TERMS):
                change[r, m] = rate[r, m]
                motion[r, m] += other[m]
        constant = 0.0
