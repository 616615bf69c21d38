"""Phases: the equations of motion while each element keeps its mode, and their Taylor series.

In a phase the inputs q = (y, y', s, sin, cos, .., 1) obey q' = A q. A phase is made when an orbit first comes to it.
Positions count from `origin` in it: from the place of the stop that is pressed, so that delta keeps its digits.
"""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.elements.element_machine import Machine
from vibro_sweep.engine.elements.laws_of_elements import (
    HELD,
    MODES,
    MOST_GUARDS,
    PRESSED,
    RELAXING,
    fill_given_forces,
    fill_guards,
)
from vibro_sweep.engine.simd.jit import jit, noinline
from vibro_sweep.engine.tables.flight import ORDER, WIDTH
from vibro_sweep.engine.tables.series import clear, derive

ROOM = 64  # phases that are kept; where more are met, the first ones are made again
DEPENDENT = 1e-10  # part of a row beside those before it with which it depends on them
SQUARINGS = 4


class Phases(NamedTuple):
    """The tables of phases, of each (phases, ...). Kernels are given all of them, and the place f of one."""

    key: np.ndarray  # (1,)
    origin: np.ndarray  # (N,)
    A: np.ndarray  # (inputs, inputs)
    series: np.ndarray  # (N + S, inputs, ORDER): Taylor coefficients of each y and s, of the inputs
    force: np.ndarray  # (E, inputs): of each element, of the inputs
    carries: np.ndarray  # (E,): whether it is held, and not by the others already
    guards: np.ndarray  # (1,)
    guard: np.ndarray  # (guards,): which one,
    element: np.ndarray  # (guards,): of which element,
    guard_row: np.ndarray  # (guards, inputs): of the inputs, and
    guard_series: np.ndarray  # (guards, inputs, ORDER): its Taylor coefficients
    step: np.ndarray  # (1,): how far the series reach
    factors: np.ndarray  # (E, E + 1): scratch
    powers: np.ndarray  # (2, inputs, inputs): scratch


def new_phases(m: Machine) -> Phases:
    N, E, inputs = len(m.free), len(m.kind), m.free.shape[1]
    S, G = int((m.relaxing >= 0).sum()), MOST_GUARDS * E
    shapes = {
        "key": (1,), "origin": (N,), "A": (inputs, inputs), "series": (N + S, inputs, ORDER), "force": (E, inputs),
        "carries": (E,), "guards": (1,), "guard": (G,), "element": (G,), "guard_row": (G, inputs),
        "guard_series": (G, inputs, ORDER), "step": (1,), "factors": (E, E + 1), "powers": (2, inputs, inputs),
    }  # fmt: skip
    whole = ("key", "carries", "guards", "guard", "element")
    return Phases(**{name: np.zeros((ROOM, *shape), int if name in whole else float) for name, shape in shapes.items()})


@noinline
def find_phase(m, p, modes, made):
    """The place of the phase with these modes, which is made if it is not there. made (1,): how many have been."""
    key = 1
    for e in range(len(modes)):
        key = MODES * key + modes[e]
    for i in range(min(made[0], ROOM)):
        if p.key[i, 0] == key:
            return i
    f = made[0] % ROOM
    made[0] += 1
    p.key[f, 0] = key
    fill(m, p, f, modes)
    return f


@jit
def fill(m, p, f, modes):
    for j in range(p.origin.shape[1]):
        p.origin[f, j] = 0.0
    for e in range(len(modes)):
        j = m.coordinate[e]
        if modes[e] == PRESSED and j >= 0:
            p.origin[f, j] = m.law[e, 0] / m.row[e, j]
    fill_given_forces(m, p, f, modes)
    fill_equations(m, p, f, modes)
    fill_guards(m, p, f, modes)
    row, N = p.powers[f, 0, 0], len(m.free)
    for i in range(p.series.shape[1]):
        for j in range(len(row)):
            row[j] = 0.0
        row[i if i < N else N + i] = 1.0
        derive(p.A[f], row, len(row), p.series[f, i])
    for n in range(p.guards[f, 0]):
        derive(p.A[f], p.guard_row[f, n], len(row), p.guard_series[f, n])
    width = m.width[0]
    p.step[f, 0] = width / max(math.ceil(fastest(m, p, f) * width / WIDTH), 1.0)


