"""
Basins of attraction
====================

Each initial state in the colour of the motion that it leads to. Two of the motions are mirror images; the light patch
leads to the motion without impacts.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.734)
starts = {"x1": {"start": -6.7, "stop": 6.7, "num": 120}, "v1": {"start": -4.2, "stop": 4.2, "num": 120}}
data = vs.sweep(system, starts, start={"x2": 3.2286, "v2": 0.2475}, observe=["attractors"], transient=4000, record=200)
vs.plot(data)
