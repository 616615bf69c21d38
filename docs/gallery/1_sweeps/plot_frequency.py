"""
Over the frequency
==================

The paper's two masses over the frequency of the force. Between the two resonances the free motion does not reach the
stops.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=2)
data = vs.sweep(system, {"omega": {"start": 0.5, "stop": 1.2, "num": 701}}, transient=600, record=120)
vs.plot(data)
