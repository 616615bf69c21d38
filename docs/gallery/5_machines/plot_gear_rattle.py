"""
Gear rattle
===========

Impact speeds of a tooth in its backlash, over the fluctuation of the torque. Below 0.5 the load keeps the teeth in
contact.
"""

import vibro_sweep as vs

gears = vs.Oscillator.named("one_mass", k=0, zeta=0.02, constant=0.5, F=1, omega=1, R=0.7, b=1, tau=0)
data = vs.sweep(
    gears,
    {"F": {"start": 0, "stop": 3, "num": 601}},
    section={"kind": "impact", "stop": "right"},
    transient=300,
    record=100,
)
vs.plot(data)
