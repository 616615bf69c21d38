"""Missed and invented impacts per decade of penetration, for this package and for the usual ways: a Markdown table.

    python benchmarks/grazes.py [--flights 2000] [--decades 2 3 4 5 6 8 10 12] [--methods ...]

Each flight of the paper's oscillator has one extremum of x1 at a random time that lies 10^-k b behind a stop (does the
method see an impact?) or before it (does it see one that is not there?). Flights are built and certified in
40-digit and extended arithmetic (tests/reference/certified.py). scipy and heyoka are optional: `pip install .[bench]`.
"""

import argparse
import sys

import numpy as np
import shared  # noqa: F401
from reference import certified

import vibro_sweep as vs

SYSTEM = vs.System(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8, b=6.6)
GROUPS = 100  # times of the extremum


def flights(reference, decade, behind, count, rng):
    """States (count, 4) at t = 0, and the times just after the extremum up to which the flight is watched."""
    b, period = SYSTEM.b, SYSTEM.period
    force = reference.acceleration.astype(float)
    states, ends, need = [], [], -(-count // GROUPS)
    for _ in range(GROUPS):
        u = period * rng.uniform(0.05, 0.95)
        before, phase, taken = reference.before(u), reference.phase(u), 0
        while taken < need:
            side = rng.choice([-1, 1], 4 * need)
            depth = 10.0**-decade
            z = np.zeros((4 * need, 6), certified.REAL)
            z[:, 0] = side * b * (1 + (depth if behind else -depth))
            z[:, 2:4] = b * rng.normal(size=(4 * need, 2)) * (0.5, 0.3)
            z[:, 4:] = phase
            a = -side * (z @ force)
            watch = 1.5 * np.sqrt(2 * depth * b / np.abs(a)).astype(float)
            start = z @ before.T
            start = reference.forced(start[:, :4].astype(float))
            good = (a > 0.1) & (np.abs(start[:, 0]) < b) & (u - watch > 0) & (u + watch < period)
            start, watch = start[good], watch[good]
            free = np.full(len(start), u - watch if behind else u + watch, certified.REAL)
            verdict = reference.inside(start, b, free, np.zeros(len(start)))
            chosen = np.flatnonzero(verdict == certified.POSITIVE)[: need - taken]
            states.append(start[chosen, :4].astype(float))
            ends.append(u + watch[chosen])
            taken += len(chosen)
    return np.concatenate(states)[:count], np.concatenate(ends)[:count]


def matrix():
    """A of z' = A z, z = (x1, v1, x2, v2, sin, cos)."""
    p = SYSTEM.parameters()
    above, drag = 1 + p["mu_k"], 2 * p["zeta"]
    A = np.zeros((6, 6))
    A[0, 1] = A[2, 3] = 1
    A[1, :5] = -1, -drag, 1, drag, 1 - p["f2"]
    A[3, :5] = np.array([1, drag, -above, -drag * above, p["f2"]]) / p["mu_m"]
    A[4, 5], A[5, 4] = p["omega"], -p["omega"]
    return A


def augmented(states):
    tau = SYSTEM.phase
    return np.hstack([states, np.tile([np.sin(tau), np.cos(tau)], (len(states), 1))])


def this_package():
    def seen(states, ends):
        result = np.zeros(len(states), bool)
        for i, (state, end) in enumerate(zip(states, ends, strict=True)):
            impacts = vs.simulate(SYSTEM, state, periods=1).impacts
            result[i] = len(impacts) > 0 and impacts["t"][0] <= end
        return result

    return seen


def closed_form():
    """64 points a period; a sign change would be bisected, so that only points behind a stop are seen."""
    from scipy.linalg import expm

    step = expm(matrix() * SYSTEM.period / 64)
    rows = [np.eye(6)[0]]
    for _ in range(64):
        rows.append(rows[-1] @ step)
    rows = np.array(rows)

    def seen(states, ends):
        x1 = augmented(states) @ rows.T
        watched = np.arange(65) * SYSTEM.period / 64 <= ends[:, None]
        return ((np.abs(x1) > SYSTEM.b) & watched).any(1)

    return seen


def rk4():
    """Fixed steps, 1000 a period; an impact is a step that ends behind a stop."""
    import numba

    free, force = np.ascontiguousarray(matrix()[:4, :4]), np.ascontiguousarray(matrix()[:4, 4])
    b, h = SYSTEM.b, SYSTEM.period / 1000
    omega, tau = SYSTEM.omega, SYSTEM.phase

    @numba.njit
    def rate(t, y):
        return free @ y + force * np.sin(omega * t + tau)

    @numba.njit
    def run(states, ends):
        result = np.zeros(len(states), np.bool_)
        for i in range(len(states)):
            y, n = states[i].copy(), 0
            while n * h < ends[i] and not result[i]:
                t = n * h
                k1 = rate(t, y)
                k2 = rate(t + h / 2, y + h / 2 * k1)
                k3 = rate(t + h / 2, y + h / 2 * k2)
                k4 = rate(t + h, y + h * k3)
                y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
                n += 1
                result[i] = abs(y[0]) > b
        return result

    return run


def dop853():
    """Relative tolerance 1e-12, terminal events on both stops."""
    from scipy.integrate import solve_ivp

    A, b, omega, tau = matrix()[:4], SYSTEM.b, SYSTEM.omega, SYSTEM.phase
    free, force = A[:, :4], A[:, 4]

    def rate(t, y):
        return free @ y + force * np.sin(omega * t + tau)

    def right(t, y):
        return y[0] - b

    def left(t, y):
        return y[0] + b

    right.terminal = left.terminal = True

    def seen(states, ends):
        return np.array(
            [
                solve_ivp(rate, (0, end), y, "DOP853", rtol=1e-12, atol=1e-12, events=(right, left)).status == 1
                for y, end in zip(states, ends, strict=True)
            ]
        )

    return seen


def heyoka():
    """Taylor's method with terminal events at the default tolerance, 2^-52."""
    try:
        import heyoka as hy
    except ImportError:
        sys.exit("heyoka is not installed: pip install .[bench], or leave it out with --methods")
    y = hy.make_vars("x1", "v1", "x2", "v2")
    A, tau = matrix(), SYSTEM.phase
    force = hy.sin(SYSTEM.omega * hy.time + tau)
    rates = [(y[i], sum(float(A[i, j]) * y[j] for j in range(4)) + float(A[i, 4]) * force) for i in range(4)]
    events = [hy.t_event(y[0] - SYSTEM.b), hy.t_event(y[0] + SYSTEM.b)]
    integrator = hy.taylor_adaptive(rates, [0.0] * 4, t_events=events)

    def seen(states, ends):
        result = np.zeros(len(states), bool)
        for i, (state, end) in enumerate(zip(states, ends, strict=True)):
            integrator.time = 0.0
            integrator.state[:] = state
            integrator.reset_cooldowns()
            result[i] = integrator.propagate_until(end)[0] != hy.taylor_outcome.time_limit
        return result

    return seen


METHODS = {
    "this package": this_package,
    "closed form, 64 points a period, bisection": closed_form,
    "numba RK4, 1000 steps a period": rk4,
    "scipy DOP853, 1e-12": dop853,
    "heyoka, 2^-52": heyoka,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flights", type=int, default=2000)
    parser.add_argument("--decades", type=int, nargs="+", default=[2, 3, 4, 5, 6, 8, 10, 12, 14])
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=list(METHODS))
    options = parser.parse_args()
    reference = certified.of_paper(SYSTEM.parameters())
    rng = np.random.default_rng(1)
    sets = [[flights(reference, k, behind, options.flights, rng) for behind in (True, False)] for k in options.decades]
    print(f"{options.flights} flights that pass a stop by 10^-k b: missed, and (+) of as many that turn 10^-k b before")
    print("it: invented.\n")
    print("| k | " + " | ".join(map(str, options.decades)) + " |")
    print("| --- " * (len(options.decades) + 1) + "|")
    for name in options.methods:
        try:
            seen = METHODS[name]()
        except ImportError as error:
            sys.exit(f"{name}: {error.name} is not installed: pip install .[bench], or leave it out with --methods")
        cells = []
        for (behind, ends), (before, other_ends) in sets:
            missed = options.flights - np.count_nonzero(seen(behind, ends))
            invented = np.count_nonzero(seen(before, other_ends))
            cells.append(f"{missed} + {invented}" if invented else str(missed))
        print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
