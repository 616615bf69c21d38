"""heyoka: Taylor series of high order, compiled for the problem, with event detection of its own.

Each impact calls back into Python, as heyoka's interface has it; `bare` shows what is left without. `fast_math` is on:
it is the faster mode, and its errors are no larger here. Two events, x1 - b and x1 + b, are faster than one in x1^2,
and the forcing as sin(omega t + tau) is as fast as two more states.
"""

import heyoka as hy
import numpy as np
from numba import njit
from peers import Solver

VARIABLES = ("x1", "v1", "x2", "v2")
LANES = 8
MOST_PERIODS = 5000
RENEWAL = 5  # forcing periods between orthonormalisations of the tangent vectors


def equations(p):
    """Eqs. (3): [(variable, derivative), ...]."""
    x1, v1, x2, v2 = hy.make_vars(*VARIABLES)
    force = hy.sin(p["omega"] * hy.time + p["tau"])
    drag, above = 2 * p["zeta"], 1 + p["mu_k"]
    first = -x1 - drag * v1 + x2 + drag * v2 + (1 - p["f2"]) * force
    second = (x1 + drag * v1 - above * x2 - drag * above * v2 + p["f2"] * force) / p["mu_m"]
    return [(x1, v1), (v1, first), (x2, v2), (v2, second)]


def stops(kind, p, strike):
    """Terminal events at both stops."""
    x1 = hy.make_vars("x1")
    rising, falling = hy.event_direction.positive, hy.event_direction.negative
    return [
        kind(x1 - p["b"], callback=strike, direction=rising),
        kind(x1 + p["b"], callback=strike, direction=falling),
    ]


def scalar(params, states, tol=1e-16) -> Solver:
    """One orbit at a time."""
    hits, R, T = [], params["R"], 2 * np.pi / params["omega"]

    def strike(ta, _):
        hits.append((ta.time, state[0]))
        state[1] *= -R
        return True

    ta = hy.taylor_adaptive(
        equations(params), [0.0] * 4, tol=tol, t_events=stops(hy.t_event, params, strike), fast_math=True
    )
    state = ta.state  # a view: the callback writes into the integrator

    def restart():
        ta.time, state[:] = 0.0, states[0]
        ta.reset_cooldowns()
        hits.clear()

    return _solver(ta, restart, hits, T)


def batch(params, states, tol=1e-16) -> Solver:
    """Eight orbits side by side in the vector unit."""
    hits, R, T = [], params["R"], 2 * np.pi / params["omega"]

    def strike(ta, _, lane):
        if lane == 0:
            hits.append((ta.time[0], state[0, 0]))
        state[1, lane] *= -R
        return True

    ta = hy.taylor_adaptive_batch(
        equations(params),
        np.zeros((4, LANES)),
        tol=tol,
        t_events=stops(hy.t_event_batch, params, strike),
        fast_math=True,
    )
    state = ta.state

    def restart():
        ta.set_time(np.zeros(LANES))
        state[:] = np.resize(states, (LANES, 4)).T
        ta.reset_cooldowns()
        hits.clear()

    return _solver(ta, restart, hits, T, LANES)


def bare(params, states, tol=1e-16) -> Solver:
    """No stops at all: what the Taylor series alone cost."""
    T = 2 * np.pi / params["omega"]
    ta = hy.taylor_adaptive_batch(equations(params), np.zeros((4, LANES)), tol=tol, fast_math=True)

    def restart():
        ta.set_time(np.zeros(LANES))
        ta.state[:] = np.resize(states, (LANES, 4)).T

    return _solver(ta, restart, [], T, LANES)


