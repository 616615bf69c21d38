"""The motion in contact over a step, as a linear map of (z, cos, sin, 1) with its derivatives by the parameters.

A step resolves the rates of the contact. The Taylor series of the map holds for all contacts with a stop, and is made
anew where a number moves that it depends on; the place of the stop is a column of its own.
"""

import math

from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA, law_at
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES, bits
from vibro_sweep.engine.simd.memory import eight, put_eight

SUM, MEAN = range(2)  # of `work.pressing`
PARTS_PER_TIME_CONSTANT = 1.5  # of a contact
MOST_PARTS = 1 << 17  # of a contact: a longer one, of a stop with a strong damper, is not computed


@jit
def parts_of(f, side, length):
    """The number of parts in which a contact is computed: their length times its rates is 0.7 at most. 0: too many."""
    law = law_at(f, side)
    rate = 1.0 / f.width + PARTS_PER_TIME_CONSTANT * (math.sqrt(f.values[law]) + f.values[law + 1])
    count = abs(length) / f.numbers[OMEGA] * rate
    return int(count) + 1 if count < MOST_PARTS else 0


@jit
def ends_by_force(f, side, speed):
    """Whether a contact that ends with this gap velocity ends where the force is 0, before the gap is at its stop."""
    law = law_at(f, side)
    c, p = f.values[law + 1], f.values[law + 2]
    return f.by_force > 0 and c != 0.0 and (p == 0.0 or side * c * speed + p < 0.0)


@jit
def force_scale(f, side):
    """What the force of a contact is divided by, so that it is of the size of a speed."""
    law = law_at(f, side)
    return math.sqrt(f.values[law]) + f.values[law + 1]


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
    """rates (3, n + 2, ..): omega times those of z by (z, cos, sin, 1), and their derivatives by the parameters."""
    put_generator(f, side, rates)
    take_stop(f, side, rates)


@jit
def put_generator(f, side, rates):
    """The rates by time of (z, cos, sin) by (z, cos, sin, 1, stop), and their derivatives by the parameters."""
    put_part(f, side, f.values, f.A, f.numbers[OMEGA], rates[0])
    for j in range(f.parameters):
        put_part(f, side, f.slopes[j], f.A_slopes[j], f.number_slopes[j, OMEGA], rates[1 + j])


@jit
def put_part(f, side, values, A, omega, out):
    """out: the rates, of the numbers themselves or of their slopes."""
    n, N, law = f.A.shape[0], f.A.shape[0] // 2, law_at(f, side)
    for r in range(n):
        for i in range(n):
            out[r, i] = A[r, i]
        for i in range(2):
            out[r, n + i] = values[n * (n + 1) + r - N + i * N] if r >= N else 0.0
        out[r, n + 2], out[r, n + 3] = A[r, n], A[r, 0]
    out[N, 0] -= values[law]
    out[N, N] -= values[law + 1]
    out[N, n + 2] -= side * values[law + 2]
    out[n, n + 1], out[n + 1, n] = -omega, omega


@jit
def take_stop(f, side, tables):
    """Add the column of the stop, at its place, to that of 1."""
    n, stop = f.A.shape[0], HIGH if side > 0 else LOW
    for r in range(n):
        by_stop = tables[0, r, n + 3]
        tables[0, r, n + 2] += by_stop * f.numbers[stop]
        for j in range(f.parameters):
            tables[1 + j, r, n + 2] += tables[1 + j, r, n + 3] * f.numbers[stop] + by_stop * f.number_slopes[j, stop]


@jit
def put_tables(f, side, step, work):
    """work.pressing: the map of (z, cos, sin, 1) over a step in phase and its mean rate of change, with derivatives;
    work.courses: Taylor coefficients of its gap."""
    n, tables, k = f.A.shape[0], work.pressing, 1 if side > 0 else 0
    put_generator(f, side, work.rates)
    if differ(work.rates, work.generators[k]):
        build_contact(f, work.generators[k], work.contact_series[k])
    take_stop(f, side, work.rates)
    for j in range(f.parameters + 1):
        put_polynomials(n, work.contact_series[k, j], step, tables[MEAN, j], tables[SUM, j])
    take_stop(f, side, tables[MEAN])
    take_stop(f, side, tables[SUM])
    stop = f.numbers[HIGH if side > 0 else LOW]
    for order in range(ORDER + 1):
        for place in range(0, work.courses.shape[1], LANES):
            put_eight(work.courses[order], place, eight(work.contact_series[k, 0, order], place))
        work.courses[order, n + 2] += work.courses[order, n + 3] * stop


@jit
def differ(rates, kept):
    """Whether two tables differ; `kept` becomes the other one."""
    found = 0
    for place in range(0, rates.shape[0] * rates.shape[1] * rates.shape[2], LANES):
        value = eight(rates, place)
        found |= bits(abs(value - eight(kept, place)) > 0.0)
        put_eight(kept, place, value)
    return found != 0


@jit
def build_contact(f, rates, series):
    """series (3, ORDER + 1, n, ..): Taylor coefficients by phase of z by (z, cos, sin, 1, stop), and derivatives."""
    n, omega, wide = f.A.shape[0], f.numbers[OMEGA], rates.shape[2]
    for r in range(n):
        series[0, 0, r, r] = 1.0
    for order in range(1, ORDER + 1):
        share = 1.0 / (order * omega)
        for place in range(0, wide, LANES):
            for r in range(n):
                value = eight(rates[0], place) * (share * series[0, order - 1, r, 0])
                for i in range(1, n + 2):
                    value = value + eight(rates[0], i * wide + place) * (share * series[0, order - 1, r, i])
                put_eight(series[0, order], r * wide + place, value)
                for j in range(1, f.parameters + 1):
                    slope = value * (-f.number_slopes[j - 1, OMEGA] / omega)
                    for i in range(n + 2):
                        slope = slope + eight(rates[0], i * wide + place) * (share * series[j, order - 1, r, i])
                        slope = slope + eight(rates[j], i * wide + place) * (share * series[0, order - 1, r, i])
                    put_eight(series[j, order], r * wide + place, slope)


@jit
def put_polynomials(n, series, step, mean, total):
    """mean, total (n, ..): sum_k series_k step^(k - 1) from k = 1 on, and sum_k series_k step^k."""
    size = n * mean.shape[1]
    for i in range(0, size, LANES):
        value = eight(series, ORDER * size + i)
        for k in range(ORDER - 1, 0, -1):
            value = value * step + eight(series, k * size + i)
        put_eight(mean, i, value)
        put_eight(total, i, value * step + eight(series, i))


@jit
def put_course(f, motion, swing, work):
    """work.cell: Taylor coefficients of d over the next step."""
    for order in range(ORDER + 1):
        work.cell[order] = of_motion(f, work.courses[order], motion, swing)


@jit
def of_motion(f, row, motion, swing):
    """A row of a map of (z, cos, sin, 1) times the motion."""
    n = f.A.shape[0]
    total = row[n] * swing.real + row[n + 1] * swing.imag + row[n + 2]
    for i in range(n):
        total += row[i] * motion[i, n]
    return total
