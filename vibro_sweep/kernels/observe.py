"""What a scene observes of one orbit: section points, their period, impacts, exponents."""

import math

import numpy as np

from vibro_sweep.kernels import status, tangent
from vibro_sweep.kernels.ensemble import carry
from vibro_sweep.kernels.jit import jit
from vibro_sweep.kernels.orbits import start_count

REPEAT = 1e-6  # section points this near to each other, relative to their size, are the same point
RUNNING = 200  # points of a convergence diagram
BATCHES = 20  # parts of the recorded time whose scatter gives the error of an exponent


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
        n = p  # from the beginning: where the orbit has not settled, the first point tells
        while n < count and not apart(section, tolerance, n, p):
            n += 1
        if n == count:
            return p
    return 0


@jit
def apart(section, tolerance, n, p):
    """Whether point n and the one p before it differ."""
    for i in range(4):
        if not abs(section[n, i] - section[n - p, i]) <= tolerance[i]:
            return True
    return False


@jit
def time_average(growth, periods, T, spectrum, error):
    """Exponents after so many periods, and their standard errors from the scatter over parts; growth as in `carry`.

    Neighbouring parts are joined until `BATCHES` are left, so that they are long enough to be independent.
    """
    parts = len(growth)
    size = max(1, parts // BATCHES)
    batches = parts // size
    for i in range(4):
        spectrum[i] = growth[parts - 1, i] / (periods * T)
        scatter, before, began = 0.0, 0.0, 0
        for m in range(size - 1, parts, size):
            ended = periods_read(m, parts, periods)
            scatter += ((growth[m, i] - before) / ((ended - began) * T) - spectrum[i]) ** 2
            before, began = growth[m, i], ended
        error[i] = math.sqrt(scatter / (batches * (batches - 1.0))) if batches > 1 else np.nan


@jit
def periods_read(m, parts, periods):
    """Periods after which `carry` reads the growth for the m-th time."""
    return -(-(m + 1) * periods // parts)


@jit
def floquet(f, stops, o, records, t, mapped, axes, growth, nothing, period, spectrum):
    """The exponents of a periodic orbit, over exactly one more period of it: ln|Floquet multiplier|/time.

    The vectors have found the invariant subspaces. A real multiplier brings its vector back to itself, and its growth
    is exact; a complex pair turns two vectors in their plane, and the mean of their growths is. Returns a status.
    """
    for i in range(4):
        for j in range(4):
            axes[i, j] = t.Z[i, j]
    start_count(o)
    tangent.start_record(t)
    outcome = carry(f, stops, o, records, t, mapped, period, nothing, growth)
    if outcome != status.OK:
        return outcome
    T = f.oscillator[0].width * f.oscillator[0].cells
    for i in range(4):
        spectrum[i] = growth[0, i] / (period * T)
    i = 0
    while i < 3:
        turn = 0.0
        for j in range(4):
            turn += axes[j, i + 1] * t.Z[j, i]
        if abs(turn) > 1e-4:
            spectrum[i] = spectrum[i + 1] = 0.5 * (spectrum[i] + spectrum[i + 1])
            i += 1
        i += 1
    return status.OK


@jit
def keep_impacts(f, stops, o, records, point, section, phase):
    """The logged impacts as points of an impact section; phase: omega t mod 2 pi."""
    for n in range(min(o.impacts_logged, len(phase))):
        row = records.impacts[n]
        section[n, 0], section[n, 1] = stops.right if row[3] > 0.0 else stops.left, row[4]
        section[n, 2], section[n, 3] = row[5], row[6]
        phase[n] = point.omega * (row[1] * f.oscillator[0].width + row[2])


@jit
def keep_exponents(f, stops, o, records, t, mapped, w, period, divergence, result):
    """The spectrum, its error, and the residual of its sum rule. Returns a status."""
    spectrum, error, growth = result.lyapunov, result.lyapunov_error, w.growth
    T, parts = f.oscillator[0].width * f.oscillator[0].cells, len(w.growth)
    time = len(w.section) * T
    time_average(growth, len(w.section), T, spectrum, error)
    if period > 0:  # twice: what the second time changes is the error
        for _ in range(2):
            for i in range(4):
                error[i] = spectrum[i]
            outcome = floquet(
                f, stops, o, records, t, mapped, w.axes, growth[parts - 1 :], w.section[:0], period, spectrum
            )
            if outcome != status.OK:
                return outcome
        time = period * T
        for i in range(4):
            # two periods may agree better than either is known, by rounding on vectors that lie close together
            known = 2.0**-52 * tangent.CONDITION / time
            error[i] = max(abs(spectrum[i] - error[i]), known) if spectrum[i] > -np.inf else 0.0
    last = growth[parts - 1]
    total = ((last[0] + last[1]) + (last[2] + last[3])) / time
    exact = divergence + o.log_volume / time
    hits = o.impacts_right + o.impacts_left
    if hits > 0 and f.oscillator[0].order == 0:
        exact += 2.0 * (hits / time) * np.log(stops.R)
    result.lyapunov_residual = total - exact if total > -np.inf else np.nan
    tangent.sort(spectrum, error)
    for i in range(4 - f.oscillator[0].vanishing, 4):
        spectrum[i], error[i], result.lyapunov_residual = -np.inf, 0.0, np.nan
    return status.OK


@jit
def observe(f, stops, w, plan, mapped, point, result, section, phase, running):
    """One orbit from where it is placed to the end of the record, or of one more period of it. Returns a status."""
    o, t, records = w.orbit[0], w.tangent[0], w.records
    t.wanted = False
    outcome = carry(f, stops, o, records, t, mapped, plan.transient - plan.warm_up, w.section[:0], w.growth[:0])
    if outcome == status.OK and plan.lyapunov:
        tangent.begin(t)
        outcome = carry(f, stops, o, records, t, mapped, plan.warm_up, w.section[:0], w.growth[:0])
        tangent.catch_up(t, f.oscillator[0])
        if t.lost > 0:  # on the way here; what the attractor itself loses shows again
            tangent.begin(t)
        tangent.start_record(t)
    if outcome != status.OK:
        return outcome
    start_count(o)
    o.impacts_logged, o.log_side, o.measured = 0, plan.section_side, plan.impacts
    outcome = carry(f, stops, o, records, t, mapped, plan.record, w.section, w.growth)
    if outcome != status.OK:
        return outcome
    result.impacts_right, result.impacts_left = o.impacts_right, o.impacts_left
    result.min_impact_speed = o.slowest if o.slowest < np.inf else np.nan
    result.contact_error = o.miss if o.slowest < np.inf else np.nan
    result.sticking_time = o.rest_time
    for i in range(4):
        result.end[i] = o.X[i]
    if len(phase) > 0:
        keep_impacts(f, stops, o, records, point, section, phase)
    else:
        for n in range(len(section)):
            for i in range(4):
                section[n, i] = w.section[n, i]
    result.resting, result.period = o.resting, find_period(w.section, w.axes[0])
    T = f.oscillator[0].width * f.oscillator[0].cells
    for n in range(len(running)):
        for i in range(4):
            running[n, i] = w.growth[n, i] / (periods_read(n, len(running), plan.record) * T)
    if plan.lyapunov:
        divergence = -2.0 * point.zeta * (1.0 + (1.0 + point.mu_k) / point.mu_m)
        outcome = keep_exponents(f, stops, o, records, t, mapped, w, result.period, divergence, result)
        if outcome != status.OK:
            return outcome
    return status.OK
