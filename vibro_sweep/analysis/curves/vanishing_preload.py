"""Where a curve ends because the preload of a stop and a contact with it vanish together.

A short contact of a mass that comes with the speed v and is slowed down by a lasts 2 v/(a + p/m). Where v
and the preload p vanish at once its equations have a limit for each of their ratios. The touch does not know of the
preload: the end is the point of the graze curve at which it is 0.
"""

from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.branches.special import bare, inserted
from vibro_sweep.analysis.continuation.first_point import first_place
from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.continuation.starting_orbit import StartingOrbit
from vibro_sweep.analysis.periodic.solution import Solution

PRELOADS = ("preload", "preload_left")
SHORT = 0.1  # of a contact, in radians of the force
NEAR = 0.05  # of the bounds, from where the curve was lost


def without_preload(curve: SolutionCurve, solution: Solution, p: np.ndarray) -> Point | None:
    """The touch without preload beside an orbit of the curve, whose parameters are p; None: there is none near."""
    axes = [j for j, name in enumerate(curve.names) if name in PRELOADS and curve.bounds[j, 0] == 0.0]
    lengths = (solution.ends - solution.times[list(solution.rests)]) * solution.family.linear.omega
    if not axes or not len(lengths) or lengths.min() > SHORT:
        return None
    gone = bare(solution, solution.rests[int(np.argmin(lengths))])
    orbit = replace(gone, family=gone.family.replace(**{curve.names[axes[0]]: 0.0})).corrected()
    if orbit is None:
        return None
    touching, index = inserted(orbit)
    graze = SolutionCurve(StartingOrbit("graze", touching, index), curve.names, curve.bounds)
    found = first_place(graze, graze.axis(axes[0]))
    near = found is not None and np.all(np.abs(found.p - p)[:2] <= NEAR * np.ptp(curve.bounds, axis=1))
    return found if near else None
