"""
Bifurcation curves
==================

The special points of one branch, followed in frequency and clearance: two grazes and a pitchfork. Marks are points at
which two things happen at once.
"""

import vibro_sweep as vs

orbit = vs.periodic_orbit(vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=2), itinerary="LR")
branch = vs.continue_orbit(orbit, "b", (0.3, 6.8))
curve = vs.bifurcation_curve(branch.special[1], ("b", "omega"), ((0.1, 8), (0.45, 1.1)))
curve.plot()
