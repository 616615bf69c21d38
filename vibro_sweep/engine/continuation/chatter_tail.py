"""The end of a chatter sequence as an event, at the onset of sticking: infinitely many impacts in one term.

Impact 1 is the end of the sequence. It has no jump, and since its gap follows from that at the last impact that is
written out, acceleration = 0 stands in place of it. What the impacts after that one do is the sum Q of
chatter_sum.py, in the closure: y_{K+1} + sigma Q = sigma y_1.
"""

from vibro_sweep.engine.continuation.chatter_sum import sum_chatter
from vibro_sweep.engine.continuation.moving_flow import OMEGA
from vibro_sweep.engine.simd.jit import small


@small
def end_of_chatter(f, x, e, panel):
    """Row n of the panel: no acceleration of the gap."""
    n, N, omega = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA]
    p, F, i = 3 * n + 2, 3 * n + 2 + f.parameters, n
    panel[i, n] = -(omega * f.Z[N] * e.turn).real
    for c in range(n):
        panel[i, c] = f.A[N, c]
        panel[i, n] += f.A[N, c] * e.rate[c]
    panel[i, F] = e.motion[1]
    for j in range(f.parameters):
        turning = 1j * (f.number_slopes[j, OMEGA] * f.Z[N] + omega * f.Z_slopes[j, N])
        panel[i, p + j] = (turning * e.turn).real + f.A_slopes[j, N, n]
        for c in range(n):
            panel[i, p + j] += f.A_slopes[j, N, c] * x[c]


@small
def sum_tail(f, c, place, b):
    """Q, of the sequence that follows the last flight, with its derivatives."""
    first, rate, last = b.events[0], b.work[0].rate, b.events[len(b.events) - 1]
    for r in range(len(rate)):
        rate[r] = f.numbers[OMEGA] * first.rate[r]
    sum_chatter(f, c.sides[0], 0.0, rate, place.x[0], first.turn, last.length, b.tail[0])


@small
def put_tail(f, c, place, b, panel):
    """Add Q to the rows of the last flight.

    Q depends on y_1, phi_1, the length and the parameters. dphi_1 is eliminated by then, so that it is taken from the
    row of acceleration = 0: alpha xi_1 + beta dphi_1 + gamma dp + a = 0. `tail.by_end`: how much of that row the others
    have taken.
    """
    n, first, tail, omega = f.A.shape[0], b.events[0], b.tail[0], f.numbers[OMEGA]
    X, p, F, V = 2 * n + 2, 3 * n + 2, 3 * n + 2 + f.parameters, n + 4  # V: of Q by the length
    line, length = b.work[0].line, b.events[len(b.events) - 1].length
    for j in range(F + 1):
        line[j] = 0.0
    beta = -(omega * f.Z[n // 2] * first.turn).real
    for k in range(n):
        line[X + k] = f.A[n // 2, k]
        beta += f.A[n // 2, k] * first.rate[k]
    line[F] = first.motion[1]
    for j in range(f.parameters):
        turning = 1j * (f.number_slopes[j, OMEGA] * f.Z[n // 2] + omega * f.Z_slopes[j, n // 2])
        line[p + j] = (turning * first.turn).real + f.A_slopes[j, n // 2, n]
        for k in range(n):
            line[p + j] += f.A_slopes[j, n // 2, k] * place.x[0, k]
    Q = tail.Q
    for r in range(n):
        i, by_phase = n + 2 + r, -(Q[r, n + 1] + Q[r, V]) / omega
        for k in range(n):
            by_phase += f.A[r, k] * Q[k, 0] / omega - Q[r, 1 + k] * first.rate[k]
        by_phase *= c.sigma
        panel[i, n] += c.sigma * Q[r, V] / omega
        panel[i, F] -= c.sigma * Q[r, 0]
        for k in range(n):
            panel[i, X + k] -= c.sigma * Q[r, 1 + k]
        for j in range(f.parameters):
            panel[i, p + j] -= c.sigma * (Q[r, n + 2 + j] - Q[r, V] * length / omega * f.number_slopes[j, OMEGA])
        tail.by_end[r] = by_phase / beta
        for j in range(X, F + 1):
            panel[i, j] -= tail.by_end[r] * line[j]
