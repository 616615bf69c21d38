"""
Speeds at impacts
=================

A ball on a vibrating table: each dot is the velocity with which it meets the table. The rhythm of one bounce a period
doubles, and doubles again.
"""

import vibro_sweep as vs

ball = vs.Oscillator.named(
    "one_mass", k=0, zeta=0, constant=-1, base=True, F=0.7, omega=1, R=0.8, b=0, tau=0, stops="left"
)
data = vs.sweep(
    ball,
    {"F": {"start": 0.9, "stop": 1.3, "num": 801}},
    start={"follow": "up", "x1": 0.5, "v1": 3},
    section={"kind": "impact", "stop": "left"},
    transient=600,
    record=200,
)
vs.plot(data)
