"""The discontinuity mapping (41) of the double grazing orbit, P = Phi_{T/2} o C2 o Phi_{T/2} o C1.

Orders count in eps, with displacements from the grazing point D = O(eps) and penetration psi = O(eps^2). Flight is
linear, so Phi_{T/2} is exact: D -> L D. What a graze of the right stop does, moved to the section in zero time, is

    C1(X) = X - (1 + R) w e^{-A t} e_v

where t is the time from the section to the impact (negative, and of size eps), w the speed there, and e_v = (0, 1, 0,
0): the flights forth and back differ by the flight of the impulse alone. Order 1 is the paper's: t = 0 and w = sqrt(2
omega^2 b* psi), with psi = x1 - b (eqs. 38, 39); C1 is then wrong by O(eps^2).

Order 2: the jerk at the graze vanishes, so near it x1 - b = psi + v1 t + a t^2/2 + O(eps^4), with the acceleration a(X)
= -omega^2 b* + O(eps) of the point itself, and the earlier root and the speed there are

    w = sqrt(v1^2 - 2 a psi) + O(eps^3),    t = (w - v1)/a + O(eps^3)

with an impact if and only if the peak psi - v1^2/(2 a) lies beyond the stop; C1 is wrong by O(eps^3). The flight of the
impulse, e^{-A t} e_v, is exact. Cut off after -t A e_v it would serve as well near the graze; but on attractors t is
not small, and the orbits of the map so cut off run away to infinity. C2 mirrors C1.
"""

import math

import numpy as np

from vibro_sweep.engine.graze import impact_near_graze, impact_slopes
from vibro_sweep.engine.motion.impacts import count_impact, log_impact
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import alike
from vibro_sweep.engine.tables.flight import decaying
from vibro_sweep.engine.variational import tangent
from vibro_sweep.engine.variational.orthonormal import watch
from vibro_sweep.model import status


@jit
def map_period(f, stops, o, records, t, second):
    """One iteration of P, of first or second order; the section is the phase of the right graze. Returns a status."""
    q, half = f.oscillator[0], f.oscillator[0].cells // 2
    o.events = 0
    for side in (1.0, -1.0):
        if t.wanted:
            tangent.fly_to(t, o.lane, q, f.nodes, 0 if side > 0.0 else half, 0.0)
        if side > 0.0 and stops.right < np.inf:
            jump(f, stops.right, stops.R_right, 1.0, o, records, t, second)  # (41)
        elif side < 0.0 and stops.left > -np.inf:
            jump(f, -stops.left, stops.R_left, -1.0, o, records, t, second)
        fly_half(f.nodes[half].E, q.graze, side, o.X)
    return status.OK if math.isfinite(o.X[0] + o.X[1] + o.X[2] + o.X[3]) else status.NOT_FINITE


@jit
def fly_half(E, graze, side, X):
    """Phi_{T/2} from the side's graze to the other's: X -> -X* + L (X - X*)."""
    d0, d1, d2, d3 = X[0] - side * graze[0], X[1] - side * graze[1], X[2] - side * graze[2], X[3] - side * graze[3]
    for i in range(4):
        X[i] = (E[0, i] * d0 + E[1, i] * d1) + (E[2, i] * d2 + E[3, i] * d3) - side * graze[i]


