"""Flights of any length, forwards or backwards, as matrices; with their derivatives by parameters of the system.

For z' = A z the flight over u is E = exp(A u), and its derivative by a parameter p obeys D' = A D + (A_p/dp) E. Both
come from the Taylor series over a part u/2^k of the flight, short against every rate of the system, and from doubling
it k times: E <- E E, D <- D E + E D. The error is 2^-53 times 2^k, about the fastest rate times u.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.simd.jit import entry, jit

SIZE = 6  # x1, v1, x2, v2, sin, cos
TERMS = 24  # of the series: what is left out is below 2^-80 times the condition number of the eigenvectors of A
SHORT = 0.5  # rate times flight for the series


class Scratch(NamedTuple):
    """The matrices of a flight, and what they are computed in."""

    E: np.ndarray  # (6, 6)
    E_p: np.ndarray  # (m, 6, 6): by m parameters
    term: np.ndarray
    d_term: np.ndarray
    product: np.ndarray
    column: np.ndarray  # (6,)


def new_scratch(parameters: int) -> Scratch:
    """For derivatives by so many parameters."""
    one, many = (SIZE, SIZE), (parameters, SIZE, SIZE)
    return Scratch(np.empty(one), np.empty(many), np.empty(one), np.empty(many), np.empty(one), np.empty(SIZE))


@jit
def set_identity(a):
    for i in range(SIZE):
        for j in range(SIZE):
            a[i, j] = 1.0 if i == j else 0.0


@jit
def add_product(a, b, out):
    """out += a b."""
    for i in range(SIZE):
        for j in range(SIZE):
            total = out[i, j]
            for k in range(SIZE):
                total += a[i, k] * b[k, j]
            out[i, j] = total


@jit
def move(a, factor, out):
    """out = factor a, and a = 0."""
    for i in range(SIZE):
        for j in range(SIZE):
            out[i, j] = factor * a[i, j]
            a[i, j] = 0.0


@jit
def accumulate(a, out):
    """out += a."""
    for i in range(SIZE):
        for j in range(SIZE):
            out[i, j] += a[i, j]


@entry
def propagate(A, A_p, rate, u, w):
    """w.E = exp(A u), and w.E_p its derivatives; A_p (m, 6, 6), rate: the spectral radius of A."""
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
def advance(A, A_p, rate, u, z, dz, w):
    """Carry z (6,) over u, and in the columns of dz its derivatives: 4 by the state, m by parameters, and others."""
    propagate(A, A_p, rate, u, w)
    for j in range(dz.shape[1]):
        for i in range(SIZE):
            total = 0.0
            for k in range(SIZE):
                total += w.E[i, k] * dz[k, j]
            if 4 <= j < 4 + len(A_p):
                for k in range(SIZE):
                    total += w.E_p[j - 4, i, k] * z[k]
            w.column[i] = total
        for i in range(SIZE):
            dz[i, j] = w.column[i]
    for i in range(SIZE):
        total = 0.0
        for k in range(SIZE):
            total += w.E[i, k] * z[k]
        w.column[i] = total
    for i in range(SIZE):
        z[i] = w.column[i]


@entry
def fly(A, A_p, rate, states, phases, angles, z, dz, w, out):
    """out (n, m, 4): flights from `states` (n, 4) at the phases omega t + tau (n,) over the angles (n, m) of s."""
    for i in range(len(states)):
        for j in range(angles.shape[1]):
            for k in range(4):
                z[k] = states[i, k]
            z[4], z[5] = np.sin(phases[i]), np.cos(phases[i])
            advance(A, A_p, rate, angles[i, j], z, dz, w)
            for k in range(4):
                out[i, j, k] = z[k]
