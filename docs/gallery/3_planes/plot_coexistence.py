"""
Attractors that coexist
=======================

Sixty-four random starts at each clearance, and what share of them ends on which motion.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.7)
data = vs.sweep(
    system,
    {"b": {"start": 6.70, "stop": 6.77, "num": 36}},
    start={"random": 64, "seed": 1},
    observe=["section", "attractors", "lyapunov"],
    transient=1500,
    record=100,
)
vs.plot(data, "coexistence")
