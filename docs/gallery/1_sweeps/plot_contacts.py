"""
How hard a soft stop is pressed
===============================

The largest penetration of an elastic stop and its largest force over the forcing frequency: the resonance, bent to the
right, with bands of other motions.
"""

import numpy as np

import vibro_sweep as vs

system = vs.Oscillator.named("one_mass", zeta=0.01, F=0.5, omega=0.8, k_stop=29, b=1, tau=0, stops="right")
data = vs.sweep(system, {"omega": np.linspace(0.4, 1.4, 401)}, transient=400, record=60, observe=["contacts"])
vs.plot(data, "contacts")
