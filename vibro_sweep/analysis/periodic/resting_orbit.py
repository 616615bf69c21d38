"""Periodic orbits with events that last, of engine/continuation: rests after impacts with R = 0, and contacts with
compliant stops.

The unknowns are the phase of each event and, where it lasts its length in phase, else its velocity jump. The states
follow from them, since the motion repeats itself. Where the mass rests two multipliers are 0.
"""

import numpy as np

from vibro_sweep.analysis.periodic.orbit_motion import OrbitMotion
from vibro_sweep.engine.continuation import stepper

MOST_STEPS = 30
ROUNDED = 8 * np.finfo(float).eps  # of phases
CLOSINGS = 3  # to know from the state which contacts end by force
LONGEST = 0.02  # step of Newton's method, in parts of the period and of the fastest jump


class RestingOrbit(OrbitMotion):
    """The motion of a `Solution` with rests. Raises LinAlgError where none repeats itself."""

    def _follow_events(self, _) -> None:
        self.equations.move()
        self._close()
        self._sharpen()

    def _close(self) -> None:
        """The states that follow from phases, jumps and lengths, and the equations there.

        They follow linearly, but for contacts that end by force only where they are fast: there once more from these.
        """
        x, e, n = self.place.x, self.events, self.n
        x[:, :n] = 0.0
        self._follow()
        for _ in range(CLOSINGS if self.q.contact.by_force else 1):
            through = np.eye(n)
            for k in range(len(x)):
                through = e["E"][k, 0, :, :n] @ (e["carry"][k, :, :n] @ through if k in self.rests else through)
            left = e["landing"][-1] - self.sigma * x[0, :n]
            x[0, :n] += np.linalg.solve(self.sigma * np.eye(n) - through, left)
            self._follow()

    def _follow(self) -> None:
        self.equations.run_task(stepper.FOLLOW)
        self.equations.run_task(stepper.ASSEMBLE)

    def _sharpen(self) -> None:
        """Give the lengths of contacts the digits that they have lost as differences of two times."""
        e, n = self.events, self.n
        short = self.pressed & (np.abs(self.place.jumps) > 1e-6)
        change = np.where(short, e["pull"] / np.where(short, e["release"][:, n + 1], 1.0), 0.0)
        if np.any(short) and np.all(np.abs(change) < ROUNDED * (1 + np.abs(self._ends))):
            self.place.jumps[:] -= change
            self._close()

    def newton(self) -> tuple[np.ndarray, float]:
        """Newton's method from here: u, and the last relative change, NaN: no orbit was found. Raises LinAlgError."""
        x, n, e, before = self.place.x, self.n, self.events, np.inf
        swing, struck = abs(self.Z[0]), np.flatnonzero(~self.equations.problem.rests)
        for _ in range(MOST_STEPS):
            start = x.copy()
            e["changes"] = np.nan
            self.equations.run_task(stepper.CORRECT)
            step = e["changes"][:, 0, n:]
            fastest = max(swing, np.abs(start[struck, n + 1]).max(initial=0.0), np.abs(e["motion"][:, 0]).max())
            turned = np.append(np.abs(step[:, 0]), np.abs(step[self.rests].sum(axis=1))).max()
            change = max(turned / self.length, np.abs(step[struck, 1]).max(initial=0.0) / fastest)
            if not change < np.inf:
                break
            share = min(1.0, LONGEST / max(change, 1e-300))
            x[:, n:] = start[:, n:] - share * step
            following = np.append(x[1:, n], x[0, n] + self.length)
            if np.any(x[self.rests, n + 1] < 0) or np.any(following < self._ends):
                break
            self._close()
            if share == 1.0 and (change <= 4e-16 or (change < 1e-9 and change >= 0.5 * before)):
                return self.u, change
            before = change if share == 1.0 else np.inf
        return self.u, np.nan

    @property
    def _ends(self) -> np.ndarray:
        """(K,) phases after the impacts, and after the rests."""
        return self.place.phases + np.where(self.equations.problem.rests, self.place.jumps, 0.0)

    @property
    def u(self) -> np.ndarray:
        """The unknowns, as `Solution.u`."""
        times, ends = ((phases - self.q.tau) / self.q.omega for phases in (self.place.phases, self._ends))
        jumps = np.where(self.equations.problem.rests, -self.events["motion"][:, 0], self.place.jumps)
        return np.concatenate([times, jumps * self.q.omega, ends[self.rests]])

    def multipliers(self) -> np.ndarray:
        """(2N,) of the map over P, with the mirror for sigma = -1."""
        values = self.equations.multipliers()
        if not np.all(self.pressed[self.rests]):
            values[-2:] = 0.0
        return values

    def pieces(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Begins of flights and of events that last in order, the states there (.., 2N + 3), and of the latter the
        side; 0 of flights."""
        N, rests, ends = self.n // 2, self.equations.problem.rests, self._ends
        struck, after = self.states, self.equations.whole(self.events["after"][:, : self.n], ends)
        on, stops = self.equations.problem.sides, self.q.contact.stop(self.equations.problem.sides)
        struck[rests, 0], after[rests, 0] = stops[rests], (stops + on * self.events["depth"])[rests]
        for states in (struck, after):
            states[rests & ~self.pressed, N] = 0.0
        order = np.sort(np.append(np.flatnonzero(rests), np.arange(len(rests)) + 0.5))  # a rest, then its flight
        which, held = np.floor(order).astype(int), order == np.floor(order)
        begins = np.where(held, self.place.phases[which], ends[which])
        sides = np.where(held, self.equations.problem.sides[which], 0.0)
        return (begins - self.q.tau) / self.q.omega, np.where(held[:, None], struck[which], after[which]), sides
