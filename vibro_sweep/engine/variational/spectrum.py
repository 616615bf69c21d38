"""Lyapunov spectra: from the growth of tangent vectors over a record, or over one period of a periodic orbit.

Where nothing struck, tangent vectors obey the same linear equations as free motion, and the exponents are the real
parts of its roots. This is used where a mode keeps its energy: its exponents are exactly 0, which averages are not.
"""

import math

import numpy as np

from vibro_sweep.engine.compliant.law import is_at_rest
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.variational import tangent, tangent_at_rest, tangent_flight
from vibro_sweep.engine.variational.orthonormal import CONDITION
from vibro_sweep.tables import exponents
from vibro_sweep.tables import outcomes as status

BATCHES = 20  # parts of the recorded time whose scatter gives the error of an exponent
OF_LOGARITHMS = 2.0**-50  # rounding of their sum
MOST_FORGOTTEN = 700.0  # as a logarithm, that fits a float
MOST_CORRELATION = 0.8  # of neighbouring parts, that is allowed for

periods_read = jit(exponents.periods_read)  # after which `carry` reads the growth


@jit
def begin_warm_up(e, count):
    """The last part of the transient, on which tangent vectors find their directions."""
    e.tangent[0].wanted = True
    for i in range(count):
        tangent.begin(e.tangent[0], i)
        keep_at_rest(e, i)


@jit
def end_warm_up(e, count):
    """Count growth from here on."""
    t = e.tangent[0]
    for i in range(count):
        o = e.orbits[i]
        if o.status == status.OK:
            n = o.table
            tangent_flight.fly_to(t, i, e.flights.oscillator[n, 0], e.flights.nodes[n], 0, 0.0)
            tangent_flight.catch_up(t, tangent_flight.only(i))
            if t.lost[i] > 0.0:  # on the way here; what the attractor itself loses shows again
                tangent.begin(t, i)
                keep_at_rest(e, i)
            tangent.sort_vectors(t, i)
            tangent.start_record(t, i)


@jit
def keep_at_rest(e, i):
    """Keep the vectors while M1 rests on a stop: two of the four directions are lost already."""
    if is_at_rest(e.law, e.orbits[i]):
        q = e.flights.oscillator[e.orbits[i].table, 0]
        tangent_at_rest.rest(e.tangent[0], i, q.kappa, q.push)


