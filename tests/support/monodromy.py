"""The Jacobian of a motion over some periods, by difference quotients of orbits in 30 digits."""

import numpy as np
from mpmath import mp, mpf
from reference.events import simulate
from reference.machine import machine_of

import vibro_sweep as vs


def monodromy(q, state, periods):
    """(2 N, 2 N) over so many periods."""
    columns = []
    with mp.workdps(30):
        step = mpf(10) ** -14
        for j in range(len(state)):
            ends = []
            for sign in (1, -1):
                start = [mpf(float(x)) + (sign * step if i == j else 0) for i, x in enumerate(state)]
                ends.append(simulate(machine_of(q), start, periods=periods).section[periods])
            columns.append([float((a - b) / (2 * step)) for a, b in zip(*ends, strict=True)])
    return np.array(columns).T


def exponents_of(system, state, periods):
    """Those of a record of so many periods, falling: from the Jacobian, in the metric of the tangent vectors."""
    jacobian = monodromy(system.linear, state, periods)
    point = vs.simulate(system, state, 0)._engine.point[0]
    frame = point["to_frame"] @ np.kron(point["P"], np.eye(2))
    lengths = np.abs(np.diag(np.linalg.qr(frame @ jacobian @ np.linalg.inv(frame))[1]))
    return np.sort(np.log(lengths) / (periods * system.period))[::-1]
