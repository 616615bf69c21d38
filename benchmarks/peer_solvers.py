"""General solvers with event location, restarted after each impact: SciPy's DOP853 and SUNDIALS' CVODE.

Right-hand side and events are compiled by numba; the solvers call them through Python, as their interfaces have it.
"""

from functools import cache

import numpy as np
from numba import njit
from peers import Solver

MOST_PERIODS = 5000
NUMBERS = ("mu_m", "mu_k", "zeta", "f2", "omega", "tau")
ROOT = 2  # CVODE's status when it stops at a root


@cache
def acceleration(mu_m, mu_k, zeta, f2, omega, tau):
    """f(t, y, yp) of eqs. (3), compiled, with the numbers of the oscillator as constants."""

    @njit
    def rates(t, y, yp):
        force = np.sin(omega * t + tau)
        stretch = y[0] - y[2] + 2 * zeta * (y[1] - y[3])
        yp[0], yp[2] = y[1], y[3]
        yp[1] = (1 - f2) * force - stretch
        yp[3] = (f2 * force + stretch - mu_k * (y[2] + 2 * zeta * y[3])) / mu_m

    return rates


def dop853(params, states, tol=1e-12, longest=np.inf) -> Solver:
    """longest: of all steps, in forcing periods; left to itself it passes brief contacts."""
    from scipy.integrate import solve_ivp

    rates, b, T = acceleration(*(params[name] for name in NUMBERS)), params["b"], 2 * np.pi / params["omega"]

    @njit
    def right_hand_side(t, y):
        yp = np.empty(4)
        rates(t, y, yp)
        return yp

    def right(_, y):
        return y[0] - b

    def left(_, y):
        return y[0] + b

    right.terminal = left.terminal = True
    right.direction, left.direction = 1, -1

    def flight(t, y, end):
        """To the next contact, or to `end`."""
        flown = solve_ivp(
            right_hand_side, (t, end), y, "DOP853", rtol=max(tol, 3e-14), atol=tol, events=(right, left),
            max_step=longest * T,
        )  # fmt: skip
        side = 1 if len(flown.t_events[0]) else -1 if len(flown.t_events[1]) else 0
        return flown.t[-1], flown.y[:, -1], side

    return _restarted(flight, params, states)


def adams(params, states, tol=1e-12, longest=0.0) -> Solver:
    return cvode(params, states, tol, "Adams", longest)


def bdf(params, states, tol=1e-12) -> Solver:
    return cvode(params, states, tol, "BDF")


def cvode(params, states, tol, family, longest=0.0) -> Solver:
    from sksundae.cvode import CVODE

    rates, b, T = acceleration(*(params[name] for name in NUMBERS)), params["b"], 2 * np.pi / params["omega"]

    def events(_, y, gaps):
        gaps[0], gaps[1] = y[0] - b, y[0] + b

    events.terminal, events.direction = [True, True], [1, -1]
    solver = CVODE(
        rates, method=family, rtol=tol, atol=tol, eventsfn=events, num_events=2, max_step=longest * T,
        max_num_steps=100_000,
    )  # fmt: skip

    def flight(t, y, end):
        solver.init_step(t, y)
        flown = solver.step(end, tstop=end)
        side = 0 if flown.status != ROOT else 1 if flown.i_events[-1][0] else -1
        return float(flown.t), np.array(flown.y), side

    return _restarted(flight, params, states)


def _restarted(flight, params, states) -> Solver:
    b, R, T = params["b"], params["R"], 2 * np.pi / params["omega"]

    def follow(periods, count):
        t, y, end, times, sides = 0.0, states[0].copy(), periods * T, [], []
        while t < end and len(times) < count:
            t, y, side = flight(t, y, end)
            if side:
                times.append(t)
                sides.append(side)
                y[0], y[1] = side * b, -R * y[1]
        return np.array(times), np.array(sides)

    return Solver(lambda count: follow(MOST_PERIODS, count), lambda periods: lambda: len(follow(periods, np.inf)[0]))
