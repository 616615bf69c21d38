"""Points of plain oscillators, one after the other in a kernel.

An oscillator is plain where its mass matrix is diagonal, springs hold every mode, damping is classical, no mode is in
resonance without damping, no rate is far from that of the force, and states are measured from 0. Its points are those
of `any_points` but for last digits, at a tenth of the time. By its modes,

    psi_j^T M psi_k = delta_jk,    psi_j^T K psi_j = omega_j^2,    psi_j^T C psi_j = 2 eta_j            (eq. 5),

the steady motion is the sum of eq. (7), the frame of tangent vectors that of the psi_j themselves.
"""

import functools
import math

import numpy as np

from vibro_sweep.engine.points.frame import CLASSICAL, LEAST_SCALE, SLOWEST
from vibro_sweep.engine.points.invariant_planes import UNOBSERVABLE
from vibro_sweep.engine.points.metric import ROUNDING
from vibro_sweep.engine.points.symmetric import diagonalise, factorise, solve
from vibro_sweep.engine.simd.jit import exported, jit

APART = 8.0  # a rate over that of the force from which on tables are computed in twice the digits, where squares of
UNEVEN = 1e-4  # natural frequencies lie farther apart than this, or masses have other coordinates
FASTEST = 16.0  # rate over that of the force, and
SLOWEST_SQUARE = 1e-10  # square of a natural frequency over that of the force, beyond which an oscillator is not plain
IN_RESONANCE = 1e-10  # of omega_j^2 + omega^2: a dynamic stiffness below which it is not


@functools.cache
def machine_of(masses: int) -> np.dtype:
    """The numbers of an oscillator: the fields `MOTION` of `Linear`, in their order."""
    n = masses
    fields = [("M", (n, n)), ("K", (n, n)), ("C", (n, n)), ("normal", (n,)), ("omega", ()), ("constant", (n,))]
    return np.dtype([(name, float, shape) for name, shape in [*fields, ("sine", (n,)), ("cosine", (n,)), ("tau", ())]])


@functools.cache
def modes_of(masses: int) -> np.dtype:
    """What a point is set up from: modes, of which each column of a matrix is one, and room for sums."""
    n = masses
    fields = [
        ("K", (n, n)),  # in the metric of the masses, as C
        ("C", (n, n)),
        ("A", (n, n)),  # scratch
        ("V", (n, n)),  # eigenvectors
        ("shape", (n, n)),  # psi_j
        ("square", (n,)),  # omega_j^2, and
        ("square_error", (n,)),  # what rounding leaves of it
        ("damping", (n,)),  # 2 eta_j, and
        ("damping_error", (n,)),
        ("order", (n,)),  # of planes in the frame: which mode each is
        ("steady", (2, n)),  # a and b of the steady motion a sin(omega t + tau) + b cos(omega t + tau),
        ("turning", (2, n)),  # real and imaginary part of the same at t = 0, and
        ("left", (2, n)),  # force that is left beside it
        ("rest", (n,)),  # the state at which the constant force is balanced
        ("compliance", (n,)),  # K^-1 n
        ("row", (n,)),  # scratch
    ]
    return np.dtype([(name, float, shape) for name, shape in fields])


@exported
def set_plain_points(machines, points, known, modes, frames):
    """Fill the points (m,) of oscillators (m,) that are plain, all but stops and cells; known (m,): whether each is.

    frames : whether tangent vectors are wanted; modes (1,): scratch
    """
    w = modes[0]
    for i in range(len(machines)):
        q, p = machines[i], points[i]
        known[i] = has_modes(q, w) and set_rate(q, p, w)
        if known[i]:
            set_coordinates(q, p)
            set_equations(q, p, w)
            known[i] = set_constrained(q, p, w) and set_steady(q, p, w)
        if known[i] and frames:
            set_frame(q, p, w)


