"""Linear algebra for orbits with many impacts, at a cost that grows like their number K.

The dense Jacobian (2K, 2K) couples all impacts. With the perturbed state xi_i before each impact as further unknowns,
only neighbours are coupled, and J(mu) is what is left when the states are eliminated:

    v_i dt_i + e_g.xi_i                            and    dD_i + (1 + R_i) (a_i dt_i + e_g.A xi_i)
    xi_{i+1} = E(t_{i+1} - t_i) (xi_i + e_v dD_i - A e_v D_i dt_i),        xi_{K+1} = sigma mu xi_1

Eliminating the states multiplies the determinant by det(1 - (sigma/mu) E(P)) at most, whose sign does not change along
a branch.
"""

from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.analysis.periodic.flight_slopes import state_slopes
from vibro_sweep.analysis.periodic.impulse_equations import Equations, flow, fly, moves_stops_only
from vibro_sweep.engine.impulses import equations, flights
from vibro_sweep.engine.impulses.green import cells_needed

if TYPE_CHECKING:
    from scipy.sparse import csc_array

SPARSE = 120  # impacts from which on the sparse system is the faster one


def is_sparse(e: Equations, sides) -> bool:
    """Whether to use `solve_bordered` and `sign_and_log_det`; a free mode that the contact sees has its equations in
    the dense form only. SciPy's part for these is loaded where they are called."""
    return len(sides) >= SPARSE and not e.free


def residual(e: Equations, sides, u):
    """`Equations.residual` from flight to flight, with the derivative by any parameter.

    Sums over all impacts at each impact take seconds for thousands of them. In chatter they hold more digits, and at
    R = 0 a flight does not begin with what the unknowns say: there they are kept.
    """
    contacts = e.contacts(sides)
    t, D, gain = u[: len(sides)], u[len(sides) :], contacts[:, equations.GAIN]
    again = contacts[1:, equations.STOP] == contacts[:-1, equations.STOP]
    width = e.P / e.halves / cells_needed(e.q)  # of a cell
    if np.any(again & (np.diff(t) < equations.SHORT * width)) or not np.all(gain > 1):
        return e.residual(sides, u)
    states, B = fly(e.q, e.sigma, e.halves, sides, u)[0], flow(e.q).B
    N, rates = (len(B) - 3) // 2, states @ B.T
    v = states[:, N]
    F = np.concatenate([states[:, 0] - contacts[:, equations.STOP], D + gain * v])
    Fp = np.concatenate([-contacts[:, equations.STOP_SLOPE], contacts[:, equations.GAIN_SLOPE] * v])
    if e.slope is not None and not moves_stops_only(e.slope):
        moved = state_slopes(e, u, states)
        Fp += np.concatenate([moved[:, 0], gain * moved[:, N]])
    return F, Fp, np.stack([v, rates[:, N], rates @ B[N]], axis=1)


def slopes(e: Equations, sides, u) -> np.ndarray:
    """du/dp (2K,) of an orbit that is not at a fold."""
    K = len(sides)
    _, Fp, motion = residual(e, sides, u)
    axis = np.append(np.zeros(2 * K), 1.0)  # the parameter moves by 1
    return solve_bordered(e, sides, u, motion, Fp, axis, np.zeros(2 * K), 1.0)[:-1]


