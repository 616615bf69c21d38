"""heyoka for any number of masses whose gap is x1: eight orbits side by side, as in peer_heyoka.py for the paper's.

Each impact calls back into Python; the saltation of tangent vectors there is compiled. `fast_math` is on.
"""

import heyoka as hy
import numpy as np
from numba import njit
from peers import Solver

LANES = 8
RENEWAL = 5  # forcing periods between orthonormalisations of the tangent vectors


def variables(masses):
    return hy.make_vars(*(f"{kind}{i + 1}" for i in range(masses) for kind in "xv"))


def equations(q):
    """[(variable, derivative), ...] of a `Linear` whose mass matrix is 1; no constant force."""
    n = len(q.normal)
    z = variables(n)
    phase, rows = q.omega * hy.time + q.tau, []
    for i in range(n):
        force = [-q.K[i, j] * z[2 * j] for j in range(n) if q.K[i, j]]
        force += [-q.C[i, j] * z[2 * j + 1] for j in range(n) if q.C[i, j]]
        force += [q.sine[i] * hy.sin(phase)] if q.sine[i] else []
        rows += [(z[2 * i], z[2 * i + 1]), (z[2 * i + 1], hy.sum(force))]
    return rows


def solver(q, states, exponents: bool, tol: float) -> Solver:
    """Eight orbits from `states` (8, 2 N)."""
    n, hits = 2 * len(q.normal), []
    T = 2 * np.pi / q.omega
    acceleration = np.concatenate([-np.stack([q.K[0], q.C[0]], -1).reshape(-1), [q.sine[0]]])
    numbers = acceleration, np.array(-q.C[:, 0]), q.omega, q.tau, q.R_high

    def strike(ta, _, lane):
        hits.append((lane, ta.time[lane], state[1, lane]))
        if exponents:
            saltate(lanes[lane], ta.time[lane], n, *numbers)
        else:
            state[1, lane] *= -q.R_high
        return True

    system = hy.var_ode_sys(equations(q), hy.var_args.vars, order=1) if exponents else equations(q)
    x1 = variables(n // 2)[0]
    directions = ((x1 - q.high, hy.event_direction.positive), (x1 - q.low, hy.event_direction.negative))
    events = [hy.t_event_batch(gap, callback=strike, direction=way) for gap, way in directions]
    size = n + n * n if exponents else n
    ta = hy.taylor_adaptive_batch(system, np.zeros((size, LANES)), tol=tol, t_events=events, fast_math=True)
    state = ta.state
    lanes = [state[:, lane] for lane in range(LANES)]

    def restart():
        ta.set_time(np.zeros(LANES))
        state[:n] = states.T
        if exponents:
            state[n:] = np.eye(n).reshape(-1, 1)
        ta.reset_cooldowns()
        hits.clear()

    def impacts(count):
        """Times and speeds of the first impacts of the first orbit."""
        restart()
        for period in range(1, 1000):
            ta.propagate_until(period * T)
            first = [hit[1:] for hit in hits if hit[0] == 0]
            if len(first) >= count:
                break
        return np.array(first[:count]).reshape(-1, 2).T

    def job(periods):
        def run():
            restart()
            if not exponents:
                ta.propagate_until(periods * T)
            else:
                for done in range(0, periods, RENEWAL):
                    ta.propagate_until(min(done + RENEWAL, periods) * T)
                    vectors = state[n:].reshape(n, n, LANES).transpose(2, 0, 1)
                    state[n:] = np.linalg.qr(vectors)[0].transpose(1, 2, 0).reshape(n * n, LANES)
            return len(hits)

        return run

    return Solver(impacts, job, LANES)


@njit
def saltate(state, t, n, acceleration, kappa, omega, tau, R):
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
            state[n + n * (2 * i + 1) + j] -= kappa[i] * (1 + R) * dx
