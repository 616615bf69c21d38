"""
How hard impacts are
====================

Histograms of impact speeds at each clearance, as a map: a picture made with numpy and matplotlib from simulated
impacts.
"""

import matplotlib.pyplot as plt
import numpy as np

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
clearances, bins = np.linspace(4.2, 6.8, 131), np.linspace(0, 5, 80)
columns = []
for b in clearances:
    orbit = vs.simulate(system.replace(b=b), state=(0, 0, 0, 0), periods=800)
    speeds = abs(orbit.impacts["v1"][orbit.impacts["t"] > 400 * system.period])
    columns.append(np.histogram(speeds, bins)[0])
fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
ax.pcolormesh(clearances, (bins[1:] + bins[:-1]) / 2, np.log1p(np.array(columns).T), cmap="magma_r")
ax.set(xlabel="clearance $b$", ylabel="impact speed")
plt.show()
