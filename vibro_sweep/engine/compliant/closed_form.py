"""Contacts in closed form, eight orbits at once: the damped wave of the fast pair on a slow series (slow_manifold.py).

    delta = e^{-gamma u} (P cos kd u + Q sin kd u) + d(u),   d = L_0 chi,   P = -d(0),   Q = (V - d'(0) - gamma d(0))/kd

The force, and derivatives, are of the same form (damped_wave.py); passage.py says when the end that is found is the
first one for certain.
"""

from vibro_sweep.engine.compliant.closed_tables import FEWER, SLOW, SLOW_ROWS
from vibro_sweep.engine.compliant.damped_wave import force_of, peak, seek, wave_at
from vibro_sweep.engine.compliant.passage_series import (
    INVERSE,
    add_pull,
    at,
    changes_of,
    expanded_at,
    load_sum,
    of_stop,
)
from vibro_sweep.engine.compliant.passage_tables import NEARLY
from vibro_sweep.engine.simd.columns import rows_of, weigh
from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.simd.lanes import bits, select
from vibro_sweep.engine.simd.memory import put, row


@inline
def choose_tables(passage, touching, right):
    """The block of the tables of the stop that is touched: 0 left, 1 right, 2 where orbits touch different ones."""
    on_right = bits(touching & right)
    if on_right == 0:
        return 0
    if on_right == bits(touching):
        return 1
    blend(passage.slow, right)
    blend(passage.manifold, right)
    blend(passage.share, right)
    blend(passage.fast, right)
    blend(passage.wiggle, right)
    return 2


@noinline
def blend(rows, right):
    """The third block of tables: of the stop that each orbit touches."""
    size = len(rows) // 3
    for j in range(size):
        put(rows, 2 * size + j, select(right, row(rows, size + j), row(rows, j)))


@inline
def terms_for(touching, reach):
    """How many terms the slow series of each orbit takes, and the most of any."""
    terms = select(reach <= FEWER[0][1], FEWER[0][0], select(reach <= FEWER[1][1], FEWER[1][0], SLOW + 0.0 * reach))
    most = SLOW
    for n in range(len(FEWER) - 1, -1, -1):
        if bits(touching & (terms > FEWER[n][0])) == 0:
            most = FEWER[n][0]
    return terms, most


@inline
def begin(passage, touching, block, terms, most, speed, sin, cos):
    """Set apart what is fast and slow in the state at the touch, and load the series of what is slow.

    Returns the damped wave of delta.
    """
    slow, others, y, chi = len(passage.chi), len(passage.push) - 1, passage.y, passage.chi
    for j in range(2 * others):
        put(chi, j, row(y, j + 2))
    put(chi, 2 * others, sin)
    put(chi, 2 * others + 1, cos)
    put(chi, 2 * others + 2, 1.0)
    q = rows_of(chi)
    phi = -weigh(passage.manifold, 2 * block * slow, 1, q)
    v = speed - weigh(passage.manifold, (2 * block + 1) * slow, 1, q)
    for j in range(2 * others):
        h = 2 * (2 * block * others + j)
        put(chi, j, row(chi, j) - (row(passage.share, h) * phi + row(passage.share, h + 1) * v))
    M = 10 * block + 2
    put(passage.phi, 0, phi)
    put(passage.phi, 1, v)
    put(passage.phi, 2, row(passage.fast, M) * phi + row(passage.fast, M + 1) * v)
    put(passage.phi, 3, row(passage.fast, M + 2) * phi + row(passage.fast, M + 3) * v)
    load_slow(passage, block, most, sin, cos)
    if bits(touching & (terms < most)) != 0:
        cut_short(passage, terms, most)
    gamma, kd, d = row(passage.fast, 10 * block), row(passage.fast, 10 * block + 1), row(passage.slow_delta, 0)
    return gamma, kd, -d, (speed - row(passage.slow_delta, 1) - gamma * d) / kd


