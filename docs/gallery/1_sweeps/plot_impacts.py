"""
Impacts on each stop
====================

How often each stop is struck in a period of the force. A motion that strikes one stop more than the other has a
mirror image.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
data = vs.sweep(system, {"b": {"start": 4.2, "stop": 7, "num": 1001}}, observe=["impacts"], transient=1000, record=200)
vs.plot(data, "impacts")
