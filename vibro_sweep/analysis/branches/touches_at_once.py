"""What begins where the free motion touches its stops at once, to first order.

A change dp of a number moves the gap at touch i past its stop by a_i dp, and so do impulses J_j of the touches:

    delta_i = a_i dp + sum_j W_ij J_j

An impulse J > 0 pushes the gap away from its stop. One that is rigid or preloaded gives the J_i at which delta_i = 0;
the damper of a contact that its force ends gives J_i = c delta_i; other contacts begin more slowly. An orbit has a set
of the touches: there J_i > 0 or delta_i > 0, and elsewhere delta_i < 0.
"""

from itertools import product

import numpy as np

from vibro_sweep.analysis.periodic.contact_numbers import has_corner, is_smooth
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses.flights import flight_matrices, new_workspace
from vibro_sweep.engine.impulses.flow import contact_coordinates, flow


class TouchesAtOnce:
    """Touches of the free motion, and what a number moves it past each stop by.

    moved : (K,) slopes a_i
    Raises LinAlgError where the free motion is one of a family.
    """

    def __init__(self, touching: Solution, moved: np.ndarray):
        q, t = touching.family.linear, touching.times
        self.moved, self.sides = moved, np.array(touching.sides, float)
        self.smooth = np.array([is_smooth(q, side) for side in touching.sides])
        dampers = [q.contact.law(side).c for side in touching.sides]
        corners = np.array([has_corner(q, side) for side in touching.sides])
        push = contact_coordinates(q).by_force[0] @ q.contact.normal  # 1/m_e
        self.corners = np.where(corners, dampers, 0.0) * push
        n, K = 2 * q.masses, touching.K
        lengths = np.array([t[k + 1] - t[k] if k + 1 < K else t[0] + touching.P - t[k] for k in range(K)])
        self.flights = np.empty((K, n, n))
        flight_matrices(flow(q), lengths, self.flights, new_workspace(n + 3))
        self.sigma, self.answers = touching.sigma, np.empty((K, K))
        for j in range(K):
            impulse = np.zeros(n)
            impulse[n // 2] = -self.sides[j]
            around = np.eye(n)
            for k in (*range(j, K), *range(j)):
                around = self.flights[k] @ around
            state = np.linalg.solve(np.eye(n) - self.sigma * around, impulse)
            for i in ((j + 1 + m) % K for m in range(K)):
                state = self.flights[i - 1] @ state * (self.sigma if i == 0 else 1)
                self.answers[i, j] = self.sides[i] * state[0]

    def begun(self, some: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(K,) depths and (K,) impulses, by dp, of the orbit with these touches (K,) booleans."""
        K = len(self.moved)
        hard, damped = some & ~self.smooth, np.where(some & self.smooth, self.corners, 0.0)
        # rows: J_i - c_i delta_i = 0 of contacts and of those that take no part, delta_i = 0 of the others
        rows = np.where(hard[:, None], self.answers, np.eye(K) - damped[:, None] * self.answers)
        impulses = np.linalg.solve(rows, np.where(hard, -self.moved, damped * self.moved))
        return self.moved + self.answers @ impulses, impulses

    def side_of(self, some: np.ndarray) -> int:
        """The sign of dp for which the orbit with these touches exists; 0: for none."""
        depths, impulses = self.begun(some)
        signs = np.sign(np.where(some, np.where(self.smooth, depths, impulses), -depths))
        return int(signs[0]) if np.all(signs == signs[0]) else 0

    def goes_on(self) -> bool:
        """Whether orbits exist on both sides."""
        sets = product((False, True), repeat=len(self.moved))
        return {1, -1} <= {self.side_of(np.array(some)) for some in sets}

    def multipliers(self) -> np.ndarray:
        """(n,) of the orbits with all touches, which are contacts; by falling modulus, of a pair +im first."""
        around = np.eye(self.flights.shape[1])
        for corner, flight in zip(self.corners, self.flights, strict=True):
            around[len(around) // 2] -= corner * around[0]
            around = flight @ around
        values = self.sigma * np.linalg.eigvals(around).astype(complex)
        return values[np.lexsort((-values.imag, -np.abs(values)))]
