"""Chains of any number of masses of which the first hits stops, by matrix exponentials.

M = diag(masses), K of the springs, C = 2 zeta K, force sin(omega t) on the first mass.
"""

import math

import numpy as np
from scipy.linalg import eigh, expm


class Chain:
    """springs: one behind each mass; the last joins it to the ground."""

    def __init__(self, masses, springs, zeta, omega):
        n = len(masses)
        self.masses, self.count, self.zeta, self.omega = np.array(masses, float), n, zeta, omega
        K = np.zeros((n, n))
        for i, k in enumerate(springs):
            K[i, i] += k
            if i + 1 < n:
                K[i + 1, i + 1] += k
                K[i, i + 1] -= k
                K[i + 1, i] -= k
        self.K, self.C = K, 2 * zeta * K
        self.squares, self.psi = eigh(K, np.diag(self.masses))
        A = np.zeros((2 * n + 2, 2 * n + 2))
        for i in range(n):
            A[2 * i, 2 * i + 1] = 1.0
            A[2 * i + 1, 0 : 2 * n : 2] = -K[i] / masses[i]
            A[2 * i + 1, 1 : 2 * n : 2] = -self.C[i] / masses[i]
        A[1, 2 * n] = 1.0 / masses[0]
        A[2 * n, 2 * n + 1], A[2 * n + 1, 2 * n] = omega, -omega
        self.A, self.period = A, 2 * math.pi / omega

    def frame(self):
        """(x1, v1, ...) to (g_1 xi_1, xi_1' + eta_1 xi_1, ...) and back; square of omega_d of each mode."""
        n = self.count
        to = np.zeros((2 * n, 2 * n))
        eta = self.zeta * self.squares
        for j in range(n):
            g = math.sqrt(abs(self.squares[j] - eta[j] ** 2))
            weights = self.psi[:, j] * self.masses
            to[2 * j, 0::2], to[2 * j + 1, 0::2], to[2 * j + 1, 1::2] = g * weights, eta[j] * weights, weights
        return to, np.linalg.inv(to), eta

    def orbit(self, state, b, R, periods):
        """Impacts (t, side, v1) and the monodromy matrix, in (x1, v1, ...): steps of 1/2000 period, then bisection."""
        states, h = 2 * self.count, self.period / 2000
        z = np.array([*state, 0.0, 1.0])
        step, t, impacts, jacobian, last = expm(self.A * h), 0.0, [], np.eye(states), 0.0
        for k in range(2000 * periods):
            left = h
            while True:
                after = step @ z if left == h else expm(self.A * left) @ z
                if abs(after[0]) < b:
                    break
                low, high = 0.0, left
                while high - low > 1e-15 * h:
                    middle = (low + high) / 2
                    low, high = (middle, high) if abs((expm(self.A * middle) @ z)[0]) < b else (low, middle)
                z, left = expm(self.A * high) @ z, left - high
                t = (k + 1) * h - left
                side, before = math.copysign(1.0, z[0]), z.copy()
                z[0], z[1] = side * b, -R * z[1]
                impacts.append((t, side, before[1]))
                jacobian = self.saltation(before, z, R) @ expm(self.A * (t - last))[:states, :states] @ jacobian
                last = t
            z = after
        jacobian = expm(self.A * (periods * self.period - last))[:states, :states] @ jacobian
        return np.array(impacts), z[:states], jacobian

    def saltation(self, before, after, R):
        """S = DG + (F+ - DG F-) n^T/(n . F-)."""
        states = 2 * self.count
        G = np.eye(states)
        G[1, 1] = -R
        F = [(self.A @ z)[:states] for z in (before, after)]
        n = np.eye(states)[0]
        return G + np.outer(F[1] - G @ F[0], n) / (n @ F[0])
