"""The bifurcation curves of a scene, as the columns and arrays of its file."""

from collections.abc import Callable
from concurrent.futures import Executor
from typing import Any

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import Arrays, special_point
from vibro_sweep.analysis.branches.branch_search import Branches, compute_branch
from vibro_sweep.analysis.branches.seeds import Seed
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.curves.curve_arrays import SHAPES
from vibro_sweep.analysis.curves.curve_search import Curves, compute_curve, seed_at
from vibro_sweep.analysis.windows.edges import Plane
from vibro_sweep.analysis.windows.explained import explain, probe
from vibro_sweep.driver.executors import kept
from vibro_sweep.driver.followed_branches import where_met
from vibro_sweep.driver.joining import joined
from vibro_sweep.driver.origins import seeds_of, specials_of
from vibro_sweep.driver.swept_plane import edges_in_file
from vibro_sweep.files.pieces import Pieces
from vibro_sweep.results import ragged_dataset
from vibro_sweep.scene import Continuation
from vibro_sweep.scene.continuation import BY_BRANCHES
from vibro_sweep.tables.file_columns import CHART, OF_EDGES
from vibro_sweep.tables.quantity import Quantity


def followed_curves(
    scene: Continuation,
    of_plane: tuple[Plane, np.ndarray, Any] | None,
    pool: Executor | None,
    file: Pieces,
    progress: Callable[[int, int], None] | None,
) -> tuple[list[Quantity], Arrays]:
    """Raises NoOrbitError where there is no orbit to begin with. progress(done, total) counts branches, then curves.

    of_plane : the plane whose edges are explained (swept_plane.py), if the scene begins from one
    """
    names, bounds, more = tuple(scene.parameter), tuple(scene.parameter.values()), {}
    evaluate = kept(compute_curve, pool, file, progress)
    if of_plane is not None:
        evaluate_probes = kept(probe, pool, file, progress)
        explanation = explain(*of_plane, names, bounds, scene.of, scene.depth, evaluate_probes, evaluate)
        curves, more = explanation.curves, edges_in_file(of_plane[0], explanation)
    else:
        starts = _starts(scene, names, bounds, pool, file, progress)
        curves = Curves(names, bounds, scene.of).run(starts, scene.depth, evaluate)
    arrays = joined([curve.arrays for curve in curves], SHAPES, list(names), scene.system.masses)
    columns = ragged_dataset.columns_in_file(CHART, list(names), scene.system, OF_EDGES if more else ())
    return columns, arrays | where_met(curves, arrays["branch_special"]) | more


def _starts(scene: Continuation, names, bounds, pool, file, progress) -> list[Seed]:
    """The seeds of curves within the bounds."""
    on_branches = scene.origin in BY_BRANCHES
    specials = _on_branches(scene, pool, file, progress) if on_branches else specials_of(scene, file, pool)
    seeds = [seed_at(special, names) for special in specials if special.type in scene.of]
    lo, hi = np.transpose(bounds)
    return [seed for seed in seeds if seed is not None and np.all((lo <= (at := seed.place(names))) & (at <= hi))]


def _on_branches(scene: Continuation, pool, file, progress) -> list[SpecialPoint]:
    """All special points of the branches of the scene's orbits along its first number."""
    key, bounds = next(iter(scene.parameter.items()))
    keep = kept(compute_branch, pool, file, progress)

    def evaluate(names, jobs):
        return keep([f"branch {name}" for name in names], jobs)

    branching = Branches((key,), (bounds,), scene.follow)
    nodes = branching.run(seeds_of(scene, file, pool), scene.depth, evaluate)
    return [
        special_point(node.arrays, i, key, node.seed.system)
        for node in nodes
        for i in range(len(node.arrays["special_type"]))
    ]