@jit
def has_modes(q, w):
    """Fill the modes of an oscillator. Returns whether its masses are diagonal, springs hold all, and damping is
    classical."""
    n, K_size, C_size = len(q.M), 0.0, 0.0
    for i in range(n):
        if not 0.0 < q.M[i, i] < np.inf:
            return False
        for j in range(n):
            if i != j and q.M[i, j] != 0.0:
                return False
            scale = 1.0 / (math.sqrt(q.M[i, i]) * math.sqrt(q.M[j, j]))
            w.K[i, j], w.C[i, j] = q.K[i, j] * scale, q.C[i, j] * scale
            K_size, C_size = max(K_size, abs(w.K[i, j])), max(C_size, abs(w.C[i, j]))
    if not 0.0 < K_size < np.inf or not C_size < np.inf:
        return False
    C_size = C_size if C_size > 0.0 else 1.0
    for i in range(n):
        for j in range(n):  # of modes with one frequency those that dampers part
            w.A[i, j] = (w.K[i, j] + w.K[j, i]) / K_size + 0.618 * (w.C[i, j] + w.C[j, i]) / C_size
    if not diagonalise(w.A, w.V):
        return False
    for i in range(n):
        for j in range(n):
            w.shape[i, j] = w.V[i, j] / math.sqrt(q.M[i, i])
    springs = are_parted(w.K, K_size, w, w.square, w.square_error)
    return are_parted(w.C, C_size, w, w.damping, w.damping_error) and springs


@jit
def are_parted(matrix, size, w, part, error):
    """The parts V_j^T matrix V_j, zero where that is rounding, and their errors. Returns whether V_i^T matrix V_j is
    rounding where j is not i."""
    n, V, row = len(matrix), w.V, w.row
    parted = True
    for j in range(n):
        left, terms = 0.0, 0.0
        for i in range(n):
            row[i], sizes = 0.0, 0.0
            for k in range(n):
                row[i] += matrix[i, k] * V[k, j]
                sizes += abs(matrix[i, k] * V[k, j])
            left += row[i] * row[i]
            terms += abs(V[i, j]) * sizes
        rounding = ROUNDING * n * (terms + ROUNDING * size)
        for k in range(n):
            total = 0.0
            for i in range(n):
                total += V[i, k] * row[i]
            if k == j:
                part[j] = total if total > rounding else 0.0
            else:
                parted = parted and abs(total) <= CLASSICAL * n * size
        error[j] = rounding if part[j] > 0.0 else min(rounding, 4.0 * math.sqrt(left))
    return parted


@jit
def set_rate(q, p, w):
    """The rates of a point. Returns whether they, and natural frequencies, are near enough to that of the force."""
    omega, fastest, slowest, damping = q.omega, 0.0, np.inf, 0.0
    for j in range(len(w.square)):
        fastest, slowest = max(fastest, rate_of(w.square[j], w.damping[j])), min(slowest, w.square[j])
        damping = max(damping, w.damping[j])
    p.omega, p.tau, p.rate = omega, q.tau, fastest
    # what holds a mass takes stiffness and damping of all motion that is left from between those of the modes
    p.constrained_rate = max(fastest, rate_of(slowest, damping))
    p.rounding = 0.0
    even = fastest <= APART * omega or slowest >= UNEVEN * fastest * fastest
    return even and fastest <= FASTEST * omega and slowest > SLOWEST_SQUARE * omega * omega


@jit
def rate_of(square, damping):
    """The larger |root| of s^2 + damping s + square."""
    half = 0.5 * damping
    return math.sqrt(square) if half * half <= square else half + math.sqrt(half * half - square)


@jit
def set_coordinates(q, p):
    """P and its inverse: the gap, and the masses but the one that is held least (contact.py)."""
    n, spare, least = len(q.M), 0, np.inf
    for i in range(n):
        if q.normal[i] != 0.0:
            held = (abs(q.K[i, i]) + q.omega * abs(q.C[i, i]) + q.omega * q.omega * abs(q.M[i, i])) / q.normal[i]
            held = held / q.normal[i]
            if held < least:
                spare, least = i, held
    along = 0.0
    for i in range(n):
        along += q.normal[i] * q.normal[i] / q.M[i, i]
        for j in range(n):
            p.P[i, j] = p.back[i, j] = 0.0
    row = 1
    for j in range(n):
        p.P[0, j] = q.normal[j]
        if j != spare:
            p.P[row, j] = p.back[j, row] = 1.0
            p.back[spare, row] = 0.0 - q.normal[j] / q.normal[spare]
            p.push[row] = q.normal[j] / q.M[j, j] / along
            row += 1
    p.back[spare, 0], p.push[0] = 1.0 / q.normal[spare], 1.0
    p.turned = False
    for i in range(n):
        p.origin[i] = 0.0
        for j in range(n):
            p.turned = p.turned or p.P[i, j] != (1.0 if i == j else 0.0)


