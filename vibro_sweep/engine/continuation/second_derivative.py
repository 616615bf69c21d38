"""The derivative of the linearised equations along a null vector: gradients of all conditions are made of it.

The equations (residual.py) are linear in y and D except through phases. For a right vector v and a left one w,
psi = (alpha, beta, lambda) on the rows of an event and of its flight, w.(D_u J) v is, with Delta = phi_v,i+1 - phi_v,i,
kappa = Delta/omega, and ds = (dphi_i+1 - dphi_i)/omega - s d omega/omega,

    alpha (S_1'' phi_v dphi + dS_1' phi_v) + beta ((1 + R) (S_v'' phi_v dphi + dS_v' phi_v) + dR v_v)
    - lambda.(A E y_v) ds - lambda.E_p y_v + kappa lambda.(y1. d omega/omega)
    - kappa lambda.(A (E (dy + e_v dD) + y1. ds + E_p (y + D e_v, 1)) + A_p (y1, 1))
"""

from vibro_sweep.engine.continuation.lasting_derivative import differentiate_last
from vibro_sweep.engine.continuation.moving_flow import OMEGA, ONE_PLUS_R_HIGH, ONE_PLUS_R_LOW
from vibro_sweep.engine.simd.jit import small


@small
def differentiate(f, c, place, b, mu):
    """`events.slopes` by (xi, dphi, dD) and `work.slopes_p` by the parameters, for `events.v` and `events.w`; complex.

    mu : by which v grows from period to period

    `work.missed`: while flights miss the next state by r, G(mu) lacks A r phi_v/omega of the matrix that is
    differentiated here; times w, the sum of these, which Newton's method needs.
    """
    K, n = len(b.events), f.A.shape[0]
    for i in range(K):
        slopes = b.events[i].slopes
        for r in range(n + 2):
            slopes[r] = 0.0
    for j in range(3):
        b.work[0].slopes_p[j] = 0.0
    b.work[0].defect = 0.0
    for i in range(K):
        differentiate_event(f, c, place, b, i)
        differentiate_flight(f, c, place, b, i, mu)


@small
def differentiate_event(f, c, place, b, i):
    """Add the terms of rows 1 and 2 of an impact, and of row 1 of an event that lasts."""
    n, N, e, slopes_p = f.A.shape[0], f.A.shape[0] // 2, b.events[i], b.work[0].slopes_p
    one_plus_R = ONE_PLUS_R_HIGH if c.sides[i] > 0 else ONE_PLUS_R_LOW
    R1, alpha, beta, phi_v = f.numbers[one_plus_R], e.w[0], e.w[1], e.v[n]
    if c.rests[i]:
        beta = 0j
    e.slopes[n] -= phi_v * (alpha * (f.Z[0] * e.turn).real + beta * R1 * (f.Z[N] * e.turn).real)
    speed_v = e.v[N] + phi_v * (e.rate[N] + (1j * f.Z[N] * e.turn).real)
    for j in range(f.parameters):
        gap, speed = (1j * f.Z_slopes[j, 0] * e.turn).real, (1j * f.Z_slopes[j, N] * e.turn).real
        slopes_p[j] += phi_v * (alpha * gap + beta * R1 * speed) + beta * f.number_slopes[j, one_plus_R] * speed_v


@small
def differentiate_flight(f, c, place, b, i, mu):
    """Add the terms of the rows of a flight, and of the event that lasts before it."""
    K, n, N, omega = len(b.events), f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA]
    e, following, work = b.events[i], b.events[i + 1 if i + 1 < K else 0], b.work[0]
    y, Ey, by_state, through = work.along[0], work.along[1], work.along[2], work.along[3]
    delta, begin = following.v[n] if i + 1 < K else mu * following.v[n], e.v[n]
    if c.rests[i]:
        begin += e.v[n + 1]
        turn_carry(f, e)
        for r in range(n):
            y[r] = 0j
            for k in range(n + 2):
                y[r] += e.carry[r, k] * e.v[k]
    else:
        for r in range(n):
            y[r] = e.v[r] + e.rate[r] * e.v[n]
        y[N] += e.v[n + 1]
    delta -= begin
    kappa = delta / omega
    by_length, landing, defect = 0j, 0j, 0j
    for r in range(n):
        Ey[r] = 0.0
        for k in range(n):
            Ey[r] += e.E[0, r, k] * y[k]
    for k in range(n):
        by_state[k] = 0.0
        for r in range(n):
            by_state[k] += e.w[2 + r] * f.A[r, k]
        by_length -= by_state[k] * (Ey[k] + delta * e.landing_rate[k])
        landing += e.w[2 + k] * omega * e.landing_rate[k]
        defect += by_state[k] * e.defect[k]
    work.defect += defect * (delta + begin) / omega
    by_phase = 0j
    for k in range(n):
        through[k] = 0.0
        for r in range(n):
            through[k] += by_state[r] * e.E[0, r, k]
        if not c.rests[i]:
            e.slopes[k] -= kappa * through[k]
            by_phase -= kappa * through[k] * e.rate[k]
    if c.rests[i]:
        take_through(f, e, kappa, work)
        e.slopes[n] -= by_length / omega
        e.slopes[n + 1] -= by_length / omega
        differentiate_last(f, c.compliant, c.sides[i], place.x[i], e, work.along[4], work)
    else:
        e.slopes[n + 1] -= kappa * through[N]
        e.slopes[n] += by_phase - by_length / omega
    following.slopes[n] += by_length / omega
    length = e.length
    for j in range(f.parameters):
        d_omega = f.number_slopes[j, OMEGA]
        total = d_omega / omega * (landing * kappa - by_length * length)
        if f.moves[j] > 0:
            for r in range(n):
                lin, moved = 0j, e.E[1 + j, r, n]
                for k in range(n):
                    lin += e.E[1 + j, r, k] * y[k]
                    moved += e.E[1 + j, r, k] * e.after[k]
                total -= e.w[2 + r] * lin + kappa * by_state[r] * moved
        for r in range(n):
            rate = f.A_slopes[j, r, n]
            for k in range(n):
                rate += f.A_slopes[j, r, k] * e.landing[k]
            total -= kappa * e.w[2 + r] * rate
        work.slopes_p[j] += total


@small
def turn_carry(f, e):
    """`carry` becomes the change of y itself after an event that lasts: xi and y' (dphi + ds)."""
    n = f.A.shape[0]
    for r in range(n):
        rate = 0.0
        for k in range(n + 1):
            rate += f.A[r, k] * e.after[k] / f.numbers[OMEGA]
        e.carry[r, n] += rate
        e.carry[r, n + 1] += rate


@small
def take_through(f, e, kappa, work):
    """Add what a flight of another length makes of changes of the state after an event that lasts; `along[4]`: -w E."""
    n, through, back = f.A.shape[0], work.along[3], work.along[4]
    for r in range(n):
        for k in range(n + 2):
            e.slopes[k] -= kappa * through[r] * e.carry[r, k]
        for j in range(f.parameters):
            work.slopes_p[j] -= kappa * through[r] * e.carry[r, n + 2 + j]
        back[r] = 0j
        for k in range(n):
            back[r] -= e.w[2 + k] * e.E[0, k, r]
