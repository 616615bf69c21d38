"""
The windows of a sweep
======================

Each bar is an interval in which one periodic orbit is stable; the marks name what ends it. Most ends are grazes.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=5.6)
data = vs.sweep(system, {"b": {"start": 5.3, "stop": 6, "num": 351}}, transient=1000, record=200)
vs.plot(data, windows=vs.windows(data))
