"""
A map of power
==============

The power that two walls take from a mass on a shaken base, over the frequency and the gap: what a harvester could
turn into electricity.
"""

import vibro_sweep as vs

harvester = vs.Oscillator.named("one_mass", zeta=0.02, base=True, F=0.5, omega=1, R=0.6, b=1, tau=0)
axes = {"omega": {"start": 0.5, "stop": 3, "num": 76}, "b": {"start": 0.2, "stop": 3, "num": 71}}
data = vs.sweep(harvester, axes, observe=["energy"], transient=200, record=60)
vs.plot(data, variable="impact_power")
