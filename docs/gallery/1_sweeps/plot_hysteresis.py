"""
Hysteresis
==========

Each point starts where the last one ended: blue with a growing clearance, orange with a falling one. Where the
colours differ the machine has a choice.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.7)
data = vs.sweep(
    system, {"b": {"start": 6.6, "stop": 6.8, "num": 401}}, start={"follow": "both"}, transient=1000, record=100
)
vs.plot(data)
