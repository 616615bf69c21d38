"""Many small jobs through an executor: in any order, a bounded number at a time, each result kept as it comes."""

import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, ProcessPoolExecutor, wait
from contextlib import contextmanager
from itertools import islice
from multiprocessing import get_context, parent_process
from typing import Any

from vibro_sweep.driver.compute import RunError
from vibro_sweep.driver.pool import GIVEN_UP, PATIENCE

AT_ONCE = 4  # jobs that are sent together
AHEAD = 2  # times as many as there are workers


@contextmanager
def workers_of(workers: int | None, executor: Executor | None) -> Iterator[Executor | None]:
    """The executor that computes: the caller's, processes of our own for several workers, or None: this process."""
    if executor is not None or workers in (None, 1):
        yield executor
        return
    pool = ProcessPoolExecutor(workers, get_context("spawn"), _begin)
    try:
        yield pool
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


def _begin() -> None:
    """Begin a worker: Ctrl-C is answered by the parent; where the parent is killed, the worker ends as well."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """Without this a worker would wait for ever for jobs: it holds both ends of the queue itself."""
    parent = parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)


def results(pool: Executor | None, function: Callable, jobs: Iterable[tuple[Any, Any]]) -> Iterator[tuple[Any, Any]]:
    """(key, function(job)) of jobs (key, job), as they come. Raises RunError where workers die."""
    if pool is None:
        for key, job in jobs:
            yield key, function(job)
        return
    todo, under_way = iter(jobs), {}
    count = getattr(pool, "num_workers", None) or getattr(pool, "_max_workers", None) or 1
    try:
        while True:
            while len(under_way) < AHEAD * count and (batch := list(islice(todo, AT_ONCE))):
                future = pool.submit(_all, function, [job for _, job in batch])
                under_way[future] = [key for key, _ in batch]
            if not under_way:
                return
            done, _ = wait(under_way, PATIENCE, FIRST_COMPLETED)
            if not done and getattr(pool, "gone", False):
                raise RunError(GIVEN_UP)
            for future in done:
                yield from zip(under_way.pop(future), future.result(), strict=True)
    except BrokenExecutor as error:
        raise RunError(f"a worker process died, killed or out of memory ({error})") from error
    except CancelledError as error:
        raise RunError(GIVEN_UP) from error
    finally:
        for future in under_way:
            future.cancel()


def computed(function: Callable, pool: Executor | None, file, progress=None) -> Callable[[list[str], list], list]:
    """evaluate(names, jobs): the results of `function`, which the run `file` (files/pieces.py) keeps by these names.

    progress : called as progress(done, total) in jobs
    """
    done = 0

    def evaluate(names: list[str], jobs: list) -> list:
        nonlocal done
        kept = {name: file.get(name) for name in names}
        missing = [(name, job) for name, job in zip(names, jobs, strict=True) if kept[name] is None]
        total = done + len(jobs)
        done += len(jobs) - len(missing)
        for name, result in results(pool, function, missing):
            file.write(name, result)
            kept[name] = result
            done += 1
            if progress:
                progress(done, total)
        return list(kept.values())

    return evaluate


def _all(function: Callable, jobs: list) -> list:
    return [function(job) for job in jobs]
