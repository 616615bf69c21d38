"""
Floquet multipliers along a branch
==================================

The factors by which small deviations grow in a period. Where one of them passes 1 in size the orbit loses its
stability; towards the graze on the right one grows without bound.
"""

import vibro_sweep as vs

orbit = vs.periodic_orbit(vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=2), itinerary="LR")
branch = vs.continue_orbit(orbit, "b", (0.3, 6.8))
branch.plot(variable="multiplier")
