"""The sticking onset: where impacts accumulate, and the orbits beyond it rest on a stop.

Towards the onset impacts appear at the end of a chatter sequence, one at a time, at grazes that accumulate like R^K.
At the onset itself the sequence is infinite, the acceleration vanishes at its end, and its flights shrink by
phi = 1 - f, (1 - f)^2 (3 - f) = R (3 - 2f), its impulses by phi^2 (orbits.md). So the first K impacts are written out,
the rest is one impulse of their sum at their centre, and the parameter is found from

    g''(t_inf) = 0,   t_inf = t_K + (t_K - t_{K-1}) phi/(1 - phi)

with an error that falls geometrically in K, and so is extrapolated.
"""

import math

import numpy as np

from vibro_sweep.analysis.branches.precise import precise
from vibro_sweep.analysis.branches.sizes import least_size
from vibro_sweep.analysis.branches.special import Chatter, Graze, SpecialPoint, graze_at
from vibro_sweep.analysis.periodic.impulse_equations import Equations
from vibro_sweep.analysis.periodic.orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.model.arguments import check_type

SHORTEST_CHATTER = 7  # impacts on one stop, the one that appears among them
FIRST_IMPACTS = 24  # of the sequence, from which on it is closed by its own shape
ENOUGH = 40  # of the sequence, at most, to begin with
UNLIKE = 8  # impacts at the end of a sequence that grazes, which are unlike those of the onset
MOST_IMPACTS = 400
GROWTH = 4  # impacts added between two closed sequences
SETTLED = 1e-8  # of the parameter's scale: an onset of which so much is in doubt, or more, is none
STEPS = 25


def shrinking(R: float) -> float:
    """phi = 1 - f: by what the flights of a chatter sequence shrink at its onset, for 0 < R < 1."""
    from scipy.optimize import brentq  # loaded where there is chatter: it takes as long as several windows

    return 1 - brentq(lambda f: (1 - f) ** 2 * (3 - f) - R * (3 - 2 * f), 0.0, 1.0, xtol=1e-16)


def sticking_onset(special: SpecialPoint) -> SpecialPoint | None:
    """The sticking onset beyond a graze at which an impact appears at the end of a chatter sequence.

    A special point of type "sticking"; its orbit has no finite list of impacts, and the status "sticking". None where
    there is no such sequence, or the grazes do not accumulate.
    """
    check_type("special", special, SpecialPoint, "a special point of a branch")
    if special.type != "graze" or special.impact is not None:
        return None
    name, value = next(iter(special.parameters.items()))
    graze = graze_at(special.orbit._solution, name, None)
    solution = rotated(graze.touching, graze.index + 1)  # the sequence is the end of the list now
    R = float(solution.family.linear.restitution(solution.sides[-1:])[0])
    if not 0 < R < 1 or not _chatters(solution) or solution.equations.free:
        return None
    phi, scale = shrinking(R), _scale(graze, value)
    least = FIRST_IMPACTS
    onset = value
    while _length(solution) < least:
        found = _next_graze(solution, name, value, phi, scale)
        if found is None:
            return None
        (solution, value), moved = found, found[1] - value
        onset = value + moved * R / (1 - R)
    value = onset
    surplus = max(UNLIKE, _length(solution) - ENOUGH)
    u, sides = _drop(solution, surplus), solution.sides[:-surplus]
    solution = Solution(solution.family, solution.sigma, solution.halves, sides, u)
    values, limits, moved = [], [], math.inf
    while solution.K < MOST_IMPACTS:
        found = _closed(solution, name, value, phi, scale)
        if found is None:  # rounding: no longer sequence is to be had
            break
        longest, value = found
        values.append(value)
        if len(values) >= 3:
            limits.append(_limit(*values[-3:]))
        if len(limits) >= 2:
            before, moved = moved, abs(limits[-1] - limits[-2])
            if before < SETTLED * scale and moved >= before:  # rounding: the one before was the best
                limits.pop()
                break
        solution = _longer(longest, phi, GROWTH)
    if not moved < SETTLED * scale:
        return None
    onset, error = limits[-1], 2 * moved + 16 * np.finfo(float).eps * abs(value)
    orbit = PeriodicOrbit(special.orbit.system.replace(**{name: onset}), "sticking")
    none, chatter = np.empty(0, complex), _chatter(longest, phi)
    return SpecialPoint("sticking", {name: onset}, orbit, none, float(error), special.stop, _chatter=chatter)


