"""Periodic orbits and branches: orbits from guesses and points of branches per second, beside shooting.

    python benchmarks/branches.py

Times are of one core, the least of some rounds. Shooting has the state as unknown: Newton's method with differences on
the map over a period, integrated by heyoka (tolerance 1e-16) or SciPy's DOP853 (1e-12).
"""

import time
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import shared  # noqa: F401
from scipy.integrate import solve_ivp
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches.compiled_stepper import CompiledStepper
from vibro_sweep.analysis.continuation.first_point import start_of_branch
from vibro_sweep.analysis.continuation.solution_curve import LONGEST_STEP, branch_through
from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.analysis.periodic.solution import Solution

GUESSES = 1000
NEAR = 1e-4  # relative distance of a guess from its orbit
ROUNDS = 5
NUMBERS = {"b": (3.3, 4.3), "omega": (0.62, 0.64), "zeta": (0.048, 0.055)}  # in which branches are followed


def least(job, rounds=ROUNDS) -> float:
    """Seconds of the fastest of some calls, after one that compiles."""
    job()
    times = []
    for _ in range(rounds):
        began = time.perf_counter()
        job()
        times.append(time.perf_counter() - began)
    return min(times)


def one_sided(count: int) -> Solution:
    """An orbit with `count` impacts."""
    orbit = vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R")
    return orbit._solution.whole().repeated(count) if count > 1 else orbit._solution


def from_guesses(solution: Solution) -> tuple[float, float]:
    """Microseconds for an orbit from a guess in a compiled batch, and the share that converged."""
    e, rng = EventEquations.of(solution), np.random.default_rng(0)
    guesses = solution.u * (1 + rng.uniform(-NEAR, NEAR, (GUESSES, len(solution.u))))
    found = np.isfinite(e.newton(guesses)[1]).mean()
    return least(lambda: e.newton(guesses)) / GUESSES * 1e6, found


def additions(solution: Solution) -> dict[str, float]:
    """Microseconds that the certificate, the multipliers and the call from Python add."""
    sides = solution.sides
    guess = [(t, side, -D / 1.8) for t, side, D in zip(solution.times, sides, solution.jumps, strict=True)]
    periods = solution.half_periods // 2
    system = PAPER.replace(b=4.0)
    return {
        "certificate": least(lambda: replace(solution).stop_distance) * 1e6,
        "certificate and multipliers": least(lambda: replace(solution).multipliers) * 1e6,
        "periodic_orbit, from Python": least(lambda: vs.periodic_orbit(system, guess=guess, periods=periods)) * 1e6,
    }


def run_along(solution: Solution, name: str, bounds, counts: list):
    """A job that takes steps along a branch, and appends how many points and corrections there were."""
    first = start_of_branch(branch_through(solution, name, bounds[1] - bounds[0], bounds)).backwards()
    length = LONGEST_STEP / 25  # so that a run has enough points to be timed

    def job():
        stepper = CompiledStepper(first, 0, length)
        counts.append(stepper.record_steps(1)[1:])

    return job


def points(solution: Solution, name="b", bounds=NUMBERS["b"]) -> tuple[float, float]:
    """Points per second with all tests and the certificate, and corrections for each."""
    counts = []
    seconds = least(run_along(solution, name, bounds, counts))
    return counts[-1][0] / seconds, counts[-1][1] / counts[-1][0]


def compare(count: int, name: str, bounds) -> None:
    """Points of branches with so many contacts beside those with as many impacts: processor time, in turns."""
    solutions, counts, spent = {"rigid": one_sided(count)}, [], {}
    for k_stop in (1e2, 1e4):
        system = PAPER.replace(b=4.0, R=None, k_stop=k_stop, c_stop=0.14 * k_stop**0.5)
        solutions[k_stop] = vs.periodic_orbit(system, itinerary="R")._solution.repeated(count)
    jobs = {key: run_along(solution, name, bounds, counts) for key, solution in solutions.items()}
    for turn in range(2 * ROUNDS):
        for key, job in jobs.items():
            began = time.process_time()
            job()
            if turn:
                spent[key] = min(spent.get(key, np.inf), (time.process_time() - began) / counts[-1][0])
    for k_stop in (1e2, 1e4):
        share = f"{spent['rigid'] / spent[k_stop]:.2f} of the rigid ones"
        print(f"  {count:3d} contacts, k_stop = {k_stop:g}, in {name}: {1 / spent[k_stop]:8.0f} per second, {share}")


