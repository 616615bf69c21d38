"""From a scene of branches or of curves to its file."""

from collections.abc import Callable
from concurrent.futures import Executor
from pathlib import Path

from vibro_sweep.checks.file_names import file_to_write
from vibro_sweep.driver.executors import workers_of
from vibro_sweep.driver.followed_branches import followed_branches
from vibro_sweep.driver.followed_curves import followed_curves
from vibro_sweep.driver.origins import NoOrbitError, attributes_of, source_of
from vibro_sweep.driver.provenance import provenance
from vibro_sweep.driver.source_file import computed_from_source
from vibro_sweep.driver.swept_plane import plane_of
from vibro_sweep.files.pieces import pieces_run
from vibro_sweep.files.subject import Complete
from vibro_sweep.results import ragged_dataset
from vibro_sweep.scene import Continuation
from vibro_sweep.tables.file_columns import BRANCHES, CHART


def run_continuation(
    scene: Continuation,
    output: str | Path,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
    mode: str = "new",
) -> bool:
    """Follow the branches or curves of a scene and write their file; arguments as of `run`. False: it is complete
    already.

    The file does not depend on workers, executor or interruptions. Raises StoreError as `run` does, ValueError where
    the scene's first orbit does not exist, RunError where workers fail.
    """
    output, of_curves = file_to_write("output", output), len(scene.parameter) > 1
    with computed_from_source(scene):
        of_plane = plane_of(scene) if of_curves else None
        attributes = attributes_of(scene, source_of(scene))
        header = ragged_dataset.attributes_of(CHART if of_curves else BRANCHES, scene.name, scene.text, attributes)
        with pieces_run(header, output, mode, provenance(), scene.inputs) as file:
            if isinstance(file, Complete):
                return False
            with workers_of(workers, executor) as pool:
                try:
                    if of_curves:
                        contents = followed_curves(scene, of_plane, pool, file, progress)
                    else:
                        contents = followed_branches(scene, pool, file, progress)
                except NoOrbitError:
                    file.drop()
                    raise
            file.finish(ragged_dataset.dataset(header, *contents))
            return True
