"""
The next impact from the last
=============================

Each dot is the speed of an impact over that of the one before. Chaos is not disorder: the dots lie on a few curves.
"""

import matplotlib.pyplot as plt

import vibro_sweep as vs

ball = vs.Oscillator.named(
    "one_mass", k=0, zeta=0, constant=-1, base=True, F=2.52, omega=1, R=0.3, b=0, tau=0, stops="left"
)
orbit = vs.simulate(ball, state=(1, 3), periods=6000)
speed = abs(orbit.impacts["v1"])
fig, ax = plt.subplots(figsize=(5, 4.5), layout="constrained")
ax.plot(speed[500:-1], speed[501:], ",k")
ax.set(xlabel="speed of an impact", ylabel="speed of the next one")
plt.show()
