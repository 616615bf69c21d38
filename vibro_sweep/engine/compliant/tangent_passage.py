"""Tangent vectors through the contacts of eight orbits at once; what touch and release do: tangent_in_contact.py."""

import math

from vibro_sweep.engine.compliant.passage_series import INVERSE, carry_vector, from_contact, of_stop
from vibro_sweep.engine.compliant.relaxing import GONE
from vibro_sweep.engine.simd.jit import inline, noinline
from vibro_sweep.engine.simd.lanes import LANES, alike, bits, lanes_of, lowest, number, select
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.variational.growth import shrink_volumes
from vibro_sweep.engine.variational.orthonormal import watch
from vibro_sweep.engine.variational.tangent_flight import apply_flight

SMALLEST = 1e-15  # what a vector may grow by unseen


@inline
def carry_through(law, e, passed):
    """Carry the tangent vectors of the orbits that `passed` a contact, as bits, through it."""
    if law is not None:
        if passed != 0:
            carry_through_contacts(law.passage[0], e.strike[0], e.tangent[0], e.orbits, passed)


@noinline
def carry_through_contacts(passage, strikes, t, orbits, passed):
    """`carry_through` where there are some; their flight up to the touch is collected."""
    who, side, size = lanes_of(passed), row(strikes.side, 0), len(t.growth)
    right, time, parts = side > 0.0, row(passage.time, 0), row(passage.parts, 0)
    c, p = of_stop(passage.damping, right), of_stop(passage.preload, right)
    touch, release = p / row(passage.speed, 0), p / row(passage.speed_after, 0)
    by_force, u = of_stop(passage.by_force, right) > 0.0, time / parts
    forgets, apart = who & by_force & ~(p > 0.0), GONE * c
    apply_flight(t, who)
    closed = who & (row(passage.closed, 0) > 0.0)
    if bits(closed) != 0:
        set_slow_flight(passage, time)
    for j in range(size):
        to_contact(passage, t, side, j)
        vector = passage.vector
        put(vector, 1, row(vector, 1) - touch * row(vector, 0))
        if bits(closed) != 0:
            fly_closed(passage, c, closed)
        part, going = 0.0 * u, who & ~closed
        while bits(going) != 0:
            carry_vector(passage, c, u, going)
            part = part + 1.0
            going = going & (part < parts)
        delta = row(vector, 0)
        put(vector, 1, row(vector, 1) + select(by_force, -c, release) * delta)
        for n in range(len(t.places) // size):
            chosen = who & (right if n == 1 else ~right)
            if bits(forgets) != 0:
                jump = apart * abs(row(t.places, n * size + j))
                forget(t, j, bits(chosen & forgets & (jump > SMALLEST)), jump)
            put(t.places, n * size + j, select(chosen, delta, row(t.places, n * size + j)))
            put(t.alone, n, select(chosen, 0.0, row(t.alone, n)))
        set_from_contact(passage, t, side, j, who)
    put(t.mixed, 0, select(who, 1.0, row(t.mixed, 0)))
    shrink_volumes(t, who, c * time)
    left, growth = passed, of_stop(passage.trace, right) * time - c * time
    while left != 0:
        i = lowest(left)
        left &= left - 1
        crossed = int(passage.crossed[i])
        t.volume[i] *= math.exp(number(growth, i))
        t.cell[i] = orbits[i].cell + crossed
        t.offset[i] = strikes.offset[i] + passage.time[i] - crossed * strikes.width[i]
    watch(t, who, alike(1.0))


@noinline
def forget(t, j, who, jump):
    """Count how much vector j of these orbits might have grown at a touch of a stop that still moves a little."""
    for i in range(LANES):
        if who >> i & 1:
            t.forgotten[j, i] += math.log1p(number(jump, i))


@noinline
def set_slow_flight(passage, time):
    """e^{S time} of w2, w2', ..., for contacts in closed form."""
    others, slow, terms = len(passage.push) - 1, len(passage.chi), row(passage.terms, 0)
    size, E, term = 2 * others, passage.slow_flight, passage.slow_term
    for j in range(size):
        for i in range(size):
            put(term, i, 1.0 if i == j else 0.0)
            put(E, i * size + j, 1.0 if i == j else 0.0)
        for n in range(1, passage.most):
            step = select(terms > float(n), time * INVERSE[n - 1], 0.0)
            for m in range(others):
                first = (passage.block * others + m) * slow
                total = row(passage.slow, first) * row(term, 0)
                for i in range(1, size):
                    total = total + row(passage.slow, first + i) * row(term, i)
                put(term, size + 2 * m, step * row(term, 2 * m + 1))
                put(term, size + 2 * m + 1, step * total)
            for i in range(size):
                put(term, i, row(term, size + i))
                put(E, i * size + j, row(E, i * size + j) + row(term, i))


@inline
def fly_closed(passage, c, who):
    """Carry the tangent `vector` of these orbits on through a contact in closed form.

    With J = (1, 0; c, 1), phi = J (phi, phi') here: f = phi + J L q, q = chi + H J^-1 phi (slow_manifold.py).
    """
    size, slow, vector = len(passage.slow_term) // 2, len(passage.chi), passage.vector
    x, g, chi, E = row(passage.flight, 0), row(passage.flight, 1), passage.slow_term, passage.slow_flight
    L, F, H = 2 * passage.block * slow, 10 * passage.block + 6, 2 * passage.block * size
    phi, v = row(vector, 0), row(vector, 1)
    for j in range(size):
        place, speed = row(passage.manifold, L + j), row(passage.manifold, L + slow + j)
        phi = phi - place * row(vector, j + 2)
        v = v - (speed + c * place) * row(vector, j + 2)
    for j in range(size):
        h = row(passage.share, H + 2 * j + 1)
        put(chi, j, row(vector, j + 2) - ((row(passage.share, H + 2 * j) - c * h) * phi + h * v))
    phi, v = (
        x * phi + g * (row(passage.fast, F) * phi + row(passage.fast, F + 1) * v),
        x * v + g * (row(passage.fast, F + 2) * phi + row(passage.fast, F + 3) * v),
    )
    delta, speed = phi, v
    for j in range(size):
        h = row(passage.share, H + 2 * j + 1)
        w = (row(passage.share, H + 2 * j) - c * h) * phi + h * v
        for i in range(size):
            w = w + row(E, j * size + i) * row(chi, i)
        place, slope = row(passage.manifold, L + j), row(passage.manifold, L + slow + j)
        delta, speed = delta + place * w, speed + (slope + c * place) * w
        put(vector, j + 2, select(who, w, row(vector, j + 2)))
    put(vector, 0, select(who, delta, row(vector, 0)))
    put(vector, 1, select(who, speed, row(vector, 1)))


@inline
def to_contact(passage, t, side, j):
    """Tangent vector j as (delta, delta', w2, ...)."""
    Z, back, size, to = t.Z, t.from_frame, len(t.growth), passage.vector
    for a in range(size):
        total = row(back, a * size) * row(Z, j)
        for m in range(1, size):
            total = total + row(back, a * size + m) * row(Z, m * size + j)
        put(to, a, total)
    for m in range(1, len(passage.push)):
        put(to, 2 * m, row(to, 2 * m) - row(passage.push, m) * row(to, 0))
        put(to, 2 * m + 1, row(to, 2 * m + 1) - row(passage.push, m) * row(to, 1))
    put(to, 0, side * row(to, 0))
    put(to, 1, side * row(to, 1))


@inline
def set_from_contact(passage, t, side, j, who):
    """Tangent vector j from (delta, delta', w2, ...)."""
    Z, frame, size, of = t.Z, t.to_frame, len(t.growth), passage.vector
    from_contact(passage, of, of, side, 0.0 * side)
    for m in range(size):
        total = row(frame, size * m) * row(of, 0)
        for a in range(1, size):
            total = total + row(frame, size * m + a) * row(of, a)
        put(Z, size * m + j, select(who, total, row(Z, size * m + j)))
