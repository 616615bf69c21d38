"""The discontinuity mapping (41) of the double grazing orbit, P = Phi_{T/2} o C2 o Phi_{T/2} o C1.

Orders count in eps, with displacements from the grazing point D = O(eps) and penetration psi = O(eps^2). Flight is
linear, so Phi_{T/2} is exact: D -> L D. What a graze of the right stop does, moved to the section in zero time, is

    C1(X) = X - (1 + R) w e^{-A t} e_v

where t is the time from the section to the impact (negative, and of size eps), w the speed there, and e_v a unit
velocity of the gap x1: the flights forth and back differ by the flight of the impulse alone. Order 1 is the paper's: t
= 0 and w = sqrt(2 omega^2 b* psi), with psi = x1 - b (eqs. 38, 39); C1 is then wrong by O(eps^2).

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
from vibro_sweep.engine.variational import tangent_flight
from vibro_sweep.engine.variational.orthonormal import watch
from vibro_sweep.tables import outcomes as status


@jit
def map_period(f, stops, o, records, t, second):
    """One iteration of P, of first or second order; the section is the phase of the right graze. Returns a status."""
    q, half, states = f.oscillator[0], f.oscillator[0].cells // 2, 2 * len(o.c)
    o.events = 0
    for side in (1.0, -1.0):
        if t.wanted:
            tangent_flight.fly_to(t, o.lane, q, f.nodes, 0 if side > 0.0 else half, 0.0)
        if side > 0.0 and stops.right < np.inf:
            jump(f, stops.right, stops.R_right, 1.0, o, records, t, second)  # (41)
        elif side < 0.0 and stops.left > -np.inf:
            jump(f, -stops.left, stops.R_left, -1.0, o, records, t, second)
        fly_half(f.nodes[half].E, q.graze, side, o)
    total = 0.0
    for i in range(states):
        total += o.X[i]
    return status.OK if math.isfinite(total) else status.NOT_FINITE


@jit
def fly_half(E, graze, side, o):
    """Phi_{T/2} from the side's graze to the other's: X -> -X* + L (X - X*)."""
    X, d, states = o.X, o.y, 2 * len(o.c)
    for i in range(states):
        d[i] = X[i] - side * graze[i]
    for i in range(states):
        total = E[0, i] * d[0] + E[1, i] * d[1]
        for j in range(2, states, 2):
            total = total + (E[j, i] * d[j] + E[j + 1, i] * d[j + 1])
        X[i] = total - side * graze[i]


@jit
def jump(f, b, R, side, o, records, t, second):
    """C1 (side +1) or C2 (side -1), on the state and the tangent vectors."""
    q, X, graze, d, states = f.oscillator[0], o.X, f.oscillator[0].graze, o.y, 2 * len(o.c)
    # seen from the right: the left stop is its mirror image
    for i in range(states):
        d[i] = side * X[i] - graze[i]
    v1 = side * X[1]
    d[1] = v1
    psi = d[0] + (graze[0] - b)
    a = -q.omega * q.omega * graze[0]
    if second:
        change = q.force[0] * d[0] + q.force[1] * d[1]
        for i in range(2, states, 2):
            change = change + (q.force[i] * d[i] + q.force[i + 1] * d[i + 1])
        a += change
    w, late = impact_near_graze(a, psi, v1, second)
    if w == 0.0:
        return
    # (38), (39): X -> X - (1 + R) w e^{-A late} e_v
    push = -(1.0 + R) * w
    count_impact(o, side, w)
    log_impact(o, records, 0 if side > 0.0 else q.cells // 2, 0.0, side, side * w, X)
    set_impulse(q, -late, o.c)
    for m in range(len(o.c)):
        X[2 * m] += side * push * o.c[m, 0]
        X[2 * m + 1] += side * push * o.c[m, 1]
    if t.wanted:
        push_tangent(q, R, psi, a, w, v1, late, second, o, t)


@jit
def set_impulse(q, u, c):
    """e^{A u} e_v: the free motion at time u from a unit impulse on the gap. c (N, 3): x, v and a of each mass.

    In the plane j of coordinates/frame.py, with the vectors e1 = (A e2 + eta e2)/g and e2, it begins with p e1 + w e2.
    """
    for m in range(len(c)):
        c[m, 0], c[m, 1], c[m, 2] = 0.0, 0.0, 0.0
    for j in range(len(c)):
        eta = -q.frame_series[1, 2 * j]
        omega_squared = q.frame_square[j] + eta * eta
        _, s, c_eta_s, rate = decaying(eta, omega_squared, u)
        a = -(2.0 * eta * rate + omega_squared * s)
        p, w = q.to_frame[2 * j, 1], q.to_frame[2 * j + 1, 1]
        for m in range(1, len(c)):
            if q.push[m] != 0.0:
                p += q.push[m] * q.to_frame[2 * j, 2 * m + 1]
                w += q.push[m] * q.to_frame[2 * j + 1, 2 * m + 1]
        for m in range(len(c)):
            x2, v2 = q.from_frame[2 * m, 2 * j + 1], q.from_frame[2 * m + 1, 2 * j + 1]
            c[m, 0] += w * v2 * s
            c[m, 1] += w * v2 * rate
            c[m, 2] += w * v2 * a
            if x2 != 0.0 or p != 0.0:  # where damping is not proportional
                x = x2 * c_eta_s + v2 * s
                v = v2 * rate - x2 * omega_squared * s
                turned = v2 * a - x2 * omega_squared * rate
                jerk = -(2.0 * eta * turned + omega_squared * v)
                c[m, 0] += w * x2 * c_eta_s + p / q.frame_scale[j] * (v + eta * x)
                c[m, 1] += p / q.frame_scale[j] * (turned + eta * v) - w * x2 * omega_squared * s
                c[m, 2] += p / q.frame_scale[j] * (jerk + eta * turned) - w * x2 * omega_squared * rate


@jit
def push_tangent(q, R, psi, a, w, v1, late, second, o, t):
    """Tangent vectors across a jump: DC = 1 + e p^T - u r^T with e = e^{-A t} e_v, u = A e.

    p is the gradient of -(1 + R) w, and r that of t, times -(1 + R) w. At order 1, r = 0 and p = (1 + R) (a/w) e_x:
    there is the singularity of the square root. Then |det DC| = 1; order 2 has R^2 at the graze, like the impact.
    """
    p, r, c, states = t.before, t.after, o.c, 2 * len(o.c)
    for i in range(states):
        da = q.force[i] if second else 0.0
        d_psi, dv = 1.0 if i == 0 else 0.0, 1.0 if i == 1 else 0.0
        dw, d_late = impact_slopes(a, psi, v1, w, late, second, da, d_psi, dv)
        p[i], r[i] = -(1.0 + R) * dw, -(1.0 + R) * w * d_late
    Z, lane, back, to = t.Z, o.lane, q.from_frame, q.to_frame
    tangent_flight.apply_flight(t, tangent_flight.only(lane))
    t.mixed[lane] = 1.0
    for j in range(states):
        kick, shift = 0.0, 0.0
        for i in range(states):
            moved = 0.0
            for m in range(states):
                moved += back[i, m] * Z[states * m + j, lane]
            kick += p[i] * moved
            shift += r[i] * moved
        for i in range(states):
            total = 0.0
            for m in range(len(c)):
                total += to[i, 2 * m] * (c[m, 0] * kick - c[m, 1] * shift)
                total += to[i, 2 * m + 1] * (c[m, 1] * kick - c[m, 2] * shift)
            Z[states * i + j, lane] += total
    determinant = 1.0
    if second:
        pe, pu, re, ru = 0.0, 0.0, 0.0, 0.0
        for m in range(len(c)):
            pe += p[2 * m] * c[m, 0] + p[2 * m + 1] * c[m, 1]
            pu += p[2 * m] * c[m, 1] + p[2 * m + 1] * c[m, 2]
            re += r[2 * m] * c[m, 0] + r[2 * m + 1] * c[m, 1]
            ru += r[2 * m] * c[m, 1] + r[2 * m + 1] * c[m, 2]
        determinant = (1.0 + pe) * (1.0 - ru) + pu * re
    o.log_volume += np.log(abs(determinant))
    watch(t, tangent_flight.only(lane), alike(abs(determinant)))
