"""
Unequal stops
=============

Impacts over the middle of the stops and their distance. Where the middle is moved away from zero the double graze
opens into two curves.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
axes = {"offset": {"start": -0.6, "stop": 0.6, "num": 121}, "b": {"start": 6.2, "stop": 7.2, "num": 101}}
data = vs.sweep(system, axes, observe=["impacts"], transient=400, record=60)
vs.plot(data)
