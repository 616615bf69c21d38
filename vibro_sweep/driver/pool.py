"""Blocks through an executor: in any order, a bounded number at a time, again where a worker has died."""

import queue
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor

from vibro_sweep.driver.blocks import Block
from vibro_sweep.driver.compute import BlockError, RunError, compute

ATTEMPTS = 3  # at a block whose worker dies: it may be the block that kills them
FINAL = (BlockError, BrokenExecutor, CancelledError, ImportError)  # another attempt would not help
PATIENCE = 1.0  # seconds after which to look whether workers have joined, or the scheduler has died
GIVEN_UP = "the executor gave up its work: the scheduler has died, or somebody has cancelled it"


def as_computed(
    pool: Executor, todo: Iterator[Block], window: Callable[[], int], go_on: Callable[[Block, dict], Block]
) -> Iterator[tuple]:
    """The results of `compute`, as they come; no more than `window()` blocks are under way.

    go_on : called as go_on(block, arrays) where chains go on after a block; the block that it makes comes before others

    A block that is lost with its worker is sent again. Raises RunError where that does not help.
    """
    finished = queue.SimpleQueue()
    under_way = {}  # future: its block, and at which attempt
    parts = deque()  # blocks that go on with the chains of others

    def send(block: Block, attempt: int) -> None:
        try:
            future = pool.submit(compute, block)
        except RunError:
            raise
        except BrokenExecutor as error:
            raise _given_up(block, attempt, error) from error
        except Exception as error:
            raise RunError(f"the executor takes no more work ({type(error).__name__}: {error})") from error
        under_way[future] = block, attempt
        future.add_done_callback(finished.put)

    try:
        while True:
            while len(under_way) < window() and (block := parts.popleft() if parts else next(todo, None)):
                send(block, 1)
            if not under_way:
                return
            try:
                future = finished.get(timeout=PATIENCE)
            except queue.Empty:
                if getattr(pool, "gone", False):
                    raise RunError(GIVEN_UP) from None
                continue
            block, attempt = under_way.pop(future)
            error = CancelledError() if future.cancelled() else future.exception()
            if error is None:
                box, arrays = future.result()
                if not block.last:
                    parts.append(go_on(block, arrays))
                yield box, arrays
            elif isinstance(error, FINAL) or attempt == ATTEMPTS:
                raise _given_up(block, attempt, error) from error
            else:
                send(block, attempt + 1)
    finally:
        for future in under_way:
            future.cancel()


def _given_up(block: Block, attempt: int, error: BaseException) -> RunError:
    reason = f"{type(error).__name__}: {error}"
    if isinstance(error, BlockError):
        return error
    if isinstance(error, BrokenExecutor):
        return RunError(f"a worker process died, killed or out of memory, and its pool with it ({reason})")
    if isinstance(error, CancelledError):
        return RunError(GIVEN_UP)
    if isinstance(error, ImportError):
        return RunError(f"a worker cannot load vibro_sweep ({reason}); install it there")
    return RunError(f"{attempt} attempts at {block} were lost with their workers ({reason})")
