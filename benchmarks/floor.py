"""The arithmetic floor of this method: what its sums and products alone must cost, against what a period costs.

Scan: a stop can be excluded from a cell by two numbers at least, each a sum of four products and the forced motion:
8 multiply-adds a cell, at the rate at which this machine does them in vectors, one factor of each from its first cache.
Impact: the state at the cell's beginning (16 multiply-adds), one economised series of 12 coefficients from 6 numbers
(72), three evaluations with the slope (3 x 22), and the impulse's share of the state at the cell's end (4 x 11 + 4):
202 in all. The lower floor takes all of them at the vector rate. The other measures an impact as it is, of eight
orbits at once: its evaluations wait for one another, and two divide. Not counted: comparisons, branches, records, and
cells that the bound cannot clear although nothing happens in them.
"""

import numpy as np
import problem
from book import Goal, digits, main, table
from peers import ENGINE, METHODS
from timing import interleaved, spent

from vibro_sweep.engine.one_system import points_of
from vibro_sweep.engine.simd.jit import exported, jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import new_lines, put, row
from vibro_sweep.engine.tables.economy import FEWER_TERMS
from vibro_sweep.model.oscillator import System

TITLE = "The arithmetic floor"
COMMAND = "python benchmarks/floor.py"
CLEARANCES = problem.CLEARANCES  # not above grazing: an orbit that can strike no more costs nothing
ASKED = 3
TERMS = FEWER_TERMS
MULTIPLY_ADDS = 16 + 6 * TERMS + (3 + 2) * 2 * (TERMS - 1) + 4  # of an impact
SUMS = 8  # side by side: one waits for the last one of the same sum


@exported
def multiply_adds(rows, y, out, repeats):
    """One multiply-add and one load for each number of `rows` (n, LANES), `repeats` times; the sums go to `out`."""
    a = b = c = d = e = f = g = h = row(out, 0)
    for n in range(repeats):
        factor = y + n  # or the loop would be done once
        for p in range(0, len(rows), SUMS):
            a, b = a + row(rows, p) * factor, b + row(rows, p + 1) * factor
            c, d = c + row(rows, p + 2) * factor, d + row(rows, p + 3) * factor
            e, f = e + row(rows, p + 4) * factor, f + row(rows, p + 5) * factor
            g, h = g + row(rows, p + 6) * factor, h + row(rows, p + 7) * factor
    put(out, 0, ((a + b) + (c + d)) + ((e + f) + (g + h)))


@exported
def impacts(E, series, impulse, X, gap, width, c, repeats):
    """So many impacts of eight orbits, each from the state that the one before left: the least that finds an impact
    within a cell and takes the state X over it. One row for each number, one column for each orbit."""
    for _ in range(repeats):
        x = X_of(E, X, 0), X_of(E, X, 1), X_of(E, X, 2), X_of(E, X, 3)
        for n in range(TERMS):
            put(
                c,
                n,
                (row(series, n) * x[0] + row(series, TERMS + n) * x[1])
                + (row(series, 2 * TERMS + n) * x[2] + row(series, 3 * TERMS + n) * x[3])
                + (row(series, 4 * TERMS + n) * row(X, 4) + row(series, 5 * TERMS + n) * row(X, 5)),
            )
        u = 0.5 * row(width, 0)
        for _ in range(2):
            value, slope = evaluate(c, 0, u)
            u = u + (row(gap, 0) - value) / slope
        _, slope = evaluate(c, 0, u)
        push, left = -1.8 * slope, row(width, 0) - u
        x1, v1 = evaluate(impulse, 0, left)
        x2, v2 = evaluate(impulse, TERMS, left)
        put(X, 0, x[0] + push * x1)
        put(X, 1, x[1] + push * v1)
        put(X, 2, x[2] + push * x2)
        put(X, 3, x[3] + push * v2)


@jit
def X_of(E, X, i):
    """Number i of the state at the cell's beginning."""
    n = 4 * i
    return (row(E, n) * row(X, 0) + row(E, n + 1) * row(X, 1)) + (row(E, n + 2) * row(X, 2) + row(E, n + 3) * row(X, 3))


@jit
def evaluate(c, first, u):
    """A polynomial, whose coefficients begin in row `first`, and its slope; even and odd terms side by side."""
    v = u * u
    even, odd = row(c, first + TERMS - 2), row(c, first + TERMS - 1)
    slope_even, slope_odd = 0.0 * u, 0.0 * u
    for n in range(TERMS - 4, -1, -2):
        slope_even = slope_even * v + even
        even = even * v + row(c, first + n)
        slope_odd = slope_odd * v + odd
        odd = odd * v + row(c, first + n + 1)
    return even + u * odd, odd + 2.0 * u * (slope_even + u * slope_odd)


def multiply_add_rate(rounds: int) -> float:
    """Multiply-adds per second, on 16 kB, cache line by cache line like the engine's tables."""
    rows, out, repeats = new_lines((256, LANES), float), new_lines((1, LANES), float), 20_000
    rows[:] = np.random.default_rng(1).uniform(-1, 1, rows.shape)
    multiply_adds(rows, 1.0, out, 1)
    return rows.size * repeats / min(spent(lambda: multiply_adds(rows, 1.0, out, repeats))[0] for _ in range(rounds))


def impact_cost(rounds: int) -> float:
    """Seconds for an impact of one of eight orbits, one after the other.

    The numbers are made up so that they stay the same from impact to impact; the work does not depend on them.
    """
    E, series, impulse, c, X, gap, width = (
        new_lines((n, LANES), float) for n in (16, 6 * TERMS, 2 * TERMS, TERMS, 6, 1, 1)
    )
    E[::5], gap[:], width[:] = 1.0, 0.1, 0.3
    series[0], series[TERMS + 1], series[2 * TERMS + 3], series[3 * TERMS + 5] = 1.0, 1.0, 1e-3, 1e-6
    impulse[TERMS + 1], repeats = 1e-9, 50_000
    X[:] = np.array([[0.0, 1.0, 0.1, 0.1, 0.5, 0.5]]).T

    def run():
        impacts(E, series, impulse, X, gap, width, c, repeats)

    run()
    return min(spent(run)[0] for _ in range(rounds)) / repeats / LANES


def measure(quick: bool) -> dict:
    rounds = 3 if quick else 15
    params = problem.on_attractor(CLEARANCES[0])[0]
    cells = int(points_of({name: np.array(value) for name, value in System(**params).parameters().items()})["cells"])
    rate, costs = multiply_add_rate(rounds), {}
    for b in CLEARANCES:
        params, states = problem.on_attractor(b)
        solvers = {m.name: m.solver(params, states) for m in METHODS if m.name == ENGINE}
        costs[b] = interleaved(solvers, problem.CYCLE[b], 0.03 if quick else 0.2, rounds)
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
    header = (
        "b",
        "impacts",
        "engine, ns",
        "floor, impact as it is",
        "floor, vector rate",
        "ratio",
        "ratio, vector rate",
    )
    counted = " ".join(__doc__.split("\n\n", 1)[1].split())
    return (
        "Per forcing period, the least of all rounds. Multiply-adds on arrays in the first cache: "
        f"{data['rate'] / 1e9:.1f} per nanosecond; the scan of {data['cells']} cells: {1e9 * data['scan']:.1f} ns. An "
        f"impact: {1e9 * data['chain']:.1f} ns as it is, {1e9 * data['overlapped']:.1f} ns at the vector rate."
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
