"""`vibro_sweep.run`: from a scene of either kind to its file."""

import json
from collections.abc import Callable
from concurrent.futures import Executor
from pathlib import Path
from typing import Literal

import numpy as np

from vibro_sweep.checks.arguments import check_type, checked_count, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.file_names import file_to_write
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.driver.progress import given_or_bar
from vibro_sweep.driver.sweep import RunReport, check_how, run_sweep
from vibro_sweep.files.opening import open_file
from vibro_sweep.scene import Continuation, Scene
from vibro_sweep.tables.bifurcations import CODIMENSION_TWO, TYPES
from vibro_sweep.tables.file_columns import CHART

__all__ = ["RunReport", "run"]


@names_its_arguments
def run(
    scene: Scene | Continuation,
    output: str | Path,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | bool | None = None,
    mode: Literal["new", "resume", "overwrite"] = "new",
    block: int | None = None,
) -> RunReport:
    """Compute a scene and write its file.

    Parameters
    ----------
    scene : of a sweep, of branches or of curves, as `load_scene` returns it
    output : the HDF5 file; that of a sweep is there from the beginning, and can be read at any moment: `status` is -1
        where nothing is computed yet
    workers : of a sweep threads, by default one for each core; of branches and curves processes, by default one; of an
        `executor` that does not say how many it has, its workers
    executor : any `concurrent.futures.Executor` instead
    progress : True: a bar, False: none; or called as progress(done, total), from this thread; left out: a bar on a
        terminal or in a notebook, unless the level of the logger `vibro_sweep` is WARNING
    mode : "new" (nothing that exists is replaced), "resume" (continue `output` where it stopped) or "overwrite"
    block : of a sweep, points of which a worker computes all starts at once; fewer where memory is short; left out: as
        many as take a moment

    An `output` that is complete, and made by the same scene and code, is left as it is: the report is that of its run.
    Results do not depend on workers, executor, block size or interruptions, bit for bit. Memory is that of the blocks
    under way, whatever the size of the sweep. Raises `StoreError` for a file that is in the way or does not fit the
    scene, ValueError for a number of workers that cannot be and where a scene's first orbit does not exist, TypeError
    for arguments of other kinds, RunError where workers fail, and lets KeyboardInterrupt through once the file is safe.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> text = "{system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}, "
    >>> text += "sweep: {b: {values: [3, 4]}}, orbit: {transient: 300, record: 50}}"
    >>> with open("run.yaml", "w") as file:
    ...     _ = file.write(text)
    >>> report = vs.run(vs.load_scene("run.yaml"), "run.h5")
    >>> report.points, report.bad, report.statuses
    (2, 0, {'ok': 2})
    """
    check_type("scene", scene, (Scene, Continuation), "a Scene or a Continuation, as `load_scene` returns it")
    output = file_to_write("output", output)
    check_how(workers, executor, progress, mode)
    if block is not None:
        block = checked_count("block", block, 1)
    if isinstance(scene, Scene):
        return run_sweep(scene, output, workers, executor, progress, mode, block)
    if block is not None:
        raise ArgumentError(not_allowed("block", block, "None of a scene of branches or curves"))
    from vibro_sweep.driver.run_continuation import run_continuation  # a sweep needs nothing of it

    with given_or_bar(progress) as tell:
        computed = run_continuation(scene, output, workers, executor, tell, mode)
    return _report(output, computed)


def _report(path: Path, computed: bool) -> RunReport:
    """The report on a file of branches or curves; `failed` counts those that could not be followed to both ends."""
    with open_file(path) as data:
        types = CODIMENSION_TWO if data.attrs["kind"] == CHART else TYPES
        names = np.array([row.name for row in types])[data["special_type"].values]
        branches, failed = data["branch_period"].size, np.unique(data["special_branch"].values[names == "failed"])
        seconds = json.loads(data.attrs["provenance"])["wall_time_s"]
    counts = {"ok": branches - len(failed), "failed": len(failed)}
    statuses = {name: count for name, count in counts.items() if count}
    return RunReport(branches, len(failed), statuses, seconds, branches if computed else 0)
