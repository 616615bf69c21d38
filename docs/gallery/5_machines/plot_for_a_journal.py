"""
One column of a journal
=======================

85 mm wide, with type of 8 points throughout; panels that stand side by side elsewhere stand below each other.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
data = vs.sweep(system, {"b": {"start": 4.2, "stop": 7, "num": 1001}}, transient=1000, record=200)
vs.plot(data, width=85)
