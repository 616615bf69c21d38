"""
Exponents as they converge
==========================

Lyapunov exponents are averages over the record. This is what they were after each period.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
data = vs.sweep(system, {"b": [4.5, 5.5]}, observe=["convergence", "lyapunov"], transient=500, record=5000)
vs.plot(data, "convergence")
