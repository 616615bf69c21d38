"""
One mass against the other
==========================

The paths of the two masses in the plane of their displacements, as in the paper's figure 4.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
data = vs.sweep(
    system, {"b": [5.5, 6.705716740973]}, transient=1000, record=100, trajectory={"periods": 8, "samples": 4000}
)
vs.plot(data, "configuration")
