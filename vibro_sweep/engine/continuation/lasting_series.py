"""An event that lasts in power series: what it makes of the state before it, and its two rows (normal_form.py).

As of lasting_event.py: first over the length s of the orbit's event, E Z, then over its change ds, exp(B ds).
"""

from vibro_sweep.engine.continuation.lasting import ends_by_force, force_scale
from vibro_sweep.engine.continuation.lasting_event import begin, dot, put_end
from vibro_sweep.engine.continuation.lasting_map import put_map
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW
from vibro_sweep.engine.continuation.power_series import grow, put_wave, steady
from vibro_sweep.engine.continuation.workspace import TERMS
from vibro_sweep.engine.simd.jit import small


@small
def last_series(f, compliant, side, x, e, y, work):
    """y (n, TERMS) becomes the state after the event, and `e.left` its rows, from `e.series` of dphi and ds; of
    contacts, since orbits that rest have no normal form."""
    if compliant is not None:
        n, s, Z, stop = f.A.shape[0], x[f.A.shape[0] + 1], work.states[1], f.numbers[HIGH if side > 0 else LOW]
        begin(f, compliant, side, x, e, work)
        put_map(f, compliant, side, s, work)
        put_end(f, work)
        put_wave(e.turn, e.series[0], work.jets)
        for m in range(TERMS):
            for r in range(n):
                y[r, m] += steady(f.Z[r], work.jets[3], work.jets[4], m)
            e.left[0, m] = y[0, m]
            for r in range(n):
                y[r, m] *= work.moving[r]
            y[n, m], y[n + 1, m], y[n + 2, m], y[n + 3, m] = work.jets[3, m], work.jets[4, m], 0j, 0j
        y[n + 2, 0], y[n + 3, 0] = 1.0, stop
        for m in range(TERMS):
            for r in range(n + 4):
                Z[r, m] = 0j
                for k in range(n + 4):
                    Z[r, m] += work.lasting[0, r, k] * y[k, m]
        grow(work.generator[0], n + 2, n + 4, 1.0, e.series[1], Z, y, work.states[2], work.jets)
        by_force = ends_by_force(f, compliant, side, s, work.end[0, n // 2])
        scale = force_scale(f, compliant, side)
        for m in range(TERMS):
            if by_force:
                e.left[1, m] = dot(work.force[0], Z[:, m], n + 4) / scale
            else:
                e.left[1, m], Z[0, m] = Z[0, m] / s, 0j
            for r in range(n):
                y[r, m] = Z[r, m] - steady(f.Z[r], Z[n], Z[n + 1], m)
        y[0, 0] += stop
