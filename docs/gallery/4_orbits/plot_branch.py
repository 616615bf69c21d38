"""
A branch of periodic orbits
===========================

The symmetric orbit that strikes each stop once a period, from the graze at which it is born to the one at which it
ends. Dashed where it is unstable.
"""

import vibro_sweep as vs

orbit = vs.periodic_orbit(vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=2), itinerary="LR")
branch = vs.continue_orbit(orbit, "b", (0.3, 6.8))
branch.plot()
