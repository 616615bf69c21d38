"""Flights over cells as products of the flight over one cell: exact for any damping, defective systems among them.

E = 1 + D is kept as D while products are formed,

    D(a + b) = D(a) + D(b) + D(a) D(b),

so that a mode which hardly moves within a cell keeps its digits. Rows are those of `node_of`: row j is what input j at
the beginning becomes, so that the first flight stands on the left.
"""

import math

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER
from vibro_sweep.engine.tables.series import clear
from vibro_sweep.engine.tables.twofold import fill_doubled


@jit
def change_within(c, u):
    """Sum of c_n u^n from n = 1 on, and of n c_n u^(n-1) from n = 2 on."""
    x, v = 0.0, 0.0
    for n in range(ORDER - 1, 1, -1):
        x = x * u + c[n]
        v = v * u + n * c[n]
    return (x * u + c[1]) * u, v * u


@jit
def fill_short(q, D, u):
    """D of a flight over a time u that the series reach over."""
    states, inputs = 2 * len(q.series), len(q.force)
    clear(D[:])
    for m in range(len(q.series)):
        for j in range(inputs):
            c = q.series[m, j]
            D[j, 2 * m], D[j, 2 * m + 1] = change_within(c, u)
            if j != 2 * m + 1 and j < states:
                D[j, 2 * m + 1] += c[1]


@jit
def join(a, b, out, states, inputs, angle):
    """D of the flight a and then b. angle: of the force, over a."""
    swing, turn = math.sin(angle), math.cos(angle)
    for j in range(inputs):
        for i in range(states):
            total = 0.0
            for m in range(states):
                total += a[j, m] * b[m, i]
            after = b[j, i]
            if j == states:  # to sin and cos at the beginning of a
                after = b[j, i] * turn - b[j + 1, i] * swing
            elif j == states + 1:
                after = b[j - 1, i] * swing + b[j, i] * turn
            out[j, i] = total + (a[j, i] + after)


@jit
def fill_products(q, nodes, point, room):
    """E at all nodes, and what each force does from rest. room: scratch of twofold.py.

    The flight to node k = rest + step, with step its lowest binary digit, is one to `rest` and one of `step` cells:
    rounding errors grow with the number of digits of k, not with k.
    """
    states, inputs, cells = 2 * len(q.series), len(q.force), q.cells
    clear(nodes[0].E[:])
    if point.apart:
        fill_doubled(q, nodes, point, room)
    else:
        fill_first(q, nodes)
    for k in range(2, cells + 1):
        if point.apart and k & (k - 1) == 0:
            continue
        step = k & -k if k & (k - 1) else k // 2
        clear(nodes[k].E[:])
        angle = 2.0 * math.pi * ((k - step) / cells)
        join(nodes[k - step].E, nodes[step].E, nodes[k].E, states, inputs, angle)
    for k in range(cells + 1):
        for j in range(states):
            nodes[k].E[j, j] += 1.0


@jit
def fill_first(q, nodes):
    """D of a cell, by the series."""
    states, inputs = 2 * len(q.series), len(q.force)
    halvings, u = 0, q.width
    while u > 1.001 * q.step:
        u *= 0.5
        halvings += 1
    fill_short(q, nodes[1].E, u)
    for _ in range(halvings):
        clear(nodes[2].E[:])
        join(nodes[1].E, nodes[1].E, nodes[2].E, states, inputs, q.omega * u)
        for j in range(inputs):
            for i in range(states):
                nodes[1].E[j, i] = nodes[2].E[j, i]
        u *= 2.0


@jit
def fill_forced_motion(q, nodes, tau, begin):
    """The motion r under the force, and the other inputs at the nodes. At node 0 the phase is tau.

    There r is at rest; where the system is stiff, in the state `begin`.
    """
    states, inputs = 2 * len(q.series), len(q.force)
    first, second = math.sin(tau), math.cos(tau)
    q.largest = 0.0
    for k in range(q.cells + 1):
        z, E, phase = nodes[k].z, nodes[k].E, tau + 2.0 * math.pi * (k / q.cells)
        for i in range(len(z)):
            z[i] = 0.0
        for i in range(states):
            z[i] = E[states, i] * first + E[states + 1, i] * second
            if inputs > states + 2:
                z[i] += E[states + 2, i]
            if q.stiff:
                for j in range(states):
                    z[i] += E[j, i] * begin[j]
        z[states], z[states + 1] = math.sin(phase), math.cos(phase)
        if inputs > states + 2:
            z[states + 2] = 1.0
        q.largest = max(q.largest, abs(z[0]))
