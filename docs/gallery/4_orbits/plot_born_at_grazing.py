"""
Speeds beside a graze
=====================

Orbits that are born at a graze begin with impacts of no speed. It grows in proportion to the distance from the graze.
"""

import matplotlib.pyplot as plt
import numpy as np

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.56, R=0.8, b=2)
at = vs.grazing(system).b
distance = np.logspace(-8, -1, 50)
fig, ax = plt.subplots(figsize=(7, 3.5), layout="constrained")
for born in vs.born_at_grazing(system, periods=2):
    ax.loglog(distance, max(born.speed_per_distance) * distance, label=f"{born.orbit.itinerary}, {born.born} $b^*$")
ax.set(xlabel=f"distance from $b^* = {at:.4f}$", ylabel="largest impact speed")
ax.legend(ncols=2, fontsize=8)
plt.show()
