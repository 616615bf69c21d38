"""Tangent vectors while a stop holds the gap: two dimensions are lost, the others go on."""

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.variational.mapped import apply_matrix
from vibro_sweep.engine.variational.orthonormal import orthonormalise
from vibro_sweep.engine.variational.tangent_flight import apply_flight, only


@jit
def rest(t, i, kappa, p):
    """Z when M1 comes to rest on a stop: dx1 = dv1 = 0, and two dimensions are lost for good.

    The others receive through dampers what moves M1 to the stop at once: dv2 -> dv2 - kappa dx1, with kappa = 2
    zeta/mu_m. Impulses on M1 move them by p at once (points/contact.py).
    """
    apply_flight(t, only(i))
    t.lost[i] = 2.0
    J, size = t.constrained, len(t.growth)
    for a in range(size):
        for b in range(size):
            J[a, b] = 1.0 if a == b > 1 else 0.0
    for k in range(1, len(t.scale)):
        J[2 * k, 0], J[2 * k + 1, 0], J[2 * k + 1, 1] = -p[k], -kappa[k], -p[k]
    hold(t, i)


@jit
def hold(t, i):
    """Z after a time on the stop in which (x1, v1, x2, ...) is multiplied by `constrained`."""
    apply_matrix(t, i, t.constrained)
    orthonormalise(t, only(i))
