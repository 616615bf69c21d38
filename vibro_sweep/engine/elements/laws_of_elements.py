"""What an element may be doing, what ends it, and what then comes: the laws of stops and of friction.

A guard is a function of the motion that stays positive while the element keeps its mode.

    mode        force along -row                   guards
    FREE        0                                  REACH: -delta
    RELAXING    0                                  REACH: s - delta; RELAXED: s
    PRESSED     k delta + c delta' + p             OPEN: delta; of a stop that is left by force FORCE: the force
    HELD        what keeps delta or w still        PULL: the force; on a preload PRESS: p - force;
                                                   of friction UP: static - force, DOWN: static + force
    SLIP_UP     kinetic                            SLIP: w
    SLIP_DOWN   -kinetic                           SLIP: -w
"""

from vibro_sweep.engine.elements.element_machine import BY_FORCE, RIGID, RUBS
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.series import clear

FREE, RELAXING, PRESSED, HELD, SLIP_UP, SLIP_DOWN = range(6)
MODES = 6
REACH, RELAXED, OPEN, FORCE, SLIP, UP, DOWN, PULL, PRESS = range(9)
GUARDS = 9
MOST_GUARDS = 2  # of an element
BACK = 2.0**-60  # of the largest distance of a stop from 0: where that is left, a stop without preload has relaxed


@jit
def may_be_held(m, e):
    """Whether the element can keep a coordinate still: a compliant stop by its preload alone."""
    return m.kind[e] == RIGID or m.kind[e] == RUBS or m.law[e, 3] > 0.0


@jit
def is_reaction(guard):
    """Whether the guard is known to rounding alone, also where it begins with a zero."""
    return guard >= UP


@jit
def instead(m, e, guard):
    """The mode of an element at rest whose guard does not stay positive."""
    if guard == UP:
        return SLIP_UP
    if guard == DOWN:
        return SLIP_DOWN
    if guard == PULL:
        return FREE
    if guard == PRESS:
        return PRESSED
    if guard == SLIP or may_be_held(m, e):
        return HELD
    return PRESSED if guard == REACH else FREE


@jit
def add_terms(m, p, f, e, row, at, speed, constant):
    """row += at . delta + speed . delta' + constant, of friction speed . w + constant, as a function of the inputs."""
    N, one = len(m.free), p.A.shape[1] - 1
    place = m.law[e, 0]
    for j in range(N):
        row[j] += at * m.row[e, j]
        row[N + j] += speed * m.row[e, j]
        place -= m.row[e, j] * p.origin[f, j]
    row[one] += constant - (speed * m.law[e, 0] if m.kind[e] == RUBS else at * place)


@jit
def fill_given_forces(m, p, f, modes):
    """The forces that follow from the mode."""
    clear(p.force[f])
    one = p.A.shape[1] - 1
    for e in range(len(modes)):
        if modes[e] == PRESSED:
            add_terms(m, p, f, e, p.force[f, e], m.law[e, 1], m.law[e, 2], m.law[e, 3])
        elif modes[e] == SLIP_UP:
            p.force[f, e, one] = m.law[e, 1]
        elif modes[e] == SLIP_DOWN:
            p.force[f, e, one] = -m.law[e, 1]


@jit
def fill_guards(m, p, f, modes):
    """The guards of all elements; those of one stand together."""
    clear(p.guard_row[f])
    p.guards[f, 0] = 0
    one, places = p.A.shape[1] - 1, 2 * len(m.free)
    for e in range(len(modes)):
        mode, s = modes[e], places + m.relaxing[e]
        if mode == FREE and m.kind[e] != RUBS:
            add_terms(m, p, f, e, p.guard_row[f, new_guard(p, f, REACH, e)], -1.0, 0.0, 0.0)
        elif mode == RELAXING:
            n = new_guard(p, f, REACH, e)
            add_terms(m, p, f, e, p.guard_row[f, n], -1.0, 0.0, 0.0)
            p.guard_row[f, n, s] = 1.0
            n = new_guard(p, f, RELAXED, e)
            p.guard_row[f, n, s] = 1.0
            if m.law[e, 3] == 0.0:
                p.guard_row[f, n, one] = -BACK * farthest(m)
        elif mode == PRESSED:
            if m.kind[e] == BY_FORCE:
                copy(p.force[f, e], 1.0, p.guard_row[f, new_guard(p, f, FORCE, e)])
            if m.kind[e] != BY_FORCE or m.law[e, 3] > 0.0:  # without preload the force is zero first
                add_terms(m, p, f, e, p.guard_row[f, new_guard(p, f, OPEN, e)], 1.0, 0.0, 0.0)
        elif mode == SLIP_UP or mode == SLIP_DOWN:
            add_terms(m, p, f, e, p.guard_row[f, new_guard(p, f, SLIP, e)], 0.0, 1.0 if mode == SLIP_UP else -1.0, 0.0)
        elif mode == HELD and p.carries[f, e]:
            if m.kind[e] == RUBS:
                copy(p.force[f, e], -1.0, p.guard_row[f, new_guard(p, f, UP, e)])
                p.guard_row[f, p.guards[f, 0] - 1, one] += m.law[e, 2]
                copy(p.force[f, e], 1.0, p.guard_row[f, new_guard(p, f, DOWN, e)])
                p.guard_row[f, p.guards[f, 0] - 1, one] += m.law[e, 2]
            else:
                copy(p.force[f, e], 1.0, p.guard_row[f, new_guard(p, f, PULL, e)])
                if m.kind[e] != RIGID:
                    copy(p.force[f, e], -1.0, p.guard_row[f, new_guard(p, f, PRESS, e)])
                    p.guard_row[f, p.guards[f, 0] - 1, one] += m.law[e, 3]


@jit
def new_guard(p, f, guard, e):
    n = p.guards[f, 0]
    p.guard[f, n], p.element[f, n] = guard, e
    p.guards[f, 0] = n + 1
    return n


@jit
def copy(row, factor, out):
    for j in range(len(row)):
        out[j] = factor * row[j]


@jit
def farthest(m):
    """The largest distance of a stop from 0."""
    largest = 2.0**-900
    for e in range(len(m.kind)):
        if m.kind[e] != RUBS:
            largest = max(largest, abs(m.law[e, 0]))
    return largest
