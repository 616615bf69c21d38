"""
A branch over a sweep
=====================

Dots are what a simulation finds; the line is one periodic orbit followed by its equations, through the window in
which it is stable and to both its ends.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=5.6)
data = vs.sweep(system, {"b": {"start": 5.3, "stop": 6, "num": 351}}, transient=1000, record=100)
settled = vs.simulate(system, (0, 0, 0, 0), 2000).section[-1]
branch = vs.continue_orbit(vs.periodic_orbit(system, settled, periods=8), "b", (5.3, 6))
vs.plot(branch, over=data)
