"""The error of a point of codimension two: by how much rounding moves its parameters.

Rounding of the equations moves the curve, and rounding of the test moves its zero along the curve. The first is what
the inverse of the Jacobian makes of the rounding of each row. The second is seen in several locations that round
differently.
"""

from collections.abc import Callable

import numpy as np

from vibro_sweep.analysis.continuation.tracer import Tracer
from vibro_sweep.analysis.curves.chord import ASIDE, Chord
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.problem import STICK, unknowns
from vibro_sweep.engine.continuation.workspace import Place

STEPS = (-3e-12, -1e-12, 1e-12, 3e-12)  # of a chord: beside the zero, so near that only rounding differs
TIMES = 6.0  # the largest difference between locations
DIGITS = 8 * np.finfo(float).eps  # of the parameters themselves
ROWS = 2 * np.finfo(float).eps  # of the size of each row


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
    rounding = DIGITS * np.abs(place.p[:2]).max() + ROWS * sensitivity(tracer, place, chord.row)
    return float(TIMES * apart + rounding)


def estimates(chord: Chord, share: float) -> np.ndarray:
    """(m, 2) parameters of the zero at `share` as points beside it tell them, with slopes of the polynomials; not
    finite where these have none. Raises ArithmeticError."""
    aside = share + (ASIDE if share < 0.5 else -ASIDE)
    near, far = (chord.at(s, exact=False) for s in (share, aside))
    beside = [chord.at(share + step) for step in STEPS]
    tests, p = np.array([chord.test(place) for place in beside]), np.array([place.p[:2] for place in beside])
    with np.errstate(all="ignore"):
        return p - np.outer(tests / np.float64(chord.test(far) - chord.test(near)), (far.p - near.p)[:2])


def sensitivity(tracer: Tracer, place: Place, row: np.ndarray) -> float:
    """By how much a parameter moves, on the plane across `row`, where each equation is off by its own size."""
    if tracer.problem.kind == STICK or not tracer.assemble(place, row):
        return 0.0
    n, free, work, events = tracer.n, unknowns(tracer.problem), tracer.bench.work[0], tracer.bench.events
    try:
        inverse = np.linalg.inv(work["ends"][: n + free, : n + free])
    except np.linalg.LinAlgError:
        return 0.0
    found = []
    for j in range(2):
        by_last, by_rows = inverse[n + j, :n], inverse[n + j, n:]
        work["left"][:] = by_last
        events["sides"][:] = -np.einsum("ikr,k->ir", events["factors"][:, :free], by_rows)
        tracer.do(stepper.TAKE_UP, place)
        rows = np.abs(place.left)
        total = rows[:-1, :2].sum() + rows[-2, 2:].sum() + np.abs(by_rows[:-1]).sum()
        found.append(total * tracer.problem.unit[j])
    return float(max(found))
