"""
The force of a soft stop
========================

A mass meets a rubber stop once a period. The force over time, and against the displacement: the area of the loop is the
energy that the stop takes in a contact.
"""

import vibro_sweep as vs

system = vs.Oscillator.named(
    "one_mass", zeta=0.02, F=0.6, omega=0.9, k_stop=20, c_stop=2, b=1, tau=0, stops="right", release="force"
)
data = vs.sweep(
    system, {"omega": [0.9]}, transient=200, record=1, trajectory={"periods": 2, "samples": 1601}, observe=["section"]
)
vs.plot(data, "contact-force")
