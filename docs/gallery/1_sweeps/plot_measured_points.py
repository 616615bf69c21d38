"""
Measured points
===============

A lever beside a rubber stop, in mm and Hz, and what was measured of it: columns by the names of the axes, here made up
with an error of 3 per cent. In the upper panel its place once a period, in the lower one the largest force of the
stop. The command line takes them from a file: `vibro-sweep plot lever.h5 --points measured.csv`.
"""

import numpy as np

import vibro_sweep as vs

lever = vs.Oscillator.named(
    "chain", m=[2.4], k=[9500, 0], c=[3, 0], force=[40], k_stop=1.8e5, c_stop=45, stop_right=1.5e-3,
    frequency=5, units="SI",
)  # fmt: skip
axes = {"frequency": np.linspace(10, 22, 241)}
data = vs.sweep(lever, axes, start={"follow": "up"}, observe=["section", "contacts"], transient=500, record=40)
hertz, noise = np.linspace(10.5, 21.5, 23), np.random.default_rng(0)
true = data.sel(frequency=hertz, method="nearest")
measured = {"frequency": hertz}
measured["x1"] = 1000 * true.x1[:, -1].values * noise.normal(1, 0.03, 23)  # mm
measured["contact_force_max"] = true.contact_force_max.values * noise.normal(1, 0.03, 23)
vs.plot(data, units="mm, Hz", points=measured)
