"""From a scene with two numbers in `parameter` to its file: bifurcation curves."""

from collections.abc import Callable
from concurrent.futures import Executor
from pathlib import Path

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import special_point
from vibro_sweep.analysis.branches.branch_search import Branches, compute_branch
from vibro_sweep.analysis.branches.seeds import Seed
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.curves.curve_arrays import SHAPES
from vibro_sweep.analysis.curves.curve_search import Curves, compute_curve, seed_at
from vibro_sweep.analysis.windows.explained import explain, probe
from vibro_sweep.driver.jobs import computed, workers_of
from vibro_sweep.driver.origins import NoOrbitError, attributes_of, seeds_of, source_of, specials_of
from vibro_sweep.driver.provenance import provenance
from vibro_sweep.driver.run_branches import where_met
from vibro_sweep.driver.source_file import computed_from_source
from vibro_sweep.driver.swept_plane import edges_in_file, plane_of
from vibro_sweep.driver.usable import is_branch, is_curve, is_probe
from vibro_sweep.model.branch_file import CHART, columns_of
from vibro_sweep.model.curve_columns import OF_EDGES
from vibro_sweep.model.files import file_to_write
from vibro_sweep.scene import Continuation
from vibro_sweep.scene.continuation import BY_BRANCHES
from vibro_sweep.store.joining import joined
from vibro_sweep.store.pieces import pieces
from vibro_sweep.store.ragged_files import Subject


def run_curves(
    scene: Continuation,
    output: str | Path,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
    mode: str = "new",
) -> bool:
    """Follow the bifurcation curves of a scene and write their file; arguments as of `run`. False: it is complete
    already.

    progress : called as progress(done, total) in branches, then in curves
    The file does not depend on workers, executor or interruptions. Raises what `run_branches` raises.
    """
    output = file_to_write("output", output)
    with computed_from_source(scene):
        of_plane = plane_of(scene)
        subject = Subject(CHART, scene.name, scene.text, attributes_of(scene, source_of(scene)))
        with pieces(subject, output, mode, scene.inputs) as file:
            if file.complete:
                return False
            file.finish(provenance(), *_contents(scene, of_plane, workers, executor, file, progress))
            return True


def _contents(scene: Continuation, of_plane, workers, executor, file, progress) -> tuple:
    """Columns and arrays of the file."""
    names, bounds, more = tuple(scene.parameter), tuple(scene.parameter.values()), {}
    with workers_of(workers, executor) as pool:
        evaluate = computed(compute_curve, is_curve, pool, file, progress)
        if of_plane is not None:
            evaluate_probes = computed(probe, is_probe, pool, file, progress)
            found = explain(*of_plane, names, bounds, scene.of, scene.depth, evaluate_probes, evaluate)
            curves, more = found.curves, edges_in_file(of_plane[0], found)
        else:
            try:
                starts = _starts(scene, names, bounds, pool, file, progress)
            except NoOrbitError:
                file.drop()
                raise
            curves = Curves(names, bounds, scene.of).run(starts, scene.depth, evaluate)
    arrays = joined([one.arrays for one in curves], SHAPES, list(names), scene.system.masses)
    held = columns_of(CHART, list(names), scene.system, OF_EDGES if more else ())
    return held, arrays | where_met(curves, arrays["branch_special"]) | more


def _starts(scene: Continuation, names, bounds, pool, file, progress) -> list[Seed]:
    """The seeds of curves within the bounds."""
    on_branches = scene.origin in BY_BRANCHES
    specials = _on_branches(scene, pool, file, progress) if on_branches else specials_of(scene, file, pool)
    found = [seed_at(special, names) for special in specials if special.type in scene.of]
    lo, hi = np.transpose(bounds)
    return [one for one in found if one is not None and np.all((lo <= (at := one.place(names))) & (at <= hi))]


def _on_branches(scene: Continuation, pool, file, progress) -> list[SpecialPoint]:
    """All special points of the branches of the scene's orbits along its first number."""
    key, bounds = next(iter(scene.parameter.items()))
    keep = computed(compute_branch, is_branch, pool, file, progress)

    def evaluate(names, jobs):
        return keep([f"branch {name}" for name in names], jobs)

    branching = Branches((key,), (bounds,), scene.follow)
    nodes = branching.run(seeds_of(scene, file, pool), scene.depth, evaluate)
    return [
        special_point(node.arrays, i, key, node.seed.system)
        for node in nodes
        for i in range(len(node.arrays["special_type"]))
    ]
