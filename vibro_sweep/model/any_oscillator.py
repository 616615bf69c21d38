"""What all oscillators have in common: it follows from their `Linear`."""

import math
from typing import Any

import numpy as np

from vibro_sweep.model.linear import Family, Linear
from vibro_sweep.model.models.declaration import Model
from vibro_sweep.model.stops import followers
from vibro_sweep.tables.quantity import Parameter
from vibro_sweep.tables.units import Units


class AnyOscillator:
    """A System or an Oscillator; a subclass says what its numbers and options are, by the model that it is of.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> from vibro_sweep.types import AnyOscillator
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> isinstance(system, AnyOscillator), system.masses, round(system.phase, 6)
    (True, 2, 2.229307)
    """

    model: Model
    family: Family
    described: dict[str, Parameter]  # its numbers, those of lists one by one
    numbers: dict[str, Any]  # their values, as given
    options: dict[str, Any]
    omega: float
    units: Units | None  # None: its numbers are nondimensional

    @property
    def linear(self) -> Linear:
        """The matrices, forces and stops, with the phase resolved."""
        return self.family.linear

    @property
    def masses(self) -> int:
        """N."""
        return len(self.linear.normal)

    @property
    def gap_is_x1(self) -> bool:
        """Whether the contact is that of mass 1 with a wall."""
        along = self.linear.normal
        return bool(along[0] == 1 and not along[1:].any())

    @property
    def phase(self) -> float:
        """tau in radians, `grazing` resolved."""
        return float(self.linear.tau)

    @property
    def period(self) -> float:
        """The forcing period T = 2 pi/omega."""
        return 2 * math.pi / self.omega

    @property
    def divergence(self) -> float:
        """-tr(M^-1 C): the sum of the Lyapunov exponents of a non-impacting orbit."""
        q = self.linear
        return -float(np.trace(np.linalg.solve(q.M, q.C)))

    def parameters(self) -> dict[str, float]:
        """The numbers by name, `tau` resolved, and those that follow others."""
        known = {name: value for name, value in self.numbers.items() if value is not None}
        return followers(self.numbers) | known | {"tau": self.phase}
