"""Bifurcation curves: points per second on one core, with all tests and the certificate.

    python benchmarks/curves.py [QUICKSTART.h5]

A curve is followed in steps so short that a run has enough points to be timed; the least processor time of some
rounds. With the file of the scene `quickstart` also the time of the chart of its ten largest windows in (b, omega).
"""

import sys
import time

import numpy as np
import shared  # noqa: F401
from support.branches import branch_of
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.continuation.solution_curve import LONGEST_STEP, SolutionCurve, copy
from vibro_sweep.analysis.continuation.starting_orbit import Start
from vibro_sweep.analysis.curves.bifurcation_curve import first_of
from vibro_sweep.analysis.curves.curve_start import start_at
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation.workspace import TEST, new_place

ROUNDS = 5
PIECES = 40  # a step is so much shorter than usual
BOX = ((0.01, 9), (0.58, 0.68))  # b, omega


def speed(start: Start, names, bounds) -> tuple[float, float, int]:
    """Points per second, corrections for each, and how many impacts there are in the equations."""
    curve, first = first_of(SolutionCurve(start, names, bounds))
    curve.path = curve.path._replace(longest=LONGEST_STEP / PIECES)
    place, best, corrections = new_place(curve.K, curve.n), 0.0, 0.0
    for _ in range(ROUNDS):
        for aim in (curve.path.first, curve.path.a):
            copy(first, aim)
        curve.path.a.tests[TEST.length] = LONGEST_STEP / PIECES
        began = time.process_time()
        curve.take_steps(place)
        spent = time.process_time() - began
        points, made = map(int, curve.path.counts[1:])
        best, corrections = max(best, points / spent), made / max(points, 1)
    return best, corrections, curve.K


def longer(start: Start, times: int) -> Start:
    """The same bifurcation of the orbit taken `times` times, with so many times the impacts. Odd where mu = -1."""
    s = start.solution
    shifts = np.repeat(np.arange(times), s.K)
    signs = np.repeat(float(s.sigma) ** np.arange(times), s.K)
    u = np.concatenate([np.tile(s.times, times) + shifts * s.P, np.tile(s.jumps, times) * signs])
    sides = tuple(int(side * sign) for side, sign in zip(s.sides * times, signs, strict=True))
    theta = abs(float(np.angle(np.exp(1j * times * start.theta))))
    solution = Solution(s.family, s.sigma**times, s.half_periods * times, sides, u)
    return Start(start.type, solution, start.index, theta)


def onset() -> SpecialPoint:
    """The sticking onset of the paper's symmetric orbit."""
    system = PAPER.replace(b=0.0666)
    orbit = vs.periodic_orbit(system, state=vs.simulate(system, (0, 0, 0, 0), 400).section[-1])
    branch = vs.continue_orbit(orbit, "b", (0.06, 0.067))
    return next(special for special in branch.special if special.type == "sticking")


def starts() -> list[Start]:
    """Of each type, with 1 to 5 impacts; of an onset of sticking, as many as are to be written out."""
    symmetric = vs.continue_orbit(vs.periodic_orbit(PAPER, itinerary="LR"), "b", (0.3, 6.8))
    one_sided = vs.continue_orbit(vs.periodic_orbit(PAPER.replace(b=4.0), itinerary="R"), "b", (0.3, 6.8))
    window = branch_of(6.6, 13)
    pitchfork, torus = start_at(symmetric.special[1]), start_at(one_sided.special[1])
    fold = start_at(next(special for special in window.special if special.type == "fold"))
    grazes = [start_at(branch.begins) for branch in (symmetric, one_sided, window)]
    smooth = [pitchfork, longer(pitchfork, 3), torus, longer(torus, 4), fold]
    return [*smooth, start_at(symmetric.ends), *grazes, start_at(onset())]


def chart(path: str) -> tuple[float, int, int]:
    """Curves through the ends of a sweep's ten largest windows with impacts, as far as their orbits are motions.

    Processor seconds for these and the multipliers at their points; how many curves, and points.
    """
    windows = [window for window in vs.windows(path) if window.itinerary]
    largest = sorted(windows, key=lambda window: window.lo - window.hi)[:10]
    ends = [end for window in largest for end in (window.lower, window.upper) if end.type != "boundary"]
    times = []
    for _ in range(2):  # the first one loads kernels
        began = time.process_time()
        curves = [vs.bifurcation_curve(end, ("b", "omega"), BOX, virtual=False) for end in ends]
        points = sum(curve.points.sizes["point"] for curve in curves)
        times.append(time.process_time() - began)
    return min(times), len(curves), points


def main() -> None:
    if len(sys.argv) > 1:
        print("ten largest windows: {:.2f} s, {} curves, {} points".format(*chart(sys.argv[1])))
    for start in starts():
        s = start.solution
        numbers = s.family.numbers
        print(f"{start.type}, P = {s.half_periods / 2:g} T:")
        for names in (("b", "omega"), ("b", "R"), ("mu_m", "zeta")):
            bounds = [(0.97 * numbers[name], 1.03 * numbers[name]) for name in names]
            rate, made, K = speed(start, names, bounds)
            print(f"    in {', '.join(names)}: {rate:7.0f} points per second, {K} impacts, {made:.1f} corrections each")


if __name__ == "__main__":
    main()
