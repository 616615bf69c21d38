"""
Impacts for each period
=======================

The number of impacts in a period of the force is constant in each window: steps of a staircase. Windows are in
colour.
"""

import matplotlib.pyplot as plt

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
data = vs.sweep(
    system, {"b": {"start": 5.4, "stop": 6.75, "num": 1351}}, observe=["section", "impacts"], transient=1000, record=360
)
rate = (data.impacts_right + data.impacts_left) / 360
fig, ax = plt.subplots(figsize=(8, 3.5), layout="constrained")
ax.plot(data.b, rate, color="0.7", linewidth=0.6)
ax.scatter(data.b, rate.where(data.period > 0), c=data.period, s=4, cmap="turbo")
ax.set(xlabel="clearance $b$", ylabel="impacts per period")
plt.show()
