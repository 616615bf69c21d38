"""This package as one of the methods: `compute.compute` on a block of one point with one start or eight."""

from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from unittest.mock import patch

import numpy as np
from peers import Solver

import vibro_sweep as vs
from vibro_sweep.driver import blocks, compute
from vibro_sweep.engine.tables import cells as grid
from vibro_sweep.model import status
from vibro_sweep.scene import scene


def scene_text(params, state, observe="impacts", sweep_key="", transient=0, record=1000) -> str:
    system = ", ".join(f"{name}: {value!r}" for name, value in params.items())
    start = ", ".join(f"{name}: {float(x)!r}" for name, x in zip(("x1", "v1", "x2", "v2"), state, strict=True))
    orbit = f"transient: {transient}, record: {record}"
    return f"system: {{{system}}}\n{sweep_key}\nstart: {{{start}}}\norbit: {{{orbit}}}\nobserve: [{observe}]\n"


def block_of(text: str) -> blocks.Block:
    """A scene as one block."""
    parsed = scene.parse_scene(text)
    (block,) = blocks.blocks(parsed, points_per_block=10**9)
    return block


@contextmanager
def cell_count(cells: int):
    """The grid with another number of cells than the package chooses; fewer than that are not certified."""
    with patch.object(grid, "cells_needed", lambda rates, *_: np.full(rates.shape[:-1], cells)):
        yield


def _solver(params, states, observe, cells) -> Solver:
    grid = (lambda: cell_count(cells)) if cells else nullcontext
    thread = ThreadPoolExecutor(1)  # `compute` keeps its workspace per thread

    def impacts(count):
        with grid():
            periods = 64
            while True:
                hits = vs.simulate(vs.System(**params), states[0], periods).impacts
                if len(hits) >= count or periods > 10**5:
                    return hits["t"][:count], hits["side"][:count]
                periods *= 4

    def job(periods):
        block = block_of(scene_text(params, states[0], observe, record=periods))._replace(starts=states)

        def run():
            with grid():
                arrays = thread.submit(compute.compute, block).result()[1]
            if not status.is_valid(arrays["status"]).all():
                raise ArithmeticError(f"status {arrays['status']}")
            return int(arrays["impacts_right"].sum() + arrays["impacts_left"].sum())

        return run

    return Solver(impacts, job, len(states))


def batch(params, states, cells=None) -> Solver:
    """Eight orbits, as the points of a sweep."""
    return _solver(params, states, "impacts", cells)


def scalar(params, states) -> Solver:
    """One orbit alone."""
    return _solver(params, states[:1], "impacts", None)


def exponents(params, states) -> Solver:
    """Eight orbits with the four Lyapunov exponents of each."""
    return _solver(params, states, "impacts, lyapunov", None)
