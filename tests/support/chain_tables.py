"""The kernels' tables of a chain of any number of masses (reference/chains.py), from matrix exponentials."""

import math

import numpy as np
from scipy.linalg import expm

from vibro_sweep.engine.tables.flight import ORDER, WIDTH, Flight, new_flight


def tables(chain) -> Flight:
    """What `tables.build` makes for two masses."""
    n, states = chain.count, 2 * chain.count
    rate = max(chain.omega, math.sqrt(chain.squares.max()))
    cells = 8 * math.ceil(rate * chain.period / WIDTH / 8)
    flights = new_flight(1, cells, n)
    f = Flight(flights.oscillator[0], flights.nodes[0], flights.scan[0])
    q = f.oscillator[0]
    q["cells"], q["width"] = cells, chain.period / cells
    h = float(q["width"])
    q["step"], q["omega"], q["zeta"], q["rest_step"] = h, chain.omega, chain.zeta, h
    q["kappa"][1:] = -chain.C[1:, 0] / chain.masses[1:]
    q["force"] = chain.A[1]
    power = chain.A[0:states:2] * 0.0
    power[np.arange(n), 2 * np.arange(n)] = 1.0
    for m in range(ORDER):
        q["series"][:, :, m] = power
        power = power @ chain.A / (m + 1)
    orders = np.arange(ORDER, dtype=float)
    q["reach"] = np.where(orders > 0, h**orders, 0.0)
    q["third"] = np.where(orders > 2, orders * (orders - 1) * (orders - 2) * h ** np.maximum(orders - 3, 0), 0.0)
    q["impulse_third"] = np.abs(q["series"][0, 1]) @ q["third"]
    falling = orders * (orders - 1) * (orders - 2) * (orders - 3) * h ** np.maximum(orders - 4, 0)
    for k in range(cells + 1):
        E = expm(chain.A * (k * h))
        node = f.nodes[k]
        node["E"][:, : states + 2] = E.T
        node["E"][:, states:] = 0.0
        sin, cos = math.sin(chain.omega * k * h), math.cos(chain.omega * k * h)
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
    to, back, eta = chain.frame()
    q["to_frame"], q["from_frame"] = to, back
    q["frame_square"] = chain.squares - eta**2
    q["frame_scale"] = np.sqrt(np.abs(q["frame_square"]))
    q["stretch"] = q["leash"] = 10**9
    for j in range(n):
        block = np.array([[0.0, 1.0], [-chain.squares[j], -2 * eta[j]]])
        row, xi = np.eye(2), np.zeros((ORDER, 2))
        for m in range(ORDER):  # xi from (xi, xi'); then c and s with xi = c + eta s, s
            xi[m] = row[0]
            row = row @ block / (m + 1)
        q["frame_series"][:, 2 * j], q["frame_series"][:, 2 * j + 1] = xi[:, 0] - eta[j] * xi[:, 1], xi[:, 1]
    for k in range(cells + 1):
        for j in range(n):
            xi = expm(np.array([[0.0, 1.0], [-chain.squares[j], -2 * eta[j]]]) * (k * h))[0]
            f.nodes[k]["frame"][2 * j : 2 * j + 2] = xi[0] - eta[j] * xi[1], xi[1]
    return flights
