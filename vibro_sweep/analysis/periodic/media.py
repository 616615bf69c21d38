"""The tables with which compiled steps work (engine/impulses/medium.py), along a parameter or for one oscillator."""

import numpy as np
from numpy.polynomial import chebyshev

from vibro_sweep.analysis.periodic.impulse_equations import flow, moves_stops_straight
from vibro_sweep.engine.impulses import branch, extremes, medium
from vibro_sweep.engine.impulses.flow import rates
from vibro_sweep.engine.impulses.medium import NUMBERS, TAU
from vibro_sweep.model.linear import Family, Linear, forcing_period

DECAYED = 1e-14  # relative size of their last coefficients; or
NOISE = 1e-11  # where half the interval makes them no smaller, which is what rounding leaves
NARROWEST = 1e-6  # of the branch's range


def _numbers(q: Linear, B: np.ndarray, halves: int) -> np.ndarray:
    """B and the numbers, in the order of `values` of a medium."""
    numbers = [q.low, q.high, 1 + q.R_low, 1 + q.R_high, q.omega, q.tau, forcing_period(q) / 2 * halves]
    return np.append(B.ravel(), [value if np.isfinite(value) else 0.0 for value in numbers])


def medium_of(family: Family, halves: int, name: str, centre: float, reach: float) -> np.ndarray | None:
    """The oscillator around a value of the parameter, to `reach` or as far as polynomials hold; None: they do not."""
    nodes = np.cos(np.pi * (np.arange(medium.DEGREE + 1) + 0.5) / (medium.DEGREE + 1))
    least, before = NARROWEST * reach, np.inf
    if moves_stops_straight(family, name, reach):
        return _straight_medium(family, halves, name, centre, reach)

    def sampled(p: float) -> np.ndarray:
        q = family.replace(**{name: p}).linear
        return _numbers(q, rates(q), halves)

    while reach > least:
        try:
            values = np.array([sampled(centre + branch.BEYOND * reach * x) for x in nodes])
        except (ValueError, np.linalg.LinAlgError):
            values = np.full((medium.DEGREE + 1, NUMBERS + 1), np.nan)
        if np.all(np.isfinite(values)):
            values[:, TAU - NUMBERS] = np.unwrap(values[:, TAU - NUMBERS])
            c, size = chebyshev.chebfit(nodes, values, medium.DEGREE), np.abs(values).max(axis=0)
            size[:-NUMBERS] = sizes_of_rates(size[:-NUMBERS], _acts_as_force(len(family.linear.along)))
            size[TAU - NUMBERS] = max(size[TAU - NUMBERS], 1.0)
            left = float(np.max(np.abs(c[-2:]) / np.maximum(size, 1e-300)))
            if left <= DECAYED or (left <= NOISE and left > 0.3 * before):
                c[np.abs(c) < 2e-16 * size] = 0.0
                return _built(family.replace(**{name: centre}).linear, c, values, centre, reach)
            before = left
        reach /= 2
    return None


def sizes_of_rates(largest: np.ndarray, forces: np.ndarray) -> np.ndarray:
    """Beside what entries of B are small: those of forces, which are in the unit of length too, and all others."""
    return np.where(forces, largest[forces].max(), largest[~forces].max())


def _acts_as_force(masses: int) -> np.ndarray:
    """Of the entries of B: whether they act on sin, cos and 1."""
    n = 2 * masses
    forces = np.zeros((n + 3, n + 3), bool)
    forces[:n, n:] = True
    return forces.ravel()


def _straight_medium(family: Family, halves: int, name: str, centre: float, reach: float) -> np.ndarray:
    """Where the parameter moves stops and restitutions in proportion, and no table."""
    q = family.linear
    ends = (family.replace(**{name: centre + x * branch.BEYOND * reach}).stops(name, q)[0] for x in (-1, 1))
    low, high = (_numbers(end, flow(q).B, halves) for end in ends)
    return _built(q, np.array([low + high, high - low]) / 2, np.array([low, high]), centre, reach)


def still_medium(q: Linear, halves: int) -> np.ndarray:
    """One oscillator, for steps in which no parameter changes; its parameter is 0."""
    values = _numbers(q, rates(q), halves)[None]
    return _built(q, values, values, 0.0, 1.0)


def _built(q: Linear, c, values, centre: float, reach: float) -> np.ndarray:
    f = flow(q)
    m = len(f.B)
    n = m - 3
    degree = int(np.flatnonzero(np.abs(c).max(axis=1))[-1])
    powers_of = np.zeros((max(degree, 1) + 1, c.shape[1]))
    powers_of[0] = c[0]
    for j in np.flatnonzero(np.any(c[1:], axis=0)):
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
    r["series"], r["powers"][:], r["step"] = f.series.reshape(-1, m, m)[:, :n], f.powers, f.powers[0].T
    r["gap_rows"] = r["series"][:, 0].T
    r["middle_weights"], r["rest_weights"] = extremes.middle_weights(f.width)
    r["middle"], r["rest"] = r["gap_rows"] @ r["middle_weights"], np.abs(r["gap_rows"]) @ r["rest_weights"]
    return result
