"""
All branches from one orbit
===========================

From the pitchfork of the symmetric orbit two mirror images begin, from their special points others, and so on.
"""

import matplotlib.pyplot as plt

import vibro_sweep as vs

orbit = vs.periodic_orbit(vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=2), itinerary="LR")
fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
for item in vs.follow_branches(orbit, "b", (0.3, 6.8), depth=2):
    points = item.branch.points
    for stable, style in ((True, "-"), (False, ":")):
        x1 = points.x1.where((points.unstable == 0) == stable)
        ax.plot(points.b, x1, style, color=f"C{item.generation}", linewidth=1.2)
    for special in item.branch.special:
        ax.plot(special.parameters["b"], special.orbit.state[0], "k.", markersize=4)
ax.set(xlabel="clearance $b$", ylabel="$x_1$ at $t = 0$")
plt.show()
