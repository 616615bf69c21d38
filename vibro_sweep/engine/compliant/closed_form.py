"""Contacts in closed form, eight orbits at once: the damped wave of the fast pair on a slow series (slow_manifold.py).

    delta = e^{-gamma u} (P cos kd u + Q sin kd u) + d(u),   d = L_0 chi,   P = -d(0),   Q = (V - d'(0) - gamma d(0))/kd

The force, and derivatives, are of the same form (damped_wave.py); passage.py says when the end that is found is the
first one for certain.
"""

from vibro_sweep.engine.compliant.damped_wave import force_of, peak_of, seek, wave
from vibro_sweep.engine.compliant.passage_series import INVERSE, at, derivatives_at, of_stop
from vibro_sweep.engine.compliant.passage_tables import NEARLY
from vibro_sweep.engine.compliant.slow_manifold import FEWER, SLOW
from vibro_sweep.engine.simd.columns import rows_of, weigh
from vibro_sweep.engine.simd.jit import inline, jit, noinline
from vibro_sweep.engine.simd.lanes import bits, select
from vibro_sweep.engine.simd.memory import put, row

MARGIN = 1.0 + 1e-9  # of bounds that rounding may have moved


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
def load_force(to, of, count, k, c, p):
    """The series of k delta + c delta' + p from that of delta."""
    for n in range(count - 1):
        put(to, n, k * row(of, n) + c * ((n + 1.0) * row(of, n + 1)))
    put(to, count - 1, k * row(of, count - 1))
    put(to, 0, row(to, 0) + p)


@inline
def changes_of(c, last, u):
    """By how much a series up to the `last` power changes at most within u, and its derivative."""
    size, slope = abs(row(c, last)), float(last) * abs(row(c, last))
    for n in range(last - 1, 0, -1):
        size = size * u + abs(row(c, n))
        if n > 1:
            slope = slope * u + float(n) * abs(row(c, n))
    return size * u * MARGIN, slope * u * MARGIN


@inline
def keep_state(passage, block, to, who, u, x, y):
    """The state of these orbits at u, where the damped waves are x and y."""
    gamma, kd = row(passage.fast, 10 * block), row(passage.fast, 10 * block + 1)
    P, Q = row(passage.waves, 0), row(passage.waves, 1)
    f, slope, _ = derivatives_at(passage.slow_delta, 0, passage.most, u)
    put(to, 0, select(who, P * x + Q * y + f, row(to, 0)))
    put(to, 1, select(who, (kd * Q - gamma * P) * x - (kd * P + gamma * Q) * y + slope, row(to, 1)))
    phi, v = row(passage.phi, 0) * x + row(passage.phi, 2) * y, row(passage.phi, 1) * x + row(passage.phi, 3) * y
    others = len(passage.push) - 1
    for m in range(others):
        f, slope, _ = derivatives_at(passage.slow_others, m * SLOW, passage.most, u)
        h = 4 * (block * others + m)
        f = f + row(passage.share, h) * phi + row(passage.share, h + 1) * v
        slope = slope + row(passage.share, h + 2) * phi + row(passage.share, h + 3) * v
        put(to, 2 * m + 2, select(who, f, row(to, 2 * m + 2)))
        put(to, 2 * m + 3, select(who, slope, row(to, 2 * m + 3)))


@inline
def terms_for(passage, touching, reach):
    """How many terms the slow series of each orbit takes."""
    terms = select(reach <= FEWER[0][1], FEWER[0][0], select(reach <= FEWER[1][1], FEWER[1][0], SLOW + 0.0 * reach))
    passage.most = SLOW
    for n in range(len(FEWER) - 1, -1, -1):
        if bits(touching & (terms > FEWER[n][0])) == 0:
            passage.most = FEWER[n][0]
    put(passage.terms, 0, terms)
    return terms


@inline
def load_slow(passage, block, terms):
    """The series of the slow parts of delta, w2, ..., of so many `terms`, by chi' = S chi; others are zero."""
    slow, others, chi, omega = len(passage.chi), len(passage.push) - 1, passage.chi, row(passage.omega, 0)
    for n in range(passage.most):
        part, inverse = terms > n, INVERSE[n]
        q = rows_of(chi)
        put(passage.slow_delta, n, select(part, weigh(passage.manifold, 2 * block * slow, 1, q), 0.0))
        for m in range(others):
            put(passage.slow_others, m * SLOW + n, select(part, row(chi, 2 * m), 0.0))
            put(chi, 2 * m, row(chi, 2 * m + 1) * inverse)
            put(chi, 2 * m + 1, weigh(passage.slow, (block * others + m) * slow, 1, q) * inverse)
        put(chi, 2 * others, omega * q[2 * others + 1] * inverse)
        put(chi, 2 * others + 1, -omega * q[2 * others] * inverse)
        put(chi, 2 * others + 2, 0.0)


@inline
def begin(passage, block, speed, sin, cos, terms):
    """Set apart what is fast and slow in the state at the touch, and load the series of what is slow."""
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
    load_slow(passage, block, terms)
    gamma, kd, d = row(passage.fast, 10 * block), row(passage.fast, 10 * block + 1), row(passage.slow_delta, 0)
    put(passage.waves, 0, -d)
    put(passage.waves, 1, (speed - row(passage.slow_delta, 1) - gamma * d) / kd)