def variational(params, states, tol=1e-16) -> Solver:
    """One orbit with four tangent vectors, carried over each impact by the saltation matrix."""
    p, hits = params, []
    T, numbers = 2 * np.pi / p["omega"], tuple(p[name] for name in ("mu_m", "zeta", "f2", "omega", "tau", "R"))

    def strike(ta, _):
        hits.append((ta.time, state[0]))
        saltate(state, ta.time, numbers)
        return True

    system = hy.var_ode_sys(equations(p), hy.var_args.vars, order=1)
    ta = hy.taylor_adaptive(system, [0.0] * 4, tol=tol, t_events=stops(hy.t_event, p, strike), fast_math=True)
    state = ta.state

    def restart():
        ta.time, state[:4], state[4:] = 0.0, states[0], np.eye(4).ravel()
        ta.reset_cooldowns()
        hits.clear()

    return _solver(ta, restart, hits, T, growth=Growth(state[:, None], T))


def variational_batch(params, states, tol=1e-16) -> Solver:
    """Eight orbits with their tangent vectors side by side."""
    p, hits = params, []
    T, numbers = 2 * np.pi / p["omega"], tuple(p[name] for name in ("mu_m", "zeta", "f2", "omega", "tau", "R"))

    def strike(ta, _, lane):
        if lane == 0:
            hits.append((ta.time[0], state[0, 0]))
        saltate(lanes[lane], ta.time[lane], numbers)
        return True

    system = hy.var_ode_sys(equations(p), hy.var_args.vars, order=1)
    events = stops(hy.t_event_batch, p, strike)
    ta = hy.taylor_adaptive_batch(system, np.zeros((4, LANES)), tol=tol, t_events=events, fast_math=True)
    state = ta.state
    lanes = [state[:, lane] for lane in range(LANES)]

    def restart():
        ta.set_time(np.zeros(LANES))
        state[:4], state[4:] = np.resize(states, (LANES, 4)).T, np.eye(4).reshape(16, 1)
        ta.reset_cooldowns()
        hits.clear()

    return _solver(ta, restart, hits, T, LANES, Growth(state, T))


class Growth:
    """Orthonormalises the tangent vectors of all lanes now and then, and sums what they grew."""

    def __init__(self, state, T):
        self.state, self.T, self.logs, self.periods = state, T, 0.0, 0

    def renew(self, periods):
        vectors = self.state[4:].reshape(4, 4, -1).transpose(2, 0, 1)
        q, r = np.linalg.qr(vectors)
        self.state[4:] = q.transpose(1, 2, 0).reshape(16, -1)
        self.logs += np.log(np.abs(np.diagonal(r, axis1=1, axis2=2)))
        self.periods += periods

    def exponents(self):
        """(lanes, 4) since the beginning of the job, per unit time."""
        return self.logs / (self.periods * self.T)


@njit
def saltate(state, t, numbers):
    """S = DG + (F+ - DG F-) n^T/(n . F-) on the columns of the 4x4 matrix behind the state, and v1 -> -R v1."""
    mu_m, zeta, f2, omega, tau, R = numbers
    before = state[1]
    state[1] = -R * before
    push = (1 - f2) * np.sin(omega * t + tau)
    after = -state[0] - 2 * zeta * state[1] + state[2] + 2 * zeta * state[3] + push
    steepness = (1 + R) * (after / before - 2 * zeta * R)
    for j in range(4):
        dx = state[4 + j]
        state[4 + j] = -R * dx
        state[8 + j] = steepness * dx - R * state[8 + j]
        state[16 + j] -= 2 * zeta / mu_m * (1 + R) * dx


def _solver(ta, restart, hits, T, orbits=1, growth=None) -> Solver:
    def impacts(count):
        restart()
        n = 0
        while len(hits) < count and n < MOST_PERIODS:
            n += 1
            ta.propagate_until(n * T)
        times, positions = np.array(hits[:count]).reshape(-1, 2).T
        return times, np.sign(positions)

    def job(periods):
        def run():
            restart()
            if growth is None:
                ta.propagate_until(periods * T)
            else:
                growth.logs, growth.periods = 0.0, 0
                for n in range(0, periods, RENEWAL):
                    ta.propagate_until(min(n + RENEWAL, periods) * T)
                    growth.renew(min(RENEWAL, periods - n))
            return len(hits) * orbits

        run.growth = growth
        return run

    return Solver(impacts, job, orbits)
