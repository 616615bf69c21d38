"""
Windows beside a graze
======================

Towards the clearance at which the free motion grazes (dashed) windows follow one another, each with a period one
longer than the last.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
data = vs.sweep(system, {"b": {"start": 6.5, "stop": 6.76, "num": 1301}}, transient=2000, record=200)
vs.plot(data)
