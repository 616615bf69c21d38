"""Flights of any length, forwards or backwards, as matrices; with their derivatives by parameters of the system.

For z' = A z the flight over u is E = exp(A u), and its derivative by a parameter p obeys D' = A D + (A_p/dp) E. Both
come from the Taylor series over a part u/2^k of the flight, short against every rate of the system, and from doubling
it k times: E <- E E, D <- D E + E D. The error is 2^-53 times 2^k, about the fastest rate times u.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.simd.jit import exported, jit

TERMS = 24  # of the series: what is left out is below 2^-80 times the condition number of the eigenvectors of A
SHORT = 0.5  # rate times flight for the series


class Workspace(NamedTuple):
    """The matrices of a flight, and what they are computed in."""

    E: np.ndarray  # (k, k)
    E_p: np.ndarray  # (m, k, k): by m parameters
    term: np.ndarray
    d_term: np.ndarray
    product: np.ndarray
    column: np.ndarray  # (k,)


def new_workspace(size: int, parameters: int) -> Workspace:
    """Arrays for z of so many numbers, and derivatives by so many parameters."""
    one, many = (size, size), (parameters, size, size)
    return Workspace(np.empty(one), np.empty(many), np.empty(one), np.empty(many), np.empty(one), np.empty(size))


@jit
def set_identity(a):
    for i in range(len(a)):
        for j in range(len(a)):
            a[i, j] = 1.0 if i == j else 0.0


@jit
def add_product(a, b, out):
    """out += a b."""
    for i in range(len(a)):
        for j in range(len(a)):
            total = out[i, j]
            for k in range(len(a)):
                total += a[i, k] * b[k, j]
            out[i, j] = total


@jit
def move(a, factor, out):
    """out = factor a, and a = 0."""
    for i in range(len(a)):
        for j in range(len(a)):
            out[i, j] = factor * a[i, j]
            a[i, j] = 0.0


@jit
def accumulate(a, out):
    """out += a."""
    for i in range(len(a)):
        for j in range(len(a)):
            out[i, j] += a[i, j]


@exported
def propagate(A, A_p, rate, u, w):
    """w.E = exp(A u), and w.E_p its derivatives; A_p (m, k, k), rate: the spectral radius of A."""
    halvings, size = 0, rate * abs(u)
    while size > SHORT:
        size *= 0.5
        u *= 0.5
        halvings += 1
    count = len(A_p)
    set_identity(w.E)
    set_identity(w.term)
    move(w.term, 0.0, w.product)
    set_identity(w.term)
    for p in range(count):
        move(w.product, 0.0, w.E_p[p])
        move(w.product, 0.0, w.d_term[p])
    for n in range(1, TERMS + 1):
        for p in range(count):
            add_product(A_p[p], w.term, w.product)
            add_product(A, w.d_term[p], w.product)
            move(w.product, u / n, w.d_term[p])
            accumulate(w.d_term[p], w.E_p[p])
        add_product(A, w.term, w.product)
        move(w.product, u / n, w.term)
        accumulate(w.term, w.E)
    for _ in range(halvings):
        for p in range(count):
            add_product(w.E_p[p], w.E, w.product)
            add_product(w.E, w.E_p[p], w.product)
            move(w.product, 1.0, w.E_p[p])
        add_product(w.E, w.E, w.product)
        move(w.product, 1.0, w.E)


@jit
def advance(A, A_p, rate, u, z, dz, columns, w):
    """Carry z (k,) over u, and its derivatives in the columns of dz; A_p[p] belongs to column `columns[p]`."""
    size = len(z)
    propagate(A, A_p, rate, u, w)
    for j in range(dz.shape[1]):
        for i in range(size):
            total = 0.0
            for k in range(size):
                total += w.E[i, k] * dz[k, j]
            w.column[i] = total
        for i in range(size):
            dz[i, j] = w.column[i]
    for p in range(len(columns)):
        for i in range(size):
            for k in range(size):
                dz[i, columns[p]] += w.E_p[p, i, k] * z[k]
    for i in range(size):
        total = 0.0
        for k in range(size):
            total += w.E[i, k] * z[k]
        w.column[i] = total
    for i in range(size):
        z[i] = w.column[i]


@exported
def fly(A, rate, states, phases, angles, w, out):
    """out (n, m, 2 N): flights from `states` (n, 2 N) at the phases omega t + tau (n,) over the angles (n, m) of s."""
    count = states.shape[1]
    for i in range(len(states)):
        sin, cos = np.sin(phases[i]), np.cos(phases[i])
        for j in range(angles.shape[1]):
            propagate(A, w.E_p, rate, angles[i, j], w)
            for k in range(count):
                total = w.E[k, count] * sin + w.E[k, count + 1] * cos + w.E[k, count + 2]
                for m in range(count):
                    total += w.E[k, m] * states[i, m]
                out[i, j, k] = total
