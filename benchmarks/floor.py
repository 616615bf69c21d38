"""The arithmetic floor of this method: what its sums and products alone must cost, against what a period costs.

Scan: a stop can be excluded from a cell by two numbers at least, each a sum of four products and the forced motion:
8 multiply-adds a cell, at the rate at which this machine does them on arrays in its first cache.
Impact: the state at the cell's beginning (16 multiply-adds), one series of 16 coefficients from 6 numbers (96), three
evaluations with the slope (3 x 30), and the impulse's share of the state at the cell's end (4 x 15 + 4): 266 in all.
The lower floor takes all of them at the vector rate, as if independent orbits filled the vector unit. The floor of one
orbit measures an impact as it is: its evaluations wait for one another, and two divide. Not counted: comparisons,
branches, records, and cells that the bound cannot clear although nothing happens in them.
"""

import numpy as np
import problem
from book import Goal, digits, main, table
from numba import njit
from peers import ENGINE, METHODS
from timing import interleaved, spent

from vibro_sweep.kernels.flight import ORDER
from vibro_sweep.orbit import points_of
from vibro_sweep.system import System

TITLE = "The arithmetic floor"
COMMAND = "python benchmarks/floor.py"
CLEARANCES = (6.8, *problem.CLEARANCES)
ASKED = 3
MULTIPLY_ADDS = 16 + 96 + 3 * 30 + 4 * 15 + 4  # of an impact


@njit(fastmath=True, error_model="numpy")
def multiply_adds(columns, y, repeats):
    """4 multiply-adds and 4 loads for each column of `columns` (4, n), summed up, n * repeats times."""
    total = 0.0
    for n in range(repeats):
        y0, y1, y2, y3 = y[0] + n, y[1], y[2], y[3]  # + n: or the loop would be done once
        for p in range(columns.shape[1]):
            total += columns[0, p] * y0 + columns[1, p] * y1 + columns[2, p] * y2 + columns[3, p] * y3
    return total


@njit(fastmath={"contract"}, error_model="numpy")
def one_impact(E, series, impulse, X, gap, width, c):
    """The least that finds an impact within a cell and takes the state X over it."""
    x0 = E[0, 0] * X[0] + E[0, 1] * X[1] + E[0, 2] * X[2] + E[0, 3] * X[3]
    x1 = E[1, 0] * X[0] + E[1, 1] * X[1] + E[1, 2] * X[2] + E[1, 3] * X[3]
    x2 = E[2, 0] * X[0] + E[2, 1] * X[1] + E[2, 2] * X[2] + E[2, 3] * X[3]
    x3 = E[3, 0] * X[0] + E[3, 1] * X[1] + E[3, 2] * X[2] + E[3, 3] * X[3]
    for n in range(ORDER):
        c[n] = (
            (series[0, n] * x0 + series[1, n] * x1)
            + (series[2, n] * x2 + series[3, n] * x3)
            + (series[4, n] * X[4] + series[5, n] * X[5])
        )
    u, slope = 0.5 * width, 1.0
    for look in range(3):  # even and odd terms side by side: half the wait
        v = u * u
        even, odd, slope_even, slope_odd = c[ORDER - 2], c[ORDER - 1], 0.0, 0.0
        for n in range(ORDER - 4, -1, -2):
            slope_even = slope_even * v + even
            even = even * v + c[n]
            slope_odd = slope_odd * v + odd
            odd = odd * v + c[n + 1]
        slope = 2.0 * u * (slope_even + u * slope_odd) + odd
        if look < 2:
            u += (gap - (even + u * odd)) / slope
    push, left = -1.8 * slope, width - u
    v = left * left
    a0, a1, a2, a3 = impulse[0, ORDER - 2], impulse[1, ORDER - 2], impulse[2, ORDER - 2], impulse[3, ORDER - 2]
    b0, b1, b2, b3 = impulse[0, ORDER - 1], impulse[1, ORDER - 1], impulse[2, ORDER - 1], impulse[3, ORDER - 1]
    for n in range(ORDER - 4, -1, -2):
        a0, b0 = a0 * v + impulse[0, n], b0 * v + impulse[0, n + 1]
        a1, b1 = a1 * v + impulse[1, n], b1 * v + impulse[1, n + 1]
        a2, b2 = a2 * v + impulse[2, n], b2 * v + impulse[2, n + 1]
        a3, b3 = a3 * v + impulse[3, n], b3 * v + impulse[3, n + 1]
    a0, a1, a2, a3 = a0 + left * b0, a1 + left * b1, a2 + left * b2, a3 + left * b3
    X[0], X[1], X[2], X[3] = x0 + push * a0, x1 + push * a1, x2 + push * a2, x3 + push * a3


