"""
The graze of the free motion
============================

The clearance that the motion without impacts just fills, over the frequency, for three dampings. The peaks are
resonances.
"""

import matplotlib.pyplot as plt
import numpy as np

import vibro_sweep as vs

omega = np.linspace(0.2, 1.5, 400)
fig, ax = plt.subplots(figsize=(7, 3.5), layout="constrained")
for zeta in (0.02, 0.05, 0.1):
    system = vs.System(mu_m=10, mu_k=5, zeta=zeta, f2=0, omega=1, R=0.8, b=2)
    ax.semilogy(omega, [vs.grazing(system.replace(omega=one)).b for one in omega], label=rf"$\zeta = {zeta}$")
ax.set(xlabel=r"frequency $\omega$", ylabel="grazing clearance $b^*$")
ax.legend()
plt.show()
