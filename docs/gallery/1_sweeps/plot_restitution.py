"""
Over the restitution
====================

How much speed an impact leaves decides whether the motion is regular: with lossy impacts it mostly is.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4.5)
data = vs.sweep(system, {"R": {"start": 0.3, "stop": 1, "num": 701}}, transient=1000, record=150)
vs.plot(data)
