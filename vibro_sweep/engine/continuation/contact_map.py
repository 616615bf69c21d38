"""The motion in contact over a step, as a linear map of (z, cos, sin, 1) with its derivatives by the parameters.

A step resolves the rates of the contact. The map is summed once as a Taylor series, and it leads through all steps.
"""

import math

from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA, law_at
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import eight, put_eight

BEFORE, TERM, SUM, MEAN = range(4)  # of `work.pressing`


@jit
def parts_of(f, side, length):
    """The number of parts in which a contact is computed: their length times its rates is 0.7 at most."""
    law = law_at(f, side)
    rate = 1.0 / f.width + 1.5 * (math.sqrt(f.values[law]) + f.values[law + 1])
    return int(abs(length) / f.numbers[OMEGA] * rate) + 1


@jit
def copy_motion(source, target):
    for place in range(0, len(source) * source.shape[1], LANES):
        put_eight(target, place, eight(source, place))


@jit
def apply(f, tables, swing, motion, out):
    """out: the change of a motion, as of `begin_contact`, by a map of (z, cos, sin, 1) and its derivatives."""
    n, wide = f.A.shape[0], motion.shape[1]
    for r in range(n):
        for place in range(0, wide, LANES):
            total = eight(motion, place) * tables[0, r, 0]
            for i in range(1, n):
                total = total + eight(motion, i * wide + place) * tables[0, r, i]
            put_eight(out, r * wide + place, total)
        out[r, n] += tables[0, r, n] * swing.real + tables[0, r, n + 1] * swing.imag + tables[0, r, n + 2]
        for j in range(f.parameters):
            slopes = tables[1 + j, r]
            total = slopes[n] * swing.real + slopes[n + 1] * swing.imag + slopes[n + 2]
            for i in range(n):
                total += slopes[i] * motion[i, n]
            out[r, n + 1 + j] += total


@jit
def put_rates(f, side, rates):
    """rates (3, n, n + 3): omega times those of z by (z, cos, sin, 1), and their derivatives by the parameters."""
    n, N, stop, law = f.A.shape[0], f.A.shape[0] // 2, HIGH if side > 0 else LOW, law_at(f, side)
    forces = n * (n + 1)
    for r in range(n):
        for i in range(n):
            rates[0, r, i] = f.A[r, i]
        for i in range(2):
            rates[0, r, n + i] = f.values[forces + r - N + i * N] if r >= N else 0.0
        rates[0, r, n + 2] = f.A[r, n] + f.A[r, 0] * f.numbers[stop]
        for j in range(f.parameters):
            for i in range(n):
                rates[1 + j, r, i] = f.A_slopes[j, r, i]
            for i in range(2):
                rates[1 + j, r, n + i] = f.slopes[j, forces + r - N + i * N] if r >= N else 0.0
            rates[1 + j, r, n + 2] = f.A_slopes[j, r, n] + f.A_slopes[j, r, 0] * f.numbers[stop]
            rates[1 + j, r, n + 2] += f.A[r, 0] * f.number_slopes[j, stop]
    for i, column in enumerate((0, N, n + 2)):  # k d, c v, p
        sign = -side if i == 2 else -1.0
        rates[0, N, column] += sign * f.values[law + i]
        for j in range(f.parameters):
            rates[1 + j, N, column] += sign * f.slopes[j, law + i]


@jit
def put_tables(f, side, step, work):
    """work.pressing: the map of (z, cos, sin, 1) over a step in phase and its mean rate of change, with derivatives;
    work.courses: Taylor coefficients of its gap."""
    n, omega, tables, rates = f.A.shape[0], f.numbers[OMEGA], work.pressing, work.rates
    wide, power = tables.shape[3], 1.0
    put_rates(f, side, rates)
    for j in range(f.parameters + 1):
        for r in range(n + 3):
            for i in range(wide):
                tables[BEFORE, j, r, i] = tables[SUM, j, r, i] = 1.0 if j == 0 and r == i else 0.0
                tables[MEAN, j, r, i] = 0.0
    for i in range(wide):
        work.courses[0, i] = tables[SUM, 0, 0, i]
    for order in range(1, ORDER + 1):
        put_term(f, rates, 1.0 / (order * omega), tables[BEFORE], tables[TERM])
        for place in range(0, wide, LANES):
            put_eight(work.courses, order * wide + place, eight(tables[TERM, 0], place))
        for j in range(f.parameters + 1):
            for place in range(0, n * wide, LANES):
                value = eight(tables[TERM, j], place)
                put_eight(tables[BEFORE, j], place, value)
                put_eight(tables[MEAN, j], place, eight(tables[MEAN, j], place) + value * power)
                put_eight(tables[SUM, j], place, eight(tables[SUM, j], place) + value * (power * step))
        for place in range(n * wide, (n + 3) * wide, LANES):
            put_eight(tables[BEFORE, 0], place, eight(tables[TERM, 0], place))
        power *= step


@jit
def put_term(f, rates, share, before, term):
    """The Taylor coefficient of the map from that before it; share: 1/(order omega)."""
    n, wide, omega = f.A.shape[0], before.shape[2], f.numbers[OMEGA]
    for place in range(0, wide, LANES):
        for r in range(n):
            total = eight(before[0], place) * rates[0, r, 0]
            for i in range(1, n + 3):
                total = total + eight(before[0], i * wide + place) * rates[0, r, i]
            put_eight(term[0], r * wide + place, total * share)
            for j in range(1, f.parameters + 1):
                slope = total * (-f.number_slopes[j - 1, OMEGA] / omega)
                for i in range(n + 3):
                    slope = slope + eight(before[0], i * wide + place) * rates[j, r, i]
                for i in range(n):
                    slope = slope + eight(before[j], i * wide + place) * rates[0, r, i]
                put_eight(term[j], r * wide + place, slope * share)
        cosine, sine = eight(before[0], n * wide + place), eight(before[0], (n + 1) * wide + place)
        put_eight(term[0], n * wide + place, sine * (-share * omega))
        put_eight(term[0], (n + 1) * wide + place, cosine * (share * omega))
        put_eight(term[0], (n + 2) * wide + place, sine * 0.0)


@jit
def put_course(f, motion, swing, work):
    """work.cell: Taylor coefficients of d over the next step."""
    n = f.A.shape[0]
    for order in range(ORDER + 1):
        row = work.courses[order]
        total = row[n] * swing.real + row[n + 1] * swing.imag + row[n + 2]
        for i in range(n):
            total += row[i] * motion[i, n]
        work.cell[order] = total
