"""
Why a motion jumps
==================

The quiet motion (blue) ends at a graze, the striking one (red) at a fold. Between the two lies an unstable motion
(dashed) that no test shows.
"""

import matplotlib.pyplot as plt
import numpy as np

import vibro_sweep as vs

system = vs.Oscillator.named("one_mass", zeta=0.02, F=1.8, omega=1.6, R=0.8, b=1)
quiet = vs.continue_orbit(vs.periodic_orbit(system.replace(F=0.5), state=(0, 0)), "F", (0.05, 2))
striking = vs.continue_orbit(vs.periodic_orbit(system, itinerary="LR"), "F", (0.05, 2))
fig, ax = plt.subplots(figsize=(7, 3.5), layout="constrained")
for branch, color in ((quiet, "C0"), (striking, "C3")):
    points = branch.points
    size = np.hypot(points.x1, points.v1 / system.omega)
    ax.plot(points.F, size.where(points.unstable == 0), color=color)
    ax.plot(points.F, size.where(points.unstable > 0), "--", color=color)
ax.set(xlabel="force $F$", ylabel="size of the motion")
plt.show()
