"""
Phase portraits
===============

Velocity over displacement at four clearances, between the stops. Red dots are the state once in each period of
the force.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
data = vs.sweep(
    system, {"b": [4.3, 5.5, 6.6, 7]}, transient=1000, record=100, trajectory={"periods": 16, "samples": 8000}
)
vs.plot(data, "phase-portrait")
