"""The motion r under the force, and what the force does from rest, at each node (eqs. 5, 7)."""

import math

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import alike, lanes_of, number, select
from vibro_sweep.engine.tables.flight import ORDER, decaying
from vibro_sweep.engine.tables.stiff import is_fast


@jit
def forced_series(eta, omega_squared, omega, width, sin, cos):
    """xi and xi' after `width`, from rest, of eight xi'' + 2 eta xi' + omega_j^2 xi = sin(omega t + phase)."""
    now = before = total = rate = alike(0.0)  # Taylor terms c_(n+1) width^(n+1) and c_n width^n, and the sums
    square, force, turned = width * width, sin, omega * width * cos
    for n in range(ORDER - 2):
        # (5), term by term
        change = force * square - 2.0 * eta * width * (n + 1.0) * now - omega_squared * square * before
        after = change / ((n + 1.0) * (n + 2.0))
        total = total + after
        rate = rate + (n + 2.0) * after / width
        before, now = now, after
        # derivatives of the force, over n!
        force, turned = turned / (n + 1.0), -omega * omega * square * force / (n + 1.0)
    return total, rate


@jit
def fill_phases(q, nodes, cells, tau):
    """sin and cos of omega t at the nodes, and of omega t + tau.

    Most oscillators of a sweep have the cells, and many the phase, of the one whose tables they replace.
    """
    if cells != q.cells:
        for k in range(cells + 1):
            angle = 2.0 * math.pi * (k / cells)
            nodes[k].angle, nodes[k].turn[0], nodes[k].turn[1] = angle, math.sin(angle), math.cos(angle)
    if cells != q.cells or tau != q.tau:
        for k in range(cells + 1):
            phase = tau + nodes[k].angle
            nodes[k].z[4], nodes[k].z[5] = math.sin(phase), math.cos(phase)
    q.cells, q.tau = cells, tau


@jit
def fill_motion(q, nodes, psi, omega_squared, f2):
    """The motion r.

    The flight to node k = rest + step, with step its lowest binary digit, is one to `rest` and one of `step` cells:
    rounding errors grow with the number of digits of k, not with k.
    """
    cells = q.cells
    for k in range(cells + 1):
        z = nodes[k].z
        z[0] = z[1] = z[2] = z[3] = 0.0
    begin_modes(q, nodes, omega_squared)
    for j in range(2):
        eta, square = q.zeta * omega_squared[j], omega_squared[j]
        force = psi[0, j] * (1.0 - f2) + psi[1, j] * f2
        if is_fast(q, square):
            detuning, damping = square - q.omega * q.omega, 2.0 * eta * q.omega
            size = force / (detuning * detuning + damping * damping)
            for k in range(cells + 1):
                sin, cos = nodes[k].z[4], nodes[k].z[5]
                # (7): xi = A_j sin + B_j cos
                xi = size * (detuning * sin - damping * cos)
                rate = size * q.omega * (detuning * cos + damping * sin)
                add_mode(nodes[k].z, psi, j, xi, rate)
                add_fast_response(q, nodes[k].E, psi, j, square, size * detuning, size * damping, k)
            continue
        fill_mode(q, nodes, j, eta, square)
        sin, cos = nodes[0].z[4], nodes[0].z[5]
        for k in range(cells + 1):
            g = nodes[k].forced[j]
            add_mode(nodes[k].E[4], psi, j, force * g[0, 0], force * g[1, 0])
            add_mode(nodes[k].E[5], psi, j, force * g[0, 1], force * g[1, 1])
            add_mode(
                nodes[k].z, psi, j, force * (g[0, 0] * sin + g[0, 1] * cos), force * (g[1, 0] * sin + g[1, 1] * cos)
            )


@jit
def begin_modes(q, nodes, omega_squared):
    """Begin the response of both modes from rest to sin and cos at node 0, at nodes 0 and 1. (Of a fast mode it is not
    used.)"""
    slower, of_sin = lanes_of(0b0011), lanes_of(0b0101)
    square = select(slower, omega_squared[0], omega_squared[1])
    sin, cos = select(of_sin, 1.0, 0.0), select(of_sin, 0.0, 1.0)
    xi, rate = forced_series(q.zeta * square, square, q.omega, q.width, sin, cos)
    for j in range(2):
        first, one = nodes[0].forced[j], nodes[1].forced[j]
        for i in range(2):
            first[0, i] = first[1, i] = 0.0
            one[0, i], one[1, i] = number(xi, 2 * j + i), number(rate, 2 * j + i)


@jit
def fill_mode(q, nodes, j, eta, square):
    """Fill the response of mode j from rest to sin and cos at node 0, at each node."""
    for k in range(2, q.cells + 1):
        step = k & -k if k & (k - 1) else k // 2
        before, after, out = nodes[k - step].forced[j], nodes[step].forced[j], nodes[k].forced[j]
        c, s = nodes[step].frame[2 * j], nodes[step].frame[2 * j + 1]
        xi, rate = c + eta * s, c - eta * s
        if eta * eta > square:  # overdamped: the difference would cancel
            _, _, xi, rate = decaying(eta, square, step * q.width)
        swing, turn = nodes[k - step].turn[0], nodes[k - step].turn[1]
        out[0, 0] = xi * before[0, 0] + s * before[1, 0] + (after[0, 0] * turn - after[0, 1] * swing)
        out[0, 1] = xi * before[0, 1] + s * before[1, 1] + (after[0, 0] * swing + after[0, 1] * turn)
        out[1, 0] = rate * before[1, 0] - square * s * before[0, 0] + (after[1, 0] * turn - after[1, 1] * swing)
        out[1, 1] = rate * before[1, 1] - square * s * before[0, 1] + (after[1, 0] * swing + after[1, 1] * turn)


@jit
def add_fast_response(q, E, psi, j, omega_squared, a, b, k):
    """Add the response of a fast mode from rest to sin and cos of the force in k cells: a sin - b cos less what it
    begins with."""
    angle = 2.0 * math.pi * (k / q.cells)
    sin, cos = math.sin(angle), math.cos(angle)
    _, s, xi, rate = decaying(q.zeta * omega_squared, omega_squared, k * q.width)
    for row, (first, moving) in enumerate(((a, q.omega * b), (-b, q.omega * a))):
        turned, after = (a * cos + b * sin, b * cos - a * sin) if row == 0 else (a * sin - b * cos, a * cos + b * sin)
        x = turned - (xi * first + s * moving)
        v = q.omega * after - (rate * moving - omega_squared * s * first)
        add_mode(E[4 + row], psi, j, x, v)


@jit
def add_mode(X, psi, j, xi, rate):
    """Add a mode's motion to a state."""
    X[0] += psi[0, j] * xi
    X[1] += psi[0, j] * rate
    X[2] += psi[1, j] * xi
    X[3] += psi[1, j] * rate
