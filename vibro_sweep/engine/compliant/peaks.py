"""The largest penetration and force of eight contacts, where their slopes fall through zero."""

import math

from vibro_sweep.engine.compliant.contact_pieces import FORCE_SLOPE, SLOPE, TERMS
from vibro_sweep.engine.compliant.contact_rows import of_stop
from vibro_sweep.engine.compliant.piece_series import first_below, load_delta, load_force, next_group
from vibro_sweep.engine.motion.strike import derivatives
from vibro_sweep.engine.simd.jit import inline, noinline
from vibro_sweep.engine.simd.lanes import bits, select
from vibro_sweep.engine.simd.memory import put, row

ROUGH = 7  # terms of a first look at a peak
PEAK_LOOKS = 8
NEAR_PEAK = 1e-3  # of the length of a piece: a step whose error in the largest value is rounding


@noinline
def keep_peaks(passage, z, passed, right, block, time):
    """Keep the largest delta and F/m_e of the contacts that are `passed`: where their slopes fall below zero."""
    k, c, preload = of_stop(passage.stiffness, right), of_stop(passage.damping, right), of_stop(passage.preload, right)
    damped, largest, strongest = passed & (c > 0.0), 0.0 * time, c * z[0] + preload
    piece, at = place_of_peak(passage, SLOPE, passed, block, z)
    for_force, at_force = piece, at
    if bits(damped) != 0:
        for_force, at_force = place_of_peak(passage, FORCE_SLOPE, damped, block, z)
    elsewhere, waiting = damped & ((for_force < piece) | (for_force > piece)), passed
    while bits(waiting) != 0:
        who, n, p = next_group(waiting, block, piece)
        waiting, with_it = waiting & ~who, who & damped & ~elsewhere
        load_delta(passage, z, n, p)
        low, high, h = within_piece(passage, n, p, time)
        largest = select(who, peak(passage.now, who, at * h, low, high, NEAR_PEAK * h), largest)
        if bits(with_it) != 0:
            strongest = stronger(passage, with_it, n, p, at_force, time, strongest)
    while bits(elsewhere) != 0:
        who, n, p = next_group(elsewhere, block, for_force)
        elsewhere = elsewhere & ~who
        load_delta(passage, z, n, p)
        strongest = stronger(passage, who, n, p, at_force, time, strongest)
    put(passage.largest, 0, select(passed, largest, row(passage.largest, 0)))
    strongest = select(damped, strongest, k * largest + preload)
    put(passage.strongest, 0, select(passed, strongest, row(passage.strongest, 0)))


@inline
def place_of_peak(passage, kind, who, block, z):
    """The piece in which a slope falls below zero, which is not after the end; and about where in it, over its length:
    a sine has that zero."""
    piece, begins, ends = first_below(passage, kind, who, block, z)
    last, share = row(passage.piece, 0), (begins + ends) / (begins - ends)
    share = select((piece <= last) & (piece > 0.0), share, 0.0)
    return select(piece < last, piece, last), (2.0 / math.pi) * share * (1.0 - share * share * (1.0 / 3.0))


@inline
def within_piece(passage, n, p, time):
    """Where in piece p a peak may be, in a contact of so long a `time`; and the length of a piece."""
    h = row(passage.length, n)
    low, high = 0.0 * h if p == 0 else -0.5 * h, time - p * h
    return low, select(high < 0.5 * h, high, 0.5 * h), h


@inline
def stronger(passage, who, n, p, at, time, strongest):
    """The largest F/m_e of these orbits in the piece that is loaded, or what is larger."""
    load_force(passage, row(passage.stiffness, n), row(passage.damping, n), row(passage.preload, n))
    low, high, h = within_piece(passage, n, p, time)
    found = peak(passage.end, who, at * h, low, high, NEAR_PEAK * h)
    return select(who & (found > strongest), found, strongest)


@noinline
def peak(c, wanted, v, low, high, near):
    """The largest value of a polynomial between `low` and `high`, where its slope falls through zero, near v."""
    v = select((v >= low) & (v <= high), v, 0.5 * (low + high))
    _, slope, half_curve, sixth = derivatives(c, v, ROUGH)  # mostly one look brings it near enough
    after = v + peak_step(slope, half_curve, sixth)
    v = select((half_curve < 0.0) & (after >= low) & (after <= high), after, v)
    largest = row(c, 0)
    for _ in range(PEAK_LOOKS):
        x, slope, half_curve, sixth = derivatives(c, v, TERMS)
        low, high = select(slope > 0.0, v, low), select(slope > 0.0, high, v)
        step = peak_step(slope, half_curve, sixth)
        after = v + step
        inside = (half_curve < 0.0) & (after >= low) & (after <= high)
        change = select(inside, step * (slope + step * (half_curve + step * sixth)), 0.0)
        largest = select(wanted, row(c, 0) + (x + change), largest)
        wanted = wanted & ~(inside & (abs(step) <= near))
        if bits(wanted) == 0:
            break
        v = select(inside, after, 0.5 * (low + high))
    return largest


@inline
def peak_step(slope, half_curve, sixth):
    """To where the slope is zero, by a step of third order."""
    newton = -0.5 * slope / half_curve
    return newton * (1.0 - 1.5 * (newton / half_curve) * sixth)
