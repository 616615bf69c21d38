"""Compiled steps along a branch (engine/impulses/branch.py), from one place where something happens to the next."""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from vibro_sweep.analysis.impulse_equations import flow
from vibro_sweep.analysis.walk import Point, Walk
from vibro_sweep.engine.impulses import branch, medium, places
from vibro_sweep.engine.impulses.flights import contact_coordinates, rates
from vibro_sweep.engine.impulses.medium import NUMBERS, TAU
from vibro_sweep.engine.impulses.places import Place, Steps, new_place, new_record, new_work
from vibro_sweep.engine.impulses.tables import ORDER, REAL
from vibro_sweep.model.linear import Family, forcing_period

DECAYED = 1e-14  # relative size of their last coefficients; or
NOISE = 1e-11  # where half the interval makes them no smaller, which is what rounding leaves
NARROWEST = 1e-6  # of the branch's range
AT_ONCE = 1024  # points of one call


class Rows(NamedTuple):
    """Points of a branch."""

    p: np.ndarray  # (points,)
    t: np.ndarray  # (points, K)
    D: np.ndarray  # (points, K)
    ends: np.ndarray  # (points, rests)
    motion: np.ndarray  # (points, K, 2): gap velocity and acceleration before each impact
    margin: np.ndarray  # (points,)
    residual: np.ndarray  # (points,)
    state: np.ndarray  # (points, 2N): x1 v1 .. xN vN at t = 0


def join(parts: list[Rows]) -> Rows:
    return Rows(*(np.concatenate(values) for values in zip(*parts, strict=True)))


def _sampled(family: Family, halves: int, name: str, p: float) -> np.ndarray:
    """B and the numbers at a value of the parameter, in the order of `Medium.values`."""
    q = family.replace(**{name: p}).linear
    numbers = [q.low, q.high, 1 + q.R_low, 1 + q.R_high, q.omega, q.tau, forcing_period(q) / 2 * halves]
    return np.append(rates(q).ravel(), [value if np.isfinite(value) else 0.0 for value in numbers])


def medium_of(family: Family, halves: int, name: str, centre: float, reach: float) -> np.ndarray | None:
    """The oscillator around a value of the parameter, to `reach` or as far as polynomials hold; None: they do not."""
    nodes = np.cos(np.pi * (np.arange(medium.DEGREE + 1) + 0.5) / (medium.DEGREE + 1))
    least, before = NARROWEST * reach, np.inf
    while reach > least:
        try:
            values = np.array([_sampled(family, halves, name, centre + branch.BEYOND * reach * x) for x in nodes])
        except (ValueError, np.linalg.LinAlgError):
            values = np.full((medium.DEGREE + 1, NUMBERS + 1), np.nan)
        if np.all(np.isfinite(values)):
            values[:, TAU - NUMBERS] = np.unwrap(values[:, TAU - NUMBERS])
            c, size = chebyshev.chebfit(nodes, values, medium.DEGREE), np.abs(values).max(axis=0)
            size[:-NUMBERS] = size[:-NUMBERS].max()
            size[TAU - NUMBERS] = max(size[TAU - NUMBERS], 1.0)
            left = float(np.max(np.abs(c[-2:]) / np.maximum(size, 1e-300)))
            if left <= DECAYED or (left <= NOISE and left > 0.3 * before):
                c[np.abs(c) < 2e-16 * size] = 0.0
                return _built(family, name, c, values, centre, reach)
            before = left
        reach /= 2
    return None