def _scale(graze: Graze, value: float) -> float:
    """Of the parameter, to which rounding is compared: its value, or what moves the gap by its size; a value such as an
    offset or a phase may be 0."""
    moves = abs(graze.distance_slope)
    return max(abs(value), graze.touching.size_of_gap / moves if moves > 0 else 0.0)


def _limit(a: float, b: float, c: float) -> float:
    """Of a sequence that converges geometrically (Aitken)."""
    ratio = (c - b) / (b - a) if b != a else 0.0
    return c + (c - b) * ratio / (1 - ratio) if abs(ratio) < 0.9 else c


def rotated(solution: Solution, count: int) -> Solution:
    """The same orbit, counted from `count` impacts later."""
    K, P, sigma = solution.K, solution.equations.P, solution.sigma
    t = np.concatenate([solution.times[count:], solution.times[:count] + P])
    D = np.concatenate([solution.jumps[count:], sigma * solution.jumps[:count]])
    sides = (*solution.sides[count:], *(sigma * side for side in solution.sides[:count]))
    return Solution(solution.family, sigma, solution.halves, sides, np.concatenate([t, D, solution.u[2 * K :]]))


def _length(solution: Solution) -> int:
    """Impacts of the sequence at the end: on one stop."""
    sides = solution.sides
    other = [i for i, side in enumerate(sides) if side != sides[-1]]
    return len(sides) - (other[-1] + 1 if other else 0)


def _chatters(solution: Solution) -> bool:
    """Whether the last impacts are on one stop, with falling flights but for the last three."""
    times = solution.times[-SHORTEST_CHATTER:]
    return _length(solution) >= SHORTEST_CHATTER and bool(np.all(np.diff(times[:-3], 2) < 0))


def _drop(solution: Solution, count: int) -> np.ndarray:
    """Its unknowns without the last impacts."""
    K = solution.K
    return np.concatenate([solution.times[: K - count], solution.jumps[: K - count], solution.u[2 * K :]])


def _longer(solution: Solution, phi: float, count: int) -> Solution:
    """With impacts more at the end, each smaller by the shape of the sequence."""
    t, D, K = solution.times, solution.jumps, solution.K
    powers = phi ** np.arange(1, count + 1)
    times = np.append(t, t[-1] + (t[-1] - t[-2]) * np.cumsum(powers))
    u = np.concatenate([times, D, D[-1] * powers**2, solution.u[2 * K :]])
    sides = solution.sides + solution.sides[-1:] * count
    return Solution(solution.family, solution.sigma, solution.halves, sides, u)


def _next_graze(solution: Solution, name: str, value: float, phi: float, scale: float):
    """(solution, parameter) with one impact more at the end, whose impulse is the one that vanishes now."""
    K, t, D = solution.K, solution.times, solution.jumps
    # the end of the sequence repeats itself on the next smaller scale
    n = SHORTEST_CHATTER - 2
    times = np.append(t[:-n], t[-n - 1] + phi * np.cumsum(np.diff(t[-n - 2 :])))
    u = np.concatenate([times, D[:-n], phi**2 * D[-n - 1 : -1], [0.0], solution.u[2 * K :]])
    sides = (*solution.sides, solution.sides[-1])
    held = 2 * K + 1  # the impulse that stays 0: its place among the unknowns is the parameter's

    def system(u, value):
        e = _equations(solution, name, value)
        F, J, Fp, _ = e.evaluate(sides, u)
        J[:, held] = Fp
        step = np.linalg.solve(J, F)
        moved, step[held] = step[held], 0.0
        return step, moved

    found = _newton(system, u, value, K + 1, scale)
    return found and (_at(solution, name, found[1], sides, found[0]), found[1])


