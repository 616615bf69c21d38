"""
Restitution and clearance
=========================

Where is chaos? A plane of restitution and clearance: soft impacts leave little of it.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
axes = {"R": {"start": 0.2, "stop": 1, "num": 121}, "b": {"start": 3.5, "stop": 7, "num": 141}}
data = vs.sweep(system, axes, observe=["lyapunov"], transient=400, record=100)
vs.plot(data, variable="lyapunov")
