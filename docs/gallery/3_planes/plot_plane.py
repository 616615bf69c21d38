"""
A plane of two parameters
=========================

The largest Lyapunov exponent and the period over frequency and clearance. Above the dashed line the free motion fits
between the stops.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
axes = {"omega": {"start": 0.5, "stop": 1.1, "num": 201}, "b": {"start": 0.5, "stop": 8, "num": 151}}
data = vs.sweep(system, axes, observe=["lyapunov", "section"], transient=400, record=60)
vs.plot(data)
