"""Where a curve ends on the curve of another orbit.

A Neimark-Sacker curve ends where its pair meets at 1 (resonance 1:1) or at -1 (1:2): there the fold (flip) curve of the
same orbit has a second multiplier 1 (-1). A curve of an asymmetric or doubled orbit ends where that orbit is born, at a
point of codimension two of the pitchfork (flip) curve of the simpler orbit. The curve itself would go on from there as
its own mirror image (repetition), and its equations are singular at that point; so it is located on the other curve.
"""

import math

import numpy as np

from vibro_sweep.analysis.branches.way import halves_apart
from vibro_sweep.analysis.curves.events import Found, event_near
from vibro_sweep.analysis.curves.start import Start
from vibro_sweep.analysis.curves.tracer import Tracer
from vibro_sweep.engine.impulses.locus import FLIP, FOLD, GRAZE, THETA, TORUS, Place

NEAR = 0.2  # in the units of the curve: how far from the expected end the other curve is entered
SHORTEST = 1e-6
BIRTHS = {
    FOLD: ("degenerate_flip", "fold_flip", "resonance_1_2"),
    FLIP: ("flip_neimark_sacker",),
    TORUS: ("flip_neimark_sacker",),
    GRAZE: ("flip_graze", "pitchfork_graze", "resonant_graze"),
}


def strong_resonance(tracer: Tracer, a: Place, b: Place) -> tuple[Tracer, Found] | None:
    """The resonance 1:1 or 1:2 ahead of b, on the curve of folds or flips; None: there is none near."""
    towards_one = b.p[THETA] < math.pi / 2
    name, of_type = ("resonance_1_1", "fold") if towards_one else ("resonance_1_2", "flip")
    left = b.p[THETA] if towards_one else math.pi - b.p[THETA]
    before = a.p[THETA] if towards_one else math.pi - a.p[THETA]
    if not 0 < left < before:
        return None
    # near the end all moves with the square of the angle that is left
    aim = tracer.between(b, a, -(left**2) / (before**2 - left**2))
    return _on_other(tracer, Start(of_type, tracer.solution(aim)), a, b, aim, (name,))


def birth(tracer: Tracer, a: Place, b: Place) -> tuple[Tracer, Found] | None:
    """Where the asymmetric or doubled orbit of the curve is born between a and b, on the curve of its parent."""
    for sigma in (1, -1):
        parts = [halves_apart(tracer.solution(place), sigma) for place in (a, b)]
        if parts[0] is None or parts[1] is None:
            continue
        sizes = [np.linalg.norm(part) for part in parts]
        if not parts[0] @ parts[1] < -0.5 * sizes[0] * sizes[1]:
            continue
        aim = tracer.between(a, b, sizes[0] / (sizes[0] + sizes[1]))
        parent = tracer.solution(aim).part(2, sigma, alike=0.1)
        if parent is None:
            return None
        of_type = "pitchfork" if sigma < 0 else "flip"
        return _on_other(tracer, Start(of_type, parent), a, b, aim, BIRTHS[tracer.curve.kind])
    return None


def _on_other(tracer, start: Start, a: Place, b: Place, aim: Place, types) -> tuple[Tracer, Found] | None:
    other = Tracer(start, tracer.names, tracer.box)
    first = other.first()
    if first is None or np.abs((first.p - aim.p)[:2] / np.ptp(tracer.box, axis=1)).max() > NEAR:
        return None
    found = event_near(other, first, max(float(np.linalg.norm(tracer.difference(a, b))), SHORTEST), types)
    return None if found is None else (other, found)