@jit
def fill_equations(m, p, f, modes):
    """A, with the forces of the elements: those that follow from the modes, and those that hold."""
    clear(p.A[f])
    N, A, places = len(m.free), p.A[f], 2 * len(m.free)
    one, states = len(A) - 1, len(A) - 1 - 2 * len(m.rates)
    for i in range(N):
        A[i, N + i] = 1.0
        for j in range(one + 1):
            A[N + i, j] = m.free[i, j]
        for j in range(N):
            A[N + i, one] += m.free[i, j] * p.origin[f, j]
    for h in range(len(m.rates)):
        sin, cos = states + 2 * h, states + 2 * h + 1
        A[sin, cos], A[cos, sin] = m.rates[h], -m.rates[h]
    for e in range(len(modes)):
        if modes[e] == RELAXING:
            s = places + m.relaxing[e]
            A[s, s], A[s, one] = -m.law[e, 1] / m.law[e, 2], -m.law[e, 3] / m.law[e, 2]  # k s + c s' + p = 0
        add_force(m, p, f, e)
    hold(m, p, f, modes)


@jit
def add_force(m, p, f, e):
    N = len(m.free)
    for i in range(N):
        if m.push[e, i] != 0.0:
            for j in range(p.A.shape[1]):
                p.A[f, N + i, j] -= m.push[e, i] * p.force[f, e, j]


@jit
def hold(m, p, f, modes):
    """The forces that keep what is held still: row . y'' = 0 for all of them, by elimination. A row that depends on
    those before it carries nothing."""
    N, L, count = len(m.free), p.factors[f], 0  # L D L^T, D in the last column
    last, held = L.shape[1] - 1, p.element[f]  # of guards, which are not there yet
    for e in range(len(modes)):
        p.carries[f, e] = 0
        if modes[e] == HELD:
            for a in range(count):
                L[count, a] = across(m, e, held[a])
                for b in range(a):
                    L[count, a] -= L[count, b] * L[b, last] * L[a, b]
                L[count, a] /= L[a, last]
            size = across(m, e, e)
            L[count, last] = size
            for a in range(count):
                L[count, last] -= L[count, a] * L[count, a] * L[a, last]
            if L[count, last] > DEPENDENT * size:
                held[count], p.carries[f, e] = e, 1
                count += 1
    for j in range(p.A.shape[1]):
        for a in range(count):
            total = 0.0
            for i in range(N):
                total += m.row[held[a], i] * p.A[f, N + i, j]
            for b in range(a):
                total -= L[a, b] * p.force[f, held[b], j]
            p.force[f, held[a], j] = total
        for a in range(count - 1, -1, -1):
            total = p.force[f, held[a], j] / L[a, last]
            for b in range(a + 1, count):
                total -= L[b, a] * p.force[f, held[b], j]
            p.force[f, held[a], j] = total
    for a in range(count):
        add_force(m, p, f, held[a])
    for a in range(count):
        if m.coordinate[held[a]] >= 0:
            for j in range(p.A.shape[1]):
                p.A[f, N + m.coordinate[held[a]], j] = 0.0


@jit
def across(m, e, other):
    """row_e M^-1 row_other^T"""
    total = 0.0
    for i in range(len(m.free)):
        total += m.row[e, i] * m.push[other, i]
    return total


@jit
def fastest(m, p, f):
    """A bound near the fastest rate: the 16th root of the norm of A^16, of the force apart from the motion."""
    a, b = p.powers[f, 0], p.powers[f, 1]
    states = p.A.shape[1] - 1 - 2 * len(m.rates)
    for i in range(states):
        for j in range(states):
            a[i, j] = p.A[f, i, j]
    log, power = 0.0, 1.0
    for n in range(SQUARINGS + 1):
        size = 0.0
        for i in range(states):
            total = 0.0
            for j in range(states):
                total += abs(a[i, j])
            size = max(size, total)
        if not size > 0.0:
            log = -np.inf
            break
        log += math.log(size) / power
        if n < SQUARINGS:
            square(a, size, states, b)
            power *= 2.0
    rate = math.exp(log)
    for h in range(len(m.rates)):
        rate = max(rate, m.rates[h])
    return rate


@jit
def square(a, size, n, b):
    """a <- (a/size)^2. b: scratch"""
    for i in range(n):
        for j in range(n):
            a[i, j] /= size
    for i in range(n):
        for j in range(n):
            b[i, j] = 0.0
            for k in range(n):
                b[i, j] += a[i, k] * a[k, j]
    for i in range(n):
        for j in range(n):
            a[i, j] = b[i, j]
