"""
Strange attractors
==================

Twenty thousand section points of a chaotic motion, at two frequencies: they fill no area, and no line either.
"""

import vibro_sweep as vs

mass = vs.Oscillator.named("one_mass", zeta=0.02, F=1, omega=2.58, R=0.8, b=0.2, stops="right", tau=0)
data = vs.sweep(mass, {"omega": [2.37, 2.58]}, observe=["section"], transient=500, record=20000)
vs.plot(data, "poincare")