@inline
def load_slow(passage, block, most, sin, cos):
    """The series of the slow parts of delta and w2, ..., by chi' = S chi, from the chi at the touch."""
    slow, others, chi, L, S = len(passage.chi), len(passage.push) - 1, passage.chi, passage.manifold, passage.slow
    x, v = passage.slow_others, passage.slow_speeds
    first, phase = 2 * block * slow, 2 * others
    for m in range(others):
        put(x, m * SLOW_ROWS, row(chi, 2 * m))
        put(v, m * SLOW_ROWS, row(chi, 2 * m + 1))
    for n in range(most):
        power, inverse = row(passage.powers, n), INVERSE[n]
        s, q = power * sin, power * cos  # the n-th terms of the force
        sin, cos = cos, -sin
        total = row(L, first + phase) * s + row(L, first + phase + 1) * q
        if n == 0:
            total = total + row(L, first + phase + 2)
        put(passage.slow_delta, n, add_pull(total, L, first, x, v, SLOW_ROWS, 0, others, n))
        for m in range(others):
            part = (block * others + m) * slow
            total = row(S, part + phase) * s + row(S, part + phase + 1) * q
            if n == 0:
                total = total + row(S, part + phase + 2)
            put(x, m * SLOW_ROWS + n + 1, row(v, m * SLOW_ROWS + n) * inverse)
            put(v, m * SLOW_ROWS + n + 1, add_pull(total, S, part, x, v, SLOW_ROWS, 0, others, n) * inverse)


@noinline
def cut_short(passage, terms, most):
    """Leave to each orbit its own number of terms: its digits do not depend on what others need."""
    for n in range(FEWER[0][0], most):
        part = terms > n
        put(passage.slow_delta, n, select(part, row(passage.slow_delta, n), 0.0))
        for m in range(len(passage.push) - 1):
            place = m * SLOW_ROWS + n
            put(passage.slow_others, place, select(part, row(passage.slow_others, place), 0.0))


@inline
def keep_state(passage, block, most, wave, to, who, u, x, y):
    """The state of these orbits at u, where the damped waves are x and y."""
    gamma, kd, P, Q = wave
    f, slope, _, _, _ = expanded_at(passage.slow_delta, 0, most, u)
    put(to, 0, select(who, P * x + Q * y + f, row(to, 0)))
    put(to, 1, select(who, (kd * Q - gamma * P) * x - (kd * P + gamma * Q) * y + slope, row(to, 1)))
    phi, v = row(passage.phi, 0) * x + row(passage.phi, 2) * y, row(passage.phi, 1) * x + row(passage.phi, 3) * y
    others = len(passage.push) - 1
    for m in range(others):
        f, slope, _, _, _ = expanded_at(passage.slow_others, m * SLOW_ROWS, most, u)
        h = 4 * (block * others + m)
        f = f + row(passage.share, h) * phi + row(passage.share, h + 1) * v
        slope = slope + row(passage.share, h + 2) * phi + row(passage.share, h + 3) * v
        put(to, 2 * m + 2, select(who, f, row(to, 2 * m + 2)))
        put(to, 2 * m + 3, select(who, slope, row(to, 2 * m + 3)))


@inline
def is_first(passage, block, most, right, k, c, p, by_force, speed, u):
    """Which ends, after the time u, are the first ones for certain."""
    K, G, a, d, last = -row(passage.row, 0), -row(passage.row, 1), passage.slow_drive, passage.slow_delta, most - 4
    for n in range(most - 2):
        put(a, n, K * row(d, n) + (n + 1.0) * (G * row(d, n + 1) + (n + 2.0) * row(d, n + 2)))
    phi, v = abs(row(passage.phi, 0)) + abs(row(passage.phi, 2)), abs(row(passage.phi, 1)) + abs(row(passage.phi, 3))
    w = 4 * block
    wiggle = row(passage.wiggle, w) * phi + row(passage.wiggle, w + 1) * v
    swing = row(passage.wiggle, w + 2) * phi + row(passage.wiggle, w + 3) * v
    preloaded = by_force & (p > 0.0)
    into = away = preloaded | ~preloaded
    if bits(preloaded) != 0:
        change, _ = changes_of(a, last, u)
        into, away = row(a, 0) >= change + wiggle, -row(a, 0) >= change + wiggle
    if bits(by_force) != 0:
        load_sum(a, a, most - 2, k, c, K * p, by_force)
        wiggle = select(by_force, k * wiggle + c * swing, wiggle)
    change, bend = changes_of(a, last, u)
    change, bend, begins, slope = change + wiggle, bend + swing, row(a, 0), row(a, 1)
    duration, half_turn = of_stop(passage.duration, right), of_stop(passage.half_turn, right)
    short = u < half_turn
    signs = ((begins >= change) & (u < duration + half_turn)) | (
        ((-begins >= change) | (~by_force & (abs(slope) >= bend))) & short
    )
    usual = (u < NEARLY * duration) & (duration < NEARLY * u)
    certain = signs | (usual & (speed * of_stop(passage.firm, right) > abs(begins) + change))
    return certain & (~preloaded | (into | away) & short)


