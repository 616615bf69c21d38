"""
A bifurcation diagram
=====================

Where the mass is once a forcing period, over the clearance: single dots are periodic motions, bands may be chaos.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
data = vs.sweep(system, {"b": {"start": 4, "stop": 7, "num": 1000}}, transient=1000, record=200)
vs.plot(data)
