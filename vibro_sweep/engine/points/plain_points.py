"""Points of plain oscillators, one after the other in a kernel.

An oscillator is plain where damping is classical, no mode is in resonance without damping or far slower than the force,
and states are measured from 0. Its points are those of `any_points` but for last digits, at a tenth of the time; where
rates lie apart they are not in twice the digits. By its modes,

    psi_j^T M psi_k = delta_jk,    psi_j^T K psi_j = omega_j^2,    psi_j^T C psi_j = 2 eta_j            (eq. 5),

the steady motion is the sum of eq. (7), the frame of tangent vectors that of the psi_j themselves.
"""

import functools
import math

import numpy as np

from vibro_sweep.engine.points.plain_coordinates import set_constrained, set_coordinates, set_equations
from vibro_sweep.engine.points.plain_frame import set_frame
from vibro_sweep.engine.points.plain_modes import PLAIN, set_modes
from vibro_sweep.engine.points.plain_steady import set_steady
from vibro_sweep.engine.simd.jit import exported, jit

APART = 8.0  # a rate over that of the force from which on tables are computed in twice the digits, where squares of
UNEVEN = 1e-4  # natural frequencies lie farther apart than this, or masses have other coordinates
SLOWEST_SQUARE = 1e-10  # square of a natural frequency over that of the force, below which an oscillator is not plain


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
        ("mass", (n, n)),  # L D L^T, as of symmetric.py
        ("mobility", (n,)),  # M^-1 n, and
        ("along", (1,)),  # n M^-1 n
        ("K", (n, n)),  # in the metric of the masses, as C
        ("C", (n, n)),
        ("K_terms", (n, n)),  # moduli of what their numbers are sums of
        ("C_terms", (n, n)),
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
        ("back_low", (n, n)),  # of refined_equations.py
    ]
    return np.dtype([(name, float, shape) for name, shape in fields])


@exported
def set_plain_points(machines, points, known, modes, frames):
    """Fill the points (m,) of oscillators (m,) that are plain, all but stops and cells; known (m,): whether each is.

    frames : whether tangent vectors are wanted; modes (1,): scratch
    """
    w = modes[0]
    for i in range(len(machines)):
        known[i] = set_modes(machines[i], w) == PLAIN and set_plain_point(machines[i], points[i], w, frames)


@jit
def set_plain_point(q, p, w, frames):
    """Fill a point whose modes are known. Returns whether no mode is in resonance or far slower than the force."""
    own = set_coordinates(q, p, w)
    if not set_rate(q, p, w, own):
        return False
    set_equations(q, p, w)
    if not set_constrained(q, p, w) or not set_steady(q, p, w):
        return False
    if frames:
        set_frame(q, p, w)
    return True


@jit
def set_rate(q, p, w, own):
    """The rates of a point, and whether they lie apart; own: as of `set_coordinates`. Returns whether all that springs
    hold is fast enough."""
    omega, fastest, slowest, held, damping = q.omega, 0.0, np.inf, np.inf, 0.0  # slowest of all, of those that are held
    for j in range(len(w.square)):
        fastest, slowest = max(fastest, rate_of(w.square[j], w.damping[j])), min(slowest, w.square[j])
        held, damping = min(held, w.square[j] if w.square[j] > 0.0 else np.inf), max(damping, w.damping[j])
    p.omega, p.tau, p.rate = omega, q.tau, fastest
    # what holds a mass takes stiffness and damping of all motion that is left from between those of the modes
    p.constrained_rate = max(fastest, rate_of(slowest, damping))
    p.rounding = 0.0
    p.apart = fastest > APART * omega and not (own and slowest >= UNEVEN * fastest * fastest)
    return held > SLOWEST_SQUARE * omega * omega


@jit
def rate_of(square, damping):
    """The larger |root| of s^2 + damping s + square."""
    half = 0.5 * damping
    return math.sqrt(square) if half * half <= square else half + math.sqrt(half * half - square)
