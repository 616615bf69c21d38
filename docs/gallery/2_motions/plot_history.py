"""
Displacements over time
=======================

Both masses over sixteen periods of the force; the dashed lines are the stops of the first.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
data = vs.sweep(system, {"b": [4.5, 5.5]}, transient=1000, record=100, trajectory={"periods": 16, "samples": 4000})
vs.plot(data, "history")
