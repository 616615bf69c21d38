"""The discontinuity mapping of the double grazing orbit, for a person at a prompt; its formulas are in the kernel."""

import numpy as np

from vibro_sweep.kernels import discontinuity, orbits, tables, tangent
from vibro_sweep.kernels.flight import new_flight
from vibro_sweep.orbit import points_of
from vibro_sweep.system import System, steady_response


def expansion_point(parameters: dict[str, np.ndarray], expand_at: float | None = None) -> np.ndarray:
    """X* at the right stop, (..., 4), for arrays of parameters.

    The exact grazing point, at b* of Theorem 1; or with its x1 replaced by a clearance `expand_at`, as in the paper,
    which expands at 6.7107356 where b* is 6.7057167.
    """
    d, e = steady_response(*(parameters[name] for name in ("mu_m", "mu_k", "zeta", "f2", "omega")))
    size = np.hypot(d[..., 0], e[..., 0])
    sin, cos = d[..., 0] / size, e[..., 0] / size
    omega = parameters["omega"]
    x2, v2 = d[..., 1] * sin + e[..., 1] * cos, omega * (d[..., 1] * cos - e[..., 1] * sin)
    return np.stack([size if expand_at is None else np.full_like(size, expand_at), np.zeros_like(size), x2, v2], -1)


class DiscontinuityMap:
    """P = Phi_{T/2} o C2 o Phi_{T/2} o C1 (eqs. 41, 48): call it with a state (4,) at the phase of the right graze."""

    def __init__(self, system: System, order: int = 1, expand_at: float | None = None):
        if order not in (1, 2):
            raise ValueError(f"order: {order!r} is not allowed; it must be 1 or 2")
        parameters = system.replace(tau="grazing").parameters()
        point = points_of({name: np.array(value) for name, value in parameters.items()})[()]
        self.flight = new_flight(int(point["cells"]))
        names = ("psi", "omega_squared", "mu_m", "mu_k", "zeta", "f2", "omega", "tau")
        tables.build(self.flight, np.empty((7, 6)), int(point["cells"]), *(point[name] for name in names))
        self.graze = expansion_point({name: np.array(value) for name, value in parameters.items()}, expand_at)
        self.flight.oscillator["order"] = order
        self.flight.oscillator["graze"] = self.graze
        self.flight.oscillator["stretch"] = self.flight.oscillator[
            "cells"
        ]  # no looks at the tangent vectors on the way
        left, right = system.stops != "right", system.stops != "left"
        self.stops = orbits.Stops(-system.b if left else -np.inf, system.b if right else np.inf, system.R)

    def _iterate(self, state, with_tangent: bool):
        orbit, vectors = np.zeros(1, orbits.ORBIT), np.zeros(1, tangent.TANGENT)
        orbit["X"] = np.asarray(state, float)
        if with_tangent:
            vectors["wanted"], vectors["volume"] = True, 1e300  # never orthonormalised: one iteration is no long way
            vectors["flight"] = 1.0, 0.0, 1.0, 0.0
            vectors["Z"] = self.flight.oscillator["to_frame"]
        records = orbits.new_records()
        discontinuity.map_period(self.flight, self.stops, orbit[0], records, vectors[0])
        if with_tangent:
            tangent.apply_flight(vectors[0], self.flight.oscillator[0])
        return orbit["X"][0], vectors["Z"][0]

    def __call__(self, state) -> np.ndarray:
        """The state (4,) one period later."""
        return self._iterate(state, False)[0]

    def jacobian(self, state) -> np.ndarray:
        """(4, 4) derivative of the map, singular like 1/sqrt(psi) at a graze."""
        return self.flight.oscillator["from_frame"][0] @ self._iterate(state, True)[1]


def discontinuity_map(system: System, order: int = 1, expand_at: float | None = None) -> DiscontinuityMap:
    """The discontinuity mapping of `system` at its clearance.

    order : 1, the paper's; 2, with the next term (kernels/discontinuity.py)
    expand_at : clearance at which it is expanded, by default the exact b*

    Raises ValueError for another order.
    """
    return DiscontinuityMap(system, order, expand_at)
