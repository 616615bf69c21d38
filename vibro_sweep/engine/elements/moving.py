"""The state of one orbit, its motion along a series, and the first end of a phase."""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.elements.element_machine import CELLS, RUBS, Machine
from vibro_sweep.engine.elements.laws_of_elements import GUARDS, OPEN, REACH, SLIP, is_reaction
from vibro_sweep.engine.motion.first_contact import first_contact
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.flight import ORDER, bound_third_over, evaluate
from vibro_sweep.engine.tables.products import change_within
from vibro_sweep.engine.tables.twofold import add

ROUNDING = 2.0**-46  # of the terms of a coefficient: what is below is zero
NOW = np.dtype(
    [
        ("phase", np.int64),
        ("period", np.int64),
        ("cell", np.int64),
        ("offset", float),  # in the cell, and
        ("offset_low", float),  # what rounding leaves of it
        ("status", np.int64),
        ("events", np.int64),  # in this period
        ("logged", np.int64),  # or would have been, had there been room
        ("fastest", float),  # largest velocity at an event so far
        ("rate", float),  # of the guard that has ended the phase
    ],
    align=True,
)


class Orbit(NamedTuple):
    """One orbit; z = (y, y', s)."""

    now: np.ndarray  # (1,) NOW
    z: np.ndarray  # (states,)
    z_low: np.ndarray  # (states,): what rounding leaves of it
    q: np.ndarray  # (inputs,): inputs of the series from here on
    modes: np.ndarray  # (E,)
    at: np.ndarray  # (E,): order of the zero with which delta or w begins that is known; 0: none
    made: np.ndarray  # (1,) of `find_phase`
    c: np.ndarray  # (N + S, ORDER): Taylor coefficients
    g: np.ndarray  # (ORDER,): of a guard
    before: np.ndarray  # (E,): modes before an instant
    near: np.ndarray  # (E, guards): which guards of an element end at this instant
    pressed: np.ndarray  # (E,): whether a touch is logged whose release is not
    candidate: np.ndarray  # (E,): whether it may be held
    # of tangent vectors: z' before an event, the normal of the guard, the jump without the change of z', a flight
    flow: np.ndarray  # (states,)
    normal: np.ndarray  # (states,)
    jump: np.ndarray  # (states, states)
    flight: np.ndarray  # (states, states)
    vector: np.ndarray  # (states,): scratch


class Log(NamedTuple):
    events: np.ndarray  # (most, 6 + 2 N): kind, element, side, period, time since then, speed, (y, y') before it
    sections: np.ndarray  # (periods, states): z at the end of each period


def new_orbit(m: Machine) -> Orbit:
    N, inputs = m.free.shape
    E, S = len(m.kind), int((m.relaxing >= 0).sum())
    states, ints = 2 * N + S, np.int64
    return Orbit(
        np.zeros(1, NOW), np.zeros(states), np.zeros(states), np.zeros(inputs), np.zeros(E, ints), np.zeros(E, ints),
        np.zeros(1, ints), np.zeros((N + S, ORDER)), np.zeros(ORDER), np.zeros(E, ints), np.zeros((E, GUARDS), ints),
        np.zeros(E, ints), np.zeros(E, ints), np.zeros(states), np.zeros(states), np.zeros((states, states)),
        np.zeros((states, states)), np.zeros(states),
    )  # fmt: skip


@jit
def depth(m, o, e):
    """delta of a stop: of two floats, so that beside the stop it has all digits."""
    total, left = -m.law[e, 0], 0.0
    for j in range(len(m.free)):
        if m.row[e, j] != 0.0:
            total += m.row[e, j] * o.z[j]
            left += m.row[e, j] * o.z_low[j]
    return total + left


@jit
def speed(m, o, e):
    """delta' of a stop, w of friction."""
    N, total = len(m.free), 0.0
    for j in range(N):
        total += m.row[e, j] * (o.z[N + j] + o.z_low[N + j])
    return total - m.law[e, 0] if m.kind[e] == RUBS else total


@jit
def load_inputs(m, p, f, o):
    """The state, and the phase of the force, as inputs of the series of phase f."""
    N, states, now = len(m.free), len(o.z), o.now[0]
    for j in range(states):
        o.q[j] = (o.z[j] - p.origin[f, j] if j < N else o.z[j]) + o.z_low[j]
    for h in range(len(m.rates)):
        angle = m.rates[h] * now.offset
        sin, cos, swing, turn = m.turn[now.cell, 2 * h], m.turn[now.cell, 2 * h + 1], math.sin(angle), math.cos(angle)
        o.q[states + 2 * h] = sin * turn + cos * swing
        o.q[states + 2 * h + 1] = cos * turn - sin * swing
    o.q[len(o.q) - 1] = 1.0


@jit
def load_series(p, f, o):
    for i in range(len(o.c)):
        load_row(p.series[f, i], o.q, o.c[i])


@jit
def load_row(series, q, c):
    for n in range(ORDER):
        c[n] = series[0, n] * q[0]
    for j in range(1, len(q)):
        for n in range(ORDER):
            c[n] += series[j, n] * q[j]


