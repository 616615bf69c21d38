"""The discontinuity mapping of the double grazing orbit, for interactive use; its formulas are in the engine."""

import numpy as np
from numpy.typing import ArrayLike

from vibro_sweep.checks.arguments import names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.real import number_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.engine.motion.discontinuity import iterate_one
from vibro_sweep.engine.one_system import Engine
from vibro_sweep.oscillator.family import rigid_family_of
from vibro_sweep.oscillator.linear import gap_response, grazing_state, push_of
from vibro_sweep.oscillator.oscillator import Oscillator, checked_system
from vibro_sweep.tables.coordinates import checked_state

ORDERS = (1, 2)


class DiscontinuityMap:
    """P = Phi_{T/2} o C2 o Phi_{T/2} o C1 (eqs. 41, 48): call it with a state (2 N,) at the right graze's phase.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.7)
    >>> map_of_period = vs.discontinuity_map(system)
    >>> map_of_period(vs.grazing(system).state).shape, map_of_period.jacobian([6, 0, 3, 0]).shape
    ((4,), (4, 4))
    """

    def __init__(self, system: Oscillator, order: int = 1, expand_at: float | None = None):
        checked_system(system)
        if number_of(order) not in ORDERS:
            raise ArgumentError(not_allowed("order", order, " or ".join(map(str, ORDERS))))
        at = None if expand_at is None else number_of(expand_at)
        if expand_at is not None and (at is None or not 0 < at < np.inf):
            raise ArgumentError(not_allowed("expand_at", expand_at, "a finite number > 0"))
        rigid_family_of(system, "map")
        _check_symmetric(system)
        self._system, self._order = system.replace(tau="grazing"), int(order)
        q, self._engine = self._system.linear, Engine(self._system)
        self.graze = grazing_state(q)
        if at is not None:  # in the direction of an impulse
            self.graze[0::2] += (at - q.contact.normal @ self.graze[0::2]) * push_of(q)
        self._at = float(q.contact.normal @ self.graze[0::2])

    def __repr__(self) -> str:
        return f"<DiscontinuityMap of order {self._order}, expanded at b = {self._at:.10g}; {self._system}>"

    def __call__(self, state: ArrayLike) -> np.ndarray:
        """The state (2 N,) one period later."""
        return self._iterated(state)[0]

    def jacobian(self, state: ArrayLike) -> np.ndarray:
        """(2 N, 2 N) derivative of the map, singular like 1/sqrt(psi) at a graze."""
        return self._iterated(state)[1]

    def _iterated(self, state: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """The state one period later and its derivative; NaN where the map leads out of the floats."""
        engine, masses = self._engine, len(self.graze) // 2
        values = checked_state(state, masses)
        to, back = (np.kron(matrix, np.eye(2)) for matrix in engine.contact_matrices)
        X, J, c, scratch = to @ values, to.copy(), np.empty((masses, 3)), np.empty((3, 2 * masses))
        iterate_one(engine.flight, engine.stops, to @ self.graze, X, J, scratch[0], c, *scratch[1:], self._order == 2)
        if not np.isfinite(X).all():
            X[:] = np.nan
        return back @ X, back @ J


def _check_symmetric(system: Oscillator) -> None:
    """Check what the mapping needs: the two halves of a period are mirror images, and a steady motion."""
    q = system.linear
    if getattr(system, "offset", 0.0) != 0 or q.contact.R_low != q.contact.R_high or np.any(q.constant):
        allowed = "one with equal stops about 0 and without a constant force, for the discontinuity mapping"
        raise ArgumentError(not_allowed("system", system, allowed))
    if not gap_response(q):
        raise ArgumentError(not_allowed("system", system, "one whose gap has a steady motion, which grazes"))


@names_its_arguments
def discontinuity_map(system: Oscillator, order: int = 1, expand_at: float | None = None) -> DiscontinuityMap:
    """The discontinuity mapping of `system` at its clearance.

    system : a System, or an Oscillator; with equal stops about 0 (or one of them) and no constant force
    order : 1, the paper's; 2, with the next term (engine/motion/discontinuity.py)
    expand_at : clearance at which it is expanded, by default the exact b*

    Raises ValueError for a system that is not symmetric so, or whose gap has no steady motion, for another order, or a
    clearance that is not a number > 0. The map itself raises it for a state that is not 2 N finite numbers.

    Examples
    --------
    >>> import numpy as np
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.7)
    >>> map_of_period = vs.discontinuity_map(system)
    >>> np.round(map_of_period(vs.grazing(system).state), 4)
    array([ 6.8072, -0.0371,  3.196 ,  0.2112])
    """
    return DiscontinuityMap(system, order, expand_at)
