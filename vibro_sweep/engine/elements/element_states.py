"""Changes of the state of one orbit at an instant: a place, a velocity, an impulse."""

from vibro_sweep.engine.elements.element_machine import RUBS
from vibro_sweep.engine.elements.moving import depth, speed
from vibro_sweep.engine.elements.phases import across
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.twofold import add


@jit
def place(m, o, e, delta):
    """Set delta."""
    j = m.coordinate[e]
    if j >= 0 and abs(m.row[e, j]) == 1.0:
        o.z[j], o.z_low[j] = add(m.row[e, j] * m.law[e, 0], 0.0, m.row[e, j] * delta, 0.0)
    else:
        past = (depth(m, o, e) - delta) / across(m, e, e)
        for i in range(len(m.free)):
            o.z[i] -= past * m.push[e, i]


@jit
def set_speed(m, o, e, v):
    """Set delta' or w, where it is a coordinate."""
    j = m.coordinate[e]
    if j >= 0:
        i = len(m.free) + j
        o.z[i], o.z_low[i] = (v + m.law[e, 0] if m.kind[e] == RUBS else v) / m.row[e, j], 0.0


@jit
def kick(m, o, e, R):
    """An impulse along the row: delta' or w becomes -R times itself. All else that it moves feels it through M."""
    v, N = speed(m, o, e), len(m.free)
    part = (1.0 + R) / across(m, e, e)
    for i in range(N):
        o.z[N + i], o.z_low[N + i] = add(o.z[N + i], o.z_low[N + i], -m.push[e, i] * (part * v), 0.0)
    set_speed(m, o, e, -R * v)
    if m.kind[e] == RUBS:  # the change of z' says it all
        return
    for j in range(len(o.z)):
        along = 0.0
        for i in range(N):
            along += m.row[e, i] * o.jump[N + i, j]
        for i in range(N):
            o.jump[N + i, j] -= m.push[e, i] * (part * along)
