"""The passage through a contact, eight orbits at once: from the touch to the end of the cell of the release.

Orbits whose contact contacts_by_pieces.py does not pass for certain are left alone, and so are those whose mass does
not leave the stop freely: pressing.py follows such contacts one by one.
"""

import math

from vibro_sweep.engine.compliant.contact_rows import from_contact, of_stop, turn, turn_far
from vibro_sweep.engine.compliant.contacts_by_pieces import pass_by_pieces
from vibro_sweep.engine.motion.strike import bound_third, derivatives, leaves_freely, load_x1
from vibro_sweep.engine.simd.columns import put_transposed, rows_of, weigh
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import bits, select
from vibro_sweep.engine.simd.memory import put, row
from vibro_sweep.engine.tables import economy


@inline
def change_of(passage, z, m, u):
    """By how much mass m, not the first one, moves in free flight within u after the inputs z; its velocity then."""
    step, first = economy.TERMS, (m - 1) * len(z) * economy.TERMS
    x, v = weigh(passage.series, first + step - 1, step, z), 0.0 * u
    for n in range(step - 2, 1, -1):
        v = v * u + x
        x = x * u + weigh(passage.series, first + n, step, z)
    v, x = v * u + x, x * u + z[2 * m + 1]
    return x * u, v * u + x


@jit
def pass_contacts(passage, strikes, z, touching, side, d, v):
    """Pass the contacts of the orbits that are `touching` a compliant stop, at d in their cells with the velocity v.

    Returns those that have left the stop and touch no other until the end of the cell in which they leave it, where
    `strikes.X` is their state then.
    """
    states, masses, y, right = len(passage.y), len(passage.push), passage.y, side > 0.0
    wall, width = select(right, row(strikes.right, 0), row(strikes.left, 0)), row(strikes.width, 0)
    s, q = turn(row(passage.omega, 0) * d)
    sin, cos = z[states] * q + z[states + 1] * s, z[states + 1] * q - z[states] * s
    speed = side * v
    put(y, 0, 0.0)
    put(y, 1, speed)
    for m in range(1, masses):
        change, vm = change_of(passage, z, m, d)
        put(y, 2 * m, (z[2 * m] + change) - row(passage.push, m) * wall)
        put(y, 2 * m + 1, vm - row(passage.push, m) * v)
    to_section = row(passage.ahead, 0) * width - d
    passed, crossing, time = pass_by_pieces(passage, touching, right, speed, sin, cos, to_section)
    s, q = turn_far(row(passage.omega, 0) * time)
    sin, cos = sin * q + cos * s, cos * q - sin * s
    put(passage.speed, 0, select(touching, speed, row(passage.speed, 0)))
    put(passage.time, 0, select(touching, time, row(passage.time, 0)))
    return leave_stop(passage, strikes, passed, crossing, side, d + time, sin, cos)


@jit
def leave_stop(passage, strikes, leaving, crossing, side, end, sin, cos):
    """Release the orbits that are `leaving` their stop, `end` after the beginning of the cell in which they touched it.

    Returns those that fly freely to the end of the cell in which they leave it.
    """
    masses, states, y, right = len(passage.push), len(passage.y), passage.y, side > 0.0
    k, c, p = of_stop(passage.stiffness, right), of_stop(passage.damping, right), of_stop(passage.preload, right)
    by_force, wall = of_stop(passage.by_force, right) > 0.0, select(right, row(strikes.right, 0), row(strikes.left, 0))
    place, speed = select(by_force, row(y, 0), 0.0), row(y, 1)
    if bits(leaving & by_force) != 0:
        by_place = by_force & (c * c * k < k * k)  # of the place and the speed, that which is better conditioned
        place = select(by_place, -(c * speed + p) / k, place)
        speed = select(by_force & ~by_place, -(k * place + p) / c, speed)
    put(passage.place, 0, place)
    put(passage.speed_after, 0, speed)
    put(y, 0, place)
    put(y, 1, speed)
    from_contact(passage, passage.y, passage.release, side, wall)
    if bits(crossing) != 0:
        from_contact(passage, passage.section, passage.landing, side, wall)
        put_transposed(passage.X, passage.landing)
    put(passage.release, states, sin)
    put(passage.release, states + 1, cos)
    if len(passage.release) > states + 2:
        put(passage.release, states + 2, 1.0)
    # the rest of the cell
    width = row(strikes.width, 0)
    crossed = math.floor(end / width)
    rest = (crossed + 1.0) * width - end
    over = crossed >= row(passage.ahead, 0)
    leaving = leaving & (speed < 0.0) & (rest >= 0.0) & (crossed < row(passage.last, 0)) & (crossing | ~over)
    z = rows_of(passage.release)
    put(strikes.c, 1, z[1])
    load_x1(strikes, z, 2, economy.TERMS)
    third, after = bound_third(strikes, z), 2.0 * row(strikes.c, 2)
    leaving = leaving & leaves_freely(strikes, -speed, after, side, rest, third)
    # the relaxing stop falls behind: k delta + c delta' < 0 from the release on
    into = select(side * after > 0.0, side * after, 0.0) + rest * third
    leaving = leaving & (~by_force | (k * (-speed - rest * into) > c * into))
    put(passage.crossed, 0, crossed)
    put(passage.rest, 0, rest)
    for m in range(masses):
        if m == 0:
            change, v, _, _ = derivatives(strikes.c, rest, economy.TERMS)
            change = side * place + change
            x = wall + change
            put(passage.finer, 0, (wall - (x - (x - wall))) + (change - (x - wall)))
        else:
            change, v = change_of(passage, z, m, rest)
            x = z[2 * m] + change
        put(strikes.landing, 2 * m, select(leaving, x, row(strikes.landing, 2 * m)))
        put(strikes.landing, 2 * m + 1, select(leaving, v, row(strikes.landing, 2 * m + 1)))
    put_transposed(strikes.X, strikes.landing)
    return leaving
