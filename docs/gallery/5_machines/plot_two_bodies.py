"""
Contact between two bodies
==========================

Two masses that strike each other: the gap is the difference of their displacements. The oscillator is given by its
matrices.
"""

import vibro_sweep as vs

pair = vs.Oscillator(
    M=[[4, 0], [0, 1]],
    K=[[5, -1], [-1, 1]],
    modal_damping=[0.02, 0.02],
    force=[1, 0],
    contact_normal=[-1, 1],
    omega=1,
    b=1,
    R=0.6,
    stops="left",
)
data = vs.sweep(pair, {"omega": {"start": 0.6, "stop": 1.6, "num": 501}}, transient=400, record=100)
vs.plot(data)
