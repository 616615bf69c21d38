"""The oscillator as polynomials of its free numbers, two at most (engine/continuation/moving_flow.py)."""

from functools import cache, lru_cache
from operator import attrgetter

import numpy as np
from numpy.polynomial import chebyshev

from vibro_sweep.analysis.periodic.contact_numbers import EventUnits, numbers_of
from vibro_sweep.engine.continuation import moving_flow
from vibro_sweep.engine.impulses.extended import extended, identity
from vibro_sweep.engine.impulses.extremes import middle_weights
from vibro_sweep.engine.impulses.flow import flow, rates
from vibro_sweep.engine.impulses.free_modes import checked_cells
from vibro_sweep.engine.impulses.taylor_orders import exponential, taylor_rows
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.linear import MOTION, Linear

FEW = 4  # degree that is tried first
DECAYED = 4e-15  # relative size of the last coefficients
NARROWEST = 1e-11  # of what is asked for
BEYOND = 1.2  # times the reach, up to where the polynomials hold
KEPT = 64  # oscillators
ASIDE = 0.37  # of the reach: where degrees are read off, so that products of both parameters are seen


def sampled(q: Linear, units: EventUnits) -> np.ndarray:
    """The numbers of `plane_of`.values, in these units."""
    B, (length, rate) = rates(q), units
    n = len(B) - 3
    N = n // 2
    B[:N] /= rate * np.repeat([1.0, 1 / rate, length], [N, N, 3])
    B[N:n] /= rate**2 * np.repeat([1.0, 1 / rate, length], [N, N, 3])
    A = np.column_stack([B[:n, :n], B[:n, n + 2]])
    return np.concatenate([A.ravel(), B[N:n, n], B[N:n, n + 1], numbers_of(q, units)])


