"""The other programs, behind one small interface: heyoka for any of the machines, SciPy's DOP853, and Runge-Kutta.

Each is in its best mode: heyoka with `fast_math`, one orbit or eight in the vector unit; right-hand sides of the others
compiled by numba. heyoka's events call back into Python, as its interface has it; without events it flies through the
stops, which shows what is left.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numba import njit

MOST_PERIODS = 5000
RENEWAL = 5  # forcing periods between orthonormalisations of tangent vectors
LEAVING = 1e-6  # speed towards a stop that relaxes, below which it is not touched


class Solver(NamedTuple):
    """A machine, and orbits from certain states at t = 0.

    fly : (state, end, count) -> (times, sides, state): the impacts or touches of one orbit until a time, or until so
        many, and its last state
    job : carries all orbits over so many forcing periods
    """

    fly: Callable[[np.ndarray, float, float], tuple]
    job: Callable[[int], object]
    orbits: int = 1


# --- heyoka


class Equations:
    """Variables x1 v1 x2 v2 .. and s of each stop that relaxes; parameters: 1 while a stop is pressed.

    The gap is x1, and the matrix of masses is diagonal.
    """

    def __init__(self, q):
        import heyoka as hy

        self.hy, self.q, self.N = hy, q, q.masses
        walls = (
            (1, q.contact.high, q.contact.k_high, q.contact.c_high, q.contact.p_high),
            (-1, q.contact.low, q.contact.k_low, q.contact.c_low, q.contact.p_low),
        )
        self.stops = [stop for stop in walls if math.isfinite(stop[1])]
        self.rigid = not any(stop[2] for stop in self.stops)
        self.relaxes = bool(q.contact.by_force and q.contact.c_high > 0)
        names = [f"{kind}{i}" for i in range(self.N) for kind in "xv"]
        names += [f"s{n}" for n in range(len(self.stops))] if self.relaxes else []
        self.z = hy.make_vars(*names)

    def depth(self, n):
        side, wall, *_ = self.stops[n]
        return side * (self.z[0] - wall)

    def force(self, n):
        side, _, k, c, p = self.stops[n]
        return k * self.depth(n) + c * side * self.z[1] + p

    def rates(self) -> list:
        """[(variable, derivative), ...]"""
        hy, q, z, rows = self.hy, self.q, self.z, []
        phase = q.omega * hy.time + q.tau
        for i in range(self.N):
            terms = [-q.K[i, j] * z[2 * j] for j in range(self.N) if q.K[i, j]]
            terms += [-q.C[i, j] * z[2 * j + 1] for j in range(self.N) if q.C[i, j]]
            terms += [q.sine[i] * hy.sin(phase)] if q.sine[i] else []
            terms += [q.cosine[i] * hy.cos(phase)] if q.cosine[i] else []
            if i == 0 and not self.rigid:
                terms += [-stop[0] * hy.par[n] * self.force(n) for n, stop in enumerate(self.stops)]
            rows += [(z[2 * i], z[2 * i + 1]), (z[2 * i + 1], hy.sum(terms) / q.M[i, i])]
        for n, (_, _, k, c, _) in enumerate(self.stops if self.relaxes else ()):
            rows.append((z[2 * self.N + n], (hy.par[n] - 1.0) * (k / c) * z[2 * self.N + n]))
        return rows

    def events(self, kind, strike, change) -> list:
        """strike(lane) at an impact; change(n, pressed, lane) where compliant stop n is touched, or left."""
        rising, falling, found = self.hy.event_direction.positive, self.hy.event_direction.negative, []
        for n in range(len(self.stops)):

            def touch(ta, sign, lane=0, n=n):
                return change(n, True, lane)

            def leave(ta, sign, lane=0, n=n):
                return change(n, False, lane)

            def either(ta, sign, lane=0, n=n):
                return change(n, sign > 0, lane)

            if self.rigid:
                found.append(kind(self.depth(n), callback=strike, direction=rising))
            elif self.relaxes:
                gone, free = self.z[2 * self.N + n], 1.0 - self.hy.par[n]  # each event only where it may happen
                found.append(kind(free * (self.depth(n) - gone) - self.hy.par[n], callback=touch, direction=rising))
                found.append(kind(self.hy.par[n] * self.force(n) + free, callback=leave, direction=falling))
            else:
                found.append(kind(self.depth(n), callback=either))
        return found


def heyoka(system, states, tol=1e-16, lanes=8, events=True, exponents=False) -> Solver:
    """Orbits from `states` (8, 2 N), one of them alone if lanes is 1; with tangent vectors if `exponents`."""
    q, touched = system.linear, []
    equations = Equations(q)
    hy, T, size = equations.hy, 2 * np.pi / q.omega, 2 * q.masses
    rates, R = equations.rates(), q.contact.R_high
    variables = len(rates)
    if exponents:
        rates = hy.var_ode_sys(rates, hy.var_args.vars, order=1)
    total = variables + variables**2 * exponents
    acceleration = np.concatenate([-np.stack([q.K[0], q.C[0]], -1).reshape(-1), [q.sine[0]]]) / q.M[0, 0]
    saltation = acceleration, q.C[:, 0] / np.diag(q.M), q.omega, q.tau or 0.0, R

    def strike(ta, _, lane=0):
        column = columns[lane]
        if lane == 0:
            touched.append((now(0), 1 if column[0] > 0 else -1))
        if exponents:
            saltate(column, now(lane), size, *saltation)
        else:
            column[1] *= -R
        return True

    def change(n, pressed, lane):
        column, flags = columns[lane], pressings[lane]
        if bool(flags[n]) == pressed:
            return True
        side, wall, k, c, p = equations.stops[n]
        v, gone = side * column[1], variables - len(equations.stops) + n
        if equations.relaxes and pressed and v + k / c * column[gone] < LEAVING:
            return True  # the distance from a stop that was just left begins with a double zero
        if equations.relaxes:
            column[gone] = 0.0 if pressed else side * (column[0] - wall)
        elif exponents and (c or p):  # the acceleration of the gap jumps by the force
            jump = (-1 if pressed else 1) * (c * v + p) / v / q.M[0, 0]
            column[2 * variables : 3 * variables] += jump * column[variables : 2 * variables]
        flags[n] = pressed
        if lane == 0 and pressed:
            touched.append((now(0), side))
        return True

    how = dict(tol=tol, fast_math=True)
    if events:
        how["t_events"] = equations.events(hy.t_event_batch if lanes > 1 else hy.t_event, strike, change)
    make = hy.taylor_adaptive_batch if lanes > 1 else hy.taylor_adaptive
    ta = make(rates, np.zeros((total, lanes) if lanes > 1 else total), **how)
    state, flags = ta.state.reshape(total, -1), ta.pars.reshape(-1, lanes)
    columns, pressings = [state[:, i] for i in range(lanes)], [flags[:, i] for i in range(lanes)]
    now = (lambda lane: ta.time[lane]) if lanes > 1 else (lambda lane: ta.time)

    def restart(begin):
        if lanes > 1:
            ta.set_time(np.zeros(lanes))
        else:
            ta.time = 0.0
        state[:], flags[:] = 0.0, 0.0
        state[:size] = begin[:lanes].T
        if exponents:
            state[variables:] = np.eye(variables).reshape(-1, 1)
        if events:
            ta.reset_cooldowns()
        touched.clear()

    def fly(begin, end=math.inf, count=math.inf):
        restart(np.resize(begin, (lanes, size)))
        for period in range(1, MOST_PERIODS):
            ta.propagate_until(min(period * T, end))
            if len(touched) >= count or period * T >= end:
                break
        found = touched[: min(len(touched), count)]
        return [t for t, _ in found], [side for _, side in found], columns[0][:size].copy()

    def job(periods):
        restart(states)
        if not exponents:
            ta.propagate_until(periods * T)
            return
        for done in range(0, periods, RENEWAL):
            ta.propagate_until(min(done + RENEWAL, periods) * T)
            vectors = state[variables:].reshape(variables, variables, -1).transpose(2, 0, 1)
            state[variables:] = np.linalg.qr(vectors)[0].transpose(1, 2, 0).reshape(-1, lanes)

    return Solver(fly, job, lanes)


@njit
def saltate(state, t, n, acceleration, drag, omega, tau, R):
    """S = DG + (F+ - DG F-) n^T/(n . F-) on the columns of the matrix behind the state, and v1 -> -R v1."""
    before = state[1]
    state[1] = -R * before
    after = acceleration[n] * np.sin(omega * t + tau)
    for k in range(n):
        after += acceleration[k] * state[k]
    steepness = (1 + R) * (after / before + acceleration[1] * R)
    for j in range(n):
        dx = state[n + j]
        state[n + j] = -R * dx
        state[2 * n + j] = steepness * dx - R * state[2 * n + j]
        for i in range(1, n // 2):
            state[n + n * (2 * i + 1) + j] += drag[i] * (1 + R) * dx


# --- the paper's oscillator in the way that people write it


@njit(fastmath={"contract"}, error_model="numpy")
def rates_of(y, force, p):
    """Derivative of (x1, v1, x2, v2); p: mu_m, mu_k, zeta, f2, omega, tau."""
    stretch = y[0] - y[2] + 2 * p[2] * (y[1] - y[3])
    below = p[1] * (y[2] + 2 * p[2] * y[3])
    return y[1], (1 - p[3]) * force - stretch, y[3], (p[3] * force + stretch - below) / p[0]


@njit(fastmath={"contract"}, error_model="numpy")
def moved(y, h, rate):
    return y[0] + h * rate[0], y[1] + h * rate[1], y[2] + h * rate[2], y[3] + h * rate[3]


@njit(fastmath={"contract"}, error_model="numpy")
def rk4_step(y, t, h, begin, p):
    """A step, and the force at its end; begin: the force at its beginning."""
    middle, end = math.sin(p[4] * (t + 0.5 * h) + p[5]), math.sin(p[4] * (t + h) + p[5])
    k1 = rates_of(y, begin, p)
    k2 = rates_of(moved(y, 0.5 * h, k1), middle, p)
    k3 = rates_of(moved(y, 0.5 * h, k2), middle, p)
    k4 = rates_of(moved(y, h, k3), end, p)
    y = moved(moved(y, h / 6, k1), h / 3, k2)
    return moved(moved(y, h / 3, k3), h / 6, k4), end


@njit(fastmath={"contract"}, error_model="numpy")
def rk4_orbit(y, end, most, step, b, R, p, times, sides):
    """Impacts until a time, or until so many; a new step begins at each. `times` has room for some, or for none."""
    last, n, hits, force = 0.0, 0, 0, math.sin(p[5])  # n steps since the last impact: the sum of steps would drift
    while hits < most:
        t = last + n * step
        h = min(step, end - t)
        if h <= 0.0:
            break
        z, after = rk4_step(y, t, h, force, p)
        if abs(z[0]) <= b:
            n, y, force = n + 1, z, after
            continue
        side, low, high, u = 1.0 if z[0] > 0 else -1.0, 0.0, h, h
        for _ in range(52):
            u = 0.5 * (low + high)
            if not low < u < high:
                break
            z, after = rk4_step(y, t, u, force, p)
            if abs(z[0]) <= b:
                low = u
            else:
                high = u
        last, n, force, y = t + u, 0, after, (side * b, -R * z[1], z[2], z[3])
        if hits < len(times):
            times[hits], sides[hits] = last, side
        hits += 1
    return hits, y


def rk4(system, states, steps=1000) -> Solver:
    """So many steps a forcing period; the step that ends behind a stop is bisected."""
    T = system.period
    p = tuple(float(getattr(system, name)) for name in ("mu_m", "mu_k", "zeta", "f2", "omega", "tau"))
    nothing = np.empty(0)

    def run(begin, end, most, times, sides):
        return rk4_orbit(tuple(map(float, begin)), end, most, T / steps, system.b, system.R, p, times, sides)

    def fly(begin, end=math.inf, count=math.inf):
        times, sides = np.empty(min(count, 1000)), np.empty(min(count, 1000))
        hits, y = run(begin, min(end, MOST_PERIODS * T), float(count), times, sides)
        return times[:hits], sides[:hits], np.array(y)

    return Solver(fly, lambda periods: run(states[0], periods * T, math.inf, nothing, nothing))


def dop853(system, states, tol=1e-12, longest=np.inf) -> Solver:
    """Restarted at each impact. longest: of all steps, in forcing periods; left to itself it passes brief contacts."""
    from scipy.integrate import solve_ivp

    b, T = system.b, system.period
    p = tuple(float(getattr(system, name)) for name in ("mu_m", "mu_k", "zeta", "f2", "omega", "tau"))

    @njit
    def right_hand_side(t, y):
        return np.array(rates_of((y[0], y[1], y[2], y[3]), math.sin(p[4] * t + p[5]), p))

    def right(_, y):
        return y[0] - b

    def left(_, y):
        return y[0] + b

    right.terminal = left.terminal = True
    right.direction, left.direction = 1, -1
    how = dict(method="DOP853", rtol=max(tol, 3e-14), atol=tol, events=(right, left), max_step=longest * T)

    def fly(begin, end=math.inf, count=math.inf):
        t, y, times, sides = 0.0, np.array(begin, float), [], []
        end = min(end, MOST_PERIODS * T)
        while t < end and len(times) < count:
            flown = solve_ivp(right_hand_side, (t, end), y, **how)
            t, y = flown.t[-1], flown.y[:, -1]
            if flown.status == 1:
                times.append(t)
                sides.append(1 if len(flown.t_events[0]) else -1)
                y[0], y[1] = sides[-1] * b, -system.R * y[1]
        return times, sides, y

    return Solver(fly, lambda periods: fly(states[0], periods * T))