@inline
def keep_peaks(passage, most, wave, force, right, k, c, p, u, passed, damped):
    """Keep the largest delta and F/m_e of the contacts that are `passed`, which end at u."""
    largest = largest_of(passage.slow_delta, most, wave, u * of_stop(passage.top, right), u, passed)
    strongest = k * largest + p
    if damped:
        found = largest_of(passage.slow_force, most, force, u * of_stop(passage.force_top, right), u, passed)
        strongest = select(c > 0.0, found, strongest)
    put(passage.largest, 0, select(passed, largest, row(passage.largest, 0)))
    put(passage.strongest, 0, select(passed, strongest, row(passage.strongest, 0)))


@jit
def largest_of(series, most, wave, top, end, passed):
    """The largest value of what falls at the `end`: near `top`, or at 0 if it falls from there on."""
    gamma, kd, P, Q = wave
    first = P + row(series, 0)
    turning = passed & (kd * Q - gamma * P + row(series, 1) > 0.0)
    found = peak(series, most, wave, top, kd, end, turning)
    return select(found > first, found, first)


@jit
def pass_in_closed_form(passage, touching, right, speed, about, sin, cos, to_section):
    """Pass the contacts of the orbits that are `touching` a stop, for `about` so long.

    Returns those that are passed, with their state in `passage.y`; which of them are over a section by then, with the
    state there in `passage.section`; and the time in contact.
    """
    block = choose_tables(passage, touching, right)
    terms, most = terms_for(touching, of_stop(passage.slow_rate, right) * about)
    k, c, p = of_stop(passage.stiffness, right), of_stop(passage.damping, right), of_stop(passage.preload, right)
    by_force = touching & (of_stop(passage.by_force, right) > 0.0)
    forced, damped = bits(by_force) != 0, bits(touching & (c > 0.0)) != 0
    # what moves
    wave = begin(passage, touching, block, terms, most, speed, sin, cos)
    gamma, kd, P, Q = wave
    # what is zero at the end, delta or the force
    force = force_of(wave, k, c)
    if damped and (forced or passage.watched):
        load_sum(passage.slow_force, passage.slow_delta, most, k, c, p, touching)
    series, P_end, Q_end = passage.slow_delta, P, Q
    if forced:
        series = passage.slow_end
        for n in range(most):
            put(series, n, select(by_force, row(passage.slow_force, n), row(passage.slow_delta, n)))
        P_end, Q_end = select(by_force, force[2], P), select(by_force, force[3], Q)
    # the end
    reach, later = of_stop(passage.reach, right), about * (1.0 + row(passage.slow_delta, 1) / speed)  # it drifts
    u = select(later < reach, later, about)
    u, passed = seek(series, most, (gamma, kd, P_end, Q_end), u, kd, reach, touching)
    passed = passed & is_first(passage, block, most, right, k, c, p, by_force, speed, u)
    x, y = wave_at(gamma, kd, u)
    if bits(by_force & (p > 0.0)) != 0:  # the mass is in the stop still
        passed = passed & (~by_force | (P * x + Q * y + at(passage.slow_delta, 0, most, u) > 0.0))
    # what is kept
    crossing = passed & (to_section <= u)
    if bits(crossing) != 0:
        x_there, y_there = wave_at(gamma, kd, to_section)
        keep_state(passage, block, most, wave, passage.section, crossing, to_section, x_there, y_there)
    if passage.watched:
        keep_peaks(passage, most, wave, force, right, k, c, p, u, passed, damped)
    keep_state(passage, block, most, wave, passage.y, passed, u, x, y)
    passage.block, passage.most = block, most
    put(passage.terms, 0, terms)
    # tangent vectors need the sine to its last digits, small as it is: from what is zero at the end
    slow = at(series, 0, most, u)
    put(passage.flight, 0, select(passed, x, row(passage.flight, 0)))
    put(passage.flight, 1, select(passed, -(P_end * x + slow) / (Q_end * kd), row(passage.flight, 1)))
    return passed, crossing, u
