"""
From period to period
=====================

Section points in the order in which they come: a motion of period 13, and one that does not repeat.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
data = vs.sweep(system, {"b": [6.6, 6.69]}, transient=3000, record=200)
vs.plot(data, "iteration")
