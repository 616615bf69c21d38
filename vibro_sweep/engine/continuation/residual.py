"""The equations of a periodic orbit as a sequence of events, and their elimination event by event.

The phase phi = omega t + tau is the independent variable, and the steady motion S = Re(Z e^{i phi}) is taken out: in
contact coordinates z = y + S, and y' = A (y, 1) knows the constant force alone. Event i has the unknowns y_i, phi_i and
its velocity jump D_i, two rows, and the flight after it; s_i = (phi_{i+1} - phi_i)/omega:

    impact: gap_i = stop_i, D_i + (1 + R_i) v_i = 0        watched: v_i = 0, D_i = 0
    y_{i+1} = E(s_i) (y_i + D_i e_v, 1)                    y_{K+1} = sigma y_1, phi_{K+1} = phi_1 + pi half_periods

Newton's changes are (xi_i, dphi_i, dD_i) with dy_i = xi_i + y'_i dphi_i, so that only neighbours are coupled:

    xi_{i+1} = E_i (xi_i + e_v dD_i - rho_i dphi_i) - s_i y'_{i+1} d omega + E_p (y_i + D_i e_v, 1) dp
    rho_i = A e_v D_i/omega

Reflections eliminate xi_i, dphi_i and dD_i; xi_1 and the parameters stay to the end, where `ahead` and `behind` are
left of xi_{K+1} and xi_1: G(mu) = sigma mu ahead + behind is singular where the orbit has the multiplier mu. Nothing is
singular at D = 0, a graze, and the cost grows like K.
"""

import cmath
import math

from vibro_sweep.engine.continuation.chatter_tail import end_of_chatter, put_tail
from vibro_sweep.engine.continuation.flight_tables import flight
from vibro_sweep.engine.continuation.lasting import corner_of, is_watched, leaves_at_stop
from vibro_sweep.engine.continuation.lasting_event import last, put_lasting
from vibro_sweep.engine.continuation.moving_flow import HIGH, LOW, OMEGA, ONE_PLUS_R_HIGH, ONE_PLUS_R_LOW
from vibro_sweep.engine.continuation.problem import STICK, width_of
from vibro_sweep.engine.continuation.reflections import copy_row, reflect
from vibro_sweep.engine.impulses.taylor_orders import ORDER
from vibro_sweep.engine.simd.jit import jit

SHORT = 1 / 16  # of a cell: a flight of which only what changes is summed up
IMPACT, WATCHED, END, REST = range(4)  # laws of events; END: of a chatter sequence at the onset of sticking


@jit
def approach(f, x, e):
    """The motion before an event."""
    n, N, omega = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA]
    e.turn = cmath.exp(1j * x[n])
    for r in range(n):
        total = f.A[r, n]
        for c in range(n):
            total += f.A[r, c] * x[c]
        e.rate[r] = total / omega
    e.gap = x[0] + (f.Z[0] * e.turn).real
    e.motion[0] = x[N] + (f.Z[N] * e.turn).real
    e.motion[1] = omega * e.rate[N] + (1j * omega * f.Z[N] * e.turn).real


@jit
def put_rows(f, law, side, corner, x, e, panel):
    """Rows n and n + 1 of the panel: those of the event itself. corner: as of `corner_of`, else 0.0."""
    n, N, omega = f.A.shape[0], f.A.shape[0] // 2, f.numbers[OMEGA]
    p, F, first, second = 3 * n + 2, 3 * n + 2 + f.parameters, n, n + 1
    stop, one_plus_R = (HIGH, ONE_PLUS_R_HIGH) if side > 0 else (LOW, ONE_PLUS_R_LOW)
    v, a = e.motion[0], e.motion[1]
    if law == IMPACT or law == REST:
        panel[first, 0], panel[first, n] = 1.0, v / omega
        panel[first, F] = e.gap - f.numbers[stop]
        for j in range(f.parameters):
            panel[first, p + j] = (f.Z_slopes[j, 0] * e.turn).real - f.number_slopes[j, stop]
        if law == REST:
            return
    speed = second if law != WATCHED else first  # the row that knows the velocity, and how much of it
    weight = f.numbers[one_plus_R] if law != WATCHED else 1.0
    panel[speed, N], panel[speed, n] = weight, weight * a / omega
    panel[speed, F] = weight * v
    panel[second, n + 1] = 1.0  # D
    panel[second, F] += x[n + 1]
    for j in range(f.parameters):
        panel[speed, p + j] = weight * (f.Z_slopes[j, N] * e.turn).real
        if law != WATCHED:
            panel[speed, p + j] += f.number_slopes[j, one_plus_R] * v
    if corner > 0.0:  # D = -c (gap - stop)
        panel[second, 0], panel[second, n] = corner, corner * v / omega
        panel[second, F] += corner * (e.gap - f.numbers[stop])
        for j in range(f.parameters):
            panel[second, p + j] += corner * ((f.Z_slopes[j, 0] * e.turn).real - f.number_slopes[j, stop])
    if law == END:
        end_of_chatter(f, x, e, panel)


