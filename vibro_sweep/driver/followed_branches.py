"""The branches of a scene, as the columns and arrays of its file."""

from collections.abc import Callable
from concurrent.futures import Executor

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import SHAPES, Arrays
from vibro_sweep.analysis.branches.branch_search import Branches, compute_branch
from vibro_sweep.analysis.branches.search import Node
from vibro_sweep.driver.executors import kept
from vibro_sweep.driver.joining import joined
from vibro_sweep.driver.origins import seeds_of
from vibro_sweep.files.pieces import Pieces
from vibro_sweep.results import ragged_dataset
from vibro_sweep.scene import Continuation
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.file_columns import BRANCHES, OF_CONTACTS
from vibro_sweep.tables.quantity import Quantity


def followed_branches(
    scene: Continuation, pool: Executor | None, file: Pieces, progress: Callable[[int, int], None] | None
) -> tuple[list[Quantity], Arrays]:
    """Raises NoOrbitError where the scene's first orbit does not exist. progress(done, total) counts branches."""
    names, masses = list(scene.parameter), scene.system.masses
    evaluate = kept(compute_branch, pool, file, progress)
    search = Branches(tuple(names), tuple(scene.parameter.values()), scene.follow, observe=scene.observe)
    nodes = search.run(seeds_of(scene, file, pool), scene.depth, evaluate)
    arrays = joined([node.arrays for node in nodes], SHAPES, names, masses)
    sections = [node.arrays["section"].reshape(-1, 2 * masses) for node in nodes]
    together = np.concatenate(sections) if sections else np.zeros((0, 2 * masses))
    arrays |= {f"section_{name}": together[:, i] for i, name in enumerate(state(masses))}
    arrays["branch_sections"] = np.array([node.arrays["section"].shape[1] for node in nodes], int)
    columns = ragged_dataset.columns_in_file(BRANCHES, names, scene.system, OF_CONTACTS if scene.observe else ())
    return columns, arrays | where_met(nodes, arrays["branch_special"])


def where_met(nodes: list[Node], counts: np.ndarray) -> dict[str, np.ndarray]:
    """The columns that say from which special point each branch or curve was reached; counts : of those of each."""
    parents = np.array([node.seed.parent for node in nodes], int)
    special_points = np.array([node.seed.special for node in nodes], int)
    first = np.append(0, np.cumsum(counts))
    return {
        "branch_parent": parents,
        "branch_parent_special": np.where(parents >= 0, first[parents] + special_points, -1),
        "branch_generation": np.array([node.generation for node in nodes], int),
    }
