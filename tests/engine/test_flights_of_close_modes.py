"""Tables of flights of systems whose two modes have nearly the same frequency, against 50-digit exponentials."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.gmp import expm

import vibro_sweep as vs
from vibro_sweep.engine.one_system import Engine

EPS = 2.0**-52
# (mu_m, mu_k): equal large ratios, nearly equal ones, and a second mass that hardly moves the first
PAIRS = [(100.0, 100.0), (1e4, 1e4), (1e6, 1e6 - 0.5), (1e8, 1.0001e8), (1e10, 1e10), (1e10, 1e10 - 1.0)]
# without damping, weak, next to critical (omega_j is near 1), just above it, strong
DAMPING = [0.0, 0.05, 1.0 - 1e-9, 1.02, 3.0]


def exponential(system, u):
    """exp(A u) of (x1, v1, x2, v2) in 50 digits; rows: after the flight."""
    mu_m, mu_k, zeta = mpf(system.mu_m), mpf(system.mu_k), mpf(system.zeta)
    stiffness = mp.matrix([[1, -1], [-1 / mu_m, (1 + mu_k) / mu_m]])
    A = mp.zeros(4)
    A[0, 1] = A[2, 3] = 1
    for i in range(2):
        for j in range(2):
            A[2 * i + 1, 2 * j], A[2 * i + 1, 2 * j + 1] = -stiffness[i, j], -2 * zeta * stiffness[i, j]
    return expm(A * mpf(u))


@pytest.mark.parametrize("mu_m, mu_k", PAIRS)
def test_flights_keep_their_digits(mu_m, mu_k):
    with mp.workdps(50):
        for zeta in DAMPING:
            system = vs.System(mu_m=mu_m, mu_k=mu_k, zeta=zeta, f2=0.0, omega=0.63, R=0.8, b=1.0, tau=0.0)
            engine = Engine(system)
            nodes = engine.ensemble.flights.nodes[0]
            largest = np.abs(nodes["E"]).max(0)
            for k in (1, engine.cells // 3, engine.cells):
                exact = exponential(system, mpf(engine.width) * k)
                for start in range(4):
                    for end in range(4):
                        error = abs(float(mpf(nodes["E"][k, start, end]) - exact[end, start]))
                        assert error <= 64 * EPS * largest[start, end], (zeta, k, start, end)
