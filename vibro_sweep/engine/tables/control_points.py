"""Control points of x1 over the cells, by which a scan excludes cells without contact."""

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.exclusion import bound_fourth
from vibro_sweep.engine.tables.flight import CHUNK
from vibro_sweep.engine.tables.stiff import add_stiff_remainder, slow_part


@jit
def fill_scan(q, nodes, scan, psi, omega_squared, mu_m, f2):
    """Control points of the cubic through x1 and v1 at both ends of each cell, and how far x1 can be from it.

    The cubic has the Bernstein coefficients x_k, x_k + h v_k/3, x_{k+1} - h v_{k+1}/3, x_{k+1}. Its error is at most
    bound t^2 (1 - t)^2 h^4/24, a quartic with the one coefficient bound h^4/144, the middle one. So x1 stays below b
    where both inner control points do by that much, and both ends do. An end is the mean of the inner points beside it.
    """
    third = q.width / 3.0
    for i in range(5):
        for p in range(2 * q.cells + 1, 2 * q.cells + CHUNK):
            scan[i, p] = 0.0
        q.remainder[i] = 0.0
    for k in range(q.cells + 1):
        E, z = nodes[k].E, nodes[k].z
        for i in range(5):
            x, v = (z[0], z[1]) if i == 4 else (E[i, 0], E[i, 1])
            if q.stiff and i < 4:
                x, v = slow_part(q, psi, omega_squared, mu_m, i, k * q.width)
            scan[i, 2 * k] = x + third * v
            if k > 0:
                scan[i, 2 * k - 1] = x - third * v
        if not q.stiff:
            for i in range(4):
                q.remainder[i] = max(q.remainder[i], bound_fourth(q, E[i], 4))
            q.remainder[4] = max(q.remainder[4], bound_fourth(q, z[:], 6))
    for i in range(5):
        largest = 0.0
        for p in range(2 * q.cells + 1):
            largest = max(largest, abs(scan[i, p]))
        # 1e-15: the rounding of a control point, a few units in the last place of each of its terms
        q.remainder[i] = q.remainder[i] * q.width**4 / 144.0 + 1e-15 * largest
    if q.stiff:
        for i in range(4):
            q.slow[i], _ = slow_part(q, psi, omega_squared, mu_m, i, 0.0)
        add_stiff_remainder(q, nodes, psi, omega_squared, mu_m, f2)
