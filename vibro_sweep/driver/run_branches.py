"""From a scene of branches to its file."""

from collections.abc import Callable
from concurrent.futures import Executor
from pathlib import Path

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import SHAPES
from vibro_sweep.analysis.branches.branch_search import Branches, compute_branch
from vibro_sweep.analysis.branches.search import Node
from vibro_sweep.driver.jobs import computed, workers_of
from vibro_sweep.driver.origins import NoOrbitError, attributes_of, seeds_of, source_of
from vibro_sweep.driver.provenance import provenance
from vibro_sweep.driver.source_file import computed_from_source
from vibro_sweep.driver.usable import is_branch
from vibro_sweep.model.branch_file import BRANCHES, columns_of
from vibro_sweep.model.files import file_to_write
from vibro_sweep.model.state import state
from vibro_sweep.scene import Continuation
from vibro_sweep.store.joining import joined
from vibro_sweep.store.pieces import pieces
from vibro_sweep.store.ragged_files import Subject


def run_branches(
    scene: Continuation,
    output: str | Path,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
    mode: str = "new",
) -> bool:
    """Follow the branches of a scene and write their file; arguments as of `run`. False: it is complete already.

    progress : called as progress(done, total) in branches
    The file does not depend on workers, executor or interruptions. Raises StoreError as `run` does, ValueError where
    the scene's first orbit does not exist, RunError where workers fail.
    """
    output = file_to_write("output", output)
    with computed_from_source(scene):
        subject = Subject(BRANCHES, scene.name, scene.text, attributes_of(scene, source_of(scene)))
        with pieces(subject, output, mode, scene.inputs) as file:
            if file.complete:
                return False
            with workers_of(workers, executor) as pool:
                try:
                    seeds = seeds_of(scene, file, pool)
                except NoOrbitError:
                    file.drop()
                    raise
                evaluate = computed(compute_branch, is_branch, pool, file, progress)
                branching = Branches(tuple(scene.parameter), tuple(scene.parameter.values()), scene.follow)
                found = branching.run(seeds, scene.depth, evaluate)
            file.finish(provenance(), *_contents(scene, found))
            return True


def _contents(scene: Continuation, found: list[Node]) -> tuple:
    """Columns and arrays of the file."""
    names, masses = list(scene.parameter), scene.system.masses
    arrays = joined([node.arrays for node in found], SHAPES, names, masses)
    sections = [node.arrays["section"].reshape(-1, 2 * masses) for node in found]
    together = np.concatenate(sections) if sections else np.zeros((0, 2 * masses))
    arrays |= {f"section_{name}": together[:, i] for i, name in enumerate(state(masses))}
    arrays["branch_sections"] = np.array([node.arrays["section"].shape[1] for node in found], int)
    return columns_of(BRANCHES, names, scene.system), arrays | where_met(found, arrays["branch_special"])


def where_met(found: list[Node], counts: np.ndarray) -> dict[str, np.ndarray]:
    """The columns that say from which special point each branch or curve was reached; counts : of those of each."""
    parents = np.array([node.seed.parent for node in found], int)
    own = np.array([node.seed.special for node in found], int)
    first = np.append(0, np.cumsum(counts))
    return {
        "branch_parent": parents,
        "branch_parent_special": np.where(parents >= 0, first[parents] + own, -1),
        "branch_generation": np.array([node.generation for node in found], int),
    }