@jit
def jump(f, b, R, side, o, records, t, second):
    """C1 (side +1) or C2 (side -1), on the state and the tangent vectors."""
    q, X, graze = f.oscillator[0], o.X, f.oscillator[0].graze
    # seen from the right: the left stop is its mirror image
    d0, v1, d2, d3 = side * X[0] - graze[0], side * X[1], side * X[2] - graze[2], side * X[3] - graze[3]
    psi = d0 + (graze[0] - b)
    a = -q.omega * q.omega * graze[0]
    if second:
        a += (q.force[0] * d0 + q.force[1] * v1) + (q.force[2] * d2 + q.force[3] * d3)
    w, late = impact_near_graze(a, psi, v1, second)
    if w == 0.0:
        return
    # (38), (39): X -> X - (1 + R) w e^{-A late} e_v
    push = -(1.0 + R) * w
    count_impact(o, side, w)
    log_impact(o, records, 0 if side > 0.0 else q.cells // 2, 0.0, side, side * w, X)
    e0, e1, e2, e3, _, _ = impulse(q, -late)
    X[0] += side * push * e0
    X[1] += side * push * e1
    X[2] += side * push * e2
    X[3] += side * push * e3
    if t.wanted:
        push_tangent(q, R, psi, a, w, v1, late, second, o, t)


@jit
def impulse(q, u):
    """e^{A u} e_v, and the accelerations (a1, a2) there: the free motion at time u from a unit impulse on M1."""
    x1, v1, x2, v2, a1, a2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(2):
        eta, psi1, psi2 = -q.frame_series[1, 2 * j], q.from_frame[1, 2 * j + 1], q.from_frame[3, 2 * j + 1]
        omega_squared = q.frame_square[j] + eta * eta
        _, s, _, rate = decaying(eta, omega_squared, u)
        a = -(2.0 * eta * rate + omega_squared * s)
        x1 += psi1 * psi1 * s
        v1 += psi1 * psi1 * rate
        a1 += psi1 * psi1 * a
        x2 += psi1 * psi2 * s
        v2 += psi1 * psi2 * rate
        a2 += psi1 * psi2 * a
    return x1, v1, x2, v2, a1, a2


@jit
def push_tangent(q, R, psi, a, w, v1, late, second, o, t):
    """Tangent vectors across a jump: DC = 1 + e p^T - u r^T with e = e^{-A t} e_v, u = A e.

    p is the gradient of -(1 + R) w, and r that of t, times -(1 + R) w. At order 1, r = 0 and p = (1 + R) (a/w) e_x:
    there is the singularity of the square root. Then |det DC| = 1; order 2 has R^2 at the graze, like the impact.
    """
    da0, da1, da2, da3 = (q.force[0], q.force[1], q.force[2], q.force[3]) if second else (0.0, 0.0, 0.0, 0.0)
    dw0, dt0 = impact_slopes(a, psi, v1, w, late, second, da0, 1.0, 0.0)
    dw1, dt1 = impact_slopes(a, psi, v1, w, late, second, da1, 0.0, 1.0)
    dw2, dt2 = impact_slopes(a, psi, v1, w, late, second, da2, 0.0, 0.0)
    dw3, dt3 = impact_slopes(a, psi, v1, w, late, second, da3, 0.0, 0.0)
    e = -(1.0 + R)
    p0, p1, p2, p3 = e * dw0, e * dw1, e * dw2, e * dw3
    r0, r1, r2, r3 = e * w * dt0, e * w * dt1, e * w * dt2, e * w * dt3
    e0, e1, e2, e3, u1, u3 = impulse(q, -late)  # u = (e1, u1, e3, u3)
    Z, lane, back, to = t.Z, o.lane, q.from_frame, q.to_frame
    tangent.apply_flight(t, tangent.only(lane))
    t.mixed[lane] = 1.0
    for j in range(4):
        z0, z1, z2, z3 = Z[j, lane], Z[4 + j, lane], Z[8 + j, lane], Z[12 + j, lane]
        x1 = back[0, 0] * z0 + back[0, 2] * z2
        v = (back[1, 0] * z0 + back[1, 1] * z1) + (back[1, 2] * z2 + back[1, 3] * z3)
        x2 = back[2, 0] * z0 + back[2, 2] * z2
        v2 = (back[3, 0] * z0 + back[3, 1] * z1) + (back[3, 2] * z2 + back[3, 3] * z3)
        kick = (p0 * x1 + p1 * v) + (p2 * x2 + p3 * v2)
        shift = (r0 * x1 + r1 * v) + (r2 * x2 + r3 * v2)
        d0, d1, d2, d3 = e0 * kick - e1 * shift, e1 * kick - u1 * shift, e2 * kick - e3 * shift, e3 * kick - u3 * shift
        for i in range(4):
            Z[4 * i + j, lane] += (to[i, 0] * d0 + to[i, 1] * d1) + (to[i, 2] * d2 + to[i, 3] * d3)
    determinant = 1.0
    if second:
        pe, pu = (p0 * e0 + p1 * e1) + (p2 * e2 + p3 * e3), (p0 * e1 + p1 * u1) + (p2 * e3 + p3 * u3)
        re, ru = (r0 * e0 + r1 * e1) + (r2 * e2 + r3 * e3), (r0 * e1 + r1 * u1) + (r2 * e3 + r3 * u3)
        determinant = (1.0 + pe) * (1.0 - ru) + pu * re
    o.log_volume += np.log(abs(determinant))
    watch(t, tangent.only(lane), alike(abs(determinant)))