@jit
def leave(f, c, i, x, e, work):
    """The state after event i, and what it does to changes of the state."""
    n, N = f.A.shape[0], f.A.shape[0] // 2
    if c.rests[i] and not is_watched(f, c, i):
        last(f, c.compliant, c.sides[i], x, e, work)
        for r in range(n):
            e.bend[r] = 0.0  # where it is only watched, without length
        return
    for r in range(n):
        e.after[r], e.bend[r] = x[r], f.A[r, N] * x[n + 1] / f.numbers[OMEGA]
    e.after[N] += x[n + 1]
    e.after[n] = 1.0


@jit
def fly(f, c, i, length, x, e, work):
    """Fly from event i for this time to the next event."""
    leave(f, c, i, x, e, work)
    e.length = length - x[f.A.shape[0] + 1] / f.numbers[OMEGA] if c.rests[i] else length
    flight(f, e.length, e.E, work.other)
    land(f, e)


@jit
def land(f, e):
    """The end of the flight `e.E`."""
    n, omega = f.A.shape[0], f.numbers[OMEGA]
    for r in range(n):
        total = 0.0
        for c in range(n + 1):
            total += e.E[0, r, c] * e.after[c]
        e.landing[r] = total
    for r in range(n):
        total = f.A[r, n]
        for c in range(n):
            total += f.A[r, c] * e.landing[c]
        e.landing_rate[r] = total / omega


@jit
def put_flight(f, law, e, panel):
    """The last rows of the panel: the flight, whose end is to be the next state."""
    n, N = f.A.shape[0], f.A.shape[0] // 2
    p, F = 3 * n + 2, 3 * n + 2 + f.parameters
    for r in range(n):
        i, by_phase = n + 2 + r, 0.0
        if law != REST:
            for c in range(n):
                panel[i, c] = -e.E[0, r, c]
                by_phase += e.E[0, r, c] * e.bend[c]
            panel[i, n], panel[i, n + 1] = by_phase, -e.E[0, r, N]
        panel[i, n + 2 + r], panel[i, F] = 1.0, e.defect[r]
        for j in range(f.parameters):
            panel[i, p + j] = e.length * e.landing_rate[r] * f.number_slopes[j, OMEGA]
            if f.moves[j] > 0:
                for c in range(n + 1):
                    panel[i, p + j] -= e.E[1 + j, r, c] * e.after[c]


@jit
def hold(f, panel):
    """A free mode that the contact does not see may stand anywhere: its place does not change."""
    n = f.A.shape[0]
    for r in range(n):
        for k in range(n):
            panel[n + 2 + r, 2 * n + 2 + k] += f.unseen[r, k]


@jit
def is_short(f, c, b, i):
    """Whether the flight after event i comes back to the same stop so soon that states would lose its digits."""
    same = c.sides[i] != 0.0 and c.sides[i] == c.sides[i + 1] and not (c.rests[i] or c.rests[i + 1])
    return same and not (c.kind == STICK and i == 0) and b.events[i].length < SHORT * f.width


@jit
def hardly_leaves(f, c, b, i):
    """Whether the mass leaves its stop so shortly between this contact and the next that states would lose its
    digits."""
    j = i + 1 if i + 1 < len(c.sides) else 0
    same = c.sides[j] == (c.sides[i] if j > 0 else c.sigma * c.sides[i]) and i != j
    return same and leaves_at_stop(c, i, b.events[i]) and abs(b.events[i].length) < SHORT * f.width


