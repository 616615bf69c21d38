"""heyoka with compliant stops: events at touch and release switch the force of a stop on and off.

The gap is x1 of a `Linear` whose matrix of masses is diagonal; its first mass is 1. Each event calls back into Python,
as heyoka's interface has it, and turns a runtime parameter; `events=False` shows what is left without. Tangent vectors
obey the variational equations, and jump where the force does. `fast_math` is on.
"""

import heyoka as hy
import numpy as np
from peers import Solver

LANES = 8
MOST_PERIODS = 2000
RENEWAL = 5  # forcing periods between orthonormalisations of the tangent vectors
LEAVING = 1e-6  # speed towards a stop that relaxes, below which it is not touched


class Problem:
    """Equations and events. Variables x1 v1 .., and s of each stop that relaxes; parameters: 1 while pressed."""

    def __init__(self, q):
        self.q, self.N = q, len(q.normal)
        walls = ((1, q.high, q.k_high, q.c_high, q.p_high), (-1, q.low, q.k_low, q.c_low, q.p_low))
        self.stops = [stop for stop in walls if np.isfinite(stop[1])]
        self.relaxes = bool(q.by_force and q.c_high > 0)
        names = [f"{kind}{i}" for i in range(self.N) for kind in "xv"]
        names += [f"s{n}" for n in range(len(self.stops))] if self.relaxes else []
        self.z = hy.make_vars(*names)

    def depth(self, n):
        side, wall, *_ = self.stops[n]
        return side * (self.z[0] - wall)

    def force(self, n):
        side, _, k, c, p = self.stops[n]
        return k * self.depth(n) + c * side * self.z[1] + p

    def equations(self):
        q, z, rows = self.q, self.z, []
        phase = q.omega * hy.time + q.tau
        for i in range(self.N):
            terms = [-q.K[i, j] * z[2 * j] for j in range(self.N) if q.K[i, j]]
            terms += [-q.C[i, j] * z[2 * j + 1] for j in range(self.N) if q.C[i, j]]
            terms += [q.sine[i] * hy.sin(phase)] if q.sine[i] else []
            if i == 0:
                terms += [-stop[0] * hy.par[n] * self.force(n) for n, stop in enumerate(self.stops)]
            rows += [(z[2 * i], z[2 * i + 1]), (z[2 * i + 1], hy.sum(terms) / q.M[i, i])]
        for n, (_, _, k, c, _) in enumerate(self.stops if self.relaxes else ()):
            rows.append((z[2 * self.N + n], (hy.par[n] - 1.0) * (k / c) * z[2 * self.N + n]))
        return rows

    def events(self, kind, happen):
        """happen(n, pressed, lane): stop n is touched, or left."""
        found = []
        for n in range(len(self.stops)):

            def either(ta, sign, lane=0, n=n):
                return happen(n, sign > 0, lane)

            def touch(ta, sign, lane=0, n=n):
                return happen(n, True, lane)

            def leave(ta, sign, lane=0, n=n):
                return happen(n, False, lane)

            if self.relaxes:
                gone, rising, falling = self.z[2 * self.N + n], hy.event_direction.positive, hy.event_direction.negative
                free = 1.0 - hy.par[n]  # each event only where it may happen
                found.append(kind(free * (self.depth(n) - gone) - hy.par[n], callback=touch, direction=rising))
                found.append(kind(hy.par[n] * self.force(n) + free, callback=leave, direction=falling))
            else:
                found.append(kind(self.depth(n), callback=either))
        return found


def solver(q, states, tol, lanes=LANES, events=True, exponents=False) -> Solver:
    """Orbits from `states` (8, 2 N), one of them alone if lanes is 1."""
    problem, touched = Problem(q), []
    system, size, T = problem.equations(), 2 * problem.N, 2 * np.pi / q.omega
    variables = len(system)
    if exponents:
        system = hy.var_ode_sys(system, hy.var_args.vars, order=1)
    total = variables + variables**2 * exponents
    shape = (total, lanes) if lanes > 1 else total

    def happen(n, pressed, lane):
        here = (lane,) if lanes > 1 else ()
        if bool(pars[(n, *here)]) == pressed:
            return True
        side, wall, k, c, p = problem.stops[n]
        v = side * state[(1, *here)]
        if problem.relaxes and pressed and v + k / c * state[(variables - len(problem.stops) + n, *here)] < LEAVING:
            return True  # the distance from a stop that was just left begins with a double zero
        if problem.relaxes:
            state[(variables - len(problem.stops) + n, *here)] = 0.0 if pressed else side * (state[(0, *here)] - wall)
        elif exponents and (c or p):  # the acceleration of the gap jumps by the force
            change = (c * v + p) / v
            for j in range(variables):
                first, second = (variables + j, *here), (2 * variables + j, *here)
                state[second] += (-change if pressed else change) * state[first]
        pars[(n, *here)] = pressed
        if lane == 0 and pressed:
            touched.append(ta.time[0] if lanes > 1 else ta.time)
        return True

    how = dict(tol=tol, fast_math=True)
    if events:
        how["t_events"] = problem.events(hy.t_event_batch if lanes > 1 else hy.t_event, happen)
    ta = (hy.taylor_adaptive_batch if lanes > 1 else hy.taylor_adaptive)(system, np.zeros(shape), **how)
    state, pars = ta.state, ta.pars

    def restart():
        if lanes > 1:
            ta.set_time(np.zeros(lanes))
        else:
            ta.time = 0.0
        state[:], pars[:] = 0.0, 0.0
        state[:size] = states.T if lanes > 1 else states[0]
        if exponents:
            unit = np.eye(variables).ravel()
            state[variables:] = unit[:, None] if lanes > 1 else unit
        if events:
            ta.reset_cooldowns()
        touched.clear()

    def impacts(count):
        """Times of the first touches of the first orbit."""
        restart()
        for period in range(1, MOST_PERIODS):
            ta.propagate_until(period * T)
            if len(touched) >= count:
                break
        return np.array(touched[:count]), None

    def renew():
        columns = state[variables:].reshape(variables, variables, -1).transpose(2, 0, 1)
        state[variables:] = np.linalg.qr(columns)[0].transpose(1, 2, 0).reshape(state[variables:].shape)

    def job(periods):
        def run():
            restart()
            for done in range(0, periods, RENEWAL if exponents else periods):
                ta.propagate_until(min(done + RENEWAL, periods) * T if exponents else periods * T)
                if exponents:
                    renew()
            return len(touched) * lanes

        return run

    return Solver(impacts, job, lanes)
