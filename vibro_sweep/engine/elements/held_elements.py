"""Who is held at one instant, and so which phase comes next.

What may be held are closed rigid stops, preloaded ones and friction elements without speed: all of them are at first;
then the first one whose state contradicts itself changes, until none does (least-index pivoting). Exactly at a limit
the first Taylor coefficient that is not zero decides; if all are zero, the state holds.
"""

from vibro_sweep.engine.elements.element_machine import RUBS
from vibro_sweep.engine.elements.element_states import kick, set_speed
from vibro_sweep.engine.elements.laws_of_elements import DOWN, FREE, HELD, UP, instead, may_be_held
from vibro_sweep.engine.elements.moving import known_zeros, leading, load_inputs
from vibro_sweep.engine.elements.phases import find_phase
from vibro_sweep.engine.simd.jit import jit, noinline
from vibro_sweep.tables import outcomes as status

MOST_CHANGES = 1000  # of who is held, at one instant, with the static force, and as many with the kinetic one


@noinline
def hold_candidates(m, p, o):
    """Hold the candidates that can be held, and find the phase to come; a status where no choice fits."""
    now, some = o.now[0], False
    for e in range(len(o.modes)):
        if o.candidate[e]:
            some = True
            if m.kind[e] == RUBS or may_be_held(m, e):
                o.modes[e] = HELD
                kick(m, o, e, 0.0)
            else:
                o.modes[e] = FREE
    for e in range(len(o.modes)):
        if o.candidate[e]:
            set_speed(m, o, e, 0.0)
            o.at[e] = 1 if m.kind[e] == RUBS else 2
    for change in range(2 * MOST_CHANGES):
        now.phase = find_phase(m, p, o.modes, o.made)
        if not some or not change_one(m, p, now.phase, o, change < MOST_CHANGES):
            return
    now.status = status.UNRESOLVED


@jit
def change_one(m, p, f, o, static):
    """Change the first candidate that contradicts itself; whether there is one. static: what a stick holds."""
    load_inputs(m, p, f, o)
    for n in range(p.guards[f, 0]):
        e, guard = p.element[f, n], p.guard[f, n]
        if o.candidate[e]:
            less = m.law[e, 2] - m.law[e, 1] if (guard == UP or guard == DOWN) and not static else 0.0
            if leading(p.guard_series[f, n], o.q, known_zeros(p, f, o, n), less)[1] < 0:
                o.modes[e] = instead(m, e, guard)
                return True
    return False