@jit
def grown(f, e, begin, r):
    """The growth of coordinate r in the flight after an event, of all of its motion, not formed as a difference.

    begin : e^{i phi} at its beginning
    """
    n, turned, power, total = f.A.shape[0], f.numbers[OMEGA] * e.length, 1.0, 0.0
    for k in range(1, ORDER + 1):
        power *= e.length
        for j in range(n + 1):
            total += f.series[k, r, j] * power * e.after[j]
    swing = begin * cmath.exp(0.5j * turned) * complex(0.0, 2.0 * math.sin(0.5 * turned))
    return total + (f.Z[r] * swing).real


@jit
def fly_through(f, c, place, b):
    """The motion through all events, at the parameters to which f was moved."""
    K, n = len(place.x), f.A.shape[0]
    for i in range(K):
        e, x, last = b.events[i], place.x[i], i + 1 == K
        following = place.x[0 if last else i + 1]
        length = (following[n] + (math.pi * f.half_turns if last else 0.0) - x[n]) / f.numbers[OMEGA]
        approach(f, x, e)
        fly(f, c, i, length, x, e, b.work[0])
        for r in range(n):
            e.defect[r] = (c.sigma if last else 1.0) * following[r] - e.landing[r]
    for i in range(K - 1):
        if is_short(f, c, b, i):
            e, following = b.events[i], b.events[i + 1]
            e.defect[0] = following.gap - e.gap - grown(f, e, e.turn, 0)
            e.defect[n // 2] = following.motion[0] - e.motion[0] - place.x[i, n + 1] - grown(f, e, e.turn, n // 2)
    for i in range(K):
        if hardly_leaves(f, c, b, i):
            e, j = b.events[i], i + 1 if i + 1 < K else 0
            gap = b.events[j].gap - f.numbers[HIGH if c.sides[j] > 0 else LOW]
            rise = grown(f, e, e.turn * cmath.exp(1j * place.x[i, n + 1]), 0)
            e.defect[0] = (gap if j > 0 else c.sigma * gap) - rise


@jit
def eliminate(f, c, place, b, watched):
    """Eliminate all events after `fly_through`. Sign of the determinant's part; 0.0: singular.

    watched : whether the event c.index takes part in nothing but is followed
    """
    K, n, work = len(place.x), f.A.shape[0], b.work[0]
    panel, X, width, sign = work.panel, 2 * n + 2, width_of(n, f.parameters), 1.0
    for r in range(n):  # xi_1 - xi_1 = 0
        for j in range(width):
            panel[r, j] = 0.0
        panel[r, r], panel[r, X + r] = 1.0, -1.0
    for i in range(K):
        e, x, last = b.events[i], place.x[i], i + 1 == K
        law = REST if c.rests[i] else END if c.kind == STICK and i == 0 else IMPACT
        if c.sides[i] == 0.0 or (watched and i == c.index) or is_watched(f, c, i):
            law = WATCHED
        for r in range(n, 2 * n + 2):
            for j in range(width):
                panel[r, j] = 0.0
        corner = 0.0 if watched else corner_of(f, c, i)
        put_rows(f, law, c.sides[i], corner, x, e, panel)
        put_flight(f, law, e, panel)
        if law == REST:
            put_lasting(f, e, panel)
        if last and f.has_unseen > 0:
            hold(f, panel)
        if c.kind == STICK and last:
            put_tail(f, c, place, b, panel)
        sign *= reflect(panel, width, n + 2, e.mirrors, e.scales)
        if sign == 0.0:
            return 0.0
        for r in range(n + 2):
            copy_row(panel, r, e.kept, r, width)
        for r in range(n):
            below = n + 2 + r
            for j in range(n):
                panel[r, j], panel[r, n + 2 + j] = panel[below, n + 2 + j], 0.0
            panel[r, n] = panel[r, n + 1] = 0.0
            for j in range(X, width):
                panel[r, j] = panel[below, j]
    for r in range(n):
        copy_row(panel, r, work.last, r, width)
    return sign


@jit
def follow(f, c, place, b):
    """States before all events from that before the first."""
    n = f.A.shape[0]
    for i in range(len(place.x) - 1):
        e, x, following = b.events[i], place.x[i], place.x[i + 1]
        approach(f, x, e)
        fly(f, c, i, (following[n] - x[n]) / f.numbers[OMEGA], x, e, b.work[0])
        for r in range(n):
            following[r] = e.landing[r]
