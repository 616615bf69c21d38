"""The contacts of a periodic orbit with compliant stops, as `simulate` has them: speeds, largest depth and force."""

import numpy as np

from vibro_sweep.engine.impulses import flights
from vibro_sweep.engine.impulses.flow import contact_flow
from vibro_sweep.engine.one_system import CONTACT
from vibro_sweep.oscillator.linear import Linear

SAMPLES = 65  # of a contact, between which its depth and its force have no two extrema
FINER = 5  # times that such an interval is divided in as many: near an extremum values differ by the square of that


def contacts_between(q: Linear, begins, lengths, sides, starts) -> np.ndarray:
    """Structured array `CONTACT` of contacts that begin in the states `starts` (m, 2N + 3), in contact coordinates."""
    result = np.empty(len(begins), CONTACT)
    result["t_touch"], result["t_release"], result["side"] = begins, begins + lengths, sides
    for one, length, start in zip(result, lengths, starts, strict=True):
        contact = _Contact(q, int(one["side"]), float(one["t_touch"]), start)
        (depth, speed, force, _) = contact.at(np.linspace(0.0, length, SAMPLES))
        force = np.maximum(force, 0.0)  # at a graze it is rounding
        one["v_touch"], one["v_release"] = speed[0], speed[-1]
        one["max_penetration"], one["max_force"] = depth.max(), force.max()
        for name, value, slope in (("max_penetration", 0, 1), ("max_force", 2, 3)):
            for u in contact.zeros(slope, length):
                one[name] = max(one[name], contact.at(np.array([u]))[value][0])
    return result


class _Contact:
    """The motion in one contact."""

    def __init__(self, q: Linear, side: int, begin: float, start: np.ndarray):
        self.flow, self.side, self.begin, self.start = (
            contact_flow(q, side),
            side,
            np.array([begin]),
            start[None].copy(),
        )
        self.N = q.masses
        self.law, self.stop = q.contact.law(side), float(q.contact.stop(side))

    def at(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Depth, its rate, the force and its rate, so long after the touch."""
        out, none = np.empty((len(times), self.start.shape[1])), np.zeros(len(times), int)
        workspace = flights.new_workspace(self.start.shape[1])
        flights.sample_flights(self.flow, self.start, self.begin, none, self.begin + times, out, workspace)
        depth, speed = self.side * (out[:, 0] - self.stop), self.side * out[:, self.N]
        rate = self.side * (out @ self.flow.B.T)[:, self.N]
        k, c, p = self.law.k, self.law.c, self.law.p
        return depth, speed, k * depth + c * speed + p, k * speed + c * rate

    def zeros(self, which: int, length: float) -> list[float]:
        """The times at which one of these numbers changes its sign downwards."""
        times = np.linspace(0.0, length, SAMPLES)
        values, found = self.at(times)[which], []
        for i in np.flatnonzero((values[:-1] > 0) & (values[1:] <= 0)):
            finer, at = times, int(i)
            for _ in range(FINER):
                finer = np.linspace(finer[at], finer[at + 1], SAMPLES)
                at = max(int(np.argmax(self.at(finer)[which] <= 0)) - 1, 0)
            found.append(float(finer[at]))
        return found
