"""The error by rounding of the parameters of a point, from that of each row through the inverse of the Jacobian."""

from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.problem import STICK, conditions, unknowns
from vibro_sweep.engine.continuation.workspace import Place

if TYPE_CHECKING:
    from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve

DIGITS = 8 * np.finfo(float).eps  # of the parameters themselves
ROWS = 2 * np.finfo(float).eps  # of the size of each row
BESIDE = 2.0**-45  # of phases: so near to a graze the equations of its contact, in part dependent there, tell the same


def rounding_error(curve: "SolutionCurve", place: Place, row: np.ndarray) -> float:
    """The error by rounding of the parameters of a point on the plane across `row`."""
    return float(DIGITS * np.abs(place.p[:2]).max() + ROWS * sensitivity(curve, place, row))


def sensitivity(curve: "SolutionCurve", place: Place, row: np.ndarray) -> float:
    """The change of the parameters, on the plane across `row`, if each equation is off by its own size; infinite
    where they are singular, and beside it, too."""
    if not curve.assemble(place, row):
        place = curve.copied(place)
        place.phases[:] += BESIDE
        if not curve.assemble(place, row):
            return np.inf
    c, n, work, events = curve.problem, curve.n, curve.workspace.work[0], curve.workspace.events
    free, found = unknowns(c), []
    try:
        inverse = np.linalg.inv(work["ends"][: n + free, : n + free])
    except np.linalg.LinAlgError:
        return np.inf
    for j in range(c.parameters):
        by_last, by_rows = inverse[n + j, :n], inverse[n + j, n:]
        work["left"][:] = by_last
        events["sides"][:] = -np.einsum("ikr,k->ir", events["factors"][:, :free], by_rows)
        curve.run_task(stepper.TAKE_UP, place)
        if c.kind == STICK:
            curve.workspace.trial[0, 0] -= curve.workspace.trial[-2, 2:] @ curve.workspace.tail[0]["by_end"]
        rows = np.abs(curve.workspace.trial)
        flights = rows[-2:-1, 2:] if c.kind == STICK else rows[:-1, 2:]  # in a chatter sequence they vanish
        total = rows[:-1, :2].sum() + flights.sum() + np.abs(by_rows[: conditions(c)]).sum()
        found.append(total * c.unit[j])
    return float(max(found))
