"""The tables of one oscillator (`Flight`), from its modes."""

import math

import numpy as np

from vibro_sweep.kernels.flight import CHUNK, ORDER, WIDTH, decaying
from vibro_sweep.kernels.jit import entry, jit
from vibro_sweep.kernels.lanes import LANES
from vibro_sweep.kernels.stiff import add_stiff_remainder, is_fast, rate_of, slow_part

LEAST_CELLS = 24
MOST_CELLS = 16384
STIFF_CELLS = 2048
LONGEST = 1e7  # the fastest rate times the period beyond which a system is refused: two seconds of work at worst
VANISHED = 30.0  # logarithm of what is below rounding
STRETCH = 4.0  # logarithm of what free flight may do to a tangent vector and not to another: two digits are lost
LOST = 200.0  # logarithm of what free flight may do to all of them
MOST_STRETCH = 1_000_000_000


def cells_needed(omega_squared: np.ndarray, zeta: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """Cells for which every rate of a system times the cell width is at most `WIDTH`; omega_squared is (..., 2).

    `STIFF_CELLS` where that would be too many, 0 where the rates are too far apart altogether.
    """
    eta = np.asarray(zeta)[..., None] * omega_squared
    overdamped = np.sqrt(np.maximum(eta**2 - omega_squared, 0.0))
    rate = np.where(eta**2 <= omega_squared, np.sqrt(omega_squared), eta + overdamped).max(-1)
    turns = 2 * math.pi * np.maximum(rate / omega, 1.0)
    cells = np.maximum(LEAST_CELLS, 8 * np.ceil(np.minimum(turns, LONGEST) / WIDTH / 8)).astype(np.int64)
    return np.where(turns > LONGEST, 0, np.where(cells > MOST_CELLS, STIFF_CELLS, cells))


@jit
def derive(A, row, size, series):
    """series[i, n]: Taylor coefficient n of (row . z) as a function of z_i, for z' = A z."""
    for i in range(size):
        series[i, 0] = row[i]
    for n in range(1, ORDER):
        for i in range(size):
            total = 0.0
            for j in range(size):
                total += series[j, n - 1] * A[j, i]
            series[i, n] = total / n


@jit
def clear(a):
    for i in range(a.shape[0]):
        for j in range(a.shape[1]):
            a[i, j] = 0.0


@jit
def fill_series(q, A, row, mu_m, mu_k, f2):
    """Taylor series of x1 and x2 in flight, and of M1's free acceleration and x2 while M1 rests on a stop (eq. 3).

    A (6, 6) and row (6,) are scratch.
    """
    zeta, omega = q.zeta, q.omega
    clear(A)
    A[0, 1] = A[2, 3] = 1.0
    A[1, 0], A[1, 1], A[1, 2], A[1, 3], A[1, 4] = -1.0, -2.0 * zeta, 1.0, 2.0 * zeta, 1.0 - f2
    A[3, 0], A[3, 1] = 1.0 / mu_m, 2.0 * zeta / mu_m
    A[3, 2], A[3, 3], A[3, 4] = -(1.0 + mu_k) / mu_m, -2.0 * zeta * (1.0 + mu_k) / mu_m, f2 / mu_m
    A[4, 5], A[5, 4] = omega, -omega
    for i in range(6):
        q.force[i] = A[1, i]
        row[i] = 0.0
    row[0] = 1.0
    derive(A, row, 6, q.series1)
    row[0], row[2] = 0.0, 1.0
    derive(A, row, 6, q.series2)
    # at rest z = (x1, x2, v2, sin, cos)
    spring, damper, push = A[3, 2], A[3, 3], A[3, 4]
    clear(A)
    A[1, 2] = 1.0
    A[2, 0], A[2, 1], A[2, 2], A[2, 3] = 1.0 / mu_m, spring, damper, push
    A[3, 4], A[4, 3] = omega, -omega
    row[0], row[1], row[2], row[3], row[4] = q.force[0], q.force[2], q.force[3], q.force[4], 0.0
    derive(A, row, 5, q.resting1)
    row[0], row[1], row[2], row[3] = 0.0, 1.0, 0.0, 0.0
    derive(A, row, 5, q.resting2)


@jit
def fill_flight(q, nodes, psi, omega_squared, mu_m):
    """E = exp(A t_k) in physical coordinates, from the 2x2 block of each mode."""
    for k in range(q.cells + 1):
        E, frame = nodes[k].E, nodes[k].frame
        clear(E)
        for j in range(2):
            eta = q.zeta * omega_squared[j]
            c, s, xi, rate = decaying(eta, omega_squared[j], k * q.width)
            frame[2 * j], frame[2 * j + 1] = c, s
            for i in range(2):
                for m in range(2):
                    weight = psi[i, j] * psi[m, j] * (mu_m if m == 1 else 1.0)
                    E[2 * m, 2 * i] += weight * xi
                    E[2 * m + 1, 2 * i] += weight * s
                    E[2 * m, 2 * i + 1] -= weight * omega_squared[j] * s
                    E[2 * m + 1, 2 * i + 1] += weight * rate


@jit
def forced_series(eta, omega_squared, omega, width, sin, cos):
    """xi and xi' after `width`, from rest, of xi'' + 2 eta xi' + omega_j^2 xi = sin(omega t + phase)."""
    now, before, total, rate = 0.0, 0.0, 0.0, 0.0  # Taylor terms c_(n+1) width^(n+1) and c_n width^n, and the sums
    square, force, turned = width * width, sin, omega * width * cos
    for n in range(ORDER - 2):
        after = force * square - 2.0 * eta * width * (n + 1.0) * now - omega_squared * square * before
        after /= (n + 1.0) * (n + 2.0)
        total += after
        rate += (n + 2.0) * after / width
        before, now = now, after
        # derivatives of the force, over n!
        force, turned = turned / (n + 1.0), -omega * omega * square * force / (n + 1.0)
    return total, rate


@jit
def fill_motion(q, nodes, psi, omega_squared, f2, tau):
    """The phase at the nodes, and the motion r.

    The flight to node k = rest + step, with step its lowest binary digit, is one to `rest` and one of `step` cells:
    rounding errors grow with the number of digits of k, not with k.
    """
    cells = q.cells
    for k in range(cells + 1):
        phase = tau + 2.0 * math.pi * (k / cells)
        z = nodes[k].z
        for i in range(LANES):
            z[i] = 0.0
        z[4], z[5] = math.sin(phase), math.cos(phase)
    for j in range(2):
        eta, square = q.zeta * omega_squared[j], omega_squared[j]
        force = psi[0, j] * (1.0 - f2) + psi[1, j] * f2
        if is_fast(q, square):
            detuning, damping = square - q.omega * q.omega, 2.0 * eta * q.omega
            size = force / (detuning * detuning + damping * damping)
            for k in range(cells + 1):
                sin, cos = nodes[k].z[4], nodes[k].z[5]
                xi = size * (detuning * sin - damping * cos)
                rate = size * q.omega * (detuning * cos + damping * sin)
                add_mode(nodes[k].z, psi, j, xi, rate)
            continue
        first, one = nodes[0].forced[j], nodes[1].forced[j]
        first[0, 0] = first[0, 1] = first[1, 0] = first[1, 1] = 0.0
        one[0, 0], one[1, 0] = forced_series(eta, square, q.omega, q.width, 1.0, 0.0)
        one[0, 1], one[1, 1] = forced_series(eta, square, q.omega, q.width, 0.0, 1.0)
        for k in range(cells + 1):
            if k > 1:
                step = k & -k if k & (k - 1) else k // 2
                before, after, out = nodes[k - step].forced[j], nodes[step].forced[j], nodes[k].forced[j]
                _, s, xi, rate = decaying(eta, square, step * q.width)
                angle = 2.0 * math.pi * ((k - step) / cells)
                swing, turn = math.sin(angle), math.cos(angle)
                for i in range(2):  # to sin and cos at node 0
                    there = (
                        after[0, 0] * turn - after[0, 1] * swing if i == 0 else after[0, 0] * swing + after[0, 1] * turn
                    )
                    moving = (
                        after[1, 0] * turn - after[1, 1] * swing if i == 0 else after[1, 0] * swing + after[1, 1] * turn
                    )
                    out[0, i] = xi * before[0, i] + s * before[1, i] + there
                    out[1, i] = rate * before[1, i] - square * s * before[0, i] + moving
            g, sin, cos = nodes[k].forced[j], nodes[0].z[4], nodes[0].z[5]
            add_mode(
                nodes[k].z, psi, j, force * (g[0, 0] * sin + g[0, 1] * cos), force * (g[1, 0] * sin + g[1, 1] * cos)
            )


@jit
def add_mode(X, psi, j, xi, rate):
    """Add a mode's motion to a state."""
    X[0] += psi[0, j] * xi
    X[1] += psi[0, j] * rate
    X[2] += psi[1, j] * xi
    X[3] += psi[1, j] * rate


@jit
def fourth_derivative_bound(q, x1, v1, x2, v2, sin, cos):
    """Bound on the fourth derivative of x1 over a cell that begins with this state: the sum of its terms' sizes."""
    s = q.series1
    total, power = 0.0, 1.0
    for n in range(4, ORDER):
        c = (s[0, n] * x1 + s[1, n] * v1) + (s[2, n] * x2 + s[3, n] * v2) + (s[4, n] * sin + s[5, n] * cos)
        total += n * (n - 1.0) * (n - 2.0) * (n - 3.0) * power * abs(c)
        power *= q.width
    return total


@jit
def fill_scan(q, nodes, scan, psi, omega_squared, mu_m, f2):
    """Control points of the cubic through x1 and v1 at both ends of each cell, and how far x1 can be from it.

    The cubic has the Bernstein coefficients x_k, x_k + h v_k/3, x_{k+1} - h v_{k+1}/3, x_{k+1}. Its error is at most
    bound t^2 (1 - t)^2 h^4/24, a quartic with the one coefficient bound h^4/144, the middle one. So x1 stays below b
    where both inner control points do by that much, and both ends do. An end is the mean of the inner points beside it.
    """
    third = q.width / 3.0
    for i in range(5):
        for p in range(2 * q.cells + 1, 2 * q.cells + CHUNK):
            scan[i, p] = 0.0
        q.remainder[i] = 0.0
    for k in range(q.cells + 1):
        E, z = nodes[k].E, nodes[k].z
        for i in range(5):
            x, v = (z[0], z[1]) if i == 4 else (E[i, 0], E[i, 1])
            if q.stiff and i < 4:
                x, v = slow_part(q, psi, omega_squared, mu_m, i, k * q.width)
            scan[i, 2 * k] = x + third * v
            if k > 0:
                scan[i, 2 * k - 1] = x - third * v
        if not q.stiff:
            for i in range(4):
                free = fourth_derivative_bound(q, E[i, 0], E[i, 1], E[i, 2], E[i, 3], 0.0, 0.0)
                q.remainder[i] = max(q.remainder[i], free)
            forced = fourth_derivative_bound(q, z[0], z[1], z[2], z[3], z[4], z[5])
            q.remainder[4] = max(q.remainder[4], forced)
    for i in range(5):
        largest = 0.0
        for p in range(2 * q.cells + 1):
            largest = max(largest, abs(scan[i, p]))
        # 1e-15: the rounding of a control point, a few units in the last place of each of its terms
        q.remainder[i] = q.remainder[i] * q.width**4 / 144.0 + 1e-15 * largest
    if q.stiff:
        add_stiff_remainder(q, nodes, psi, omega_squared, mu_m, f2)


@jit
def fill_frame(q, psi, omega_squared, mu_m):
    """The metric in which free flight is a rotation times a decay (tangent.py)."""
    series, to_frame, from_frame = q.frame_series, q.to_frame, q.from_frame
    clear(to_frame)
    clear(from_frame)
    fastest, slowest, turning, q.vanishing = 0.0, np.inf, True, 0
    for j in range(2):
        eta = q.zeta * omega_squared[j]
        square = omega_squared[j] - eta * eta
        if (eta + math.sqrt(max(-square, 0.0))) * q.width > VANISHED:
            q.vanishing += 2 if square > 0.0 else 1
        fastest = max(fastest, eta + math.sqrt(max(-square, 0.0)))
        slowest = min(slowest, eta if square >= 0.0 else omega_squared[j] / (eta + math.sqrt(-square)))
        # near critical damping the plane shears instead of turning; any scale then serves
        scale = max(math.sqrt(abs(square)), 1e-3 * math.sqrt(omega_squared[j]))
        turning = turning and square > 1e-6 * omega_squared[j]
        q.frame_square[j], q.frame_scale[j] = square, scale
        series[0, 2 * j], series[1, 2 * j] = 1.0, -eta
        series[0, 2 * j + 1], series[1, 2 * j + 1] = 0.0, 1.0
        for n in range(ORDER - 2):
            for i in range(2 * j, 2 * j + 2):
                rate = 2.0 * eta * (n + 1.0) * series[n + 1, i] + omega_squared[j] * series[n, i]
                series[n + 2, i] = -rate / ((n + 1.0) * (n + 2.0))
        for i in range(2):
            mass = mu_m if i == 1 else 1.0
            to_frame[2 * j, 2 * i] = scale * psi[i, j] * mass
            to_frame[2 * j + 1, 2 * i] = eta * psi[i, j] * mass
            to_frame[2 * j + 1, 2 * i + 1] = psi[i, j] * mass
            from_frame[2 * i, 2 * j] = psi[i, j] / scale
            from_frame[2 * i + 1, 2 * j] = -eta * psi[i, j] / scale
            from_frame[2 * i + 1, 2 * j + 1] = psi[i, j]
    apart = (fastest - slowest) * q.width
    q.stretch = max(1, int(STRETCH / apart)) if apart > 1e-9 * STRETCH else MOST_STRETCH
    q.leash = q.stretch
    if turning:  # nothing then but the range of the floats asks for a look
        q.leash = max(q.stretch, int(min(LOST / (fastest * q.width), MOST_STRETCH)) if fastest > 0.0 else MOST_STRETCH)


@entry
def build(f, scratch, cells, psi, omega_squared, mu_m, mu_k, zeta, f2, omega, tau):
    """Fill the tables of an oscillator with modes psi (2, 2), omega_squared (2,), and phase tau (radians) at node 0.

    scratch: (7, 6) floats.
    """
    q = f.oscillator[0]
    q.cells, q.width, q.omega, q.zeta, q.kappa = cells, 2.0 * math.pi / omega / cells, omega, zeta, 2.0 * zeta / mu_m
    rate = max(omega, max(rate_of(omega_squared[0], zeta), rate_of(omega_squared[1], zeta)))
    q.stiff = rate * q.width > 1.0001 * WIDTH
    q.step = q.width / math.ceil(rate * q.width / WIDTH) if q.stiff else q.width
    power = 1.0
    for n in range(ORDER):
        q.reach[n] = power if n > 0 else 0.0
        if n < ORDER - 3:
            q.third[n + 3] = (n + 3.0) * (n + 2.0) * (n + 1.0) * power
        power *= q.step
    fill_series(q, scratch[:6], scratch[6], mu_m, mu_k, f2)
    q.impulse_third = 0.0
    for n in range(ORDER):
        q.impulse_third += q.third[n] * abs(q.series1[1, n])
    fill_flight(q, f.nodes, psi, omega_squared, mu_m)
    fill_motion(q, f.nodes, psi, omega_squared, f2, tau)
    fill_scan(q, f.nodes, f.scan, psi, omega_squared, mu_m, f2)
    fill_frame(q, psi, omega_squared, mu_m)
