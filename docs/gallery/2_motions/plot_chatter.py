"""
Chatter and rest
================

A ball that falls into ever faster impacts, rests on the table, and is thrown off again. The time at rest begins where
the series of impacts ends.
"""

import vibro_sweep as vs

ball = vs.Oscillator.named(
    "one_mass", k=0, zeta=0, constant=-1, base=True, F=1.5, omega=1, R=0.5, b=0, tau=0, stops="left"
)
orbit = vs.simulate(ball, state=(2, 0), periods=4)
orbit.plot(periods=4)
