"""
Three masses in a chain
=======================

The middle one strikes two stops; over the frequency each of the three resonances brings impacts.
"""

import vibro_sweep as vs

chain = vs.Oscillator.named(
    "chain", m=[1, 1, 1], k=[1, 1, 1, 1], c=[0.02] * 4, force=[1, 0, 0], stop_at=2, omega=1, R=0.8, b=1
)
data = vs.sweep(chain, {"omega": {"start": 0.5, "stop": 2.2, "num": 426}}, transient=400, record=100)
vs.plot(data)
