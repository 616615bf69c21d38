"""Where a curve ends on the curve of another orbit.

A Neimark-Sacker curve ends where its pair meets at 1 (resonance 1:1) or at -1 (1:2): there the fold (flip) curve of the
same orbit has a second multiplier 1 (-1). A curve of an asymmetric or doubled orbit ends where that orbit is born, at a
point of codimension two of the pitchfork (flip) curve of the simpler orbit, or at the resonance 1:4 of its
Neimark-Sacker curve. The curve itself would go on from there as its own mirror image (repetition), and its equations
are singular at that point; so it is located on the other curve.
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
NEARLY = 0.05  # what tells the halves apart, in 1/omega and the fastest impulse, next to a birth
LENGTHS = (1e-6, 1e-5, 1e-4, 1e-3)  # in which the end is looked for there
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
    length = max(float(np.linalg.norm(tracer.difference(a, b))), SHORTEST)
    return _on_other(tracer, Start(of_type, tracer.solution(aim)), aim, length, (name,))


def birth(tracer: Tracer, a: Place, b: Place) -> tuple[Tracer, Found] | None:
    """Where the orbit of the curve is born between a and b, on the curve of its parent."""
    for sigma in (1, -1):
        parts = [halves_apart(tracer.solution(place), sigma) for place in (a, b)]
        if parts[0] is None or parts[1] is None:
            continue
        sizes = [np.linalg.norm(part) for part in parts]
        if not parts[0] @ parts[1] < -0.5 * sizes[0] * sizes[1]:
            continue
        aim = tracer.between(a, b, sizes[0] / (sizes[0] + sizes[1]))
        length = max(float(np.linalg.norm(tracer.difference(a, b))), SHORTEST)
        return _first_found(tracer, aim, sigma, (length,))
    return None


def birth_near(tracer: Tracer, a: Place) -> tuple[Tracer, Found] | None:
    """The same, where the steps end just before it: Newton's method may fail so near to the singular point."""
    for sigma in (1, -1):
        parts = halves_apart(tracer.solution(a), sigma)
        if parts is not None and np.linalg.norm(parts) < NEARLY:
            return _first_found(tracer, a, sigma, LENGTHS)
    return None


def _first_found(tracer: Tracer, aim: Place, sigma: int, lengths) -> tuple[Tracer, Found] | None:
    solution, kind = tracer.solution(aim), tracer.curve.kind
    starts = []
    if sigma > 0 and solution.K % 4 == 0 and solution.halves % 4 == 0 and kind == FOLD:
        mirrored = solution.sides[solution.K // 4] == -solution.sides[0]
        quarter = solution.part(4, -1 if mirrored else 1, alike=0.1)
        if quarter is not None:
            starts.append((Start("neimark_sacker", quarter, theta=math.pi / 2), ("resonance_1_4",)))
    parent = solution.part(2, sigma, alike=0.1)
    if parent is not None:
        starts.append((Start("pitchfork" if sigma < 0 else "flip", parent), BIRTHS[kind]))
    for start, types in starts:
        for length in lengths:
            found = _on_other(tracer, start, aim, length, types)
            if found is not None:
                return found
    return None


def _on_other(tracer: Tracer, start: Start, aim: Place, length: float, types) -> tuple[Tracer, Found] | None:
    other = Tracer(start, tracer.names, tracer.box)
    first = other.first()
    if first is None or np.abs((first.p - aim.p)[:2] / np.ptp(tracer.box, axis=1)).max() > NEAR:
        return None
    found = event_near(other, first, length, types)
    return None if found is None else (other, found)
