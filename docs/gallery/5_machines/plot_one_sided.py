"""
One stop alone
==============

One mass beside one stop, with a growing and with a falling force.
"""

import vibro_sweep as vs

system = vs.Oscillator.named("one_mass", zeta=0.02, F=1, omega=0.8, R=0.9, b=1, stops="right")
data = vs.sweep(
    system, {"F": {"start": 0.3, "stop": 1.3, "num": 501}}, start={"follow": "both"}, transient=600, record=120
)
vs.plot(data)
