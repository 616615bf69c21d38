"""Periodic orbits of one oscillator as sequences of impacts: the equations of engine/continuation, no number free.

Phases are in radians of the force and lengths as they are, so that omega is 1 there.
"""

from functools import lru_cache

import numpy as np

from vibro_sweep.analysis.periodic.impulse_equations import TABLES, closing, flow
from vibro_sweep.engine.continuation import guesses, moving_flow
from vibro_sweep.engine.continuation.problem import ORBIT, Problem
from vibro_sweep.engine.continuation.workspace import new_bench, new_place
from vibro_sweep.engine.impulses.flow import contact_coordinates, unseen_modes
from vibro_sweep.engine.impulses.green import MOST_CELLS, ResonanceError, TooStiffError, cells_needed, has_free_gap
from vibro_sweep.engine.impulses.tables import ORDER
from vibro_sweep.model.linear import Keyed, Linear, amplitudes


class EventEquations:
    """Orbits of `q` with impacts on `sides`, z(t + P) = sigma z(t), P = halves T/2.

    sigma = +1 and an even number of halves, or sigma = -1 and an odd one (symmetric orbits).
    Raises ResonanceError, TooStiffError (green.py).
    """

    def __init__(self, q: Linear, sigma: int, halves: int, sides):
        if cells_needed(q) * halves > MOST_CELLS:
            raise TooStiffError(f"{halves} half periods need more than {MOST_CELLS} cells")
        self.q, self.K, self.n = q, len(sides), 2 * len(q.along)
        self.free = sigma == 1 and has_free_gap(q)
        units = np.repeat([1.0, q.omega], self.n // 2)
        self.planes, self.closing = _tables(Keyed(q, TABLES)).copy(), closing(q, sigma, halves).copy()
        self.planes["half_turns"], self.planes["is_held"] = halves, sigma == 1 and np.any(self.planes["held"])
        self.closing /= units[:, None]
        self.closing[:, :-1] *= units
        self.problem = Problem(ORBIT, 0, np.array(sides, float), float(sigma), 0, np.ones(2), False, False)
        self.place, self.bench = new_place(self.K, self.n), new_bench(self.K, self.n)

    def newton(self, starts, contacts=None) -> tuple[np.ndarray, np.ndarray]:
        """Newton's method from guesses (m, 2K) of times and jumps: solutions, and the last change, NaN: none found.

        contacts : (m, 4) stops and 1 + R as of `contact_of`, where they are not those of `q`
        """
        q, K = self.q, self.K
        if not K:
            return starts, np.zeros(len(starts))
        if contacts is None:
            contacts = np.repeat([contact_of(q)], len(starts), 0)
        phases = q.omega * starts[:, :K] + q.tau
        right = self.problem.sides[0] > 0
        gap = contacts[:, int(right)] - (self.planes[0]["Z"][0] * np.exp(1j * phases[:, 0])).real
        guess = np.column_stack([phases, starts[:, K:] / q.omega, gap])
        ends, changes = np.empty_like(guess), np.empty(len(guess))
        guesses.settle_all(
            self.planes, self.problem, self.place, self.closing, self.bench, contacts, guess, ends, changes
        )
        return np.hstack([(ends[:, :K] - q.tau) / q.omega, ends[:, K : 2 * K] * q.omega]), changes


def contact_of(q: Linear) -> list[float]:
    """Both stops and 1 + R there, in the order of `numbers` (engine/continuation/moving_flow.py)."""
    return [q.low, q.high, 1 + q.R_low, 1 + q.R_high]


@lru_cache(maxsize=16)
def _tables(key: Keyed) -> np.ndarray:
    """(1,) `plane_of` of an oscillator, without its contact."""
    q = key.q
    f, to = flow(q), contact_coordinates(q)
    m = len(f.B)
    n = m - 3
    units = np.repeat([1.0, q.omega], n // 2)
    scale = np.append(units, 1.0) / units[:, None]
    result = np.zeros(1, moving_flow.plane_of(n // 2))
    r, columns = result[0], [*range(n), m - 1]
    try:
        X = amplitudes(q)
    except np.linalg.LinAlgError:
        raise ResonanceError("the force drives an undamped mode at its own frequency") from None
    r["A"] = f.B[:n, columns] * scale / q.omega
    r["Z"] = np.concatenate([to.P @ X, 1j * (to.U @ X)])
    if not np.all(np.isfinite(r["Z"])):
        raise ResonanceError("the force drives an undamped mode at its own frequency")
    rates = q.omega ** -np.arange(ORDER + 1.0)
    r["series"] = f.series.reshape(-1, m, m)[:, :n, columns] * scale * rates[:, None, None]
    r["powers"] = f.powers[:, :n, columns] * scale
    r["width"], r["bits"], r["is_still"], r["is_known"] = f.width * q.omega, moving_flow.BITS, 1, 1
    r["numbers"][moving_flow.OMEGA] = 1.0
    r["held"] = unseen_modes(q) / np.outer(units, units)
    return result
