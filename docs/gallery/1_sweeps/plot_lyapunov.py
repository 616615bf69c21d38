"""
The Lyapunov spectrum
=====================

Rates at which neighbouring motions separate. Where the largest one is above zero by more than two of its errors there
is chaos, and the background is tinted.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
data = vs.sweep(
    system, {"b": {"start": 4.2, "stop": 5.5, "num": 651}}, observe=["lyapunov"], transient=1000, record=400
)
vs.plot(data, "lyapunov")
