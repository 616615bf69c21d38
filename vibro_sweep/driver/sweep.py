"""From a scene to its file: blocks of points, computed by an executor, handed to the store as they come."""

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from vibro_sweep.checks.arguments import check_call
from vibro_sweep.checks.errors import ArgumentError, ArgumentTypeError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.driver import MOST_WORKERS
from vibro_sweep.driver.attractor_ids import following, number_attractors
from vibro_sweep.driver.block_size import BlockSize
from vibro_sweep.driver.blocks import Block, blocks, missing_spans, next_part, whole_chains
from vibro_sweep.driver.compute import CHAIN_ENDS, compute
from vibro_sweep.driver.executors import completed, worker_count
from vibro_sweep.driver.memory_needed import available_cores, blocks_under_way, orbits_per_block
from vibro_sweep.driver.progress import given_or_bar
from vibro_sweep.driver.provenance import provenance
from vibro_sweep.engine.halting import heed, new_halt
from vibro_sweep.files.subject import Complete, check_mode, now
from vibro_sweep.files.sweep_file import SweepFile
from vibro_sweep.files.sweep_runs import sweep_run
from vibro_sweep.results import layout
from vibro_sweep.results.in_memory import InMemory
from vibro_sweep.scene import Scene
from vibro_sweep.tables.outcomes import VALID, status_of

BLOCK_SECONDS = 1.0  # of a thread's block: long enough for its overhead not to count, short enough to lose
SENT_SECONDS = 4.0  # of one that an executor computes


@dataclass
class RunReport:
    """The report on a file that `run` has made.

    points : orbits; of branches and curves, so many of these
    bad : how many of them have a bad status; `not_settled` is a remark and no bad status: the numbers stand
    statuses : how many have which
    seconds : wall time
    computed : points that this call has computed, 0 where the file was complete already

    Reports of equal files are equal.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> text = "{system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}, "
    >>> text += "sweep: {b: {values: [3, 4]}}, orbit: {transient: 300, record: 50}}"
    >>> with open("report.yaml", "w") as file:
    ...     _ = file.write(text)
    >>> scene = vs.load_scene("report.yaml")
    >>> report, again = vs.run(scene, "report.h5"), vs.run(scene, "report.h5")
    >>> report.computed, again.computed, report == again
    (2, 0, True)
    """

    points: int
    bad: int
    statuses: dict[str, int]
    seconds: float
    computed: int = field(compare=False)


def run_sweep(
    scene: Scene,
    output: Path,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | bool | None = None,
    mode: str = "new",
    block: int | None = None,
) -> RunReport:
    """Compute a sweep and write its file; arguments and errors as of `run`."""
    data, size = layout.dataset(scene), layout.size(scene)
    with sweep_run(data, following(scene), size, output, mode, provenance(), scene.inputs) as file:
        if isinstance(file, Complete):
            if progress and not isinstance(progress, bool):
                progress(scene.n_points, scene.n_points)
            return _report(file, 0)
        return fill(scene, file, workers, executor, progress, block)


def fill(
    scene: Scene,
    file: SweepFile | InMemory,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | bool | None = None,
    block: int | None = None,
) -> RunReport:
    """Compute what is missing of a sweep; arguments and errors as of `run`."""
    total = scene.n_points
    missing, done = total - file.done(), file.done()
    with given_or_bar(progress) as tell:
        if tell:
            tell(done, total)
        if missing:
            workers_here = workers or available_cores()
            with closing(_results(scene, file, missing, workers_here, executor, block)) as results:
                for box, arrays in results:
                    file.write(box, arrays)
                    done += arrays["status"].size
                    if tell:
                        tell(min(done, total), total)
    numbered = number_attractors(scene, file.read) if "attractors" in scene.observe else {}
    threads = (workers or available_cores()) if executor is None else None
    seconds = file.finish(numbered, _how(scene, threads, executor) | {"history": [f"{now()} complete"]})
    codes, counts = np.unique(file.status, return_counts=True)
    return _report(Complete(dict(zip(codes.tolist(), counts.tolist(), strict=True)), seconds), missing)


def _report(made: Complete, computed: int) -> RunReport:
    bad = sum(number for code, number in made.statuses.items() if code not in VALID)
    named = {status_of(code).name: number for code, number in made.statuses.items()}
    return RunReport(sum(named.values()), bad, named, made.seconds, computed)


def check_how(workers, executor, progress, mode) -> None:
    """Check the arguments of `run` that say how it computes."""
    if workers is not None and (type(workers) is not int or not 1 <= workers <= MOST_WORKERS):
        raise ArgumentError(not_allowed("workers", workers, f"a whole number from 1 to {MOST_WORKERS}"))
    if executor is not None and not callable(getattr(type(executor), "submit", None)):
        raise ArgumentTypeError(not_allowed("executor", executor, "a concurrent.futures.Executor"))
    if not isinstance(progress, bool):
        check_call("progress", progress, "progress(done, total)", 0, 0)
    check_mode(mode)


def _results(
    scene: Scene, file: SweepFile | InMemory, missing: int, workers: int, executor: Executor | None, points: int | None
) -> Iterator[tuple]:
    """Results of all blocks, of so many points, with one of the missing orbits, as they come."""
    count = workers if executor is None else worker_count(executor, workers)
    size = BlockSize(scene, missing, count, BLOCK_SECONDS if executor is None else SENT_SECONDS, points)
    orbits = orbits_per_block(scene, count)
    most = blocks_under_way(scene, orbits, here=executor is None)
    halt = new_halt()
    pool = executor or ThreadPoolExecutor(min(workers, most), initializer=heed, initargs=(halt,))
    cut = blocks(scene, size, orbits, missing_spans(scene, file.status))
    todo = (block for block in cut if file.missing(whole_chains(block)))
    parts: deque[Block] = deque()  # which go on with the chains of others

    def next_block() -> Block | None:
        return parts.popleft() if parts else next(todo, None)

    def window() -> int:  # one block for each worker: it gets its next when the one before is safe in the file
        return min(worker_count(pool, workers), most)

    try:
        for block, (box, arrays), seconds in completed(pool, compute, next_block, window):
            size.learn(block, seconds)
            if not block.last:
                parts.append(next_part(scene, block, arrays.pop(CHAIN_ENDS)))
            if file.missing(box):  # parts of chains may only lead to the one that is missing
                yield box, arrays
    finally:
        if executor is None:
            halt[0] = 1
            pool.shutdown(wait=False, cancel_futures=True)


def _how(scene: Scene, threads: int | None, executor: Executor | None) -> dict:
    """How a sweep is computed, for the provenance of its file."""
    seed = scene.start.seed if scene.start.kind == "random" else None
    here = "threads" if executor is None else type(executor).__name__
    return {"executor": here, "threads": threads, "seed": seed}