@jit
def time_average(growth, periods, warm_up, T, spectrum, error):
    """Exponents after so many periods, and their standard errors from the scatter over parts; growth as in `carry`.

    Neighbouring parts are joined until `BATCHES` are left. Where the scatter of one part is like that of the part
    before it (correlation c), the parts know less than so many independent ones would: by (1 + c)/(1 - c).
    """
    parts = len(growth)
    size = max(1, parts // BATCHES)
    batches = parts // size
    for i in range(len(spectrum)):
        spectrum[i] = growth[parts - 1, i] / (periods * T)
        scatter, together, last, before, began = 0.0, 0.0, 0.0, 0.0, 0
        for m in range(size - 1, parts, size):
            ended = periods_read(m, parts, periods)
            deviation = (growth[m, i] - before) / ((ended - began) * T) - spectrum[i]
            scatter += deviation * deviation
            together += deviation * last
            before, began, last = growth[m, i], ended, deviation
        error[i] = np.nan
        if batches > 1:
            # a correlation found from few parts is low by 1/batches on the mean
            c = together / scatter + 1.0 / batches if scatter > 0.0 else 0.0
            c = min(max(c, 0.0), MOST_CORRELATION)
            rounding = 2.0**-52 * (abs(spectrum[i]) + CONDITION / (periods * T))
            error[i] = math.sqrt(scatter / (batches * (batches - 1.0)) * (1.0 + c) / (1.0 - c)) + rounding
        if spectrum[i] == -np.inf:
            error[i] = 0.0
    add_shear(periods, warm_up, T, spectrum, error)


@jit
def add_shear(periods, warm_up, T, spectrum, error):
    """No error is smaller than what the growth of vectors by shear would give.

    In regular motion without losses a vector grows like the time t, and another shrinks like 1/t. Over a record after a
    warm-up that seems to be an exponent +-ln(1 + record/warm-up)/(record T), and the parts hardly scatter about it. The
    errors of chaos are larger.
    """
    largest = spectrum[0]
    for i in range(1, len(spectrum)):
        largest = max(largest, spectrum[i])
    if largest > 0.0:
        shear = math.log(1.0 + periods / max(warm_up, 1)) / (periods * T)
        for i in range(len(spectrum)):
            if spectrum[i] > -np.inf:
                error[i] = max(error[i], shear)


@jit
def period_of(e, o):
    """The forcing period T."""
    q = e.flights.oscillator[o.table, 0]
    return q.width * q.cells


@jit
def is_free(o, plan):
    """Whether the orbit met no stop in what was counted last."""
    struck = o.impacts_left + o.impacts_right > 0 or o.rest_time > 0.0 or o.resting != 0.0
    return plan.order == 0 and not struck and o.pressed_time == 0.0


@jit
def keeps_energy(q):
    """Whether free motion has a root on the imaginary axis."""
    for j in range(len(q.frame_square)):  # without a frame there are no scales
        if -q.frame_series[1, 2 * j] == math.sqrt(max(-q.frame_square[j], 0.0)) and q.frame_scale[j] > 0.0:
            return True
    return False


@jit
def real_parts(q, spectrum):
    """The real parts of the roots -eta +- sqrt(-square) of free motion."""
    for j in range(len(q.frame_square)):
        eta, square = -q.frame_series[1, 2 * j], q.frame_square[j]
        apart = math.sqrt(max(-square, 0.0))
        slow = (square + eta * eta) / (eta + apart) if square < 0.0 else eta
        if eta == apart:  # but for rounding of the product
            slow = 0.0
        spectrum[2 * j], spectrum[2 * j + 1] = 0.0 - slow, 0.0 - (eta + apart)


@jit
def close_spectrum(e, o, w, plan, point, result):
    """Floquet exponents in place of averages; the residual of the sum rule, which is part of the last one's error,
    and of the last multiplier's."""
    q, spectrum, error = e.flights.oscillator[o.table, 0], result.lyapunov, result.lyapunov_error
    periods = result.period if result.period > 0 else w.section.shape[1]
    time, beyond = periods * period_of(e, o), 0.0
    if result.period > 0:
        found = w.multipliers[o.lane]
        beyond = found.beyond / time
        for j in range(len(spectrum)):
            spectrum[j], error[j] = found.log[j] / time, found.log_error[j] / time
            result.multiplier_re[j], result.multiplier_im[j] = found.re[j], found.im[j]
            result.multiplier_error[j] = found.error[j]
    if is_free(o, plan) and keeps_energy(q) and spectrum[0] == spectrum[0]:
        real_parts(q, spectrum)
        for j in range(len(spectrum)):
            error[j] = 0.0
    for j in range(len(spectrum)):
        error[j] += point.rounding if spectrum[j] > -np.inf else 0.0
    widen_forgotten(e.law, e.tangent[0], o.lane, result, time)
    exact = point.divergence + o.log_volume / time
    if plan.order == 0:
        left, right = o.impacts_left, o.impacts_right
        if o.stops[2] == o.stops[3]:
            left, right = 0, left + right
        if left > 0:
            exact += 2.0 * (left / time) * np.log(o.stops[2])
        if right > 0:
            exact += 2.0 * (right / time) * np.log(o.stops[3])
    sort_exponents(spectrum, error)
    count, total = len(spectrum), spectrum[0] + spectrum[1]
    for j in range(2, count, 2):
        total += spectrum[j] + spectrum[j + 1]
    residual = total + beyond - exact
    if e.law is not None:
        if not is_free(o, plan):
            residual = w.multipliers[o.lane].excess / time - exact
    for j in range(count - q.vanishing, count):
        spectrum[j], error[j], residual = -np.inf, 0.0, -np.inf
        result.multiplier_re[j] = result.multiplier_im[j] = result.multiplier_error[j] = 0.0
    result.lyapunov_residual = residual if residual > -np.inf else np.nan
    if residual > -np.inf:
        error[count - 1] = max(error[count - 1], abs(residual))
        if result.period > 0:
            widen_last(result, abs(residual) * time)


@inline
def widen_forgotten(law, t, i, result, time):
    """Add what stops that are at rest to rounding might do where contacts shrink vectors by more than that, and
    rounding of the logarithms themselves."""
    if law is not None:
        spectrum, error = result.lyapunov, result.lyapunov_error
        for j in range(len(spectrum)):
            if spectrum[j] > -np.inf:
                more = t.forgotten[j, i] + OF_LOGARITHMS * abs(spectrum[j]) * time
                error[j] += more / time
                if result.period > 0:
                    most = math.expm1(min(more, MOST_FORGOTTEN))
                    result.multiplier_error[j] += most * math.hypot(result.multiplier_re[j], result.multiplier_im[j])


@jit
def widen_last(result, part):
    """The smallest multiplier, and its conjugate, are not known to better than this part of it."""
    re, im, error = result.multiplier_re, result.multiplier_im, result.multiplier_error
    last = len(re) - 1
    for j in range(last - 1 if im[last] < 0.0 else last, last + 1):
        error[j] = max(error[j], part * math.hypot(re[j], im[j]))


@jit
def sort_exponents(spectrum, error):
    """Descending; the vectors find their order only as far as the exponents differ."""
    for i in range(1, len(spectrum)):
        value, doubt, j = spectrum[i], error[i], i
        while j > 0 and spectrum[j - 1] < value:
            spectrum[j], error[j] = spectrum[j - 1], error[j - 1]
            j -= 1
        spectrum[j], error[j] = value, doubt
