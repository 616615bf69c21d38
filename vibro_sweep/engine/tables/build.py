"""The tables of one oscillator (`Flight`), from its modes."""

from vibro_sweep.engine.motion.coast import fill_coasting
from vibro_sweep.engine.simd.jit import exported
from vibro_sweep.engine.tables.close_modes import CLOSE
from vibro_sweep.engine.tables.control_points import fill_scan
from vibro_sweep.engine.tables.forced import fill_motion, fill_phases
from vibro_sweep.engine.tables.frame_tables import fill_frame
from vibro_sweep.engine.tables.free_tables import fill_coupling, fill_flight, gap_of
from vibro_sweep.engine.tables.resting import fill_rest
from vibro_sweep.engine.tables.series import fill_equations, fill_impulse, fill_series, set_grid
from vibro_sweep.engine.tables.stiff import rate_of


@exported
def build(f, workspace, cells, psi, omega_squared, mu_m, mu_k, zeta, f2, omega, tau):
    """Fill the tables of an oscillator with modes psi (2, 2), omega_squared (2,), and phase tau (radians) at node 0.

    scratch: `series.Scratch`.
    """
    q = f.oscillator[0]
    q.zeta, q.kappa[0], q.kappa[1] = zeta, 0.0, 2.0 * zeta / mu_m
    rate = max(omega, max(rate_of(omega_squared[0], zeta), rate_of(omega_squared[1], zeta)))
    fill_phases(q, f.nodes, cells, tau)
    set_grid(q, cells, omega, rate)
    q.exact = False
    fill_equations(q, workspace, mu_m, mu_k, f2)
    fill_series(q, workspace)
    fill_rest(q, mu_m, mu_k, f2)
    fill_impulse(q)
    fill_flight(q, f.nodes, psi, omega_squared, mu_m)
    gap = gap_of(mu_m, mu_k)
    if gap < CLOSE * omega_squared[1]:
        fill_coupling(q, f.nodes, psi, omega_squared, mu_m, gap)
    fill_motion(q, f.nodes, psi, omega_squared, f2)
    q.largest = 0.0
    for k in range(cells + 1):
        q.largest = max(q.largest, abs(f.nodes[k].z[0]))
    fill_scan(q, f.nodes, f.scan, psi, omega_squared, mu_m, f2)
    fill_frame(q, psi, omega_squared, mu_m)
    fill_coasting(q, psi, omega_squared, mu_m, mu_k, f2, tau)
