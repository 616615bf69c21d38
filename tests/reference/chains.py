"""Chains of any number of masses of which the first hits stops, by matrix exponentials: tables for the kernels, orbits.

M = diag(masses), K of the springs, C = 2 zeta K, force sin(omega t) on the first mass.
"""

import math

import numpy as np
from scipy.linalg import eigh, expm

from vibro_sweep.engine.tables.flight import ORDER, WIDTH, Flight, new_flight


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

    def tables(self) -> Flight:
        """What `tables.build` makes for two masses."""
        n, states = self.count, 2 * self.count
        rate = max(self.omega, math.sqrt(self.squares.max()))
        cells = 8 * math.ceil(rate * self.period / WIDTH / 8)
        flights = new_flight(1, cells, n)
        f = Flight(flights.oscillator[0], flights.nodes[0], flights.scan[0])
        q = f.oscillator[0]
        q["cells"], q["width"] = cells, self.period / cells
        h = float(q["width"])
        q["step"], q["omega"], q["zeta"], q["rest_step"] = h, self.omega, self.zeta, h
        q["kappa"][1:] = -self.C[1:, 0] / self.masses[1:]
        q["force"] = self.A[1]
        power = self.A[0:states:2] * 0.0
        power[np.arange(n), 2 * np.arange(n)] = 1.0
        for m in range(ORDER):
            q["series"][:, :, m] = power
            power = power @ self.A / (m + 1)
        orders = np.arange(ORDER, dtype=float)
        q["reach"] = np.where(orders > 0, h**orders, 0.0)
        q["third"] = np.where(orders > 2, orders * (orders - 1) * (orders - 2) * h ** np.maximum(orders - 3, 0), 0.0)
        q["impulse_third"] = np.abs(q["series"][0, 1]) @ q["third"]
        falling = orders * (orders - 1) * (orders - 2) * (orders - 3) * h ** np.maximum(orders - 4, 0)
        for k in range(cells + 1):
            E = expm(self.A * (k * h))
            node = f.nodes[k]
            node["E"][:, : states + 2] = E.T
            node["E"][:, states:] = 0.0
            sin, cos = math.sin(self.omega * k * h), math.cos(self.omega * k * h)
            node["z"][:states] = E[:states, states + 1]  # from rest at phase 0: sin = 0, cos = 1
            node["z"][states : states + 2] = sin, cos
            for j, x in enumerate([*E[:, :states].T, [*node["z"][:states], sin, cos]]):
                f.scan[j, 2 * k] = x[0] + h / 3 * x[1]
                if k:
                    f.scan[j, 2 * k - 1] = x[0] - h / 3 * x[1]
                x = [*x[:states], 0, 0] if j < states else x
                bound = np.abs(x @ q["series"][0]) @ falling
                q["remainder"][j] = max(q["remainder"][j], bound * h**4 / 144 * (1 + 1e-9) + 1e-14)
        q["largest"] = np.abs(f.nodes["z"][:, 0]).max()
        to, back, eta = self.frame()
        q["to_frame"], q["from_frame"] = to, back
        q["frame_square"] = self.squares - eta**2
        q["frame_scale"] = np.sqrt(np.abs(q["frame_square"]))
        q["stretch"] = q["leash"] = 10**9
        for j in range(n):
            block = np.array([[0.0, 1.0], [-self.squares[j], -2 * eta[j]]])
            row, xi = np.eye(2), np.zeros((ORDER, 2))
            for m in range(ORDER):  # xi from (xi, xi'); then c and s with xi = c + eta s, s
                xi[m] = row[0]
                row = row @ block / (m + 1)
            q["frame_series"][:, 2 * j], q["frame_series"][:, 2 * j + 1] = xi[:, 0] - eta[j] * xi[:, 1], xi[:, 1]
        for k in range(cells + 1):
            for j in range(n):
                xi = expm(np.array([[0.0, 1.0], [-self.squares[j], -2 * eta[j]]]) * (k * h))[0]
                f.nodes[k]["frame"][2 * j : 2 * j + 2] = xi[0] - eta[j] * xi[1], xi[1]
        return flights

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