@jit
def set_equations(q, p, w):
    """q'' + damping q' + stiffness q = force (sin, cos, 1)."""
    n = len(q.M)
    p.divergence = 0.0
    into_contact(q, p, q.K, w.A, p.stiffness)
    into_contact(q, p, q.C, w.A, p.damping)
    for i in range(n):
        p.divergence -= p.damping[i, i]
        sin = cos = one = 0.0
        for k in range(n):
            if p.P[i, k] != 0.0:
                share = p.P[i, k] / q.M[k, k]
                sin += share * q.sine[k]
                cos += share * q.cosine[k]
                one += share * q.constant[k]
        p.force[i, 0], p.force[i, 1], p.force[i, 2] = sin, cos, one


@jit
def into_contact(q, p, matrix, scratch, out):
    """P M^-1 matrix P^-1."""
    n = len(matrix)
    for i in range(n):
        for j in range(n):
            scratch[i, j] = 0.0
            for k in range(n):
                scratch[i, j] += matrix[i, k] * p.back[k, j]
            scratch[i, j] /= q.M[i, i]
    for i in range(n):
        for j in range(n):
            out[i, j] = 0.0
            for k in range(n):
                out[i, j] += p.P[i, k] * scratch[k, j]


@jit
def set_constrained(q, p, w):
    """q'' as a function of (q, q', sin, cos, 1) while a stop holds the gap. Returns whether it could be found."""
    n, A, row = len(q.M), w.A, w.row
    for i in range(1, n):
        for j in range(1, n):
            A[i - 1, j - 1] = 0.0
            for k in range(n):
                A[i - 1, j - 1] += p.back[k, i] * q.M[k, k] * p.back[k, j]
    if not factorise(A, n - 1):
        return False
    for j in range(2 * n + 3):
        p.constrained[0, j] = 0.0
        for i in range(1, n):
            row[i - 1] = 0.0
            for k in range(n):
                row[i - 1] += p.back[k, i] * free_force(q, p, k, j)
        solve(A, n - 1, row)
        for i in range(1, n):
            p.constrained[i, j] = row[i - 1]
    return True


@jit
def free_force(q, p, k, j):
    """The force on mass k for a unit of number j of (q, q', sin, cos, 1)."""
    n, total = len(q.M), 0.0
    if j < n:
        for i in range(n):
            total -= q.K[k, i] * p.back[i, j]
    elif j < 2 * n:
        for i in range(n):
            total -= q.C[k, i] * p.back[i, j - n]
    elif j == 2 * n:
        total = q.sine[k]
    else:
        total = q.cosine[k] if j == 2 * n + 1 else q.constant[k]
    return total


@jit
def set_steady(q, p, w):
    """How far from its steady motion the oscillator may be and reach no stop (confinement.py). Returns whether springs
    hold all, and no mode is in resonance."""
    n, omega, sin, cos = len(q.M), q.omega, math.sin(q.tau), math.cos(q.tau)
    for i in range(n):
        w.rest[i], w.compliance[i], w.steady[0, i], w.steady[1, i] = q.constant[i], q.normal[i], 0.0, 0.0
        for j in range(n):
            w.A[i, j] = q.K[i, j]
    if not factorise(w.A, n) or is_resonant(q, w):
        return False
    solve(w.A, n, w.rest)
    solve(w.A, n, w.compliance)
    for _ in range(2):  # once more for what rounding has left
        add_steady(q, w)
    for i in range(n):  # x = Re(turning e^{i omega t})
        a, b = w.steady[0, i], w.steady[1, i]
        w.turning[0, i], w.turning[1, i] = a * sin + b * cos, b * sin - a * cos
    real = imaginary = compliance = p.middle = 0.0
    for i in range(n):
        real += q.normal[i] * w.turning[0, i]
        imaginary += q.normal[i] * w.turning[1, i]
        compliance += q.normal[i] * w.compliance[i]
        p.middle += q.normal[i] * w.rest[i]
    p.swing = math.hypot(real, imaginary)
    for i in range(n):
        p.steady[2 * i] = p.steady[2 * i + 1] = 0.0
        for k in range(n):
            p.steady[2 * i] += p.P[i, k] * (w.turning[0, k] + w.rest[k])
            p.steady[2 * i + 1] -= p.P[i, k] * omega * w.turning[1, k]
        for j in range(n):
            stiffness = mass = 0.0
            for k in range(n):
                mass += p.back[k, i] * q.M[k, k] * p.back[k, j]
                for m in range(n):
                    stiffness += p.back[k, i] * q.K[k, m] * p.back[m, j]
            p.confining[2 * i, 2 * j], p.confining[2 * i + 1, 2 * j + 1] = compliance * stiffness, compliance * mass
            p.confining[2 * i, 2 * j + 1] = p.confining[2 * i + 1, 2 * j] = 0.0
    return True