@njit(error_model="numpy")
def impacts(E, series, impulse, X, gap, width, c, repeats):
    """So many impacts, each from the state that the one before left."""
    for _ in range(repeats):
        one_impact(E, series, impulse, X, gap, width, c)


def multiply_add_rate(rounds: int) -> float:
    """Multiply-adds per second, on 16 kB."""
    columns, y, repeats = np.random.default_rng(1).uniform(-1, 1, (4, 512)), np.ones(4), 20_000
    multiply_adds(columns, y, 1)
    return columns.size * repeats / min(spent(lambda: multiply_adds(columns, y, repeats))[0] for _ in range(rounds))


def impact_cost(rounds: int) -> float:
    """Seconds for an impact of one orbit, one after the other.

    The numbers are made up so that they stay the same from impact to impact; the work does not depend on them.
    """
    E, series, impulse, c = np.eye(4), np.zeros((6, ORDER)), np.zeros((4, ORDER)), np.zeros(ORDER)
    series[0, 0], series[1, 1], series[2, 3], series[3, 5] = 1.0, 1.0, 1e-3, 1e-6
    impulse[1, 1] = 1e-9
    X, repeats = np.array([0.0, 1.0, 0.1, 0.1, 0.5, 0.5]), 200_000
    impacts(E, series, impulse, X, 0.1, 0.3, c, 1)
    return min(spent(lambda: impacts(E, series, impulse, X, 0.1, 0.3, c, repeats))[0] for _ in range(rounds)) / repeats


def measure(quick: bool) -> dict:
    rounds = 3 if quick else 15
    params = problem.on_attractor(CLEARANCES[0])[0]
    cells = int(points_of({name: np.array(value) for name, value in System(**params).parameters().items()})["cells"])
    rate, costs = multiply_add_rate(rounds), {}
    for b in CLEARANCES:
        params, states = problem.on_attractor(b)
        solvers = {m.name: m.solver(params, states) for m in METHODS if m.name == ENGINE}
        costs[b] = interleaved(solvers, problem.CYCLE.get(b, 1), 0.03 if quick else 0.2, rounds)
    return {
        "cells": cells,
        "rate": rate,
        "scan": 8 * cells / rate,
        "chain": impact_cost(rounds),
        "overlapped": MULTIPLY_ADDS / rate,
        "costs": costs,
    }


def floor(data: dict, b: float, impact: str) -> float:
    """Seconds per period at least; impact: "chain" or "overlapped"."""
    return data["scan"] + data["costs"][b][ENGINE].impacts * data[impact]


def text(data: dict) -> str:
    rows = []
    for b in CLEARANCES:
        cost, chain, overlapped = data["costs"][b][ENGINE], floor(data, b, "chain"), floor(data, b, "overlapped")
        times = [digits(1e9 * seconds) for seconds in (cost.least, chain, overlapped)]
        ratios = [digits(cost.least / seconds) for seconds in (chain, overlapped)]
        rows.append((f"{b:g}", f"{cost.impacts:.2f}", *times, *ratios))
    header = ("b", "impacts", "engine, ns", "floor, one orbit", "floor, vector rate", "ratio", "ratio, vector rate")
    counted = " ".join(__doc__.split("\n\n", 1)[1].split())
    return (
        "Per forcing period, the least of all rounds. Multiply-adds on arrays in the first cache: "
        f"{data['rate'] / 1e9:.1f} per nanosecond; the scan of {data['cells']} cells: {1e9 * data['scan']:.1f} ns. An "
        f"impact: {1e9 * data['chain']:.0f} ns in one orbit, {1e9 * data['overlapped']:.0f} ns at the vector rate."
        f"\n\n{counted}\n\n{table(header, rows)}"
    )


def goals(data: dict) -> list[Goal]:
    rows = []
    for b in CLEARANCES:
        cost = data["costs"][b][ENGINE].least
        chain, overlapped = cost / floor(data, b, "chain"), cost / floor(data, b, "overlapped")
        reached = f"{chain:.1f} times; {overlapped:.1f} times the floor at the vector rate"
        rows.append(Goal(f"b = {b:g}: within {ASKED} times the arithmetic floor", reached, ASKED / chain, COMMAND))
    return rows


def figure(_: dict) -> None:
    """A table says it all."""


if __name__ == "__main__":
    main(__name__)
