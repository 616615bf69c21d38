"""The discontinuity mapping of the double grazing orbit, for a person at a prompt; its formulas are in the kernel."""

import numpy as np

from vibro_sweep.kernels import ensemble, tangent
from vibro_sweep.orbit import Engine
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
        system = system.replace(tau="grazing")
        parameters = {name: np.array(value) for name, value in system.parameters().items()}
        self._engine = Engine(system)
        parameters = system.replace(tau="grazing").parameters()
        self.graze = expansion_point({name: np.array(value) for name, value in parameters.items()}, expand_at)
        self._engine = Engine(system.replace(tau="grazing"), lyapunov=True)
        oscillator = self._engine.ensemble.flights.oscillator[0]
        oscillator["order"], oscillator["graze"] = order, self.graze
        oscillator["stretch"] = oscillator["leash"] = oscillator["cells"]  # no looks at the tangent vectors on the way

    def _iterate(self, state, with_tangent: bool):
        engine, vectors = self._engine, self._engine.ensemble.tangent[0]
        engine.put(state)
        vectors["wanted"] = with_tangent
        if with_tangent:
            tangent.begin(vectors, 0)
            vectors["volume"] = 1e300  # never orthonormalised: one iteration is no long way
            vectors["Z"][:, 0] = vectors["to_frame"][:, 0]
        ensemble.map_once(engine.ensemble)
        return engine.orbit["X"][0, :4].copy(), vectors["Z"][:, 0].reshape(4, 4)

    def __call__(self, state) -> np.ndarray:
        """The state (4,) one period later."""
        return self._iterate(state, False)[0]

    def jacobian(self, state) -> np.ndarray:
        """(4, 4) derivative of the map, singular like 1/sqrt(psi) at a graze."""
        return self._engine.ensemble.flights.oscillator["from_frame"][0, 0] @ self._iterate(state, True)[1]


def discontinuity_map(system: System, order: int = 1, expand_at: float | None = None) -> DiscontinuityMap:
    """The discontinuity mapping of `system` at its clearance.

    order : 1, the paper's; 2, with the next term (kernels/discontinuity.py)
    expand_at : clearance at which it is expanded, by default the exact b*

    Raises ValueError for another order.
    """
    return DiscontinuityMap(system, order, expand_at)