@jit
def is_resonant(q, w):
    """Whether the force has the frequency of a mode that nothing damps, or nearly."""
    for j in range(len(w.square)):
        stiffness = math.hypot(w.square[j] - q.omega * q.omega, w.damping[j] * q.omega)
        if stiffness <= IN_RESONANCE * (w.square[j] + q.omega * q.omega):
            return True
    return False


@jit
def add_steady(q, w):
    """Add to the steady motion a sin + b cos what balances the force that is left beside it."""
    n, omega, a, b = len(q.M), q.omega, w.steady[0], w.steady[1]
    for i in range(n):
        w.left[0, i] = q.sine[i] + omega * omega * q.M[i, i] * a[i]
        w.left[1, i] = q.cosine[i] + omega * omega * q.M[i, i] * b[i]
        for k in range(n):
            w.left[0, i] -= q.K[i, k] * a[k] - omega * q.C[i, k] * b[k]
            w.left[1, i] -= q.K[i, k] * b[k] + omega * q.C[i, k] * a[k]
    for j in range(n):
        # (7): xi = A_j sin + B_j cos, for a force of sine and of cosine
        detuning, damping = w.square[j] - omega * omega, w.damping[j] * omega
        size = detuning * detuning + damping * damping
        sine = cosine = 0.0
        for i in range(n):
            sine += w.shape[i, j] * w.left[0, i]
            cosine += w.shape[i, j] * w.left[1, i]
        A, B = (detuning * sine + damping * cosine) / size, (detuning * cosine - damping * sine) / size
        for i in range(n):
            a[i] += w.shape[i, j] * A
            b[i] += w.shape[i, j] * B


@jit
def set_frame(q, p, w):
    """The frame of tangent vectors (frame.py): each mode is a plane, those that the contact does not see come first."""
    n, effective, first = len(q.M), 0.0, 0
    for i in range(n):
        effective += q.normal[i] * q.normal[i] / q.M[i, i]
    for seen in range(2):
        for j in range(n):
            share = 0.0
            for i in range(n):
                share += q.normal[i] * w.shape[i, j]
            if (abs(share) / math.sqrt(effective) > UNOBSERVABLE) == (seen == 1):
                w.order[first] = j
                first += 1
    for i in range(2 * n):
        for j in range(2 * n):
            p.to_frame[i, j] = p.from_frame[i, j] = 0.0
    for m in range(n):
        j = int(w.order[m])
        eta = 0.5 * w.damping[j]
        square = w.square[j] - eta * eta
        scale = max(math.sqrt(abs(square)), LEAST_SCALE * math.sqrt(w.square[j]))
        scale = scale if scale > SLOWEST * q.omega else q.omega
        p.frame_eta[m], p.frame_square[m], p.frame_scale[m] = eta, square, scale
        p.rounding = max(p.rounding, moved(eta, square, 0.5 * w.damping_error[j], w.square_error[j]))
        for i in range(n):
            shape = dual = 0.0
            for k in range(n):
                shape += p.P[i, k] * w.shape[k, j]
                dual += p.back[k, i] * q.M[k, k] * w.shape[k, j]
            p.to_frame[2 * m, 2 * i], p.to_frame[2 * m + 1, 2 * i] = scale * dual, eta * dual
            p.to_frame[2 * m + 1, 2 * i + 1] = dual
            p.from_frame[2 * i, 2 * m], p.from_frame[2 * i + 1, 2 * m] = shape / scale, -eta * shape / scale
            p.from_frame[2 * i + 1, 2 * m + 1] = shape


@jit
def moved(eta, square, of_eta, of_product):
    """The distance by which rounding of eta and of eta^2 + square moves the roots -eta +- sqrt(-square) along the real
    axis."""
    apart = math.sqrt(max(-square, 0.0))
    more = max(2.0 * eta * of_eta + of_product - max(square, 0.0), 0.0)  # of apart^2
    return of_eta + more / (apart + math.sqrt(apart * apart + more)) if more > 0.0 else of_eta