@inline
def is_first(passage, block, right, k, c, p, by_force, speed, u):
    """Which ends, after the time u, are the first ones for certain."""
    K, G, a, d, count = -row(passage.row, 0), -row(passage.row, 1), passage.slow_drive, passage.slow_delta, passage.most
    for n in range(count - 2):
        put(a, n, K * row(d, n) + (n + 1.0) * (G * row(d, n + 1) + (n + 2.0) * row(d, n + 2)))
    phi, v = abs(row(passage.phi, 0)) + abs(row(passage.phi, 2)), abs(row(passage.phi, 1)) + abs(row(passage.phi, 3))
    w = 4 * block
    wiggle = row(passage.wiggle, w) * phi + row(passage.wiggle, w + 1) * v
    swing = row(passage.wiggle, w + 2) * phi + row(passage.wiggle, w + 3) * v
    preloaded = by_force & (p > 0.0)
    into = away = preloaded | ~preloaded
    if bits(preloaded) != 0:
        change, _ = changes_of(a, count - 4, u)
        into, away = row(a, 0) >= change + wiggle, -row(a, 0) >= change + wiggle
    if bits(by_force) != 0:
        for n in range(count - 3):
            both = k * row(a, n) + c * ((n + 1.0) * row(a, n + 1))
            if n == 0:
                both = both + K * p
            put(a, n, select(by_force, both, row(a, n)))
        wiggle = select(by_force, k * wiggle + c * swing, wiggle)
    change, bend = changes_of(a, count - 4, u)
    change, bend, begins, slope = change + wiggle, bend + swing, row(a, 0), row(a, 1)
    duration, half_turn = of_stop(passage.duration, right), of_stop(passage.half_turn, right)
    short = u < half_turn
    signs = ((begins >= change) & (u < duration + half_turn)) | (
        ((-begins >= change) | (~by_force & (abs(slope) >= bend))) & short
    )
    usual = (u < NEARLY * duration) & (duration < NEARLY * u)
    certain = signs | (usual & (speed * of_stop(passage.firm, right) > abs(begins) + change))
    return certain & (~preloaded | (into | away) & short)


@jit
def pass_in_closed_form(passage, touching, right, speed, about, sin, cos, to_section):
    """Pass the contacts of the orbits that are `touching` a stop, for `about` so long.

    Returns those that are passed, with their state in `passage.y`; which of them are over a section by then, with the
    state there in `passage.section`; and the time in contact.
    """
    block = passage.block = choose_tables(passage, touching, right)
    terms = terms_for(passage, touching, of_stop(passage.slow_rate, right) * about)
    begin(passage, block, speed, sin, cos, terms)
    count = passage.most
    k, c, p = of_stop(passage.stiffness, right), of_stop(passage.damping, right), of_stop(passage.preload, right)
    by_force = touching & (of_stop(passage.by_force, right) > 0.0)
    gamma, kd = row(passage.fast, 10 * block), row(passage.fast, 10 * block + 1)
    P, Q = row(passage.waves, 0), row(passage.waves, 1)
    P_force, Q_force = force_of(k, c, gamma, kd, P, Q)
    forced = bits(by_force) != 0
    damped = passage.watched and bits(touching & (c > 0.0)) != 0
    if forced or damped:
        load_force(passage.slow_force, passage.slow_delta, count, k, c, p)
    for n in range(count):
        term = row(passage.slow_delta, n)
        put(passage.slow_end, n, select(by_force, row(passage.slow_force, n), term) if forced else term)
    P_end, Q_end = select(by_force, P_force, P), select(by_force, Q_force, Q)
    u, found = seek(passage.slow_end, count, gamma, kd, P_end, Q_end, about, of_stop(passage.reach, right), touching)
    passed = found & is_first(passage, block, right, k, c, p, by_force, speed, u)
    x, y = wave(gamma, kd, u)
    if bits(by_force & (p > 0.0)) != 0:  # the mass is in the stop still
        passed = passed & (~by_force | (P * x + Q * y + at(passage.slow_delta, 0, count, u) > 0.0))
    crossing = passed & (to_section <= u)
    if bits(crossing) != 0:
        x_there, y_there = wave(gamma, kd, to_section)
        keep_state(passage, block, passage.section, crossing, to_section, x_there, y_there)
    if passage.watched:
        top = u * of_stop(passage.top, right)
        largest = peak_of(passage.slow_delta, count, gamma, kd, P, Q, top, u, passed)
        put(passage.largest, 0, select(passed, largest, row(passage.largest, 0)))
        strongest = k * largest + p
        if damped:  # k delta + c delta' is about k delta(u + c/k)
            top = select(top * k > c, top - c / k, 0.0)
            most = peak_of(passage.slow_force, count, gamma, kd, P_force, Q_force, top, u, passed)
            strongest = select(c > 0.0, most, strongest)
        put(passage.strongest, 0, select(passed, strongest, row(passage.strongest, 0)))
    keep_state(passage, block, passage.y, passed, u, x, y)
    # tangent vectors need the sine to its last digits, small as it is: from what is zero at the end
    slow = at(passage.slow_end, 0, count, u)
    put(passage.flight, 0, select(passed, x, row(passage.flight, 0)))
    put(passage.flight, 1, select(passed, -(P_end * x + slow) / (Q_end * kd), row(passage.flight, 1)))
    return passed, crossing, u
