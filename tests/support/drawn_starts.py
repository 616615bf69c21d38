"""Starts that a sweep draws at random: its file has the state a period later, from which motion is followed back.

Where nothing is damped, R = 1 and the force is even in time (tau = pi / 2), x(-t) is a motion if x(t) is.
"""

import math

import numpy as np

import vibro_sweep as vs

BACKWARDS = np.array([1, -1, 1, -1])  # x1, v1, x2, v2


def drawn_starts(system: vs.System, clearances, count: int, seed: int) -> np.ndarray:
    """(clearances, count, 4); they do not depend on damping, R and tau."""
    elastic = system.replace(zeta=0, R=1, tau=math.pi / 2)
    drawn = {"random": count, "seed": seed}
    data = vs.sweep(elastic, {"b": clearances}, start=drawn, transient=0, record=1, observe=["section"], workers=1)
    assert (data["status"] == 0).all()
    later = np.stack([data[name].values[..., 0] for name in ("x1", "v1", "x2", "v2")], axis=-1)
    starts = np.empty_like(later)
    for i, b in enumerate(clearances):
        for k in range(count):
            starts[i, k] = vs.simulate(elastic.replace(b=b), later[i, k] * BACKWARDS, 1).section[-1] * BACKWARDS
    return starts
