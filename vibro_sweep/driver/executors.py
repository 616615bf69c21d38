"""Jobs through an executor of any kind: in any order, a bounded number at a time, again where a worker has died."""

import contextlib
import os
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, ProcessPoolExecutor
from functools import partial
from multiprocessing import current_process, get_context, parent_process
from pathlib import Path
from typing import Any

from vibro_sweep.driver.compute import BlockError, InternalError, RunError
from vibro_sweep.engine import simd
from vibro_sweep.files.pieces import Pieces

ATTEMPTS = 3  # at a job whose worker dies: it may be the job that kills them
FINAL = (BlockError, BrokenExecutor, CancelledError, ImportError)  # another attempt would not help
PATIENCE = 1.0  # seconds after which to look whether workers have joined, or the scheduler has died
GIVEN_UP = "the executor gave up its work: the scheduler has died, or somebody has cancelled it"
GUARD = 'under `if __name__ == "__main__":`'
AT_ONCE = 4  # short jobs that are sent together
AHEAD = 2  # times as many of these as there are workers


def worker_count(pool: Executor, default: int = 1) -> int:
    """Jobs that an executor computes at a time, now: it may grow. mpi4py calls it `num_workers`."""
    with contextlib.suppress(Exception):  # the scheduler may be away for a moment
        return sum(pool._client.nthreads().values()) or default  # of Dask
    return getattr(pool, "num_workers", None) or getattr(pool, "_max_workers", None) or default


def _is_gone(pool: Executor) -> bool:
    """Whether it is of a Dask scheduler that has died. A job that was sent at that moment is never answered."""
    return getattr(getattr(pool, "_client", None), "status", None) in ("closing", "closed")


def completed(
    pool: Executor, function: Callable, following: Callable[[], Any], window: Callable[[], int]
) -> Iterator[tuple[Any, Any, float]]:
    """(job, function(job), seconds), as they come; no more than `window()` jobs are under way.

    following : the next job, or None where there is none before other results are there
    A job that is lost with its worker is sent again. Raises RunError where that does not help.
    """
    finished: queue.SimpleQueue = queue.SimpleQueue()
    under_way = {}  # future: its job, at which attempt, and when it was sent

    def send(job: Any, attempt: int) -> None:
        try:
            future = pool.submit(function, job)
        except BrokenExecutor as error:
            raise _given_up(job, attempt, error) from error
        except Exception as error:
            if _is_gone(pool):
                raise RunError(GIVEN_UP) from error
            raise RunError(f"the executor takes no more work ({type(error).__name__}: {error})") from error
        under_way[future] = job, attempt, time.monotonic()
        future.add_done_callback(finished.put)

    try:
        while True:
            while len(under_way) < window() and (job := following()) is not None:
                send(job, 1)
            if not under_way:
                return
            try:
                future = finished.get(timeout=PATIENCE)
            except queue.Empty:
                if _is_gone(pool):
                    raise RunError(GIVEN_UP) from None
                continue
            job, attempt, sent = under_way.pop(future)
            error = CancelledError() if future.cancelled() else future.exception()
            if error is None:
                yield job, future.result(), time.monotonic() - sent
            elif isinstance(error, FINAL) or attempt == ATTEMPTS:
                raise _given_up(job, attempt, error) from error
            else:
                send(job, attempt + 1)
    finally:
        for future in under_way:
            future.cancel()


def _given_up(job: Any, attempt: int, error: BaseException) -> RunError:
    reason = f"{type(error).__name__}: {error}"
    if isinstance(error, BlockError):
        return error
    if isinstance(error, BrokenExecutor):
        if _is_script_without_guard():
            return RunError(f"workers run the whole script again, for want of a line in it: put what it does {GUARD}")
        return RunError(f"a worker process died, killed or out of memory, and its pool with it ({reason})")
    if isinstance(error, CancelledError):
        return RunError(GIVEN_UP)
    if isinstance(error, ImportError):
        return RunError(f"a worker cannot load vibro_sweep ({reason}); install it there")
    return RunError(f"{attempt} attempts at {job} were lost with their workers ({reason})")


def _is_script_without_guard() -> bool:
    """Whether Python runs a file in which nothing asks whether it is the program, or a module of a worker."""
    try:
        return "__main__" not in Path(sys.modules["__main__"].__file__).read_text()
    except (AttributeError, KeyError, TypeError, OSError, ValueError):
        return False


@contextlib.contextmanager
def workers_of(workers: int | None, executor: Executor | None) -> Iterator[Executor | None]:
    """The executor that computes: the caller's, processes of our own for several workers, or None: this process."""
    if executor is not None or workers in (None, 1):
        yield executor
        return
    if getattr(current_process(), "_inheriting", False):  # a worker that runs the script again, to import it
        os._exit(1)
    simd.FREE.set()  # its processes compile and compute
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


def kept(
    function: Callable, pool: Executor | None, file: Pieces, progress: Callable[[int, int], None] | None = None
) -> Callable[[list[str], list], list]:
    """evaluate(names, jobs): the results of `function` for short jobs, which the run `file` keeps by these names.

    progress : called as progress(done, total) in jobs
    """
    done = 0

    def evaluate(names: list[str], jobs: list) -> list:
        nonlocal done
        result_of = {name: file.get(name) for name in names}
        missing = iter([(name, job) for name, job in zip(names, jobs, strict=True) if result_of[name] is None])
        total = done + len(jobs)
        done += sum(result is not None for result in result_of.values())
        for name, result in _results(function, pool, missing):
            file.write(name, result)
            result_of[name] = result
            done += 1
            if progress:
                progress(done, total)
        return list(result_of.values())

    return evaluate


def _results(function: Callable, pool: Executor | None, jobs: Iterator[tuple[str, Any]]) -> Iterator[tuple[str, Any]]:
    """The results of jobs with names, as they come: in this process, or some together in others."""
    if pool is None:
        yield from ((name, function(job)) for name, job in jobs)
        return

    def following() -> list | None:
        return [job for _, job in zip(range(AT_ONCE), jobs, strict=False)] or None

    for _, results, _ in completed(pool, partial(_all, function), following, lambda: AHEAD * worker_count(pool)):
        yield from results


def _all(function: Callable, jobs: list[tuple[str, Any]]) -> list[tuple[str, Any]]:
    try:
        return [(name, function(job)) for name, job in jobs]
    except Exception as error:
        raise InternalError(f"a worker failed: {type(error).__name__}: {error}") from error