def extended(e: Equations, sides, u, motion, mu: int, column=None, row=None) -> "csc_array":
    """The system above, unknowns (dt_i, dD_i, xi_i) by impacts. With a border: `column` (2K,) by the parameter, `row`
    (2K + 1,), both in the order of the dense system."""
    from scipy.sparse import csc_array

    f = flow(e.q)
    K, n = len(sides), f.B.shape[0] - 3
    N, m = n // 2, n + 2
    contacts = e.contacts(sides)
    t, D = u[:K], u[K : 2 * K]
    E = np.empty((K, n, n))
    flights.flight_matrices(f, np.diff(np.append(t, t[0] + e.P)), E, flights.new_room(n + 3))
    first = m * np.arange(K)
    following = np.roll(first, -1)
    gain, v, a = contacts[:, 1], motion[:, 0], motion[:, 1]
    one = np.ones(K)
    closing = np.where(np.arange(K) == K - 1, float(e.sigma * mu), 1.0)
    rows, columns, values = [], [], []

    def put(i, j, value):
        i, j, value = np.broadcast_arrays(i, j, value)
        rows.append(i.ravel())
        columns.append(j.ravel())
        values.append(value.ravel())

    put(first, first, v)
    put(first, first + 2, one)
    put(first + 1, first, gain * a)
    put(first + 1, first + 1, one)
    put(first + 1, first + 2 + N, gain)
    state = np.arange(n)
    after = first[:, None] + 2 + state
    put(after, following[:, None] + 2 + state, closing[:, None])
    put(after[:, :, None], (first[:, None] + 2 + state)[:, None, :], -E)
    put(after, (first + 1)[:, None], -E[:, :, N])
    put(after, first[:, None], (E @ f.B[:n, N]) * D[:, None])
    size = m * K
    if column is not None:
        places = np.concatenate([first, first + 1])
        put(places, size, column)
        put(size, np.append(places, size), row)
        size += 1
    indices = np.concatenate(rows), np.concatenate(columns)
    return csc_array((np.concatenate(values), indices), shape=(size, size))


def solve_bordered(e: Equations, sides, u, motion, column, row, F, last: float, mu: int = 1) -> np.ndarray:
    """Solution (2K + 1,) of [J column; row] x = [F; last], with J = J(mu)."""
    lu, places = _bordered(e, sides, u, motion, column, row, mu)
    right = np.zeros(lu.shape[0])
    right[places] = np.append(F, last)
    return lu.solve(right)[places]


def critical_direction(e: Equations, sides, u, motion, mu: int, scale) -> np.ndarray:
    """(2K,) of length 1 in units `scale`: what a singular J(mu) takes to zero."""
    nothing, column, row = np.zeros(2 * len(sides)), np.ones(2 * len(sides)), 1 / scale
    for _ in range(2):  # first across any direction, which may lie badly, then across the one that is found
        found = solve_bordered(e, sides, u, motion, column, np.append(row, 0.0), nothing, 1.0, mu)[:-1] / scale
        row = found / np.linalg.norm(found) / scale
    return found / np.linalg.norm(found)


def _bordered(e: Equations, sides, u, motion, column, row, mu: int = 1):
    """The factors of [J column; row] with the states as unknowns, and where the dense system's unknowns are."""
    from scipy.sparse.linalg import splu

    K = len(sides)
    matrix = extended(e, sides, u, motion, mu, column, row)
    m = (matrix.shape[0] - 1) // K
    try:
        lu = splu(matrix)
    except RuntimeError:
        raise np.linalg.LinAlgError("the bordered system is singular") from None
    return lu, np.concatenate([m * np.arange(K), m * np.arange(K) + 1, [m * K]])


def sign_and_log_det(e: Equations, sides, u, motion, mu: int) -> tuple[float, float]:
    """Of det J(mu) up to a factor that has one sign along a branch."""
    from scipy.sparse.linalg import splu

    try:
        lu = splu(extended(e, sides, u, motion, mu))
    except RuntimeError:
        return 0.0, -np.inf
    diagonal = lu.U.diagonal()
    sign = np.prod(np.sign(diagonal)) * _parity(lu.perm_r) * _parity(lu.perm_c)
    return float(sign), float(np.log(np.abs(diagonal)).sum())


def _parity(permutation) -> int:
    """+1 for an even permutation."""
    seen, cycles = np.zeros(len(permutation), bool), 0
    for start in range(len(permutation)):
        if not seen[start]:
            cycles += 1
            place = start
            while not seen[place]:
                seen[place] = True
                place = permutation[place]
    return 1 if (len(permutation) - cycles) % 2 == 0 else -1