class Oscillators:
    """The oscillators of a family along up to two of its parameters, over so many half periods. Raises
    TooStiffError."""

    def __init__(self, family: Family, names: tuple[str, ...], half_periods: int, units: EventUnits):
        checked_cells(family.linear, half_periods)
        self.family, self.names, self.half_periods, self.units = family, names, half_periods, units
        self.slopes = [family.derivative(name) for name in names]
        still = not any(np.any(values) for slope in self.slopes for values in attrgetter(*MOTION)(slope))
        self._still = sampled(family.linear, units) if still else None
        self._known: dict[tuple[float, ...], Family] = {}  # the last ones

    def at(self, p) -> Family:
        key = tuple(map(float, p[: len(self.names)]))
        if key not in self._known:
            if len(self._known) >= KEPT:
                del self._known[next(iter(self._known))]
            self._known[key] = self.family.replace(**dict(zip(self.names, key, strict=True)))
        return self._known[key]

    def values(self, p) -> np.ndarray:
        """`sampled` at the parameters p; the phase, which that does not need, is not looked for."""
        q = self.at(p).built
        if np.any(q.contact.is_compliant((-1, 1)) != self.family.linear.contact.is_compliant((-1, 1))):
            raise ValueError("k_stop: a stop has lost its stiffness")
        if self._still is None:
            return sampled(q, self.units)
        values = self._still.copy()
        known = numbers_of(q, self.units)
        values[-len(known) :] = known
        return values

    def _sample(self, p) -> np.ndarray:
        try:
            with np.errstate(all="ignore"):
                values = self.values(p)
                if not values[-1] > 0:  # there is no forcing period
                    return np.full_like(values, np.nan)
                return np.where(np.isinf(values), 0.0, values)  # a stop that is not there
        except (ValueError, ZeroDivisionError, np.linalg.LinAlgError):
            q = self.family.linear
            return np.full(moving_flow.count_of(q.masses, q.compliant), np.nan)

    def around(self, around, within) -> np.ndarray | None:
        """(1,) `plane_of` around these values, as far as `within`, or as polynomials hold; None: nowhere."""
        count = len(self.names)
        centre, reach = np.zeros(2), np.full(2, np.inf)
        centre[:count], reach[:count] = around[:count], within[:count]
        least = NARROWEST * reach[:count]
        while np.all(reach[:count] > least):
            degrees = [self._degree(centre, reach, j) if j < count else 0 for j in range(2)]
            if None not in degrees:
                found = self._fitted(centre, reach, degrees)
                if found is not None:
                    return self._built(centre, reach, degrees, *found)
            reach = reach / np.where([degree is None for degree in degrees] if None in degrees else True, 2, 1)
        return None

    def _degree(self, centre, reach, j: int) -> int | None:
        """The least degree in parameter j; None where the highest allowed is not enough."""
        start = centre + ASIDE * np.where(np.isfinite(reach), reach, 0.0)
        for most in (FEW, moving_flow.DEGREE):
            values = []
            for x in _nodes(most):
                start[j] = centre[j] + BEYOND * reach[j] * x
                values.append(self._sample(start))
            values = np.array(values)
            if not np.all(np.isfinite(values)):
                return None
            size = _sizes(values, 2 * self.family.linear.masses)
            seen = np.flatnonzero((np.abs(_to_chebyshev(most) @ values) > DECAYED * size).any(axis=1))
            degree = int(seen[-1]) if len(seen) else 0
            if degree <= most - 2:
                return degree
        return None

    def _fitted(self, centre, reach, degrees):
        nodes, span = [_nodes(degree) for degree in degrees], np.where(np.isfinite(reach), reach, 0.0)
        values = np.array(
            [[self._sample(centre + BEYOND * span * [x, y]) for y in nodes[1]] for x in nodes[0]]
        )  # (d1 + 1, d2 + 1, count)
        if not np.all(np.isfinite(values)):
            return None
        c = values
        for to in (_to_chebyshev, _to_powers):  # one after the other: in powers rounding would not stay small
            first, second = map(to, degrees)
            c = np.einsum("ix,xyk->iyk", first, np.einsum("jy,xyk->xjk", second, c))
        return c, values

    def _built(self, centre, reach, degrees, c, values) -> np.ndarray:
        q = self.at(centre).linear
        n = 2 * q.masses
        result = np.zeros(1, moving_flow.plane_of(n // 2, q.compliant))
        r, at_centre = result[0], sampled(q, self.units)
        flat, size = values[..., : n * (n + 1)], _sizes(values.reshape(-1, values.shape[-1]), n)[: n * (n + 1)]
        for j in range(2):
            r["moves"][j] = bool(np.any(np.ptp(flat, axis=j) > 1e-15 * size))
        swaying = np.delete(values.reshape(-1, values.shape[-1]), np.s_[n * (n + 2) : -1], axis=1)
        r["is_still"] = bool(np.all(swaying == swaying[0]))
        if not r["moves"].any():
            c[..., : n * (n + 1)] = 0.0
            c[0, 0, : n * (n + 1)] = at_centre[: n * (n + 1)]
        r["parameters"] = len(self.names)
        r["centre"], r["reach"], r["degree"] = centre, reach, degrees
        r["fit"][: c.shape[0], : c.shape[1]] = c
        r["fit"][0, 0][np.isinf(at_centre)] = at_centre[np.isinf(at_centre)]
        r["half_turns"], r["by_force"] = self.half_periods, q.contact.by_force
        r["width"] = flow(q).width * self.units.rate
        r["middle_weights"], r["rest_weights"] = middle_weights(float(r["width"]))
        longest = np.pi * self.half_periods / values[..., -1].min()
        r["bits"] = min(max(int(np.ceil(np.log2(2 * longest / r["width"]))), 1), moving_flow.BITS)
        A = at_centre[: n * (n + 1)]
        r["series"][:, :, : n + 1], r["powers"][: r["bits"], :, : n + 1] = tables_of(
            A.tobytes(), n, float(r["width"]), int(r["bits"])
        )
        return result


@lru_cache(64)
def tables_of(A: bytes, n: int, width: float, bits: int) -> tuple[np.ndarray, np.ndarray]:
    """B^k/k! and exp(B width 2^j), first n rows, for B = (A; 0) with A (n, n + 1), in extended precision."""
    B = extended(np.vstack([np.frombuffer(A).reshape(n, n + 1), np.zeros(n + 1)]))
    step, powers = exponential(B, extended(width)), []
    for _ in range(bits):
        powers.append(step[:n].astype(float))
        step = step @ step
    return taylor_rows(B, identity(n + 1))[:, :n].astype(float), np.array(powers)


def _nodes(degree: int) -> np.ndarray:
    return np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))


@cache
def _to_chebyshev(degree: int) -> np.ndarray:
    """Coefficients of Chebyshev polynomials, from values at the nodes."""
    waves = np.cos(np.outer(np.arange(degree + 1), np.arccos(_nodes(degree))))
    return waves * np.append(1.0, np.full(degree, 2.0))[:, None] / (degree + 1)


@cache
def _to_powers(degree: int) -> np.ndarray:
    """Coefficients of the powers of x, from those of Chebyshev polynomials of x / BEYOND."""
    powers = np.zeros((degree + 1, degree + 1))
    for k in range(degree + 1):
        powers[: k + 1, k] = chebyshev.cheb2poly(np.eye(degree + 1)[k, : k + 1])
    return powers * BEYOND ** -np.arange(degree + 1.0)[:, None]


def _sizes(values: np.ndarray, n: int) -> np.ndarray:
    """The sizes beside which changes of `sampled` count as small: of rates together, of numbers one by one."""
    size = np.abs(values).max(axis=0)
    forces, rates = np.zeros(n * (n + 2), bool), size[: n * (n + 2)]
    forces[n : n * (n + 1) : n + 1] = forces[n * (n + 1) :] = True
    rates[:] = np.where(forces, rates[forces].max(), rates[~forces].max())
    return np.maximum(size, 1e-300)