def _built(family, name, c, values, centre, reach) -> np.ndarray:
    q = family.replace(**{name: centre}).linear
    f = flow(q)
    m = len(f.B)
    n = m - 3
    degree = int(np.flatnonzero(np.abs(c).max(axis=1))[-1])
    powers_of = np.zeros((max(degree, 1) + 1, c.shape[1]))
    for j in range(c.shape[1]):
        column = chebyshev.cheb2poly(c[: degree + 1, j])
        powers_of[: len(column), j] = column
    powers_of /= branch.BEYOND ** np.arange(len(powers_of))[:, None]
    result = np.zeros(1, medium.medium_of(n // 2))
    r = result[0]
    r["moves"] = bool(np.any(np.ptp(values[:, : m * m], axis=0) > 0))
    if not r["moves"]:  # to the last digit
        powers_of[:, : m * m] = 0.0
        powers_of[0, : m * m] = f.B.ravel()
    open_stops = ~np.isfinite([q.low, q.high])
    powers_of[0, m * m : m * m + 2][open_stops] = np.array([-np.inf, np.inf])[open_stops]
    r["centre"], r["reach"], r["degree"], r["width"] = centre, reach, len(powers_of) - 1, f.width
    r["fit"][: len(powers_of)] = powers_of
    r["bits"] = min(max(int(np.ceil(np.log2(2 * values[:, -1].max() / f.width))), 1), medium.BITS)
    series = [np.eye(n, m).astype(REAL)]
    for k in range(1, ORDER + 1):
        series.append(series[-1] @ f.B.astype(REAL) / k)
    r["series"], r["powers"][:], r["step"] = np.array(series), f.powers, f.powers[0].T
    r["gap_rows"] = r["series"][:, 0].T
    return result


class Track:
    """Steps one way along a branch from its first point."""

    def __init__(self, first: Point, walk: Walk, bounds, origin: int, longest: float, shortest: float, straight: float):
        self.walk, self.bounds, self.origin = walk, bounds, origin
        K, n = walk.start.K, first.solution.states.shape[1] - 3
        scale = walk.scale
        self.steps = Steps(
            float(scale[0]), float(scale[K]), float(scale[-1]), longest, shortest, straight, *map(float, bounds)
        )
        self.sides, self.sigma = np.array(walk.start.sides, float), float(walk.start.sigma)
        self.a, self.b, self.first = (new_place(K, n) for _ in range(3))
        self.work, self.record = new_work(K, n), new_record(AT_ONCE, K, n)
        self.size = float(first.solution.size_of_gap)
        self.medium = self._medium(first.p)

    def _medium(self, p: float) -> np.ndarray | None:
        lo, hi = self.bounds
        return medium_of(self.walk.family, self.walk.start.halves, self.walk.name, p, hi - lo)

    def begin(self, first: Point, length: float) -> bool:
        """Stand at the first point. False where compiled steps cannot start."""
        if self.medium is None:
            return False
        K, a, scale = len(self.sides), self.a, self.walk.scale
        u = first.x[:-1] * scale[:-1]
        a.t[:], a.D[:], a.z[:] = u[:K], u[K : 2 * K], first.solution.states[:, :-3]
        tangent = first.tangent * scale
        a.tangent_t[:], a.tangent_jump[:] = tangent[:K], tangent[K : 2 * K]
        a.numbers[places.P], a.numbers[places.TANGENT] = first.p, tangent[-1]
        nothing = new_record(0, K, a.z.shape[1])  # no step is made
        if self._walk(1, nothing, True)[0] == branch.NO_START:
            return False
        a.numbers[places.LENGTH] = length
        for here, there in zip(a, self.first, strict=True):
            there[...] = here
        return True

    def _walk(self, passed: int, record, begins: bool) -> tuple[int, int, int]:
        """Reason, points recorded, corrections made."""
        return branch.walk(
            self.medium, self.sides, self.sigma, self.steps, self.size, float(self.origin), passed, self.first, self.a,
            self.b, record, self.work, begins,
        )  # fmt: skip

    def record_steps(self, passed: int) -> tuple[int, int, int]:
        """The compiled part of `run`: reason, points, corrections."""
        return self._walk(passed, self.record, False)

    def run(self, passed: int) -> tuple[int, Rows]:
        """Steps until something happens, or `AT_ONCE` points: the reason and the points before the step.

        NO_START: around the last point the oscillator is not to be had as polynomials of the parameter.
        """
        reason, count, _ = self.record_steps(passed)
        if reason == branch.FAR:
            self.medium = self._medium(float(self.a.numbers[places.P]))
            if self.medium is None:
                reason = branch.NO_START
        r = self.record
        numbers = r.numbers[:count].copy()
        p = numbers[:, places.P]
        state = self._masses(p, r.state[:count])
        t, D, motion = (values[:count].copy() for values in (r.t, r.D, r.motion))
        margin, residual = numbers[:, places.MARGIN], numbers[:, places.DEFECT_HERE] / self.size
        rows = Rows(p, t, D, np.zeros((count, 0)), motion, margin, residual, state)
        return reason, rows

    def _masses(self, p: np.ndarray, states: np.ndarray) -> np.ndarray:
        """x1 v1 .. xN vN from contact coordinates."""
        N = states.shape[1] // 2
        slope = self.walk.family.derivative(self.walk.name)
        if np.any(slope.M) or np.any(slope.along):
            values = [self.walk.family.replace(**{self.walk.name: value}).linear for value in p.tolist()]
            inverse = np.array([contact_coordinates(q).inverse for q in values]).reshape(-1, N, N)
        else:
            inverse = contact_coordinates(self.walk.family.linear).inverse[None]
        result = np.empty_like(states)
        result[:, ::2] = np.einsum("pij,pj->pi", np.broadcast_to(inverse, (len(p), N, N)), states[:, :N])
        result[:, 1::2] = np.einsum("pij,pj->pi", np.broadcast_to(inverse, (len(p), N, N)), states[:, N:])
        return result

    def accept(self) -> None:
        """Go on from b."""
        for here, there in zip(self.b, self.a, strict=True):
            there[...] = here

    def point(self, place: Place) -> Point | None:
        """The same point, corrected with the walk's own equations."""
        w, K = self.walk, len(self.sides)
        u = np.concatenate([place.t, place.D])
        tangent = np.concatenate([place.tangent_t, place.tangent_jump])
        p = float(place.numbers[places.P])
        if w.start.equations.free:
            e = w.equations(p)
            u, tangent = np.append(u, 0.0), np.append(tangent, 0.0)
            u[-1] = -np.mean(e.evaluate(w.start.sides, u)[0][:K])
        x = np.append(u, p) / w.scale
        direction = np.append(tangent, place.numbers[places.TANGENT]) / w.scale
        return w.correct(x, direction, direction)