def _closed(solution: Solution, name: str, value: float, phi: float, scale: float):
    """(solution, parameter) where the sequence goes on for ever in its own shape."""
    K, sides = solution.K, _with_rest(solution.sides)
    centre, rest, weight = _rest(phi)
    least = least_size(solution, name)

    def reduced(matrix):
        """Columns of all impacts as columns of those written out: chain rule."""
        n = K + 2
        t, D = matrix[:, :K].copy(), matrix[:, n : n + K].copy()
        for column, share in ((matrix[:, K], centre), (matrix[:, K + 1], rest)):
            t[:, -1] += (1 + share) * column
            t[:, -2] -= share * column
        D[:, -1] += weight * matrix[:, n + K]
        return np.hstack([t, D, matrix[:, 2 * n :]])

    def system(u, value):
        e = _equations(solution, name, value)
        full = _and_rest(u, K, phi)
        F, J, Fp, motion = e.evaluate(sides, full)
        F[: 2 * K + 4], acceleration = precise(e, sides, full)
        n, h = K + 2, 1e-6 * max(abs(value), least)
        kept = [*range(K), *range(n, n + K), *range(2 * n, len(F))]
        beside = [_equations(solution, name, value + d).evaluate(sides, full)[3][-1, 1] for d in (h, -h)]
        row = reduced(_acceleration_slopes(e, full, n, motion[-1, 2])[None])[0]
        matrix = np.vstack(
            [np.column_stack([reduced(J[kept]), Fp[kept]]), np.append(row, (beside[0] - beside[1]) / 2 / h)]
        )
        step = np.linalg.solve(matrix, np.append(F[kept], acceleration))
        return step[:-1], step[-1]

    found = _newton(system, solution.u, value, K, scale)
    return found and (_at(solution, name, found[1], solution.sides, found[0]), found[1])


def _rest(phi: float) -> tuple[float, float, float]:
    """Of what follows the last impact: centre and length in units of the last flight, sum in units of its impulse."""
    rest = phi / (1 - phi)
    return rest * (1 - phi * (1 - phi**2) / (1 - phi**3)), rest, phi**2 / (1 - phi**2)


def _with_rest(sides) -> tuple[int, ...]:
    return (*sides, sides[-1], sides[-1])


def _and_rest(u, K: int, phi: float) -> np.ndarray:
    """The K impacts written out, the sum of the rest, and a probe of the acceleration at the end."""
    centre, rest, weight = _rest(phi)
    t, D = u[:K], u[K : 2 * K]
    times = t[-1] + np.array([centre, rest]) * (t[-1] - t[-2])
    return np.concatenate([t, times, D, [weight * D[-1], 0.0], u[2 * K :]])


def _chatter(s: Solution, phi: float) -> Chatter:
    """Of a sequence that is closed by its own shape."""
    all_of_it = Solution(s.family, s.sigma, s.halves, _with_rest(s.sides), _and_rest(s.u, s.K, phi))
    end, sides = all_of_it.times[-1] - s.equations.P, (s.sigma * s.sides[-1], *s.sides)
    u = np.concatenate([[end], s.times, [0.0], s.jumps])
    state = s.sigma * all_of_it.states[-1][: 2 * len(s.family.linear.along)]
    return Chatter(Solution(s.family, s.sigma, s.halves, sides, u), state)


def _acceleration_slopes(e: Equations, u, n: int, jerk: float) -> np.ndarray:
    """Derivatives of g'' before the last of n impacts, whose own impulse is 0, by all unknowns."""
    result = np.zeros(len(u))
    t, D, train = u[:n], u[n : 2 * n], e.train
    for k in range(n - 1):
        s = t[-1] - t[k]
        cell = min(int(s / train.width), len(train.coefficients) - 1)
        second = np.polynomial.polynomial.polyder(train.coefficients[cell], 2)
        at = s - cell * train.width
        result[n + k] = np.polynomial.polynomial.polyval(at, second)
        result[k] = -D[k] * np.polynomial.polynomial.polyval(at, np.polynomial.polynomial.polyder(second))
    result[n - 1] = jerk
    return result


def _equations(solution: Solution, name: str, value: float) -> Equations:
    family = solution.family.replace(**{name: value})
    return Equations(family.linear, solution.sigma, solution.halves, family.derivative(name))


def _at(solution: Solution, name: str, value: float, sides, u) -> Solution:
    return Solution(solution.family.replace(**{name: value}), solution.sigma, solution.halves, tuple(sides), u)


def _newton(system, u, value: float, count: int, scale: float):
    """(u, value) by Newton's method until the parameter stands still; flights may shrink to a third in a step."""
    change = math.inf
    for _ in range(STEPS):
        try:
            step, moved = system(u, value)
        except (np.linalg.LinAlgError, ValueError):
            return None
        longest = np.abs(np.diff(step[:count])).max()
        reach = 0.6 * np.min(np.diff(u[:count]) / np.maximum(np.abs(np.diff(step[:count])), 1e-300)) if longest else 1.0
        share = min(1.0, reach)
        u, value = u - share * step, value - share * moved
        before, change = change, abs(moved)
        if share == 1.0 and (change <= 1e-16 * abs(value) or (change < 1e-10 * scale and change > 0.3 * before)):
            return u, float(value)
    return None
