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

Of tangent vectors C1 makes DC = 1 + e p^T - u r^T with e = e^{-A t} e_v, u = A e; p is the gradient of -(1 + R) w, and
r that of t, times -(1 + R) w. At order 1, r = 0 and p = (1 + R) (a/w) e_x: there is the singularity of the square root.
Then |det DC| = 1; order 2 has R^2 at the graze, like the impact.
"""

import math

import numpy as np

from vibro_sweep.engine.motion.impacts import count_impact, log_impact
from vibro_sweep.engine.simd.jit import exported, jit
from vibro_sweep.engine.simd.lanes import alike
from vibro_sweep.engine.tables.flight import decaying
from vibro_sweep.engine.variational import tangent_flight
from vibro_sweep.engine.variational.orthonormal import watch
from vibro_sweep.tables import outcomes as status


@jit
def impact_near_graze(a, psi, v, second):
    """Speed w of the impact, 0 where there is none, and the time `late` by which the section is later than it.

    Seen from the stop that is hit: psi is how far x1 lies beyond it, v the velocity towards it and a < 0 the
    acceleration, all at the section.
    """
    # (34): w^2 = -2 a psi [+ v^2]
    square = -2.0 * a * psi + (v * v if second else 0.0)
    if not (square > 0.0 and a < 0.0):
        return 0.0, 0.0
    w = math.sqrt(square)
    # (33): late = [(w - v)/a]
    return w, (w - v) / a if second else 0.0


@jit
def impact_slopes(a, psi, v, w, late, second, da, d_psi, dv):
    """Derivatives of `w` and `late` in a direction in which a, psi and v have the derivatives da, d_psi and dv."""
    dw = ((v * dv if second else 0.0) - psi * da) / w - a / w * d_psi
    return dw, (dw - dv - late * da) / a if second else 0.0


@jit
def map_period(f, stops, o, records, t, second):
    """One iteration of P, of first or second order; the section is the phase of the right graze. Returns a status."""
    q, half, states = f.oscillator[0], f.oscillator[0].cells // 2, 2 * len(o.c)
    o.events = 0
    for side in (1.0, -1.0):
        if t.wanted:
            tangent_flight.fly_to(t, o.lane, q, f.nodes, 0 if side > 0.0 else half, 0.0)
        b, R = wall_of(stops, side)
        w, late = meet_stop(q, q.graze, b, R, side, o.X, second, o.y, t.before, t.after, t.wanted)
        if w > 0.0:  # (41)
            count_impact(o, side, w)
            log_impact(o, records, 0 if side > 0.0 else half, 0.0, side, side * w, o.X)
            strike(q, R, side, w, late, o.X, o.c)
            if t.wanted:
                turn_vectors(q, o, t, second)
        fly_half(f.nodes[half].E, q.graze, side, o.X, o.y)
    total = 0.0
    for i in range(states):
        total += o.X[i]
    return status.OK if math.isfinite(total) else status.NOT_FINITE


@exported
def iterate_one(f, stops, graze, X, J, d, c, p, r, second):
    """One iteration of P on a state X (2 N,), and J (2 N, 2 N), the derivatives of it by something, to those after it.

    graze (2 N,): X*; d, p, r (2 N,) and c (N, 3): scratch.
    """
    q, half = f.oscillator[0], f.oscillator[0].cells // 2
    for side in (1.0, -1.0):
        b, R = wall_of(stops, side)
        w, late = meet_stop(q, graze, b, R, side, X, second, d, p, r, True)
        if w > 0.0:
            strike(q, R, side, w, late, X, c)
            for j in range(len(graze)):
                kick, shift = 0.0, 0.0
                for i in range(len(graze)):
                    kick += p[i] * J[i, j]
                    shift += r[i] * J[i, j]
                for m in range(len(c)):
                    J[2 * m, j] += c[m, 0] * kick - c[m, 1] * shift
                    J[2 * m + 1, j] += c[m, 1] * kick - c[m, 2] * shift
        E = f.nodes[half].E
        fly_half(E, graze, side, X, d)
        for j in range(len(graze)):
            for i in range(len(graze)):
                d[i] = J[i, j]
            for i in range(len(graze)):
                J[i, j] = 0.0
                for k in range(len(graze)):
                    J[i, j] += E[k, i] * d[k]


@jit
def wall_of(stops, side):
    """How far a stop is from the middle, infinite where there is none, and its R."""
    return (stops.right, stops.R_right) if side > 0.0 else (-stops.left, stops.R_left)


@jit
def fly_half(E, graze, side, X, d):
    """Phi_{T/2} from the side's graze to the other's: X -> -X* + L (X - X*). d (2 N,): scratch."""
    states = len(graze)
    for i in range(states):
        d[i] = X[i] - side * graze[i]
    for i in range(states):
        total = E[0, i] * d[0] + E[1, i] * d[1]
        for j in range(2, states, 2):
            total = total + (E[j, i] * d[j] + E[j + 1, i] * d[j + 1])
        X[i] = total - side * graze[i]


@jit
def meet_stop(q, graze, b, R, side, X, second, d, p, r, slopes):
    """Speed w of the impact of X on the right stop (side +1) or the left one (-1), and `late`, as `impact_near_graze`
    has them; where `slopes` are wanted p and r (2 N,) are the gradients. d (2 N,): scratch."""
    states = len(graze)
    if not b < np.inf:
        return 0.0, 0.0
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
    if w == 0.0 or not slopes:
        return w, late
    for i in range(states):
        da = q.force[i] if second else 0.0
        d_psi, dv = 1.0 if i == 0 else 0.0, 1.0 if i == 1 else 0.0
        dw, d_late = impact_slopes(a, psi, v1, w, late, second, da, d_psi, dv)
        p[i], r[i] = -(1.0 + R) * dw, -(1.0 + R) * w * d_late
    return w, late


@jit
def strike(q, R, side, w, late, X, c):
    """(38), (39): X -> X - (1 + R) w e^{-A t} e_v. c (N, 3): gets e^{-A t} e_v."""
    set_impulse(q, -late, c)
    push = -(1.0 + R) * w
    for m in range(len(c)):
        X[2 * m] += side * push * c[m, 0]
        X[2 * m + 1] += side * push * c[m, 1]


@jit
def set_impulse(q, u, c):
    """e^{A u} e_v: the free motion at time u from a unit impulse on the gap. c (N, 3): x, v and a of each mass.

    In the plane j of points/frame.py, with the vectors e1 = (A e2 + eta e2)/g and e2, it begins with p e1 + w e2.
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
def turn_vectors(q, o, t, second):
    """Tangent vectors across a jump, with the gradients in `t.before` and `t.after`."""
    p, r, c, states = t.before, t.after, o.c, 2 * len(o.c)
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
