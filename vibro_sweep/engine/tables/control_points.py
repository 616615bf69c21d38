"""Control points of x1 over the cells, by which a scan excludes cells without contact."""

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.exclusion import fill_exclusion, largest_point, put_points, rounding
from vibro_sweep.engine.tables.stiff import add_stiff_remainder, slow_part


@jit
def fill_scan(q, nodes, scan, psi, omega_squared, mu_m, f2):
    """Control points of the cubic through x1 and v1 at both ends of each cell, and how far x1 can be from it.

    The cubic has the Bernstein coefficients x_k, x_k + h v_k/3, x_{k+1} - h v_{k+1}/3, x_{k+1}. Its error is at most
    bound t^2 (1 - t)^2 h^4/24, a quartic with the one coefficient bound h^4/144, the middle one. So x1 stays below b
    where both inner control points do by that much, and both ends do. An end is the mean of the inner points beside it.
    """
    if not q.stiff:
        fill_exclusion(q, nodes, scan)
        return
    for i in range(5):
        for k in range(q.cells + 1):
            x, v = nodes[k].z[0], nodes[k].z[1]
            if i < 4:
                x, v = slow_part(q, psi, omega_squared, mu_m, i, k * q.width)
            put_points(scan[i], q.width / 3.0, k, x, v)
        q.remainder[i] = rounding(q, i, largest_point(q, scan[i]))
        if i < 4:
            q.slow[i], _ = slow_part(q, psi, omega_squared, mu_m, i, 0.0)
    add_stiff_remainder(q, nodes, psi, omega_squared, mu_m, f2)
