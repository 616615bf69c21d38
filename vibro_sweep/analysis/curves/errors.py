"""The error of a point of codimension two: by how much rounding moves its parameters.

Rounding of the equations moves the curve (analysis/continuation/errors.py), and rounding of the test moves its zero
along the curve. The second is seen in several locations that round differently.
"""

from collections.abc import Callable

import numpy as np

from vibro_sweep.analysis.continuation.errors import rounding_error
from vibro_sweep.analysis.continuation.tracer import Tracer
from vibro_sweep.analysis.curves.chord import ASIDE, Chord
from vibro_sweep.engine.continuation.workspace import Place

STEPS = (-3e-12, -1e-12, 1e-12, 3e-12)  # of a chord: beside the zero, so near that only rounding differs
TIMES = 6.0  # the largest difference between locations


def error_of(
    tracer: Tracer, a: Place, b: Place, test: Callable[[Place], float], share: float, place: Place
) -> float | None:
    """Of both parameters of the zero `place` at a share of the chord from a to b; None: there is no curve beside it."""
    chord = Chord(tracer, a, b, test)
    chord.seen[share] = place
    try:
        apart = np.abs(estimates(chord, share) - place.p[:2])
    except ArithmeticError:
        return None
    apart = apart[np.isfinite(apart)].max(initial=0.0)
    return float(TIMES * apart + rounding_error(tracer, place, chord.row))


def estimates(chord: Chord, share: float) -> np.ndarray:
    """(m, 2) parameters of the zero at `share` as points beside it tell them, with slopes of the polynomials; not
    finite where these have none. Raises ArithmeticError."""
    aside = share + (ASIDE if share < 0.5 else -ASIDE)
    near, far = (chord.at(s, exact=False) for s in (share, aside))
    beside = [chord.at(share + step) for step in STEPS]
    tests, p = np.array([chord.test(place) for place in beside]), np.array([place.p[:2] for place in beside])
    with np.errstate(all="ignore"):
        return p - np.outer(tests / np.float64(chord.test(far) - chord.test(near)), (far.p - near.p)[:2])