def shooting(period_map, state) -> np.ndarray:
    """A fixed point of a map by Newton's method with differences, from a state near it."""
    h = 1e-6
    for _ in range(8):
        image = period_map(state)
        J = np.array([(period_map(state + h * axis) - image) / h for axis in np.eye(len(state))]).T
        step = np.linalg.solve(J - np.eye(len(state)), image - state)
        state = state - step
        if np.abs(step).max() < 1e-10:
            break
    return state


def scipy_map(system):
    M, K = np.diag([1, system.mu_m]), np.array([[1, -1], [-1, 1 + system.mu_k]])
    inverse, force = np.linalg.inv(M), np.array([1 - system.f2, system.f2])

    def rate(t, z):
        x, v = z[::2], z[1::2]
        a = inverse @ (force * np.sin(system.omega * t + system.phase) - K @ x - 2 * system.zeta * K @ v)
        return np.array([v[0], a[0], v[1], a[1]])

    def high(t, z):
        return system.b - z[0]

    def low(t, z):
        return z[0] + system.b

    for event in (high, low):
        event.terminal, event.direction = True, -1

    def period_map(state):
        t, z = 0.0, state
        while t < system.period:
            found = solve_ivp(rate, (t, system.period), z, method="DOP853", rtol=1e-12, atol=1e-12, events=(high, low))
            t, z = found.t[-1], found.y[:, -1].copy()
            if found.status == 1:
                z[1] *= -system.R
        return z

    return period_map


def heyoka_map(system):
    import heyoka as hy
    from peer_heyoka import equations, stops

    numbers = {name: getattr(system, name) for name in ("mu_m", "mu_k", "zeta", "f2", "omega", "b")}

    def strike(ta, _):
        ta.state[1] *= -system.R
        return True

    events = stops(hy.t_event, numbers | {"tau": system.phase}, strike)
    flow = equations(numbers | {"tau": system.phase})
    ta = hy.taylor_adaptive(flow, [0.0] * 4, tol=1e-16, t_events=events, fast_math=True)

    def period_map(state):
        ta.time, ta.state[:] = 0.0, state
        ta.reset_cooldowns()
        ta.propagate_until(system.period)
        return ta.state.copy()

    return period_map


def main() -> None:
    print("An orbit from a guess, in a compiled batch:")
    for count in (1, 4, 10):
        spent, found = from_guesses(one_sided(count))
        print(f"  {count:3d} impacts: {spent:7.2f} us, {100 * found:.0f} % converged")
    solution = one_sided(1)
    for what, spent in additions(solution).items():
        print(f"  {what}: {spent:.0f} us")
    orbit = orbit_of(PAPER.replace(b=4.0), solution)
    maps = {"SciPy DOP853": scipy_map} | ({"heyoka": heyoka_map} if find_spec("heyoka") else {})
    start = orbit.state * (1 + NEAR)
    for name, make in maps.items():
        period_map = make(orbit.system)
        error = np.abs(shooting(period_map, start) - orbit.state).max()
        spent = least(lambda period_map=period_map: shooting(period_map, start))
        print(f"  shooting with {name}, 1 impact: {1e6 * spent:.0f} us, error {error:.0e}")
    print("Points of a branch with all tests and the certificate:")
    times = {}
    for count in (1, 4, 10, 100):
        speed, corrections = points(one_sided(count))
        times[count] = 1 / speed
        print(f"  {count:3d} impacts, in b: {speed:8.0f} per second, {corrections:.1f} corrections each")
    print(f"  a point with 100 impacts takes {times[100] / times[10]:.1f} times as long as one with 10")
    for name in ("omega", "zeta"):
        speed, corrections = points(solution, name, NUMBERS[name])
        print(f"    1 impact, in {name}: {speed:8.0f} per second, {corrections:.1f} corrections each")
    print("The same with compliant stops, and how that compares to rigid ones with as many impacts, in turns:")
    for count in (1, 4, 10):
        for name, bounds in NUMBERS.items():
            compare(count, name, bounds)


if __name__ == "__main__":
    main()
