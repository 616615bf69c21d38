"""
A film
======

The masses between their stops, with time history and phase portrait in step; this is the last of its 200 frames. With
``output="film.gif"`` or ``.mp4`` the film is written, and ``orbit.animate()`` shows one in a notebook.
"""

import vibro_sweep as vs

system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=5.5)
data = vs.sweep(system, {"b": [5.5]}, transient=1000, record=50, trajectory={"periods": 8, "samples": 1600})
vs.plot(data, "film")
