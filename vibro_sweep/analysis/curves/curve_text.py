"""What `repr` says of a bifurcation curve."""

from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.analysis.branches.branch_text import way_of
from vibro_sweep.analysis.periodic.orbit_text import itinerary_of, repr_text, span

if TYPE_CHECKING:
    from vibro_sweep.analysis.curves.bifurcation_curve import BifurcationCurve


def of_curve(curve: "BifurcationCurve") -> str:
    points = curve.points
    spans = [f"{name} {span(points[name].values)}" for name in curve.parameters]
    real = int(np.count_nonzero(~points.virtual.values))
    lines = [
        f"<BifurcationCurve, {curve.type.replace('_', '-')}, {', '.join(spans)}",
        f"{points.sizes['point']:,} points, {real:,} of them a motion; of {itinerary_of(curve.begins.orbit)}",
        *way_of(curve.begins, curve.special, curve.ends, curve.closed),
    ]
    return repr_text(lines)
