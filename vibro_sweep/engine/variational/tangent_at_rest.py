"""Tangent vectors while a stop holds the gap: two dimensions are lost, the others go on."""

from vibro_sweep.engine.simd.jit import jit
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
    Z, to, size = t.Z, t.to_frame, len(t.growth)
    for j in range(size):
        dx, dv = motion_in(t, i, 0, j)
        for k in range(1, len(t.scale)):
            push = kappa[k] * dx
            if p[k] != 0.0:
                push += p[k] * dv
                for m in range(size):
                    Z[size * m + j, i] -= to[size * m + 2 * k, i] * (p[k] * dx)
            for m in range(size):
                Z[size * m + j, i] -= to[size * m + 2 * k + 1, i] * push
    for m in range(size):
        for j in range(size):
            t.constrained[m, j] = 1.0 if m == j else 0.0
    release(t, i)


@jit
def motion_in(t, i, mass, j):
    """Displacement and speed of a mass in tangent vector j of orbit i."""
    Z, back, size = t.Z, t.from_frame, len(t.growth)
    x, v = 2 * mass * size, (2 * mass + 1) * size
    first, second = Z[j, i], Z[size + j, i]
    dx, across = back[x, i] * first, back[x + 1, i] * second
    dv = back[v, i] * first + back[v + 1, i] * second
    for m in range(2, size, 2):
        first, second = Z[size * m + j, i], Z[size * (m + 1) + j, i]
        dx += back[x + m, i] * first
        across += back[x + m + 1, i] * second
        dv += back[v + m, i] * first + back[v + m + 1, i] * second
    return dx + across, dv


@jit
def release(t, i):
    """Z after a rest on the stop during which (dx2, dv2, dx3, ...) is multiplied by `constrained`."""
    Z, to, constrained, size, before, after = t.Z, t.to_frame, t.constrained, len(t.growth), t.before, t.after
    t.mixed[i] = 1.0
    for j in range(size):
        for mass in range(1, len(t.scale)):
            before[2 * mass], before[2 * mass + 1] = motion_in(t, i, mass, j)
        for a in range(2, size):
            after[a] = constrained[a, 2] * before[2] + constrained[a, 3] * before[3]
            for b in range(4, size, 2):
                after[a] += constrained[a, b] * before[b] + constrained[a, b + 1] * before[b + 1]
        for m in range(size):
            z = 0.0
            if size > 2:
                z = to[size * m + 2, i] * after[2] + to[size * m + 3, i] * after[3]
            for a in range(4, size, 2):
                z += to[size * m + a, i] * after[a] + to[size * m + a + 1, i] * after[a + 1]
            Z[size * m + j, i] = z
    orthonormalise(t, only(i))
