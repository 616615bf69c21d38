"""
Power lost in impacts
=====================

An impact damper: the ball in its cavity takes most power where it moves in step with its host, and the host moves
least just before that step is lost.
"""

import vibro_sweep as vs

damper = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.05, zeta=0.01, F=0.1, omega=1, R=0.7, b=1)
gaps = {"b": {"start": 0.2, "stop": 4, "num": 381}}
data = vs.sweep(damper, gaps, start={"x1": 0, "v1": 0.1}, observe=["energy"], transient=600, record=120)
vs.plot(data, "energy")
