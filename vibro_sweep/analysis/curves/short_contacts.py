"""Contacts of critical orbits that are about to vanish: beside their graze a curve has no digits.

The condition of a critical orbit is divided by the length s of each contact without preload (engine/continuation/
conditions.py): next to s = 0 it is rounding over s. The graze itself is located along the curve of grazes. Behind it
the curve goes on from the mirror image of its last place with digits, which is right to s^2.
"""

from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.continuation.events import LocatedEvent
from vibro_sweep.analysis.continuation.point import Point
from vibro_sweep.analysis.continuation.solution_curve import SolutionCurve
from vibro_sweep.analysis.curves.curve_events import SHORT, events_between, is_divided, locate, on_grazes
from vibro_sweep.engine.continuation.problem import TORUS
from vibro_sweep.engine.continuation.workspace import Place

ACROSS = 1e-5  # length, in phase, of a contact that has digits again
LENGTHS = (1e-4, 1e-3, 1e-2)  # along a curve of grazes, in which the graze is looked for
NEAR = 1e-2  # of the bounds, within which it lies
BEHIND = (1.0, 2.0, 4.0, 8.0)  # times as far behind the graze as that place is before it: there may be no digits
MOST = 32  # times that a run goes over a graze: rounding may lead it to and fro


class ShortContacts:
    """The contacts of a curve whose lengths divide its condition, and its last place at which all have digits."""

    def __init__(self, curve: SolutionCurve):
        self.curve = curve
        self._divided = [i for i in range(curve.K) if is_divided(curve, i)]
        self._clear: tuple[np.ndarray, np.ndarray] | None = None
        self._left = MOST

    def keep(self, x: np.ndarray, p: np.ndarray) -> None:
        """Take note of points (points, K, 2N + 2), (points, 3) of the curve."""
        clear = np.flatnonzero((np.abs(x[:, self._divided, -1]) > ACROSS).all(axis=1))
        if len(clear):
            self._clear = x[clear[-1]].copy(), p[clear[-1]].copy()

    def are_lost(self, a: Place, b: Place) -> bool:
        """Whether a contact vanishes between a and b, at one of which its length has no digits."""
        least = np.minimum(np.abs(a.jumps), np.abs(b.jumps))
        return bool(np.any(((a.jumps * b.jumps < 0) & (least < SHORT))[self._divided]))

    def graze_beside(self, a: Place) -> LocatedEvent | None:
        """The graze, near a, of a contact whose length has no digits there."""
        for i in (i for i in self._divided if abs(a.jumps[i]) < ACROSS):
            found = on_grazes(self.curve, i, a, LENGTHS) or self._between_both_sides(a, i)
            reach = NEAR * np.ptp(self.curve.bounds, axis=1)
            if found is not None and np.all(np.abs(found.place.p - a.p)[:2] <= reach):
                return found._replace(event=replace(found.event, impact=i))
        return None

    def _between_both_sides(self, a: Place, contact: int) -> LocatedEvent | None:
        """The graze between the last place with digits and one behind it: of a pair where multipliers jump, for which
        curves of grazes have no test."""
        if self._clear is None or self.curve.problem.kind != TORUS:
            return None
        guess = self.curve.copied(a)
        guess.x[:], guess.p[:] = self._clear
        clear = self.curve.correct(guess, a.direction)
        if clear is None:
            return None
        towards = -clear.jumps[contact] / clear.direction[self.curve.K + contact]
        for farther in BEHIND:
            behind = self.curve.step(clear, (1 + farther) * towards)
            for event in [] if behind is None else events_between(self.curve, clear, behind):
                found = locate(self.curve, event, clear, behind) if event.impact == contact else None
                if found is not None:
                    return found
        return None

    def behind(self, graze: Place) -> Point | None:
        """The curve behind such a graze, on its way there."""
        if self._clear is None or self._left == 0:
            return None
        self._left -= 1
        (x, p), guess = self._clear, self.curve.copied(graze)
        for farther in BEHIND:
            guess.x[:], guess.p[:] = graze.x + farther * (graze.x - x), graze.p + farther * (graze.p - p)
            row = self.curve.unit_row(self.curve.difference(graze, guess))
            beyond = self.curve.correct(guess, row)
            if beyond is not None:
                turned = np.sign(beyond.direction @ row)
                beyond.tangent[:] *= turned
                beyond.tangent_p[:] *= turned
                return beyond
        return None
