"""Curves of orbits with two or four times the period that begin at a point of codimension two.

The orbits are entered at a small amplitude in the critical direction, which Newton's method keeps. A fold of doubled
orbits begins at a degenerate flip, a Neimark-Sacker curve of doubled orbits where a flip meets a Neimark-Sacker point.
At the resonance 1:4 the fourth iterate is, to third order (Kuznetsov, Elements of Applied Bifurcation Theory, 9.5.4),

    z' = eps z + c |z|^2 z + d conj(z)^3,   A = c/|d|

and has two folds where |A| > 1. They and eps follow from Re(A conj(u)) = -1, eps = -|d| |z|^2 (A + u), |u| = 1. At the
resonance 1:3 no curve of this kind begins: the orbits of three times the period are saddles on all sides.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibro_sweep.analysis.branches import torus
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.curves.start import Start
from vibro_sweep.analysis.curves.tracer import Tracer
from vibro_sweep.analysis.curves.way import CurvePoint
from vibro_sweep.analysis.periodic.orbit import orbit_of
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses.locus import Place

AMPLITUDES = (0.01, 0.02, 0.005, 0.0025, 0.04)  # in the units of a curve, in the order in which they are tried
REACH = 0.2  # of the parameters around the point, relative
FARTHEST = 0.02  # relative distance of the point that is found, in both parameters
ALIKE = 0.3  # relative difference from what the third order says


class Entry(NamedTuple):
    """A guess of a point of such a curve: the orbit and its change (2K,) from the parent, taken several times; how far
    the parameters have moved, by the normal form (None: not known).
    """

    start: Start
    change: np.ndarray
    moved: np.ndarray | None


def born(special: CurvePoint) -> list[SpecialPoint]:
    """Points of such curves that begin at a point of codimension two of a curve; [] where none does or is found."""
    solution, kind = special.orbit._solution, special.type
    if solution is None:  # of an onset of sticking
        return []
    flip = "pitchfork" if solution.sigma == -1 else "flip"
    if kind == "degenerate_flip":
        name, parent, count = "fold", Start(flip, solution), 2
    elif kind == "flip_neimark_sacker":
        name, parent, count = "neimark_sacker", Start(flip, solution), 2
    elif kind == "resonance_1_4":
        name, parent, count = "fold", Start("neimark_sacker", solution, theta=np.pi / 2), 4
    else:
        return []
    found = []
    for sign in (1, -1) if count == 4 else (1,):
        for amplitude in AMPLITUDES:
            guess = entry(special, name, parent, count, amplitude, sign)
            one = guess and entered(special, guess)
            if one is not None:
                found.append(one)
                break
    return found


def entry(special: CurvePoint, name: str, parent: Start, count: int, amplitude: float, sign: int) -> Entry | None:
    """For orbits with `count` times the period at this amplitude; sign: which of two folds. None: there are none."""
    names, values = tuple(special.parameters), np.array(list(special.parameters.values()))
    tracer = Tracer(parent, names, _box(values))
    place = tracer.first()
    if place is None:
        return None
    w, K, moved, theta = place.w * tracer.curve.unit[: tracer.S], tracer.K, None, 0.0
    largest = place.w[np.argmax(np.abs(place.w[: 2 * K]))]
    factor, family = amplitude / largest, parent.solution.family
    if count == 4:
        found = _quarter(tracer, place, abs(factor), sign)
        if found is None:
            return None
        factor, moved = found
        family = family.replace(**dict(zip(names, map(float, values + moved), strict=True)))
    if name == "neimark_sacker":
        mu = parent.solution.multipliers
        pair = mu[np.argmin(np.where(mu.imag > 1e-6, np.abs(np.abs(mu) - 1), np.inf))]
        theta = abs(float(np.angle(pair**count)))
    mu = -1.0 if count == 2 else 1j
    child, change = repeated(parent.solution, count, factor * w[:K], factor * w[K : 2 * K], mu)
    if moved is not None:
        child = _bent(child, tracer, place, factor, moved)
    return Entry(Start(name, replace(child, family=family), theta=theta), change, moved)


def entered(special: CurvePoint, guess: Entry) -> SpecialPoint | None:
    """The point of the curve with the amplitude of the guess, if it is near."""
    names, values = tuple(special.parameters), np.array(list(special.parameters.values()))
    tracer = Tracer(guess.start, names, _box(values))
    row = np.zeros(tracer.size)
    row[: len(guess.change)] = guess.change / tracer.curve.unit[: len(guess.change)]
    place = tracer.guess()
    place = place and tracer.settle(place, row / np.linalg.norm(row))
    if place is None:
        return None
    far = np.abs(place.p[:2] - values) > FARTHEST * np.maximum(np.abs(values), 1e-3)
    if guess.moved is not None:
        far = np.abs(place.p[:2] - values - guess.moved) > ALIKE * np.abs(guess.moved).max()
    if np.any(far):
        return None
    solution = tracer.solution(place)
    parameters = dict(zip(names, map(float, place.p[:2]), strict=True))
    orbit = orbit_of(special.orbit.system.replace(**parameters), solution)
    return SpecialPoint(guess.start.type, parameters, orbit, solution.multipliers, float(special.error))


def _box(values: np.ndarray) -> np.ndarray:
    reach = REACH * np.maximum(np.abs(values), 1e-3)
    return np.column_stack([values - reach, values + reach])


def repeated(parent: Solution, count: int, dt, dD, mu: complex) -> tuple[Solution, np.ndarray]:
    """The orbit taken `count` times, moved by mu^k (dt, dD) and its conjugate in period k; and the change itself."""
    P, s = parent.equations.P, float(parent.sigma)
    turns, signs = mu ** np.arange(count)[:, None], s ** np.arange(count)[:, None]
    change = np.concatenate([2 * (turns * dt).real.ravel(), 2 * (signs * turns * dD).real.ravel()])
    t = parent.times + P * np.arange(count)[:, None]
    sides = tuple(int(side * s**k) for k in range(count) for side in parent.sides)
    u = np.concatenate([t.ravel(), (signs * parent.jumps).ravel()]) + change
    return Solution(parent.family, parent.sigma**count, parent.halves * count, sides, u), change


def _bent(child: Solution, tracer: Tracer, place: Place, z: complex, moved) -> Solution:
    """To second order in z: the multipliers of the child, near 1, differ from 1 by as much as this changes them."""
    bend, mean = tracer.second_order(place)
    K, s, count = tracer.K, float(tracer.start.solution.sigma), child.K // tracer.K
    turns, signs = (-1.0) ** np.arange(count)[:, None], s ** np.arange(count)[:, None]
    _, along = tracer.rates_of_pair(place)
    each = 2 * turns * (z * z * bend).real + abs(z) ** 2 * mean + along @ moved  # (count, 2K)
    return replace(child, u=child.u + np.concatenate([each[:, :K].ravel(), (signs * each[:, K:]).ravel()]))


def _quarter(tracer: Tracer, place: Place, size: float, sign: int) -> tuple[complex, np.ndarray] | None:
    """z, in units of w with |z| = size, and the parameters' change, at one of two folds; None: there are none."""
    c, d, q = torus.quarter(torus.Map(tracer.solution(place)))
    K, S = tracer.K, tracer.S
    xi = (place.w * tracer.curve.unit[:S])[2 * K :]
    scale = (q.conj() @ xi) / (q.conj() @ q)  # xi = scale q
    A = c / abs(d)
    if not abs(A) > 1:
        return None
    u = A / abs(A) * np.exp(1j * sign * np.arccos(-1 / abs(A)))
    z = size * abs(scale) * np.exp(1j * (np.angle(d) - np.angle(u)) / 4)
    eps = -abs(d) * abs(z) ** 2 * (A + u)
    rates, _ = tracer.rates_of_pair(place)
    moved = np.linalg.solve(np.array([rates.real, rates.imag]), [eps.real, eps.imag])
    return z / scale, moved
