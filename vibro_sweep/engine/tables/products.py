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
def join(a, b, out, states, inputs, swing, turn):
    """D of the flight a and then b. swing, turn: sin and cos of omega t, over a."""
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
        swing, turn = nodes[k - step].turn[0], nodes[k - step].turn[1]
        join(nodes[k - step].E, nodes[step].E, nodes[k].E, states, inputs, swing, turn)
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
        swing, turn = math.sin(q.omega * u), math.cos(q.omega * u)
        join(nodes[1].E, nodes[1].E, nodes[2].E, states, inputs, swing, turn)
        for j in range(inputs):
            for i in range(states):
                nodes[1].E[j, i] = nodes[2].E[j, i]
        u *= 2.0
