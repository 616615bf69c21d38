"""What a scene observes of one orbit: section points, their period, impacts, exponents, the continuous motion."""

import math

import numpy as np

from vibro_sweep.kernels import status, tangent
from vibro_sweep.kernels.ensemble import cross_period, record, settle
from vibro_sweep.kernels.impacts import Records, place, start_count
from vibro_sweep.kernels.jit import jit

REPEAT = 1e-6  # section points this near to each other, relative to their size, are the same point


@jit
def find_period(section, tolerance):
    """Least p, up to half of the points, after which all points repeat themselves; 0 if there is none.

    tolerance: (4,) scratch.
    """
    count, largest = len(section), 0.0
    for i in range(4):
        tolerance[i] = 0.0
        for n in range(count):
            tolerance[i] = max(tolerance[i], abs(section[n, i]))
        largest = max(largest, tolerance[i])
    for i in range(4):
        tolerance[i] = REPEAT * max(tolerance[i], 1e-3 * largest)
    for p in range(1, count // 2 + 1):
        n, near = count - 1, True
        while near and n >= p:
            for i in range(4):
                near = near and abs(section[n, i] - section[n - p, i]) <= tolerance[i]
            n -= 1
        if near:
            return p
    return 0


@jit
def follow_trajectory(f, stops, o, records, t, periods, out):
    """The motion over the next `periods`, sampled uniformly from the present section to the last one: out (m, 4)."""
    q, last = f.oscillator[0], len(out) - 1
    i = 0
    for n in range(periods):
        first = i
        while i < last and i * periods < (n + 1) * last:
            cells = (i * periods - n * last) / last * q.cells
            records.times[i, 0] = math.floor(cells)
            records.times[i, 1] = (cells - math.floor(cells)) * q.width
            i += 1
        part = Records(records.impacts, records.rests, records.times[first:i], records.samples[first:i])
        outcome = cross_period(f, stops, o, part, t, 0, 0.0)
        if outcome != status.OK:
            return outcome
    for i in range(last):
        for j in range(4):
            out[i, j] = records.samples[i, j]
        out[i, 0] = min(max(out[i, 0], stops.left), stops.right)  # evaluation may round past a stop
    for j in range(4):
        out[last, j] = o.X[j]
    return status.OK


@jit
def floquet(f, stops, o, records, t, axes, period, spectrum):
    """The exponents of a periodic orbit, over exactly one more period of it: ln|Floquet multiplier|/time.

    The vectors have found the invariant subspaces. A real multiplier brings its vector back to itself, and its growth
    is exact; a complex pair turns two vectors in their plane, and the mean of their growths is. Returns a status and
    the sum of the exponents.
    """
    for i in range(4):
        for j in range(4):
            axes[i, j] = t.Z[i, j]
    start_count(o)
    tangent.start_record(t)
    for _ in range(period):
        outcome = cross_period(f, stops, o, records, t, 0, 0.0)
        if outcome != status.OK:
            return outcome, np.nan
    q = f.oscillator[0]
    tangent.catch_up(t, q)
    growth = tangent.exponents(t, period * (q.width * q.cells), spectrum)
    i = 0
    while i < 3:
        turn = 0.0
        for j in range(4):
            turn += axes[j, i + 1] * t.Z[j, i]
        if abs(turn) > 1e-4:
            mean = 0.5 * (spectrum[i] + spectrum[i + 1])
            spectrum[i] = spectrum[i + 1] = mean
            i += 1
        i += 1
    return status.OK, growth


@jit
def observe(f, stops, w, plan, point, result, section, phase, trajectory):
    """One orbit from where it is placed to the end of all that is wanted of it. Returns a status."""
    o, t, records = w.orbit[0], w.tangent[0], w.records
    points = section if len(section) > 0 and plan.section_side == 0.0 else w.section
    t.wanted = False
    outcome = settle(f, stops, o, records, t, plan.transient, plan.warm_up)
    if outcome != status.OK:
        return outcome
    if plan.lyapunov and not t.wanted:
        tangent.begin(t)
    o.impacts_logged, o.log_side = 0, plan.section_side
    outcome, growth = record(f, stops, o, records, t, points, result.lyapunov)
    if outcome != status.OK:
        return outcome
    result.impacts_right, result.impacts_left = o.impacts_right, o.impacts_left
    result.min_impact_speed = o.slowest if o.slowest < np.inf else np.nan
    result.sticking_time = o.rest_time
    for i in range(4):
        result.end[i] = o.X[i]
    if len(phase) > 0:
        for n in range(min(o.impacts_logged, len(phase))):
            row = records.impacts[n]
            section[n, 0], section[n, 1] = stops.right if row[3] > 0.0 else stops.left, row[4]
            section[n, 2], section[n, 3] = row[5], row[6]
            phase[n] = point.omega * (row[1] * f.oscillator[0].width + row[2])
    resting, period = o.resting, find_period(points, w.axes[0])
    result.period = period
    if plan.lyapunov:
        periods_counted = plan.record
        if period > 0:
            outcome, growth = floquet(f, stops, o, records, t, w.axes, period, result.lyapunov)
            if outcome != status.OK:
                return outcome
            periods_counted = period
        tangent.sort(result.lyapunov)
        nu = (o.impacts_right + o.impacts_left) / (periods_counted * 2.0 * math.pi / point.omega)
        divergence = -2.0 * point.zeta * (1.0 + (1.0 + point.mu_k) / point.mu_m)
        exact = divergence + (2.0 * nu * np.log(stops.R) if nu > 0.0 else 0.0)
        result.lyapunov_residual = growth - exact if growth > -np.inf else np.nan
    if len(trajectory) > 0:
        t.wanted = False
        place(o, result.end[0], result.end[1], result.end[2], result.end[3])
        o.resting = resting
        return follow_trajectory(f, stops, o, records, t, plan.periods, trajectory)
    return status.OK
