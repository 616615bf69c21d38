"""Lyapunov spectra: from the growth of tangent vectors over a record, or over one period of a periodic orbit."""

import math

import numpy as np

from vibro_sweep.kernels import status, tangent
from vibro_sweep.kernels.jit import jit
from vibro_sweep.kernels.orbits import start_count
from vibro_sweep.kernels.orthonormal import CONDITION

BATCHES = 20  # parts of the recorded time whose scatter gives the error of an exponent


@jit
def begin_warm_up(e, count):
    """The last part of the transient, on which tangent vectors find their directions."""
    e.tangent[0].wanted = True
    for i in range(count):
        tangent.begin(e.tangent[0], i)


@jit
def end_warm_up(e, count):
    """Count growth from here on."""
    t = e.tangent[0]
    for i in range(count):
        o = e.orbits[i]
        if o.status == status.OK:
            n = o.table
            tangent.fly_to(t, i, e.flights.oscillator[n, 0], e.flights.nodes[n], 0, 0.0)
            tangent.catch_up(t, tangent.only(i))
            if t.lost[i] > 0.0:  # on the way here; what the attractor itself loses shows again
                tangent.begin(t, i)
            tangent.start_record(t, i)


@jit
def begin_floquet(e, w, results):
    """Set periodic orbits out for exactly one more period of each."""
    t = e.tangent[0]
    for i in range(len(results)):
        o, result = e.orbits[i], results[i]
        o.periods = result.period if o.status == status.OK and result.period > 0 else 0
        if o.periods > 0:
            for m in range(16):
                w.axes[i, m] = t.Z[m, i]
            for j in range(4):
                result.lyapunov_error[j] = result.lyapunov[j]
            start_count(o)
            tangent.start_record(t, i)


@jit
def end_floquet(e, w, results):
    """Floquet exponents ln|multiplier|/time, in place of averages; what the second time changes is their error.

    The vectors have found the invariant subspaces. A real multiplier brings its vector back to itself, and its growth
    is exact; a complex pair turns two vectors in their plane, and the mean of their growths is.
    """
    t = e.tangent[0]
    for i in range(len(results)):
        o, spectrum, error = e.orbits[i], results[i].lyapunov, results[i].lyapunov_error
        if o.periods == 0 or o.status != status.OK:
            continue
        time = o.periods * period_of(e, o)
        before = error[0], error[1], error[2], error[3]
        for j in range(4):
            spectrum[j] = w.growth[i, 0, j] / time
        j = 0
        while j < 3:
            turn = 0.0
            for m in range(4):
                turn += w.axes[i, 4 * m + j + 1] * t.Z[4 * m + j, i]
            if abs(turn) > 1e-4:
                spectrum[j] = spectrum[j + 1] = 0.5 * (spectrum[j] + spectrum[j + 1])
                j += 1
            j += 1
        # two periods may agree better than either is known, by rounding on vectors that lie close together
        known = 2.0**-52 * CONDITION / time
        for j in range(4):
            error[j] = max(abs(spectrum[j] - before[j]), known) if spectrum[j] > -np.inf else 0.0


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
def period_of(e, o):
    """The forcing period T."""
    q = e.flights.oscillator[o.table, 0]
    return q.width * q.cells


@jit
def close_spectrum(e, o, w, point, result):
    """The residual of the sum rule; and the spectrum in order."""
    q, spectrum, error, periodic = (
        e.flights.oscillator[o.table, 0],
        result.lyapunov,
        result.lyapunov_error,
        result.period > 0,
    )
    time = (result.period if periodic else w.section.shape[1]) * period_of(e, o)
    last = w.growth[o.lane, 0 if periodic else w.growth.shape[1] - 1]
    total = ((last[0] + last[1]) + (last[2] + last[3])) / time
    exact = -2.0 * point.zeta * (1.0 + (1.0 + point.mu_k) / point.mu_m) + o.log_volume / time
    hits = o.impacts_right + o.impacts_left
    if hits > 0 and q.order == 0:
        exact += 2.0 * (hits / time) * np.log(point.R)
    result.lyapunov_residual = total - exact if total > -np.inf else np.nan
    tangent.sort(spectrum, error)
    for j in range(4 - q.vanishing, 4):
        spectrum[j], error[j], result.lyapunov_residual = -np.inf, 0.0, np.nan
