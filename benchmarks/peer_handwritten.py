"""What people write themselves, compiled by numba: Runge-Kutta with a crossing test, and a scan of the closed form.

Both are written with care for speed, but look for contacts only where they happen to look: a graze between two steps
or two points of the scan is missed.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from peers import Solver

from vibro_sweep.model.grazing import steady_response
from vibro_sweep.model.oscillator import System
from vibro_sweep.model.parameters import NAMES

MOST_PERIODS = 5000
compiled = njit(fastmath={"contract"}, error_model="numpy")


# Runge-Kutta


@compiled
def rk4_step(x1, v1, x2, v2, h, force0, force1, force2, p):
    """One step of eqs. (3); force: at its beginning, middle and end."""
    mu_m, mu_k, zeta, f2 = p[0], p[1], p[2], p[3]
    drag, first, second = 2 * zeta, 1 - f2, 1 / mu_m
    s = x1 - x2 + drag * (v1 - v2)
    a1, b1 = first * force0 - s, (f2 * force0 + s - mu_k * (x2 + drag * v2)) * second
    w1, w2 = v1 + 0.5 * h * a1, v2 + 0.5 * h * b1
    y1, y2 = x1 + 0.5 * h * v1, x2 + 0.5 * h * v2
    s = y1 - y2 + drag * (w1 - w2)
    a2, b2 = first * force1 - s, (f2 * force1 + s - mu_k * (y2 + drag * w2)) * second
    u1, u2 = v1 + 0.5 * h * a2, v2 + 0.5 * h * b2
    y1, y2 = x1 + 0.5 * h * w1, x2 + 0.5 * h * w2
    s = y1 - y2 + drag * (u1 - u2)
    a3, b3 = first * force1 - s, (f2 * force1 + s - mu_k * (y2 + drag * u2)) * second
    z1, z2 = v1 + h * a3, v2 + h * b3
    y1, y2 = x1 + h * u1, x2 + h * u2
    s = y1 - y2 + drag * (z1 - z2)
    a4, b4 = first * force2 - s, (f2 * force2 + s - mu_k * (y2 + drag * z2)) * second
    sixth = h / 6
    return (
        x1 + sixth * (v1 + 2 * (w1 + u1) + z1),
        v1 + sixth * (a1 + 2 * (a2 + a3) + a4),
        x2 + sixth * (v2 + 2 * (w2 + u2) + z2),
        v2 + sixth * (b1 + 2 * (b2 + b3) + b4),
    )


@compiled
def rk4_orbit(p, start, steps, periods, linear, times, sides):
    """Impacts in so many periods, or until `times` is full if it has room; a new step begins at each impact."""
    omega, R, b, tau = p[4], p[5], p[6], p[7]
    T = 2 * math.pi / omega
    end, step = periods * T, T / steps
    x1, v1, x2, v2 = start[0], start[1], start[2], start[3]
    last, n, hits, force0 = 0.0, 0, 0, math.sin(tau)  # n steps since the last impact: the sum of many steps would drift
    while len(times) == 0 or hits < len(times):
        t = last + n * step
        h = min(step, end - t)
        if h <= 0.0:
            break
        force1, force2 = math.sin(omega * (t + 0.5 * h) + tau), math.sin(omega * (t + h) + tau)
        y1, w1, y2, w2 = rk4_step(x1, v1, x2, v2, h, force0, force1, force2, p)
        if abs(y1) <= b:
            n += 1
            x1, v1, x2, v2, force0 = y1, w1, y2, w2, force2
            continue
        side = 1.0 if y1 > 0 else -1.0
        if linear:
            part = min(max((side * b - x1) / (y1 - x1), 0.0), 1.0)
            u, y2, w1, w2 = part * h, x2 + part * (y2 - x2), v1 + part * (w1 - v1), v2 + part * (w2 - v2)
        else:
            low, high = 0.0, h
            for _ in range(52):
                u = 0.5 * (low + high)
                if not low < u < high:
                    break
                force1, force2 = math.sin(omega * (t + 0.5 * u) + tau), math.sin(omega * (t + u) + tau)
                y1, w1, y2, w2 = rk4_step(x1, v1, x2, v2, u, force0, force1, force2, p)
                if abs(y1) <= b:
                    low = u
                else:
                    high = u
        last, n = t + u, 0
        force0 = math.sin(omega * last + tau)
        x1, v1, x2, v2 = side * b, -R * w1, y2, w2
        if len(times) > 0:
            times[hits], sides[hits] = last, side
        hits += 1
    return hits


def rk4(params, states, steps=1000, linear=False) -> Solver:
    """Steps of T/steps, and bisection of the step that ends behind a stop."""
    p = np.array([params[name] for name in NAMES])
    return _solver(lambda periods, times, sides: rk4_orbit(p, states[0], steps, periods, linear, times, sides))


def rk4_linear(params, states, steps=1000) -> Solver:
    """Linear interpolation in that step."""
    return rk4(params, states, steps, linear=True)


# Closed form


class Closed(NamedTuple):
    """An oscillator: numbers of its modes, its steady motion, its stops."""

    psi: np.ndarray
    eta: tuple[float, float]
    fast: tuple[float, float]  # omega_dj
    d: tuple[float, float]  # steady x_i = d_i sin + e_i cos
    e: tuple[float, float]
    omega: float
    mu_m: float
    b: float
    R: float
    tau: float


@compiled
def position(u, phase, m, a):
    """x1 after a free flight of u in closed form (eq. 6); a: amplitudes of this flight, for each mode two."""
    x = m.d[0] * math.sin(phase + m.omega * u) + m.e[0] * math.cos(phase + m.omega * u)
    for j in range(2):
        angle = m.fast[j] * u
        x += math.exp(-m.eta[j] * u) * (a[2 * j] * math.cos(angle) + a[2 * j + 1] * math.sin(angle))
    return x


@compiled
def take_off(state, phase, m, a):
    """Amplitudes of the flight that starts here: the share of each mode in x1."""
    sin, cos = math.sin(phase), math.cos(phase)
    for j in range(2):
        x, v = 0.0, 0.0
        for i in range(2):
            weight = m.psi[i, j] * (1.0 if i == 0 else m.mu_m)
            x += weight * (state[2 * i] - (m.d[i] * sin + m.e[i] * cos))
            v += weight * (state[2 * i + 1] - m.omega * (m.d[i] * cos - m.e[i] * sin))
        a[2 * j], a[2 * j + 1] = m.psi[0, j] * x, m.psi[0, j] * (v + m.eta[j] * x) / m.fast[j]


@compiled
def land(state, u, phase, m, a):
    """The state after a flight of u."""
    sin, cos = math.sin(phase + m.omega * u), math.cos(phase + m.omega * u)
    for i in range(2):
        state[2 * i] = m.d[i] * sin + m.e[i] * cos
        state[2 * i + 1] = m.omega * (m.d[i] * cos - m.e[i] * sin)
    for j in range(2):
        decay, angle = math.exp(-m.eta[j] * u), m.fast[j] * u
        c, s = decay * math.cos(angle), decay * math.sin(angle)
        x = a[2 * j] * c + a[2 * j + 1] * s
        v = m.fast[j] * (a[2 * j + 1] * c - a[2 * j] * s) - m.eta[j] * x
        for i in range(2):
            state[2 * i] += m.psi[i, j] / m.psi[0, j] * x
            state[2 * i + 1] += m.psi[i, j] / m.psi[0, j] * v


@compiled
def scan_orbit(m, steady, turn, start, periods, times, sides):
    """Impacts in so many periods, as `rk4_orbit`.

    A mode is the real part of a complex amplitude, which turns by one factor from node to node and needs no sine.
    steady: (nodes,) of x1; turn: (2,) factors.
    """
    nodes, T = len(steady), 2 * math.pi / m.omega
    width, state, a = T / nodes, start.copy(), np.empty(4)
    period, node, offset, hits = 0, 0, 0.0, 0  # the flight starts at an offset from the node behind
    while len(times) == 0 or hits < len(times):
        phase = m.tau + m.omega * (node * width + offset)
        take_off(state, phase, m, a)
        low, high = 0.0, width - offset
        z0 = (a[0] - 1j * a[1]) * np.exp(complex(-m.eta[0] * high, m.fast[0] * high))
        z1 = (a[2] - 1j * a[3]) * np.exp(complex(-m.eta[1] * high, m.fast[1] * high))
        k, now = node + 1, period
        while True:
            if k == nodes:
                k, now = 0, now + 1
                if now == periods:
                    return hits
            x = steady[k] + (z0.real + z1.real)
            if abs(x) > m.b:
                break
            low, high, k = high, high + width, k + 1
            z0 *= turn[0]
            z1 *= turn[1]
        side = 1.0 if x > 0.0 else -1.0
        for _ in range(60):
            u = 0.5 * (low + high)
            if not low < u < high:
                break
            if side * position(u, phase, m, a) > m.b:
                high = u
            else:
                low = u
        land(state, low, phase, m, a)
        state[0], state[1] = side * m.b, -m.R * state[1]
        total = node * width + offset + low
        if len(times) > 0:
            times[hits], sides[hits] = period * T + total, side
        hits += 1
        period += int(total / T)
        total -= int(total / T) * T
        node = min(int(total / width), nodes - 1)
        offset = total - node * width
    return hits


def scan(params, states, nodes=64) -> Solver:
    """A look at `nodes` points of each forcing period, and bisection where x1 has passed a stop."""
    s = System(**params)
    psi, omega_squared = s.modes
    fast = np.sqrt(omega_squared - s.eta**2)
    d, e = steady_response(s.mu_m, s.mu_k, s.zeta, s.f2, s.omega)
    phases = s.phase + 2 * np.pi * np.arange(nodes) / nodes
    steady = d[0] * np.sin(phases) + e[0] * np.cos(phases)
    turn = np.exp((-s.eta + 1j * fast) * s.period / nodes)
    m = Closed(psi, *(tuple(pair.tolist()) for pair in (s.eta, fast, d, e)), s.omega, s.mu_m, s.b, s.R, s.phase)
    return _solver(lambda periods, times, sides: scan_orbit(m, steady, turn, states[0], periods, times, sides))


def _solver(run) -> Solver:
    def impacts(count):
        times, sides = np.empty(count), np.empty(count)
        found = run(MOST_PERIODS, times, sides)
        return times[:found], sides[:found]

    nothing = np.empty(0)
    return Solver(impacts, lambda periods: lambda: run(periods, nothing, nothing))
