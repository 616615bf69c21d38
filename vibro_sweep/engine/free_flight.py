"""Beside the period map: flights of one oscillator as if there were no stops, from any state, also beyond a stop.

What the equations of periodic orbits need (an impact that pulls leads to a flight beyond its stop): the motion, when
the gap is first at a stop, and bounds on where it turns, which tell how far a flight stays from the stops.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.engine.motion.free import find_contacts, find_extremes
from vibro_sweep.engine.one_system import Engine
from vibro_sweep.engine.variational.propagator import fly, new_workspace
from vibro_sweep.oscillator.oscillator import Oscillator, checked_system
from vibro_sweep.oscillator.sensitivity import motion


class Contacts(NamedTuple):
    """First contacts of n flights."""

    elapsed: np.ndarray  # (n,) time from the start; infinite where there is none, NaN where the status is not 0
    side: np.ndarray  # (n,) int8: of the stop; 0 where there is none
    status: np.ndarray  # (n,) int8, codes of tables/outcomes.py


class Extremes(NamedTuple):
    """Turning points of n flights: maxima and minima of the gap strictly between their ends."""

    highest: np.ndarray  # (n, 2) lower and upper bound on the gap at the highest maximum; -inf where there is none
    highest_at: np.ndarray  # (n,) time from the start, or NaN
    lowest: np.ndarray  # (n, 2) bounds on the gap at the lowest minimum; +inf where there is none
    lowest_at: np.ndarray  # (n,)


class FreeFlight:
    """Flights of `system` without stops. States are (n, 2 N); times absolute, durations from the start; (n,) or one.

    All methods raise ValueError for states of another shape, and for numbers that are not finite.
    """

    def __init__(self, system: Oscillator):
        checked_system(system)
        self._engine = Engine(system)
        self._q = system.linear
        self._A = motion(self._q).A
        self._rate = float(abs(np.linalg.eigvals(self._A)).max())

    def sample(self, states, start_time, elapsed) -> np.ndarray:
        """States (n, m, 2 N) after the times `elapsed` (m,) or (n, m), which may be negative."""
        states, start_time, _ = self._flights(states, start_time, 0.0)
        elapsed = np.asarray(elapsed, float)
        elapsed = np.broadcast_to(elapsed, (len(states), elapsed.shape[-1]))
        result = np.empty((*elapsed.shape, self._engine.states))
        _, cell, offset = self._engine.locate(start_time)
        phase = self._q.tau + 2 * np.pi * cell / self._engine.cells + self._q.omega * offset
        fly(self._A, self._rate, states, phase, elapsed * self._q.omega, new_workspace(len(self._A), 0), result)
        return result

    def first_contact(self, states, start_time, duration) -> Contacts:
        """When the gap first is at a stop, from inside or from beyond it; a start on a stop does not count.

        Certified as contacts of orbits are: none by which the gap changes sides is passed by.
        """
        states, start_time, duration = self._flights(states, start_time, duration)
        engine, n = self._engine, len(states)
        _, cell, offset = engine.locate(start_time)
        result = Contacts(np.empty(n), np.empty(n, np.int8), np.empty(n, np.int8))
        find_contacts(
            engine.flight, engine.orbit[0], engine.stops, cell, offset, engine.to_contact(states), duration, *result
        )
        return result

    def extremes(self, states, start_time, duration) -> Extremes:
        """Bounds on the gap at the turning points strictly between the ends of each flight.

        A flight from stop to stop stays `b - highest[:, 1]` away from a right one at b and `lowest[:, 0] + b` from a
        left one at -b, but for its ends; it passes a stop where that is negative. Where speed and acceleration of the
        gap both vanish at the start, as after a rest, the start itself counts.
        """
        states, start_time, duration = self._flights(states, start_time, duration)
        engine = self._engine
        _, cell, offset = engine.locate(start_time)
        out = np.empty((len(states), 6))
        find_extremes(
            engine.flight, engine.orbit[0], engine.stops, cell, offset, engine.to_contact(states), duration, out
        )
        return Extremes(out[:, :2] + engine.middle, out[:, 2], out[:, 3:5] + engine.middle, out[:, 5])

    def _flights(self, states, start_time, duration) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The arguments as arrays of n rows."""
        states, count = np.array(states, float), self._engine.states
        if states.ndim != 2 or states.shape[1] != count:
            raise ArgumentError(f"states: shape {states.shape} is not allowed; it must be (n, {count})")
        start_time, duration = (np.array(np.broadcast_to(x, len(states)), float) for x in (start_time, duration))
        for name, values in (("states", states), ("start_time", start_time), ("duration", duration)):
            if not np.isfinite(values).all():
                raise ArgumentError(f"{name}: {values[~np.isfinite(values)][0]!r} is not allowed; it must be finite")
        return states, start_time, duration