@jit
def move(m, o, u):
    """The state, and the time, at u of the series."""
    N, now = len(m.free), o.now[0]
    for i in range(len(o.c)):
        x, v = change_within(o.c[i], u)
        j = i if i < N else N + i
        o.z[j], o.z_low[j] = add(o.z[j], o.z_low[j], x, 0.0)
        if i < N:
            o.z[N + i], o.z_low[N + i] = add(o.z[N + i], o.z_low[N + i], v, 0.0)
    now.offset, now.offset_low = add(now.offset, now.offset_low, u, 0.0)


@jit
def time_of(m, o):
    """Since the beginning of the first period."""
    now = o.now[0]
    return (now.period * CELLS + now.cell) * m.width[0] + now.offset


@jit
def known_zeros(p, f, o, n):
    """The order of the zero with which guard n begins, as far as it is known."""
    guard = p.guard[f, n]
    return o.at[p.element[f, n]] if guard == REACH or guard == OPEN or guard == SLIP else 0


@jit
def leading(series, q, first, less):
    """(n, sign) of the first Taylor coefficient of a guard from `first` on that is not zero; (ORDER, 0) of none.

    less : what is taken off the constant one
    """
    for n in range(first, ORDER):
        value = size = 0.0
        for j in range(len(q)):
            value += series[j, n] * q[j]
            size += abs(series[j, n] * q[j])
        if n == 0:
            value -= less
        if abs(value) > ROUNDING * size:
            return n, 1 if value > 0.0 else -1
    return ORDER, 0


@jit
def end_of(m, p, f, o, n, left):
    """When guard n ends the phase: within the time `left`, else infinite; NaN if it cannot be decided."""
    g, zeros = o.g, known_zeros(p, f, o, n)
    load_row(p.guard_series[f, n], o.q, g)
    if zeros > 0 or is_reaction(p.guard[f, n]):
        zeros, sign = leading(p.guard_series[f, n], o.q, zeros, 0.0)
        if sign <= 0:
            return 0.0 if sign < 0 else np.inf
    elif p.guard[f, n] == REACH or p.guard[f, n] == OPEN:  # of two floats
        e = p.element[f, n]
        s = o.z[2 * len(m.free) + m.relaxing[e]] if p.guard[f, n] == REACH and m.relaxing[e] >= 0 else 0.0
        g[0] = s - depth(m, o, e) if p.guard[f, n] == REACH else depth(m, o, e)
    if zeros == 0:
        if g[0] <= 0.0:
            return 0.0
        reach = 0.0
        for k in range(ORDER - 1, 0, -1):
            reach = (reach + abs(g[k])) * left
        if g[0] > reach:
            return np.inf
    for k in range(ORDER):
        g[k] = g[k + zeros] if k + zeros < ORDER else 0.0
    return first_contact(g, bound_third_over(g, left), left)


@jit
def first_end(m, p, f, o, left):
    """(time, guard) of the first end of the phase within the time `left`; (left, -1) if there is none."""
    first, hit = left, -1
    for n in range(p.guards[f, 0]):
        u = end_of(m, p, f, o, n, first)
        if u != u:
            return u, n
        if u < first or (u == first and hit < 0):
            first, hit = u, n
    return first, hit


@jit
def carry(m, p, f, o, V, u):
    """Tangent vectors V (states, n) over the time u of the series."""
    N, F = len(m.free), o.flight
    for i in range(len(o.c)):
        for j in range(len(F)):
            x, v = evaluate(p.series[f, i, j], u)
            F[i if i < N else N + i, j] = x
            if i < N:
                F[N + i, j] = v
    multiply(F, V, o.vector)


@jit
def multiply(F, V, column):
    """V <- F V. column: scratch"""
    for a in range(V.shape[1]):
        for i in range(len(F)):
            column[i] = 0.0
            for j in range(len(F)):
                column[i] += F[i, j] * V[j, a]
        for i in range(len(F)):
            V[i, a] = column[i]


@jit
def rate_of(row, A, q):
    """The time derivative of a function of the inputs."""
    total = 0.0
    for i in range(len(q)):
        if row[i] != 0.0:
            for j in range(len(q)):
                total += row[i] * (A[i, j] * q[j])
    return total


@jit
def fill_flow(p, f, o, out):
    """z'."""
    for i in range(len(out)):
        out[i] = 0.0
        for j in range(len(o.q)):
            out[i] += p.A[f, i, j] * o.q[j]


@jit
def keep_end(m, p, f, o, n):
    """Of the flight that guard n has ended: z', and the normal and the rate of the guard. The jump begins as 1."""
    fill_flow(p, f, o, o.flow)
    o.now[0].rate = rate_of(p.guard_row[f, n], p.A[f], o.q)
    for i in range(len(o.z)):
        o.normal[i] = p.guard_row[f, n, i]
        for j in range(len(o.z)):
            o.jump[i, j] = 1.0 if i == j else 0.0


@jit
def saltate(m, p, o, V):
    """V <- (G + (F+ - G F-) n^T/(n . F-)) V: the one jump of all events; G is `jump`, F+ is z' in the phase to come."""
    f, S, rate = o.now[0].phase, o.flight, o.now[0].rate
    load_inputs(m, p, f, o)
    fill_flow(p, f, o, o.vector)
    for i in range(len(S)):
        change = o.vector[i]
        for j in range(len(S)):
            change -= o.jump[i, j] * o.flow[j]
        for j in range(len(S)):
            S[i, j] = o.jump[i, j]
            if rate < 0.0:  # else rounding alone has ended the phase
                S[i, j] += change * (o.normal[j] / rate)
    multiply(S, V, o.vector)
